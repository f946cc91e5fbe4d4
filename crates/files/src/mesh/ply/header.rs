//! The header of a PLY file: encoding, elements, properties.

use super::{body::Source, malformed, read_error};
use crate::{FileError, Place, Result};
use std::{io::BufRead, path::Path};

/// How the body is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// A scalar type; its file names are `char`/`int8` and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            _ => return None,
        })
    }

    pub(super) const fn bytes(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    pub(super) const fn is_integer(self) -> bool {
        !matches!(self, Scalar::F32 | Scalar::F64)
    }
}

/// A property of an element.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub name: String,
    pub value: Scalar,
    /// The type of the length, for a list.
    pub length: Option<Scalar>,
}

/// A group of equal rows.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

impl Element {
    pub(super) fn position(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|p| p.name == name)
    }

    /// Bytes that a row takes at least: a list may be empty, a number in ASCII has a digit and a separator.
    fn least_row_bytes(&self, encoding: Encoding) -> u128 {
        let of = |p: &Property| match encoding {
            Encoding::Ascii => 2,
            Encoding::Little | Encoding::Big => p.length.unwrap_or(p.value).bytes() as u128,
        };
        self.properties.iter().map(of).sum()
    }
}

#[derive(Clone, Debug)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
}

const MOST_LINES: u64 = 10_000;

impl Header {
    /// Bytes that the body takes at least.
    pub(super) fn least_bytes(&self) -> u128 {
        self.elements.iter().map(|e| u128::from(e.count) * e.least_row_bytes(self.encoding)).sum()
    }

    pub(super) fn read<R: BufRead>(source: &mut Source<R>, path: &Path) -> Result<Self> {
        let first = line(source, path)?;
        if first != "ply" {
            return Err(malformed(path, Place::Line(1), "`ply` in the first line", quoted(&first)));
        }
        let mut encoding = None;
        let mut elements = Vec::new();
        loop {
            let text = line(source, path)?;
            let here = Place::Line(source.line - 1);
            let words: Vec<_> = text.split_ascii_whitespace().collect();
            let bad = |expected: &str| malformed(path, here, expected, quoted(&text));
            match words.as_slice() {
                ["end_header"] => break,
                [] | ["comment" | "obj_info", ..] => {}
                ["format", name, version] => encoding = Some(encoding_of(name, version, here, path)?),
                ["element", name, count] => elements.push(Element {
                    name: (*name).to_owned(),
                    count: count.parse().map_err(|_| bad("`element NAME COUNT` with a count from 0"))?,
                    properties: Vec::new(),
                }),
                ["property", rest @ ..] => {
                    let property = property_of(rest).ok_or_else(|| {
                        bad("`property TYPE NAME` or `property list INTEGER-TYPE TYPE NAME` with a type of PLY")
                    })?;
                    let element: &mut Element =
                        elements.last_mut().ok_or_else(|| bad("`element` before the first `property`"))?;
                    add_property(element, property, here, path)?;
                }
                _ => {
                    return Err(bad(
                        "`format`, `element`, `property`, `comment`, `obj_info` or `end_header`",
                    ));
                }
            }
            if source.line > MOST_LINES {
                return Err(bad("`end_header` within 10000 lines"));
            }
        }
        let here = Place::Line(source.line - 1);
        let encoding = encoding.ok_or_else(|| malformed(path, here, "a line `format ...`", "none"))?;
        Ok(Header { encoding, elements })
    }
}

fn encoding_of(name: &str, version: &str, here: Place, path: &Path) -> Result<Encoding> {
    if version != "1.0" {
        return Err(FileError::unsupported(path, format!("PLY version {version}"), "export version 1.0"));
    }
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::Little),
        "binary_big_endian" => Ok(Encoding::Big),
        _ => {
            Err(malformed(path, here, "`ascii`, `binary_little_endian` or `binary_big_endian`", quoted(name)))
        }
    }
}

fn property_of(words: &[&str]) -> Option<Property> {
    let (length, value, name) = match words {
        ["list", length, value, name] => {
            (Some(Scalar::from_name(length).filter(|l| l.is_integer())?), value, name)
        }
        [value, name] => (None, value, name),
        _ => return None,
    };
    Some(Property { name: (*name).to_owned(), value: Scalar::from_name(value)?, length })
}

fn add_property(element: &mut Element, property: Property, here: Place, path: &Path) -> Result<()> {
    if element.position(&property.name).is_some() {
        return Err(malformed(
            path,
            here,
            format!("properties of `{}` with different names", element.name),
            format!("`{}` again", property.name),
        ));
    }
    element.properties.push(property);
    Ok(())
}

fn quoted(text: &str) -> String {
    format!("`{}`", text.chars().take(60).collect::<String>().escape_debug())
}

/// The next line without its end; a header line is short.
fn line<R: BufRead>(source: &mut Source<R>, path: &Path) -> Result<String> {
    const LONGEST: usize = 4096;
    let mut bytes = Vec::new();
    loop {
        let place = Place::Line(source.line);
        match source.byte().map_err(|e| read_error(path, place, e))? {
            b'\n' => break,
            byte if bytes.len() < LONGEST => bytes.push(byte),
            _ => return Err(malformed(path, place, "header lines of at most 4096 bytes", "a longer one")),
        }
    }
    if bytes.last() == Some(&b'\r') {
        bytes.pop();
    }
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
