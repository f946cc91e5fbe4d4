//! Errors and warnings as [`miette`] reports with the source line.

use std::fmt::Display;
use std::sync::Arc;

use miette::{LabeledSpan, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use crate::diagnostics::{Diagnostic, Severity};
use crate::error::Error;
use crate::source::SourceFile;
use crate::span::{Place, Span};

/// Lines longer than this are shown in part: a mesh may be one line of megabytes.
const LONG: usize = 400;

/// How much of a long line is shown on either side.
const MARGIN: usize = 60;

/// How much of a long span is underlined.
const UNDERLINED: usize = 80;

impl miette::Diagnostic for Error {
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        self.hint_text().map(|hint| Box::new(hint) as Box<dyn Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.place().map(|place| &*place.source as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.place().map(|place| label(place, "here"))
    }
}

impl std::error::Error for Diagnostic {}

impl miette::Diagnostic for Diagnostic {
    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.severity {
            Severity::Note => miette::Severity::Advice,
            Severity::Warning => miette::Severity::Warning,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        self.hint.as_deref().map(|hint| Box::new(hint) as Box<dyn Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.place.as_ref().map(|place| &*place.source as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.place.as_ref().map(|place| label(place, "here"))
    }
}

fn label(place: &Place, text: &str) -> Box<dyn Iterator<Item = LabeledSpan>> {
    let span = underlined(&place.source, place.span);
    Box::new(std::iter::once(LabeledSpan::new_with_span(Some(text.to_string()), span)))
}

/// The part of a span to underline: on its first line, and not too long.
fn underlined(source: &Arc<SourceFile>, span: Span) -> SourceSpan {
    let text = &source.printable()[span.offset as usize..];
    let text = &text[..text.len().min(span.len as usize).min(UNDERLINED)];
    let line = text.iter().position(|&b| b == b'\n').unwrap_or(text.len());
    let end = char_boundary(source.printable(), span.offset as usize + line);
    (span.offset as usize..end).into()
}

/// The first position from `at` on that starts a character.
fn char_boundary(bytes: &[u8], mut at: usize) -> usize {
    while bytes.get(at).is_some_and(|b| b & 0xC0 == 0x80) {
        at += 1;
    }
    at
}

impl SourceCode for SourceFile {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let bytes = self.printable();
        if span.offset() + span.len() > bytes.len() {
            return Err(MietteError::OutOfBounds);
        }
        let starts = self.line_starts();
        let line_of = |offset: usize| starts.partition_point(|&s| s as usize <= offset) - 1;
        let (line, last) = (line_of(span.offset()), line_of(span.offset() + span.len()));
        let end_of = |line: usize| starts.get(line + 1).map_or(bytes.len(), |&s| s as usize);
        let (mut first, mut end) =
            (line.saturating_sub(before), end_of((last + after).min(starts.len() - 1)));
        let mut start = starts[first] as usize;
        if end - start > LONG {
            let low = starts[line] as usize;
            start = char_boundary(bytes, low.max(span.offset().saturating_sub(MARGIN)));
            end = end_of(last)
                .min(char_boundary(bytes, (span.offset() + span.len() + MARGIN).min(bytes.len())));
            first = line;
        }
        let column = start - starts[first] as usize;
        Ok(Box::new(MietteSpanContents::new_named(
            self.name().to_string(),
            &bytes[start..end],
            (start..end).into(),
            first,
            column,
            last + 1 - first,
        )))
    }
}
