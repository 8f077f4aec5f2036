//! The header of a PLY: its elements and the types of their properties.

use super::super::words::shown;
use crate::diagnostic::{Diagnostic, Result};
use crate::stl::REMEDY_AGAIN;

/// How the values are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Text,
    LittleEndian,
    BigEndian,
}

/// Type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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

/// A value of an element, or a list of values.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) scalar: Scalar,
    /// Type of the number of values, of a list.
    pub(super) count: Option<Scalar>,
}

/// A kind of thing, such as corners.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    /// How many there are.
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

#[derive(Debug)]
pub(super) struct Header {
    pub(super) form: Form,
    /// In the order of the file.
    pub(super) elements: Vec<Element>,
    /// Where the values begin, bytes.
    pub(super) end: usize,
    /// The line in which they begin, from 1.
    pub(super) end_line: usize,
}

impl Header {
    pub(super) fn read(bytes: &[u8]) -> Result<Self> {
        let mut form = None;
        let mut elements: Vec<Element> = Vec::new();
        let (mut at, mut number) = (0, 0);
        loop {
            let Some((line, next)) = line(bytes, at) else {
                let problem = "truncated: the file ends within its header";
                return Err(Diagnostic::input("", problem, REMEDY_AGAIN));
            };
            (at, number) = (next, number + 1);
            let text = String::from_utf8_lossy(line);
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            let wrong = || {
                let problem = format!("found '{}' in the header of a PLY", shown(line));
                Diagnostic::input(format!("line {number}"), problem, REMEDY_AGAIN)
            };
            match words[..] {
                [] | ["ply" | "comment" | "obj_info", ..] => {}
                ["format", name, ..] => form = Some(Form::named(name).ok_or_else(wrong)?),
                ["element", name, count] => elements.push(Element {
                    name: name.to_owned(),
                    count: count.parse().map_err(|_| wrong())?,
                    properties: Vec::new(),
                }),
                ["property", ref property @ ..] => {
                    let element = elements.last_mut().ok_or_else(wrong)?;
                    let property = Property::read(property).ok_or_else(wrong)?;
                    element.properties.push(property);
                }
                ["end_header"] => break,
                _ => return Err(wrong()),
            }
        }
        let Some(form) = form else {
            let problem = "the header of the PLY has no line 'format'";
            return Err(Diagnostic::input("", problem, REMEDY_AGAIN));
        };
        Ok(Self {
            form,
            elements,
            end: at,
            end_line: number + 1,
        })
    }

    /// Whether a coordinate has single precision.
    pub(super) fn has_single_precision(&self) -> bool {
        let corners = self
            .elements
            .iter()
            .filter(|element| element.name == "vertex");
        let mut properties = corners.flat_map(|element| &element.properties);
        properties.any(|p| matches!(p.name.as_str(), "x" | "y" | "z") && p.scalar == Scalar::F32)
    }
}

impl Form {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "ascii" => Self::Text,
            "binary_little_endian" => Self::LittleEndian,
            "binary_big_endian" => Self::BigEndian,
            _ => return None,
        })
    }
}

impl Property {
    /// From the words after `property`.
    fn read(words: &[&str]) -> Option<Self> {
        let (count, scalar, name) = match words {
            ["list", count, scalar, name] => (Some(Scalar::named(count)?), scalar, name),
            [scalar, name] => (None, scalar, name),
            _ => return None,
        };
        Some(Self {
            name: (*name).to_owned(),
            scalar: Scalar::named(scalar)?,
            count,
        })
    }
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }
}

/// The line that begins at `at`, and where the next begins. None: the file ends before the line.
fn line(bytes: &[u8], at: usize) -> Option<(&[u8], usize)> {
    let rest = &bytes[at..];
    let end = rest.iter().position(|b| matches!(b, b'\n' | b'\r'))?;
    // Binary values may begin with the byte of a line feed: lines end as the first one does.
    let ends_in_two = bytes.get(3..5) == Some(b"\r\n");
    let width = if ends_in_two && rest[end..].starts_with(b"\r\n") {
        2
    } else {
        1
    };
    Some((&rest[..end], at + end + width))
}
