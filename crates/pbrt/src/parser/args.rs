//! Arguments of directives, and messages about tokens that do not fit.

use super::Parser;
use crate::error::{Error, ErrorKind};
use crate::lexer::Lexer;
use crate::number::{self, NumberError};
use crate::span::Span;
use crate::text::Text;
use crate::token::{Token, TokenKind};

/// How much of a long token a message shows.
const SHOWN: usize = 60;

impl Parser {
    /// The next token, which `context` needs.
    pub(super) fn need(&mut self, context: &str, expected: &str) -> Result<Token, Error> {
        match self.lexer.next_token()? {
            Some(token) => Ok(token),
            None => Err(self.unexpected(context, expected, None)),
        }
    }

    /// One quoted string.
    pub(super) fn string(&mut self, context: &str, expected: &str) -> Result<Text, Error> {
        let token = self.need(context, expected)?;
        match token.kind {
            TokenKind::Quoted { escaped } => Ok(self.text(token, escaped)),
            _ => Err(self.unexpected(context, expected, Some(token))),
        }
    }

    /// The string of a quoted token.
    pub(super) fn text(&self, token: Token, escaped: bool) -> Text {
        let bytes = self.lexer.bytes(token);
        let (text, clean) = Text::unquote(&bytes[1..bytes.len() - 1], escaped, token.span);
        if !clean {
            self.diagnostics.warn_hint(
                self.place(token.span),
                "string is not UTF-8; other bytes were replaced",
                "save the file as UTF-8",
            );
        }
        text
    }

    /// `N` numbers without brackets.
    pub(super) fn numbers<const N: usize>(&mut self, context: &str) -> Result<[f64; N], Error> {
        let mut values = [0.0; N];
        for (i, value) in values.iter_mut().enumerate() {
            let expected = if N == 1 { "a number".into() } else { format!("{N} numbers") };
            let token = self.need(context, &expected)?;
            *value = match token.kind {
                TokenKind::Word => self.number(context, token)?,
                _ => {
                    return Err(self
                        .unexpected(context, &expected, Some(token))
                        .maybe_hint(brackets(token, i)));
                }
            };
        }
        Ok(values)
    }

    /// `[` 16 numbers `]`
    pub(super) fn matrix(&mut self, context: &str) -> Result<[f64; 16], Error> {
        let expected = "`[`, 16 numbers, `]`";
        let open = self.need(context, expected)?;
        if open.kind != TokenKind::Open {
            return Err(self.unexpected(context, expected, Some(open)));
        }
        let values = self.numbers::<16>(context)?;
        let close = self.need(context, "`]` after 16 numbers")?;
        if close.kind != TokenKind::Close {
            return Err(self.unexpected(context, "`]` after 16 numbers", Some(close)));
        }
        Ok(values)
    }

    /// The number that a word is.
    pub(super) fn number(&self, context: &str, token: Token) -> Result<f64, Error> {
        let word = String::from_utf8_lossy(self.lexer.bytes(token));
        number::parse_f64(&word).map_err(|why| self.bad_number(context, "a number", why, token))
    }

    /// The error for a token that should be a number.
    pub(super) fn bad_number(&self, context: &str, wanted: &str, why: NumberError, token: Token) -> Error {
        let expected = match why {
            NumberError::Malformed | NumberError::Fraction => wanted,
            NumberError::NotFinite => "a finite number",
            NumberError::OutOfRange if wanted == "an integer" => "an integer of 32 bits",
            NumberError::OutOfRange => "a number that single precision can hold (at most 3.4e38)",
        };
        let comma = token.kind == TokenKind::Word && self.lexer.bytes(token).contains(&b',');
        let hint = comma.then(|| "numbers are separated by blanks, with a decimal point".to_string());
        self.unexpected(context, expected, Some(token)).maybe_hint(hint)
    }

    /// The error for a token (or the end of the file) that does not fit.
    pub(super) fn unexpected(&self, context: &str, expected: &str, got: Option<Token>) -> Error {
        let got = got.filter(|t| t.span.len > 0);
        let kind = ErrorKind::Syntax {
            context: context.into(),
            expected: expected.into(),
            got: got.map_or_else(|| "the end of the file".into(), |t| shown(&self.lexer, t)),
        };
        let span = got.map_or_else(|| self.lexer.end_span(), |t| t.span);
        Error::new(kind, self.place(span))
    }

    pub(super) fn warn_at(&self, span: Span, message: impl Into<String>, hint: &str) {
        self.diagnostics.warn_hint(self.place(span), message, hint);
    }
}

/// A token for a message: cut if long, a bare word in backticks.
pub(super) fn shown(lexer: &Lexer, token: Token) -> String {
    let cut = brief(&String::from_utf8_lossy(lexer.bytes(token)));
    if matches!(token.kind, TokenKind::Quoted { .. }) { cut } else { format!("`{cut}`") }
}

/// A text for a message: cut if long.
pub(super) fn brief(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_string(),
    }
}

/// Help for those who put brackets where pbrt has none.
fn brackets(token: Token, index: usize) -> Option<String> {
    (token.kind == TokenKind::Open && index == 0).then(|| "write the numbers without brackets".to_string())
}
