//! Tokens of the pbrt format.

use crate::span::Span;

/// One token and where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// What it is.
    pub kind: TokenKind,
    /// Its bytes, quotes included.
    pub span: Span,
}

/// The four kinds of token; blanks and `#` comments separate them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// A bare word: directive, number, `true`, `false`.
    Word,
    /// A string in double quotes; `escaped` if there is a backslash in it.
    Quoted {
        /// Whether a backslash is in it.
        escaped: bool,
    },
    /// `[`
    Open,
    /// `]`
    Close,
}
