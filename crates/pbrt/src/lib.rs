//! The pbrt-v4 text format: bytes to directives with source spans.
//!
//! [`Parser`] reads a scene file, its `Include`s and `Import`s, and gives a flat stream of [`Directive`]s; it checks
//! grammar, types of parameters, nesting of blocks and single definition of names, and knows nothing of rendering.
//! Readers take the parameters of a directive from its [`ParamSet`], which keeps track of what was consumed; the
//! parser's [`Inventory`] lists every parameter of a scene with what became of it. Every [`Error`] and warning has a
//! place in the text.
//!
//! Differences from pbrt-v4's own parser: a directive ends with its file (pbrt goes on reading its parameters after
//! the end of an `Include`); an unmatched `AttributeEnd` is an error; `nan`, `inf` and numbers beyond single precision
//! are errors; an unknown escape in a string stands for itself; `"true"` in quotes and whole floats as integers are
//! read with a warning.
//!
//! ```
//! # fn main() -> Result<(), tyndall_pbrt::Error> {
//! use tyndall_pbrt::{DirectiveKind, parse_str};
//! let scene = parse_str("ball.pbrt", "WorldBegin Shape \"sphere\" \"float radius\" 2")?;
//! let DirectiveKind::Entity(ball) = &scene.directives[1].kind else { unreachable!() };
//! assert_eq!(ball.params.float("radius", 1.0)?, 2.0);
//! assert!(ball.params.unused().is_empty());
//! # Ok(())
//! # }
//! ```

mod diagnostics;
mod directive;
mod error;
mod keyword;
mod lexer;
mod load;
mod number;
mod params;
mod parser;
mod report;
mod resolve;
mod source;
mod span;
mod text;
mod token;
mod write;

use std::path::Path;

pub use diagnostics::{Diagnostic, Diagnostics, Severity};
pub use directive::{
    ActiveTransform, AttributeTarget, Directive, DirectiveKind, Entity, EntityKind, OptionValue, Texture,
    TextureValue, normalized_option,
};
pub use error::{Error, ErrorKind};
pub use keyword::did_you_mean;
pub use lexer::Lexer;
pub use params::{
    FloatOrTexture, Inventory, Numbers, Owner, Param, ParamInfo, ParamSet, ParamState, ParamType,
    SpectrumOrTexture, SpectrumValue, Values,
};
pub use parser::{Limits, Parser, Scene};
pub use resolve::{Found, NotFound, Resolver};
pub use source::{SourceFile, SourceMap};
pub use span::{FileId, Location, Place, Span};
pub use text::Text;
pub use token::{Token, TokenKind};
pub use write::to_text;

/// Reads a scene file and all that it includes.
///
/// # Errors
/// If a file cannot be read, or the first error in the text.
pub fn parse_file(path: impl AsRef<Path>) -> Result<Scene, Error> {
    Parser::open(path.as_ref())?.parse()
}

/// Reads a scene from memory; `name` is for messages, files are looked for in the working directory.
///
/// # Errors
/// The first error in the text.
pub fn parse_str(name: &str, text: &str) -> Result<Scene, Error> {
    Parser::from_bytes(name, text.as_bytes().to_vec(), Path::new(""))?.parse()
}
