//! The values of one data array, in each of the uncompressed encodings of VTK.

use std::io::{self, BufRead, ErrorKind, Read};

use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use base64::{DecodeError, Engine, alphabet};

use crate::diagnostic::{Diagnostic, Result};

/// Number type of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Int64,
    UInt64,
    Float32,
    Float64,
}

impl Scalar {
    /// From the attribute `type`. A text is an array of bytes.
    pub(super) fn named(name: &str) -> Result<Self> {
        Ok(match name {
            "Int8" | "String" => Self::Int8,
            "UInt8" => Self::UInt8,
            "Int16" => Self::Int16,
            "UInt16" => Self::UInt16,
            "Int32" => Self::Int32,
            "UInt32" => Self::UInt32,
            "Int64" | "vtkIdType" => Self::Int64,
            "UInt64" => Self::UInt64,
            "Float32" => Self::Float32,
            "Float64" => Self::Float64,
            _ => {
                return Err(Diagnostic::input(
                    "",
                    format!("unknown number type '{name}'"),
                    DAMAGED,
                ));
            }
        })
    }

    pub(super) fn bytes(self) -> usize {
        match self {
            Self::Int8 | Self::UInt8 => 1,
            Self::Int16 | Self::UInt16 => 2,
            Self::Int32 | Self::UInt32 | Self::Float32 => 4,
            Self::Int64 | Self::UInt64 | Self::Float64 => 8,
        }
    }

    pub(super) fn is_whole(self) -> bool {
        !matches!(self, Self::Float32 | Self::Float64)
    }
}

/// One value of an array.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Number {
    Integer(i128),
    Float(f64),
}

/// The remedy for an invalid file.
pub(crate) const DAMAGED: &str = "the file is damaged: write or copy it again";

/// Source of the values of an array.
pub(super) enum Values<'a> {
    /// Numbers as text, separated by white space.
    Text(&'a str),
    /// This number of bytes, little endian.
    Bytes(&'a mut dyn Read, u64),
}

impl Values<'_> {
    /// Passes every value to `take`, in order; refuses text that is not a number, and bytes that
    /// end too early.
    pub(super) fn for_each(
        self,
        scalar: Scalar,
        take: impl FnMut(Number) -> Result<()>,
    ) -> Result<()> {
        match self {
            Self::Text(text) => each_of_text(text, scalar, take),
            Self::Bytes(input, bytes) => each_of_bytes(input, bytes, scalar, take),
        }
    }
}

fn each_of_text(
    text: &str,
    scalar: Scalar,
    mut take: impl FnMut(Number) -> Result<()>,
) -> Result<()> {
    for word in text.split_ascii_whitespace() {
        let number = match scalar.is_whole() {
            true => word.parse().map(Number::Integer).ok(),
            false => word.parse().map(Number::Float).ok(),
        };
        take(number.ok_or_else(|| {
            Diagnostic::input(
                "",
                format!("'{word}' is not a number of type {scalar:?}"),
                DAMAGED,
            )
        })?)?;
    }
    Ok(())
}

fn each_of_bytes(
    input: &mut dyn Read,
    bytes: u64,
    scalar: Scalar,
    mut take: impl FnMut(Number) -> Result<()>,
) -> Result<()> {
    let size = scalar.bytes();
    if !bytes.is_multiple_of(size as u64) {
        return Err(Diagnostic::input(
            "",
            format!("{bytes} bytes are no whole number of {scalar:?} values"),
            DAMAGED,
        ));
    }
    let mut buffer = [0_u8; 1 << 15];
    let mut left = bytes;
    while left > 0 {
        let chunk = &mut buffer[..left.min(1 << 15) as usize];
        input
            .read_exact(chunk)
            .map_err(|error| unreadable(&error))?;
        left -= chunk.len() as u64;
        match scalar {
            Scalar::Int8 => each_chunk(chunk, &mut take, |b| {
                Number::Integer(i8::from_le_bytes(b).into())
            })?,
            Scalar::UInt8 => each_chunk(chunk, &mut take, |b| {
                Number::Integer(u8::from_le_bytes(b).into())
            })?,
            Scalar::Int16 => each_chunk(chunk, &mut take, |b| {
                Number::Integer(i16::from_le_bytes(b).into())
            })?,
            Scalar::UInt16 => each_chunk(chunk, &mut take, |b| {
                Number::Integer(u16::from_le_bytes(b).into())
            })?,
            Scalar::Int32 => each_chunk(chunk, &mut take, |b| {
                Number::Integer(i32::from_le_bytes(b).into())
            })?,
            Scalar::UInt32 => each_chunk(chunk, &mut take, |b| {
                Number::Integer(u32::from_le_bytes(b).into())
            })?,
            Scalar::Int64 => each_chunk(chunk, &mut take, |b| {
                Number::Integer(i64::from_le_bytes(b).into())
            })?,
            Scalar::UInt64 => each_chunk(chunk, &mut take, |b| {
                Number::Integer(u64::from_le_bytes(b).into())
            })?,
            Scalar::Float32 => each_chunk(chunk, &mut take, |b| {
                Number::Float(f32::from_le_bytes(b).into())
            })?,
            Scalar::Float64 => {
                each_chunk(chunk, &mut take, |b| Number::Float(f64::from_le_bytes(b)))?;
            }
        }
    }
    Ok(())
}

#[inline]
fn each_chunk<const SIZE: usize>(
    bytes: &[u8],
    take: &mut impl FnMut(Number) -> Result<()>,
    number: impl Fn([u8; SIZE]) -> Number,
) -> Result<()> {
    bytes
        .as_chunks::<SIZE>()
        .0
        .iter()
        .try_for_each(|&value| take(number(value)))
}

/// The error for a failure while reading: an early end, bytes that are not a body, or a disk that
/// does not respond.
pub(super) fn unreadable(error: &io::Error) -> Diagnostic {
    let refused = error
        .get_ref()
        .and_then(|inner| inner.downcast_ref::<Diagnostic>());
    if let Some(refused) = refused {
        return refused.clone();
    }
    if error.kind() == ErrorKind::UnexpectedEof {
        return truncated();
    }
    Diagnostic::failed("", format!("cannot be read: {error}"), "")
}

/// The input ended before the body was complete.
pub(super) fn truncated() -> Diagnostic {
    Diagnostic::input(
        "",
        "the file ends too early",
        "it is cut off: write or copy it again",
    )
}

/// Number of bytes of the array at the position of `input`, given by its first four or eight bytes.
pub(super) fn array_bytes(input: &mut dyn Read, header_bytes: usize) -> Result<u64> {
    let mut count = [0_u8; 8];
    input
        .read_exact(&mut count[..header_bytes])
        .map_err(|error| unreadable(&error))?;
    Ok(u64::from_le_bytes(count))
}

pub(super) fn skip(input: &mut dyn BufRead, bytes: u64) -> Result<()> {
    match io::copy(&mut input.take(bytes), &mut io::sink()) {
        Ok(skipped) if skipped == bytes => Ok(()),
        Ok(_) => Err(truncated()),
        Err(error) => Err(unreadable(&error)),
    }
}

/// The bytes of one array in base64: its size in bytes, then its values. Text after its end is
/// ignored.
pub(super) fn base64_array(text: &[u8], header_bytes: usize) -> Result<Vec<u8>> {
    let header = base64(text, header_bytes)?;
    let bytes = array_bytes(&mut header.as_slice(), header_bytes)?;
    let wanted = usize::try_from(bytes)
        .ok()
        .and_then(|bytes| bytes.checked_add(header_bytes))
        .ok_or_else(truncated)?;
    let mut decoded = base64(text, wanted)?;
    decoded.drain(..header_bytes);
    Ok(decoded)
}

/// As VTK reads it: bits beyond the last byte do not matter.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_allow_trailing_bits(true)
        .with_decode_padding_mode(DecodePaddingMode::RequireCanonical),
);

/// The first `wanted` bytes of a text in base64. There may be padding at the end of each part of
/// it.
fn base64(text: &[u8], wanted: usize) -> Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(wanted.min(text.len()) + 2);
    let mut digits = text.iter().filter(|digit| !digit.is_ascii_whitespace());
    while bytes.len() < wanted {
        let mut group = [0; 4];
        for digit in &mut group {
            *digit = *digits.next().ok_or_else(truncated)?;
        }
        BASE64
            .decode_vec(group, &mut bytes)
            .map_err(|error| match error {
                DecodeError::InvalidByte(_, digit) if digit != b'=' => {
                    let digit = char::from(digit).escape_default();
                    let problem = format!("'{digit}' is no base64 character");
                    Diagnostic::input("", problem, DAMAGED)
                }
                _ => truncated(),
            })?;
    }
    bytes.truncate(wanted);
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Test vectors of RFC 4648, section 10.
    #[test]
    fn base64_of_the_standard() {
        for (text, bytes) in [
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9v YmFy\n", "foobar"),
        ] {
            assert_eq!(
                base64(text.as_bytes(), bytes.len()).unwrap(),
                bytes.as_bytes()
            );
        }
        assert_eq!(base64(b"Zg==Zm8=", 3).unwrap(), b"ffo");
        assert!(base64(b"Zg==", 2).is_err());
        assert!(base64(b"Zm9", 3).is_err());
        assert!(base64(b"Zm9*", 3).is_err());
        assert!(base64(b"=====", 1).is_err());
    }

    #[test]
    fn an_array_with_its_size() {
        let (joint, apart) = (b"CAAAAP//////////", b"CAAAAA==/////////////w==");
        assert_eq!(base64_array(joint, 4).unwrap(), [255; 8]);
        assert!(base64_array(&apart[..12], 4).is_err());
        assert!(base64_array(b"/////////////w==", 8).is_err());
    }
}
