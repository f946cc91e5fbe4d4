//! Parameter lists: `"type name" value` or `"type name" [ values ]`, any number of them.

use std::collections::HashSet;
use std::sync::{Arc, Mutex};

use super::Parser;
use super::args::brief;
use crate::error::{Error, ErrorKind};
use crate::lexer::ListError;
use crate::number;
use crate::params::{Numbers, Owner, Param, ParamInfo, ParamSet, ParamState, ParamType, Values};
use crate::span::Span;
use crate::token::{Token, TokenKind};

impl Parser {
    /// Reads parameters up to the first token that is not a string.
    pub(super) fn params(&mut self, owner: Owner) -> Result<ParamSet, Error> {
        let owner = Arc::new(owner);
        let mut params = Vec::new();
        while let Some(token) = self.lexer.peek()? {
            if !matches!(token.kind, TokenKind::Quoted { .. }) {
                break;
            }
            self.lexer.next_token()?;
            params.push(self.param(token, &owner)?);
        }
        self.mark_repeated(&params);
        Ok(ParamSet::new(owner, self.sources.clone(), params))
    }

    /// Of parameters with the same name and type the last one counts, as in pbrt-v4; the others are said to be so.
    fn mark_repeated(&self, params: &[Param]) {
        let mut seen = HashSet::new();
        for param in params.iter().rev().map(|p| &p.info) {
            if !seen.insert((&*param.name, param.kind)) {
                param.mark(ParamState::Ignored("a later one of the same name counts".into()));
                let message = format!("parameter \"{} {}\" is given twice", param.kind, param.name);
                self.warn_at(param.span, message, "the last one counts");
            }
        }
    }

    fn param(&mut self, decl: Token, owner: &Arc<Owner>) -> Result<Param, Error> {
        let (kind, name) = self.declaration(decl, owner)?;
        let (values, value_span) = self.values(kind, &name)?;
        self.check_count(kind, &name, &values, value_span)?;
        let info = Arc::new(ParamInfo {
            name,
            kind,
            span: decl.span,
            value_span,
            count: values.len(),
            owner: owner.clone(),
            state: Mutex::new(ParamState::Unread),
        });
        self.inventory.add(info.clone());
        Ok(Param { info, values: Arc::new(values), inherited: false, color_space: None })
    }

    /// Type and name from `"type name"`.
    fn declaration(&mut self, decl: Token, owner: &Owner) -> Result<(ParamType, Arc<str>), Error> {
        let bytes = self.lexer.bytes(decl);
        let text = String::from_utf8_lossy(&bytes[1..bytes.len() - 1]).into_owned();
        let mut words = text.split_ascii_whitespace();
        let (Some(kind), Some(name)) = (words.next(), words.next()) else {
            let error = self.unexpected(&owner.to_string(), "a parameter \"type name\"", Some(decl));
            return Err(error.hint("every parameter has a type, as in \"float radius\" 1"));
        };
        if words.next().is_some() {
            self.warn_at(
                decl.span,
                format!("only the first two words of \"{text}\" count"),
                "names of parameters have no blanks",
            );
        }
        let kind = self.param_type(kind, name, decl)?;
        Ok((kind, self.intern(name)))
    }

    fn param_type(&self, word: &str, name: &str, decl: Token) -> Result<ParamType, Error> {
        if word == "normal3" {
            self.warn_at(
                decl.span,
                "type `normal3` is read as `normal`",
                "pbrt-v4's name of the type is `normal`",
            );
            return Ok(ParamType::Normal);
        }
        ParamType::find(word).ok_or_else(|| {
            let kind = ErrorKind::UnknownType { kind: brief(word), name: brief(name) };
            Error::new(kind, self.place(decl.span)).maybe_hint(ParamType::hint_for(word))
        })
    }

    /// The value or list of values that a type wants, with its span.
    fn values(&mut self, kind: ParamType, name: &str) -> Result<(Values, Span), Error> {
        let first = self.need(name, wanted(kind))?;
        if first.kind == TokenKind::Close {
            return Err(self.unexpected(name, wanted(kind), Some(first)));
        }
        match kind {
            ParamType::Integer => self.integers(first, name),
            ParamType::Bool => self.bools(first, name),
            ParamType::String | ParamType::Texture => self.strings(first, name, kind),
            ParamType::Spectrum if self.is_string(first)? => self.strings(first, name, kind),
            _ => self.float_values(first, name, kind),
        }
    }

    /// Whether a value or the first one of a list is a string.
    fn is_string(&mut self, first: Token) -> Result<bool, Error> {
        let token = if first.kind == TokenKind::Open { self.lexer.peek()? } else { Some(first) };
        Ok(token.is_some_and(|t| matches!(t.kind, TokenKind::Quoted { .. })))
    }

    fn float_values(&mut self, first: Token, name: &str, kind: ParamType) -> Result<(Values, Span), Error> {
        if first.kind == TokenKind::Open {
            let list = self.lexer.number_list(first);
            let (numbers, span) = list.map_err(|e| self.list_error(e, name, wanted(kind)))?;
            return Ok((Values::Numbers(numbers), span));
        }
        self.expect_word(first, name, wanted(kind))?;
        let number = self.number(name, first)?;
        Ok((Values::Numbers(Numbers::Wide(vec![number])), first.span))
    }

    fn integers(&mut self, first: Token, name: &str) -> Result<(Values, Span), Error> {
        let mut integers = Vec::new();
        let (span, float) = if first.kind == TokenKind::Open {
            let list = self.lexer.integer_list(first, &mut integers);
            list.map_err(|e| self.list_error(e, name, "an integer"))?
        } else {
            self.expect_word(first, name, "an integer")?;
            let scan = number::scan_i32(self.lexer.bytes(first), 0);
            let (value, _, is_float) = scan.map_err(|why| self.bad_number(name, "an integer", why, first))?;
            integers.push(value);
            (first.span, is_float.then_some(first.span))
        };
        if let Some(span) = float {
            self.warn_at(
                span,
                format!("{name}: whole number read as an integer"),
                "pbrt-v4 refuses a point or exponent here",
            );
        }
        Ok((Values::Integers(integers), span))
    }

    fn expect_word(&self, token: Token, name: &str, expected: &str) -> Result<(), Error> {
        match token.kind {
            TokenKind::Word => Ok(()),
            _ => Err(self.unexpected(name, expected, Some(token))),
        }
    }

    fn list_error(&self, error: ListError, name: &str, wanted: &str) -> Error {
        match error {
            ListError::Item(why, token) => {
                let error = self.bad_number(name, wanted, why, token);
                if error.hint_text().is_none() && self.is_directive(token) {
                    return error.hint("is the closing `]` missing?");
                }
                error
            }
            ListError::Syntax(error) => error,
        }
    }

    fn is_directive(&self, token: Token) -> bool {
        crate::keyword::Keyword::find(self.lexer.bytes(token)).is_some()
    }

    fn bools(&mut self, first: Token, name: &str) -> Result<(Values, Span), Error> {
        let mut bools = Vec::new();
        let span = self.each(first, |parser, token| {
            bools.push(parser.bool_value(token, name)?);
            Ok(())
        })?;
        Ok((Values::Bools(bools), span))
    }

    fn bool_value(&self, token: Token, name: &str) -> Result<bool, Error> {
        let bytes = self.lexer.bytes(token);
        let (word, quoted) = match token.kind {
            TokenKind::Quoted { .. } => (&bytes[1..bytes.len() - 1], true),
            _ => (bytes, false),
        };
        let value = match word {
            b"true" => true,
            b"false" => false,
            _ => return Err(self.unexpected(name, "`true` or `false`", Some(token))),
        };
        if quoted {
            self.warn_at(
                token.span,
                format!("{name}: quotes around a truth value"),
                "pbrt-v4 writes true and false bare",
            );
        }
        Ok(value)
    }

    fn strings(&mut self, first: Token, name: &str, kind: ParamType) -> Result<(Values, Span), Error> {
        let mut strings = Vec::new();
        let span = self.each(first, |parser, token| match token.kind {
            TokenKind::Quoted { escaped } => {
                strings.push(parser.text(token, escaped));
                Ok(())
            }
            _ if kind == ParamType::Spectrum => {
                Err(parser.unexpected(name, "a string after a string", Some(token)))
            }
            _ => Err(parser.unexpected(name, wanted(kind), Some(token))),
        })?;
        Ok((Values::Strings(strings), span))
    }

    /// Calls `item` for a single value or for each of a list; gives the span of all.
    fn each(
        &mut self,
        first: Token,
        mut item: impl FnMut(&Parser, Token) -> Result<(), Error>,
    ) -> Result<Span, Error> {
        if first.kind != TokenKind::Open {
            item(self, first)?;
            return Ok(first.span);
        }
        loop {
            let Some(token) = self.lexer.next_token()? else {
                return Err(Error::new(ErrorKind::UnclosedList, self.place(first.span)));
            };
            if token.kind == TokenKind::Close {
                return Ok(first.span.to(token.span));
            }
            item(self, token)?;
        }
    }

    /// Points come in whole: a multiple of the type's arity.
    fn check_count(&self, kind: ParamType, name: &str, values: &Values, span: Span) -> Result<(), Error> {
        let (n, arity) = (values.len(), kind.arity());
        if arity == 1 || n % arity == 0 || values.strings().is_some() {
            return Ok(());
        }
        let expected = match kind {
            ParamType::Spectrum => "must be pairs of wavelength and value".to_string(),
            _ => format!("`{kind}` must be a multiple of {arity} numbers"),
        };
        let got = if n == 1 { "1 number".to_string() } else { format!("{n} numbers") };
        Err(Error::new(ErrorKind::Value { name: name.into(), expected, got }, self.place(span)))
    }
}

/// What a value of the type looks like.
fn wanted(kind: ParamType) -> &'static str {
    match kind {
        ParamType::Integer => "an integer",
        ParamType::Bool => "`true` or `false`",
        ParamType::String => "a string",
        ParamType::Texture => "the name of a texture",
        ParamType::Spectrum => "numbers, or the name of a spectrum or file",
        _ => "a number",
    }
}
