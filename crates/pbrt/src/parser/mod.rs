//! The parser: a stream of directives from a scene file and all that it includes.

mod args;
mod blocks;
mod directives;
mod include;
mod params;

use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

use blocks::Blocks;
use include::Frame;

use crate::diagnostics::Diagnostics;
use crate::directive::Directive;
use crate::error::{Error, ErrorKind};
use crate::lexer::Lexer;
use crate::load;
use crate::params::Inventory;
use crate::resolve::Resolver;
use crate::source::{SourceFile, SourceMap};
use crate::span::{Place, Span};

/// Bounds that keep hostile input from using all memory or time.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// How deep `Include` and `Import` may nest.
    pub include_depth: usize,
    /// How many files may be opened in all.
    pub files: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { include_depth: 64, files: 65_536 }
    }
}

/// Reads directives one by one; after an error or the end it gives nothing more.
#[derive(Debug)]
pub struct Parser {
    sources: SourceMap,
    resolver: Resolver,
    limits: Limits,
    lexer: Lexer,
    outer: Vec<Frame>,
    current: include::Identity,
    blocks: Blocks,
    names: HashSet<Arc<str>>,
    inventory: Inventory,
    diagnostics: Arc<Diagnostics>,
    fragment: bool,
    warned_transform_block: bool,
    started: bool,
    done: bool,
}

impl Parser {
    /// Opens a scene file, gzipped or not.
    ///
    /// # Errors
    /// If it cannot be read or is no text.
    pub fn open(path: &Path) -> Result<Parser, Error> {
        let sources = SourceMap::default();
        let file = load::load_file(&sources, path, &path.display().to_string())?;
        let dir = path.parent().unwrap_or(Path::new(""));
        Ok(Parser::new(sources, file, Resolver::new(dir)))
    }

    /// Takes a scene from memory; `name` is for messages, files are looked for in `dir`.
    ///
    /// # Errors
    /// If it is no text.
    pub fn from_bytes(name: &str, bytes: Vec<u8>, dir: &Path) -> Result<Parser, Error> {
        let sources = SourceMap::default();
        let file = load::load_bytes(&sources, name, bytes)?;
        Ok(Parser::new(sources, file, Resolver::new(dir)))
    }

    pub(crate) fn new(sources: SourceMap, file: Arc<SourceFile>, resolver: Resolver) -> Parser {
        Parser {
            sources,
            resolver,
            limits: Limits::default(),
            current: include::Identity::main(&file),
            lexer: Lexer::new(file),
            outer: Vec::new(),
            blocks: Blocks::default(),
            names: HashSet::new(),
            inventory: Inventory::default(),
            diagnostics: Arc::default(),
            fragment: false,
            warned_transform_block: false,
            started: false,
            done: false,
        }
    }

    /// The same parser with other bounds.
    #[must_use]
    pub fn limits(mut self, limits: Limits) -> Parser {
        self.limits = limits;
        self
    }

    /// The same parser for a piece of a scene: `WorldBegin` need not be there, and directives may stand on
    /// either side of it.
    #[must_use]
    pub fn fragment(mut self) -> Parser {
        self.fragment = true;
        self
    }

    /// The files read so far.
    pub fn sources(&self) -> &SourceMap {
        &self.sources
    }

    /// Where files are looked for.
    pub fn resolver(&self) -> &Resolver {
        &self.resolver
    }

    /// Warnings so far, open for more.
    pub fn diagnostics(&self) -> &Arc<Diagnostics> {
        &self.diagnostics
    }

    /// The parameters read so far; later reading changes what became of each.
    pub fn inventory(&self) -> &Inventory {
        &self.inventory
    }

    /// Reads to the end.
    ///
    /// # Errors
    /// The first error in the text.
    pub fn parse(mut self) -> Result<Scene, Error> {
        let directives = self.by_ref().collect::<Result<Vec<_>, _>>()?;
        Ok(Scene {
            directives,
            sources: self.sources,
            resolver: self.resolver,
            inventory: self.inventory,
            diagnostics: self.diagnostics,
        })
    }

    fn next_directive(&mut self) -> Result<Option<Directive>, Error> {
        loop {
            let step = match self.lexer.next_token()? {
                Some(token) => {
                    self.started = true;
                    self.directive(token)?
                }
                None if self.outer.is_empty() => return self.finish().map(|()| None),
                None => self.leave_file()?,
            };
            if step.is_some() {
                return Ok(step);
            }
        }
    }

    /// Checks at the end of the main file.
    fn finish(&self) -> Result<(), Error> {
        let end = self.lexer.place(self.lexer.end_span());
        if !self.started && !self.fragment {
            return Err(Error::in_file(ErrorKind::Empty, &**end.source.name()));
        }
        self.blocks.expect_closed(&self.sources)?;
        if !self.blocks.in_world() && !self.fragment {
            let hint = "is the file truncated, or meant for Include from another?";
            return Err(Error::new(ErrorKind::NoWorld, end).hint(hint));
        }
        Ok(())
    }

    /// One shared copy of a parameter's name.
    fn intern(&mut self, name: &str) -> Arc<str> {
        if let Some(known) = self.names.get(name) {
            return known.clone();
        }
        let name: Arc<str> = name.into();
        self.names.insert(name.clone());
        name
    }

    fn place(&self, span: Span) -> Place {
        self.lexer.place(span)
    }
}

impl Iterator for Parser {
    type Item = Result<Directive, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.done {
            return None;
        }
        let next = self.next_directive().transpose();
        self.done = !matches!(next, Some(Ok(_)));
        next
    }
}

/// A whole scene's directives.
#[derive(Debug)]
pub struct Scene {
    /// In the order of the text.
    pub directives: Vec<Directive>,
    /// The files that spans refer to.
    pub sources: SourceMap,
    /// Where the files that it names are looked for.
    pub resolver: Resolver,
    /// Every parameter and what became of it.
    pub inventory: Inventory,
    /// Warnings so far, open for more.
    pub diagnostics: Arc<Diagnostics>,
}
