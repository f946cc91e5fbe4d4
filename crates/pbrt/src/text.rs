//! Strings of a scene: unescaped, with what was written kept where the two differ.

use std::fmt;

use crate::span::Span;

/// A string value or name.
///
/// pbrt decodes `\b \f \n \r \t \\ \' \"` and refuses any other escape. Scenes written on Windows have paths such as
/// `textures\wood.png`, so an unknown escape here stays as it is written, and the text before unescaping is kept
/// for the search of files.
#[derive(Clone, Debug)]
pub struct Text {
    value: Box<str>,
    raw: Option<Box<str>>,
    span: Span,
}

impl Text {
    /// A text as a scene would have it at `span`.
    pub fn new(value: impl Into<Box<str>>, span: Span) -> Text {
        Text { value: value.into(), raw: None, span }
    }

    /// Reads the bytes between the quotes. Also tells whether all of it was UTF-8.
    pub(crate) fn unquote(bytes: &[u8], escaped: bool, span: Span) -> (Text, bool) {
        let raw = String::from_utf8_lossy(bytes);
        let clean = matches!(raw, std::borrow::Cow::Borrowed(_));
        let text = if escaped {
            Text { value: unescape(&raw).into(), raw: Some(raw.into()), span }
        } else {
            Text { value: raw.into(), raw: None, span }
        };
        (text, clean)
    }

    /// The string.
    pub fn as_str(&self) -> &str {
        &self.value
    }

    /// What stands between the quotes, backslashes untouched.
    pub fn raw(&self) -> &str {
        self.raw.as_deref().unwrap_or(&self.value)
    }

    /// Where it stands, quotes included.
    pub fn span(&self) -> Span {
        self.span
    }
}

/// Texts are equal if their strings are; where they stand does not matter.
impl PartialEq for Text {
    fn eq(&self, other: &Text) -> bool {
        self.value == other.value
    }
}

impl Eq for Text {}

impl PartialEq<str> for Text {
    fn eq(&self, other: &str) -> bool {
        &*self.value == other
    }
}

impl std::ops::Deref for Text {
    type Target = str;

    fn deref(&self) -> &str {
        &self.value
    }
}

/// Prints in quotes, escaped so that it reads back.
impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"")?;
        for c in self.value.chars() {
            match c {
                '"' => f.write_str("\\\"")?,
                '\\' => f.write_str("\\\\")?,
                '\n' => f.write_str("\\n")?,
                '\r' => f.write_str("\\r")?,
                '\t' => f.write_str("\\t")?,
                '\u{8}' => f.write_str("\\b")?,
                '\u{c}' => f.write_str("\\f")?,
                c => write!(f, "{c}")?,
            }
        }
        f.write_str("\"")
    }
}

/// Decodes pbrt's escapes; an unknown one stays as it is.
fn unescape(raw: &str) -> String {
    let mut out = String::with_capacity(raw.len());
    let mut chars = raw.chars();
    while let Some(c) = chars.next() {
        if c != '\\' {
            out.push(c);
            continue;
        }
        match chars.next() {
            Some('b') => out.push('\u{8}'),
            Some('f') => out.push('\u{c}'),
            Some('n') => out.push('\n'),
            Some('r') => out.push('\r'),
            Some('t') => out.push('\t'),
            Some(c @ ('\\' | '\'' | '"')) => out.push(c),
            Some(c) => out.extend(['\\', c]),
            None => out.push('\\'),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(raw: &str) -> Text {
        Text::unquote(raw.as_bytes(), raw.contains('\\'), Span::default()).0
    }

    #[test]
    fn escapes() {
        assert_eq!(&*text(r#"a\"b\\c\n"#), "a\"b\\c\n");
        assert_eq!(&*text(r"textures\wood.png"), r"textures\wood.png");
        assert_eq!(text(r"C:\temp\new.png").raw(), r"C:\temp\new.png");
        assert_eq!(&*text(r"end\"), r"end\");
    }

    #[test]
    fn display_reads_back() {
        let odd = "a\"b\\w\n\r\t\u{8}\u{c}ü";
        let shown = Text::new(odd, Span::default()).to_string();
        assert_eq!(&*text(&shown[1..shown.len() - 1]), odd);
    }
}
