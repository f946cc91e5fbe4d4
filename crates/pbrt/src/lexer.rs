//! Bytes to tokens, and lists of numbers straight into vectors.

use std::sync::Arc;

use crate::error::{Error, ErrorKind};
use crate::load;
use crate::number::{self, NumberError, is_delimiter};
use crate::params::Numbers;
use crate::source::SourceFile;
use crate::span::{Place, Span};
use crate::token::{Token, TokenKind};

/// Lists up to this length keep their numbers in double precision.
const WIDE: usize = 64;

/// A reader of tokens over one file.
#[derive(Clone, Debug)]
pub struct Lexer {
    source: Arc<SourceFile>,
    pos: usize,
}

impl Lexer {
    /// Starts after the byte order mark, if there is one.
    pub fn new(source: Arc<SourceFile>) -> Lexer {
        let pos = load::text_start(source.bytes());
        Lexer { source, pos }
    }

    /// Starts at a byte offset.
    pub fn at(source: Arc<SourceFile>, offset: u32) -> Lexer {
        Lexer { source, pos: offset as usize }
    }

    /// The file.
    pub fn source(&self) -> &Arc<SourceFile> {
        &self.source
    }

    /// The bytes of a token.
    pub fn bytes(&self, token: Token) -> &[u8] {
        self.source.slice(token.span)
    }

    /// A span with its file.
    pub fn place(&self, span: Span) -> Place {
        Place { source: self.source.clone(), span }
    }

    /// The empty span at the end of the file.
    pub fn end_span(&self) -> Span {
        self.span(self.source.bytes().len(), self.source.bytes().len())
    }

    /// The next token; none at the end of the file.
    ///
    /// # Errors
    /// A string that is not closed on its line, or bytes that no text has.
    pub fn next_token(&mut self) -> Result<Option<Token>, Error> {
        let bytes = self.source.bytes();
        let start = skip_blanks(bytes, self.pos);
        self.pos = start;
        let Some(&first) = bytes.get(start) else { return Ok(None) };
        let (kind, end) = match first {
            b'"' => return self.quoted(start).map(Some),
            b'[' => (TokenKind::Open, start + 1),
            b']' => (TokenKind::Close, start + 1),
            _ => (TokenKind::Word, word_end(bytes, start)),
        };
        if kind == TokenKind::Word
            && let Some(n) = bytes[start..end.max(start + 1)].iter().position(|&b| b < b' ' || b == 0x7F)
        {
            return Err(load::binary(&self.source, start + n));
        }
        self.pos = end;
        Ok(Some(Token { kind, span: self.span(start, end) }))
    }

    /// The next token, which stays the next one.
    ///
    /// # Errors
    /// As [`Lexer::next_token`].
    pub fn peek(&mut self) -> Result<Option<Token>, Error> {
        let token = self.next_token();
        if let Ok(Some(token)) = token {
            self.pos = token.span.offset as usize;
        }
        token
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span { file: self.source.id(), offset: start as u32, len: (end - start) as u32 }
    }

    fn quoted(&mut self, start: usize) -> Result<Token, Error> {
        let bytes = self.source.bytes();
        let mut escaped = false;
        let mut i = start + 1;
        loop {
            match bytes.get(i) {
                Some(b'"') => break,
                Some(b'\\') => {
                    escaped = true;
                    // a backslash before the line's end escapes nothing: let the next round see the end
                    i += if matches!(bytes.get(i + 1), None | Some(b'\n')) { 1 } else { 2 };
                }
                None | Some(b'\n') => return Err(self.unclosed(start, i)),
                Some(0) => return Err(load::binary(&self.source, i)),
                Some(_) => i += 1,
            }
        }
        self.pos = i + 1;
        Ok(Token { kind: TokenKind::Quoted { escaped }, span: self.span(start, i + 1) })
    }

    fn unclosed(&self, start: usize, end: usize) -> Error {
        let error = Error::new(ErrorKind::UnclosedString, self.place(self.span(start, end)));
        let text = &self.source.bytes()[start..end];
        if text.contains(&b'\\') {
            error.hint("a backslash before `\"` keeps the string open: write `\\\\` or `/` at the end of a folder name")
        } else {
            error
        }
    }

    /// Reads numbers up to the closing bracket; `open` is the opening one. Gives the whole list's span too.
    pub(crate) fn number_list(&mut self, open: Token) -> Result<(Numbers, Span), ListError> {
        let mut wide = Vec::new();
        if let Some(span) = self.list(open, &mut wide, WIDE + 1, number::scan_f64)? {
            return Ok((Numbers::Wide(wide), span));
        }
        let mut narrow: Vec<f32> = wide.iter().map(|&x| x as f32).collect();
        let span = self.list(open, &mut narrow, usize::MAX, number::scan_f32)?;
        Ok((Numbers::Narrow(narrow), span.expect("a list without limit ends at its bracket")))
    }

    /// Reads integers up to the closing bracket. Gives the list's span, and the place of the first integer that is
    /// written as a float.
    pub(crate) fn integer_list(
        &mut self,
        open: Token,
        out: &mut Vec<i32>,
    ) -> Result<(Span, Option<Span>), ListError> {
        let mut float = None;
        let scan = |bytes: &[u8], pos| {
            let (value, end, is_float) = number::scan_i32(bytes, pos)?;
            if is_float && float.is_none() {
                float = Some((pos, end));
            }
            Ok((value, end))
        };
        let span = self.list(open, out, usize::MAX, scan)?;
        let span = span.expect("a list without limit ends at its bracket");
        Ok((span, float.map(|(start, end)| self.span(start, end))))
    }

    /// Reads items until there are `limit` of them (then none is returned) or the list is closed.
    #[inline(always)]
    fn list<T>(
        &mut self,
        open: Token,
        out: &mut Vec<T>,
        limit: usize,
        mut scan: impl FnMut(&[u8], usize) -> Result<(T, usize), NumberError>,
    ) -> Result<Option<Span>, ListError> {
        let source = self.source.clone();
        let bytes = source.bytes();
        let mut pos = self.pos;
        while out.len() < limit {
            pos = skip_blanks(bytes, pos);
            self.pos = pos;
            match bytes.get(pos) {
                Some(b']') => return Ok(Some(self.close_list(open))),
                None => return Err(self.unclosed_list(open)),
                Some(_) => {
                    let (value, end) = scan(bytes, pos).map_err(|why| self.bad_item(why))?;
                    out.push(value);
                    pos = end;
                }
            }
        }
        self.pos = pos;
        Ok(None)
    }

    fn close_list(&mut self, open: Token) -> Span {
        self.pos += 1;
        self.span(open.span.offset as usize, self.pos)
    }

    fn unclosed_list(&self, open: Token) -> ListError {
        ListError::Syntax(Error::new(ErrorKind::UnclosedList, self.place(open.span)))
    }

    /// The item at the current position is no number: a token to show, or an error of its own.
    #[cold]
    fn bad_item(&mut self, why: NumberError) -> ListError {
        match self.next_token() {
            Ok(Some(token)) => ListError::Item(why, token),
            Ok(None) => ListError::Item(why, Token { kind: TokenKind::Word, span: self.end_span() }),
            Err(e) => ListError::Syntax(e),
        }
    }
}

/// Why a list of numbers ends early.
pub(crate) enum ListError {
    Item(NumberError, Token),
    Syntax(Error),
}

/// The position of the next byte that is neither blank nor in a comment.
#[inline(always)]
fn skip_blanks(bytes: &[u8], mut i: usize) -> usize {
    while let Some(&b) = bytes.get(i) {
        match b {
            b' ' | b'\n' | b'\t' | b'\r' | 0x0B | 0x0C => i += 1,
            b'#' => i = comment_end(bytes, i),
            _ => break,
        }
    }
    i
}

/// The position of the line's end.
fn comment_end(bytes: &[u8], start: usize) -> usize {
    bytes[start..].iter().position(|&b| b == b'\n' || b == b'\r').map_or(bytes.len(), |n| start + n)
}

/// The position after a bare word; a control byte ends it too (and is an error of its own).
fn word_end(bytes: &[u8], start: usize) -> usize {
    bytes[start..].iter().position(|&b| is_delimiter(b)).map_or(bytes.len(), |n| start + n)
}
