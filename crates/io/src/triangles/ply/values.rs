//! The values of a PLY, one after the other.

use super::super::words::{finite, shown};
use super::header::{Form, Header, Property, Scalar};
use crate::diagnostic::{Diagnostic, Result};
use crate::stl::{REMEDY_AGAIN, REMEDY_REPAIR};

/// The values that are not read yet.
pub(super) struct Values<'a> {
    form: Form,
    rest: &'a [u8],
    /// Of text: the line that is read, from 1.
    line: usize,
}

impl<'a> Values<'a> {
    pub(super) fn of(header: &Header, bytes: &'a [u8]) -> Self {
        Self {
            form: header.form,
            rest: &bytes[header.end..],
            line: header.end_line,
        }
    }

    pub(super) fn is_binary(&self) -> bool {
        self.form != Form::Text
    }

    /// Number of bytes that are not read yet, without blanks at the end.
    pub(super) fn rest(&self) -> usize {
        self.rest.trim_ascii().len()
    }

    /// Reads a property: the value, or the number of values of a list, of which each is handed to
    /// `each`.
    pub(super) fn property(
        &mut self,
        property: &Property,
        mut each: impl FnMut(f64),
    ) -> Result<f64> {
        let Some(count) = property.count else {
            return self.value(property.scalar);
        };
        let count = self.value(count)?;
        if count < 0.0 || count.fract() != 0.0 {
            let problem = format!("a list of {count} values");
            return Err(Diagnostic::input("", problem, REMEDY_REPAIR));
        }
        for _ in 0..count as u64 {
            each(self.value(property.scalar)?);
        }
        Ok(count)
    }

    fn value(&mut self, scalar: Scalar) -> Result<f64> {
        match self.form {
            Form::Text => self.word(),
            Form::LittleEndian | Form::BigEndian => self.binary(scalar).ok_or_else(truncated),
        }
    }

    /// The next word of a text. One at the very end may be cut short, which its faces show.
    fn word(&mut self) -> Result<f64> {
        let start = self.rest.iter().position(|b| !b.is_ascii_whitespace());
        let start = start.ok_or_else(truncated)?;
        let blanks = &self.rest[..start];
        self.line += blanks.iter().filter(|b| **b == b'\n').count();
        let word = &self.rest[start..];
        let end = word
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(word.len());
        let (word, rest) = word.split_at(end);
        self.rest = rest;
        let text = std::str::from_utf8(word).unwrap_or("");
        text.parse().or_else(|_| finite(word)).map_err(|_| {
            let problem = format!("'{}' is not a number", shown(word));
            Diagnostic::input(format!("line {}", self.line), problem, REMEDY_REPAIR)
        })
    }

    fn binary(&mut self, scalar: Scalar) -> Option<f64> {
        Some(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes(self.bytes()?)),
            Scalar::U8 => f64::from(u8::from_le_bytes(self.bytes()?)),
            Scalar::I16 => f64::from(i16::from_le_bytes(self.bytes()?)),
            Scalar::U16 => f64::from(u16::from_le_bytes(self.bytes()?)),
            Scalar::I32 => f64::from(i32::from_le_bytes(self.bytes()?)),
            Scalar::U32 => f64::from(u32::from_le_bytes(self.bytes()?)),
            Scalar::F32 => f64::from(f32::from_le_bytes(self.bytes()?)),
            Scalar::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    /// The next bytes, in the order of little endian.
    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (bytes, rest) = self.rest.split_first_chunk::<N>()?;
        self.rest = rest;
        let mut bytes = *bytes;
        if self.form == Form::BigEndian {
            bytes.reverse();
        }
        Some(bytes)
    }
}

fn truncated() -> Diagnostic {
    Diagnostic::input("", "truncated: the file ends in it", REMEDY_AGAIN)
}
