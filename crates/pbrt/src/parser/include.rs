//! `Include` and `Import`: files within files.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Parser;
use crate::directive::{Directive, DirectiveKind};
use crate::error::{Error, ErrorKind};
use crate::lexer::Lexer;
use crate::load;
use crate::source::SourceFile;
use crate::span::Span;
use crate::text::Text;

/// What tells the file being read from others, for the search of cycles.
#[derive(Clone, Debug)]
pub(super) struct Identity {
    shown: Arc<str>,
    canonical: Option<PathBuf>,
    import: bool,
}

impl Identity {
    pub(super) fn main(file: &SourceFile) -> Identity {
        Identity::new(file, false)
    }

    fn new(file: &SourceFile, import: bool) -> Identity {
        let canonical = file.path().and_then(|path| path.canonicalize().ok());
        Identity { shown: file.name().clone(), canonical, import }
    }
}

/// A file whose reading goes on after the current one.
#[derive(Debug)]
pub(super) struct Frame {
    lexer: Lexer,
    identity: Identity,
    span: Span,
}

impl Parser {
    /// Goes on with the text of another file.
    pub(super) fn include(&mut self, span: Span) -> Result<(), Error> {
        self.enter("Include", span).map(|_| ())
    }

    /// Goes on with the text of another file, in a scope of its own.
    pub(super) fn import(&mut self, span: Span) -> Result<DirectiveKind, Error> {
        let name = self.enter("Import", span)?;
        self.blocks.begin_import();
        Ok(DirectiveKind::ImportBegin(name))
    }

    fn enter(&mut self, directive: &'static str, span: Span) -> Result<Text, Error> {
        let name = self.string(directive, "the name of a file")?;
        self.check_limits(span)?;
        let path = self.find_file(&name)?;
        self.check_cycle(directive, &path, name.span())?;
        let file = load::load_file(&self.sources, &path, &path.display().to_string())
            .map_err(|e| e.or_place(self.place(name.span())))?;
        let identity = Identity::new(&file, directive == "Import");
        let outer = Frame {
            lexer: std::mem::replace(&mut self.lexer, Lexer::new(file)),
            identity: std::mem::replace(&mut self.current, identity),
            span,
        };
        self.outer.push(outer);
        Ok(name)
    }

    /// Goes back to the including file; an import ends with a directive.
    pub(super) fn leave_file(&mut self) -> Result<Option<Directive>, Error> {
        let import = self.current.import;
        if import {
            self.blocks.expect_closed(&self.sources)?;
            self.blocks.end_import();
        }
        let Some(outer) = self.outer.pop() else { return Ok(None) };
        self.lexer = outer.lexer;
        self.current = outer.identity;
        Ok(import.then_some(Directive { span: outer.span, kind: DirectiveKind::ImportEnd }))
    }

    fn find_file(&self, name: &Text) -> Result<PathBuf, Error> {
        let beside = self.lexer.source().path().and_then(Path::parent);
        match self.resolver.find(name, beside) {
            Ok(found) => {
                if let Some(note) = found.note {
                    self.diagnostics.note(self.place(name.span()), note);
                }
                Ok(found.path)
            }
            Err(missing) => {
                let kind = ErrorKind::FileNotFound { path: name.raw().into(), tried: missing.list() };
                Err(Error::new(kind, self.place(name.span())))
            }
        }
    }

    fn check_limits(&self, span: Span) -> Result<(), Error> {
        let (what, limit) = if self.outer.len() >= self.limits.include_depth {
            ("files within files", self.limits.include_depth)
        } else if self.sources.len() >= self.limits.files {
            ("files in one scene", self.limits.files)
        } else {
            return Ok(());
        };
        Err(Error::new(ErrorKind::Limit { what, limit }, self.place(span)))
    }

    fn check_cycle(&self, directive: &'static str, path: &Path, span: Span) -> Result<(), Error> {
        let Ok(canonical) = path.canonicalize() else { return Ok(()) };
        let stack = || self.outer.iter().map(|f| &f.identity).chain([&self.current]);
        let Some(first) = stack().position(|i| i.canonical.as_ref() == Some(&canonical)) else {
            return Ok(());
        };
        let mut chain: Vec<&str> = stack().skip(first).map(|i| &*i.shown).collect();
        chain.push(chain[0]);
        let kind = ErrorKind::CyclicInclude { directive, chain: chain.join(" -> ") };
        Err(Error::new(kind, self.place(span)).hint("a file cannot contain itself"))
    }
}
