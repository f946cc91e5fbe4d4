//! Blocks that nest, and names that are defined once.

use std::collections::HashMap;

use super::args::brief;
use crate::error::{Error, ErrorKind};
use crate::source::SourceMap;
use crate::span::Span;
use crate::text::Text;

/// An open `AttributeBegin`, `TransformBegin` or `ObjectBegin`.
#[derive(Debug)]
struct Open {
    directive: &'static str,
    span: Span,
}

impl Open {
    fn is_object(&self) -> bool {
        self.directive == "ObjectBegin"
    }

    fn closing(&self) -> &'static str {
        match self.directive {
            "ObjectBegin" => "ObjectEnd",
            "TransformBegin" => "TransformEnd",
            _ => "AttributeEnd",
        }
    }
}

/// What names are told apart by: kind, scope (0: the whole scene), name.
type Key = (&'static str, usize, Box<str>);

/// The state of nesting.
#[derive(Debug, Default)]
pub(super) struct Blocks {
    world: bool,
    open: Vec<Open>,
    /// Per open import: how many blocks were open at its start, and its number.
    imports: Vec<(usize, usize)>,
    imported: usize,
    defined: HashMap<Key, Span>,
}

impl Blocks {
    pub(super) fn in_world(&self) -> bool {
        self.world
    }

    /// Begins the world and passes its directive on.
    pub(super) fn begin_world<T>(&mut self, directive: T) -> T {
        self.world = true;
        directive
    }

    pub(super) fn begin(&mut self, directive: &'static str, span: Span) {
        self.open.push(Open { directive, span });
    }

    pub(super) fn end_attribute(
        &mut self,
        directive: &'static str,
        span: Span,
        sources: &SourceMap,
    ) -> Result<(), Error> {
        match self.innermost() {
            None => Err(nesting(directive, "there is no open AttributeBegin".into(), span, sources)),
            Some(open) if open.is_object() => Err(mismatch(directive, open, span, sources)),
            Some(_) => self.close(),
        }
    }

    pub(super) fn begin_object(
        &mut self,
        directive: &'static str,
        span: Span,
        sources: &SourceMap,
    ) -> Result<(), Error> {
        self.forbid_in_object(directive, span, sources)?;
        self.begin(directive, span);
        Ok(())
    }

    pub(super) fn end_object(
        &mut self,
        directive: &'static str,
        span: Span,
        sources: &SourceMap,
    ) -> Result<(), Error> {
        match self.innermost() {
            None => Err(nesting(directive, "there is no open ObjectBegin".into(), span, sources)),
            Some(open) if !open.is_object() => Err(mismatch(directive, open, span, sources)),
            Some(_) => self.close(),
        }
    }

    /// Objects have neither objects nor instances inside.
    pub(super) fn forbid_in_object(
        &self,
        directive: &'static str,
        span: Span,
        sources: &SourceMap,
    ) -> Result<(), Error> {
        let Some(open) = self.open.iter().find(|open| open.is_object()) else { return Ok(()) };
        let begun = sources.location(open.span);
        Err(nesting(directive, format!("not allowed inside the object begun at {begun}"), span, sources))
    }

    /// The innermost block that the current import may close.
    fn innermost(&self) -> Option<&Open> {
        let base = self.imports.last().map_or(0, |&(base, _)| base);
        self.open[base..].last()
    }

    fn close(&mut self) -> Result<(), Error> {
        self.open.pop();
        Ok(())
    }

    /// Every block of the current import, or of the scene, must be closed.
    pub(super) fn expect_closed(&self, sources: &SourceMap) -> Result<(), Error> {
        let Some(open) = self.innermost() else { return Ok(()) };
        let kind = ErrorKind::UnclosedBlock { directive: open.directive, closing: open.closing() };
        Err(Error::new(kind, sources.place(open.span)))
    }

    pub(super) fn begin_import(&mut self) {
        self.imported += 1;
        self.imports.push((self.open.len(), self.imported));
    }

    pub(super) fn end_import(&mut self) {
        self.imports.pop();
    }

    /// Notes a definition; pbrt-v4 keeps media and objects of each import apart.
    pub(super) fn define(
        &mut self,
        what: &'static str,
        name: &Text,
        sources: &SourceMap,
    ) -> Result<(), Error> {
        let own_scope = matches!(what, "named medium" | "object");
        let scope = if own_scope { self.imports.last().map_or(0, |&(_, number)| number) } else { 0 };
        let first = self.defined.entry((what, scope, name.as_str().into())).or_insert(name.span());
        if *first == name.span() {
            return Ok(());
        }
        let kind = ErrorKind::Redefined { what, name: brief(name), first: sources.location(*first) };
        Err(Error::new(kind, sources.place(name.span())))
    }
}

fn nesting(directive: &'static str, problem: String, span: Span, sources: &SourceMap) -> Error {
    Error::new(ErrorKind::Nesting { directive, problem }, sources.place(span))
}

fn mismatch(directive: &'static str, open: &Open, span: Span, sources: &SourceMap) -> Error {
    let begun = sources.location(open.span);
    let problem = format!("expected {}, which closes the {} at {begun}", open.closing(), open.directive);
    nesting(directive, problem, span, sources)
}
