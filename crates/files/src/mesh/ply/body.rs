//! Values from the body of a PLY file, one after another, whatever the encoding.

use super::header::{Encoding, Scalar};
use crate::Place;
use std::io::{self, BufRead, ErrorKind};

/// A stream that knows where it is.
pub(super) struct Source<R> {
    stream: R,
    /// The line of the next byte, from 1.
    pub line: u64,
    /// The offset of the next byte (after decompression).
    pub byte: u64,
}

impl<R: BufRead> Source<R> {
    pub(super) fn new(stream: R) -> Self {
        Source { stream, line: 1, byte: 0 }
    }

    /// The next byte.
    pub(super) fn byte(&mut self) -> io::Result<u8> {
        let byte = *self.stream.fill_buf()?.first().ok_or(ErrorKind::UnexpectedEof)?;
        self.stream.consume(1);
        self.byte += 1;
        self.line += u64::from(byte == b'\n');
        Ok(byte)
    }

    fn bytes<const B: usize>(&mut self) -> io::Result<[u8; B]> {
        let mut bytes = [0; B];
        self.stream.read_exact(&mut bytes)?;
        self.byte += B as u64;
        Ok(bytes)
    }
}

/// The values behind the header. Every scalar type fits into f64 without loss.
pub(super) struct Body<R> {
    source: Source<R>,
    encoding: Encoding,
    token: Vec<u8>,
}

impl<R: BufRead> Body<R> {
    pub(super) fn new(source: Source<R>, encoding: Encoding) -> Self {
        Body { source, encoding, token: Vec::new() }
    }

    /// Looks behind the last value, where more data may follow (and are left alone).
    pub(super) fn finish(&mut self) -> io::Result<()> {
        self.source.stream.fill_buf().map(|_| ())
    }

    /// Where the next value is.
    pub(super) fn place(&self) -> Place {
        match self.encoding {
            Encoding::Ascii => Place::Line(self.source.line),
            Encoding::Little | Encoding::Big => Place::Byte(self.source.byte),
        }
    }

    /// The next value.
    pub(super) fn value(&mut self, kind: Scalar) -> io::Result<f64> {
        match self.encoding {
            Encoding::Ascii => self.ascii(kind),
            Encoding::Little => self.little(kind),
            Encoding::Big => self.big(kind),
        }
    }

    fn little(&mut self, kind: Scalar) -> io::Result<f64> {
        let s = &mut self.source;
        Ok(match kind {
            Scalar::I8 => i8::from_le_bytes(s.bytes()?).into(),
            Scalar::U8 => u8::from_le_bytes(s.bytes()?).into(),
            Scalar::I16 => i16::from_le_bytes(s.bytes()?).into(),
            Scalar::U16 => u16::from_le_bytes(s.bytes()?).into(),
            Scalar::I32 => i32::from_le_bytes(s.bytes()?).into(),
            Scalar::U32 => u32::from_le_bytes(s.bytes()?).into(),
            Scalar::F32 => f32::from_le_bytes(s.bytes()?).into(),
            Scalar::F64 => f64::from_le_bytes(s.bytes()?),
        })
    }

    fn big(&mut self, kind: Scalar) -> io::Result<f64> {
        let s = &mut self.source;
        Ok(match kind {
            Scalar::I8 => i8::from_be_bytes(s.bytes()?).into(),
            Scalar::U8 => u8::from_be_bytes(s.bytes()?).into(),
            Scalar::I16 => i16::from_be_bytes(s.bytes()?).into(),
            Scalar::U16 => u16::from_be_bytes(s.bytes()?).into(),
            Scalar::I32 => i32::from_be_bytes(s.bytes()?).into(),
            Scalar::U32 => u32::from_be_bytes(s.bytes()?).into(),
            Scalar::F32 => f32::from_be_bytes(s.bytes()?).into(),
            Scalar::F64 => f64::from_be_bytes(s.bytes()?),
        })
    }

    fn ascii(&mut self, kind: Scalar) -> io::Result<f64> {
        const LONGEST: usize = 128;
        self.token.clear();
        loop {
            // the last number of a file may end with the file
            let byte = match self.source.byte() {
                Err(e) if e.kind() == ErrorKind::UnexpectedEof && !self.token.is_empty() => break,
                other => other?,
            };
            match (byte.is_ascii_whitespace(), self.token.is_empty()) {
                (true, true) => {}
                (true, false) => break,
                (false, _) if self.token.len() == LONGEST => return Err(self.not_a_number(kind)),
                (false, _) => self.token.push(byte),
            }
        }
        let text = std::str::from_utf8(&self.token).unwrap_or_default();
        // a 32-bit float is rounded once, from decimal to f32
        let value = match kind {
            Scalar::F32 => text.parse::<f32>().ok().map(f64::from),
            Scalar::F64 => text.parse().ok(),
            integer => text.parse::<f64>().ok().filter(|v| fits(*v, integer)),
        };
        value.ok_or_else(|| self.not_a_number(kind))
    }

    fn not_a_number(&self, kind: Scalar) -> io::Error {
        let token = String::from_utf8_lossy(&self.token);
        let shown: String = token.chars().take(40).collect();
        io::Error::new(ErrorKind::InvalidData, format!("`{}` for {}", shown.escape_debug(), name_of(kind)))
    }
}

fn name_of(kind: Scalar) -> &'static str {
    match kind {
        Scalar::I8 => "an integer from -128 to 127",
        Scalar::U8 => "an integer from 0 to 255",
        Scalar::I16 => "an integer from -32768 to 32767",
        Scalar::U16 => "an integer from 0 to 65535",
        Scalar::I32 => "a signed 32-bit integer",
        Scalar::U32 => "an unsigned 32-bit integer",
        Scalar::F32 | Scalar::F64 => "a number",
    }
}

fn fits(value: f64, kind: Scalar) -> bool {
    let (low, high) = match kind {
        Scalar::I8 => (i8::MIN.into(), i8::MAX.into()),
        Scalar::U8 => (u8::MIN.into(), u8::MAX.into()),
        Scalar::I16 => (i16::MIN.into(), i16::MAX.into()),
        Scalar::U16 => (u16::MIN.into(), u16::MAX.into()),
        Scalar::I32 => (i32::MIN.into(), i32::MAX.into()),
        Scalar::U32 => (u32::MIN.into(), u32::MAX.into()),
        Scalar::F32 | Scalar::F64 => return true,
    };
    value.fract() == 0.0 && (low..=high).contains(&value)
}
