//! Errors and warnings that point at a parameter.

use super::{Param, ParamSet};
use crate::diagnostics::Diagnostics;
use crate::error::{Error, ErrorKind};
use crate::lexer::Lexer;
use crate::span::{Place, Span};
use crate::token::TokenKind;

impl ParamSet {
    /// The error `name: expected, got got` at the parameter's value (or at the directive if it has no such
    /// parameter): `error_at("sigma_s", "must be >= 0", "-0.3 1/m")`.
    pub fn error_at(&self, name: &str, expected: &str, got: &str) -> Error {
        self.value_error(name, self.value_place(name), expected, got)
    }

    /// The same error at the `index`-th value of a list.
    pub fn error_at_index(&self, name: &str, index: usize, expected: &str, got: &str) -> Error {
        let place = self.find(name).and_then(|p| self.value_span(p, index)).map(|s| self.place_of(s));
        self.value_error(name, place.unwrap_or_else(|| self.value_place(name)), expected, got)
    }

    fn value_error(&self, name: &str, place: Place, expected: &str, got: &str) -> Error {
        let kind = ErrorKind::Value { name: name.into(), expected: expected.into(), got: got.into() };
        Error::new(kind, place)
    }

    /// An error of any text at the directive itself.
    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::new(ErrorKind::Other(message.into()), self.place())
    }

    /// The error that a parameter without default is absent.
    pub fn missing(&self, kind: &str, name: &str) -> Error {
        let kind =
            ErrorKind::Missing { directive: self.owner().to_string(), kind: kind.into(), name: name.into() };
        Error::new(kind, self.place())
    }

    /// A warning of any text at the parameter's value (or at the directive).
    pub fn warn_at(&self, name: &str, message: impl Into<String>, out: &Diagnostics) {
        out.warn(self.value_place(name), message);
    }

    /// Warns of every [unused](ParamSet::unused) parameter; `known` are names for "did you mean".
    pub fn warn_unused(&self, known: &[&str], out: &Diagnostics) {
        for param in self.unused() {
            let info = &param.info;
            let message = format!("{}: unused parameter \"{} {}\"", self.owner(), info.kind, info.name);
            let place = self.place_of(info.span);
            if known.contains(&&*info.name) {
                let hint = format!("\"{}\" is not asked for here, or in another type", info.name);
                out.warn_hint(place, message, hint);
                continue;
            }
            match crate::keyword::did_you_mean(&info.name, known.iter().copied()) {
                Some(hint) => out.warn_hint(place, message, hint),
                None => out.warn(place, message),
            }
        }
    }

    /// The place of a parameter's value: the value itself if there is one, else the list; the directive if there is
    /// no such parameter.
    pub fn value_place(&self, name: &str) -> Place {
        let Some(param) = self.find(name) else { return self.place() };
        let only = if param.values.len() == 1 { self.value_span(param, 0) } else { None };
        self.place_of(only.unwrap_or(param.info.value_span))
    }

    /// The span of the `index`-th value, found by reading the list once more.
    fn value_span(&self, param: &Param, index: usize) -> Option<Span> {
        let list = param.info.value_span;
        let mut lexer = Lexer::at(self.sources().file(list.file), list.offset);
        let mut left = index;
        while let Ok(Some(token)) = lexer.next_token() {
            match token.kind {
                _ if token.span.offset >= list.end() => break,
                TokenKind::Close => break,
                TokenKind::Open => {}
                _ if left == 0 => return Some(token.span),
                _ => left -= 1,
            }
        }
        None
    }
}
