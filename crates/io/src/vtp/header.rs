//! The XML of a .vtp file: the arrays that it declares, and the places of their values.

use quick_xml::events::BytesStart;

use super::decode::{DAMAGED, Scalar};
use super::shape::{Counts, Shape};
use crate::diagnostic::{Diagnostic, Result};

/// The encoding of the values of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Ascii,
    Base64,
    /// At this offset of the appended data.
    Appended(u64),
}

/// The shapes of the arrays that are used, by their sections and names. None: it is not used.
pub(super) type Wanted<'a> = &'a dyn Fn(&str, &str) -> Option<Shape>;

/// An array as the header declares it.
#[derive(Debug, Clone)]
pub(super) struct Declared {
    /// None: it is not used.
    pub(super) shape: Option<Shape>,
    pub(super) name: String,
    /// Section and name, as in [`super::Arrays::named`].
    pub(super) key: String,
    /// Whether it is one of the arrays that make up points and cells.
    pub(super) is_of_mesh: bool,
    pub(super) components: usize,
    scalar: String,
    pub(super) format: Format,
}

impl Declared {
    /// From an element `DataArray` or `Array` inside the element `section`.
    pub(super) fn of(element: &BytesStart<'_>, section: &str, wanted: Wanted<'_>) -> Result<Self> {
        let name = attribute(element, "Name")?.unwrap_or_default();
        let scalar = attribute(element, "type")?.unwrap_or_default();
        let format = match attribute(element, "format")?.as_deref() {
            Some("ascii") => Format::Ascii,
            Some("binary") => Format::Base64,
            Some("appended") => {
                Format::Appended(count(element, "offset")?.ok_or_else(|| missing("offset"))?)
            }
            other => {
                let problem = format!(
                    "array '{name}' has the unknown format '{}'",
                    other.unwrap_or_default()
                );
                return Err(Diagnostic::input("", problem, DAMAGED));
            }
        };
        let components = attribute(element, "NumberOfComponents")?;
        Ok(Self {
            shape: wanted(section, &name),
            key: match section {
                "Points" => "Points/positions_m".to_owned(),
                _ => format!("{section}/{name}"),
            },
            is_of_mesh: ["Points", "Lines", "Polys"].contains(&section),
            components: components.and_then(|text| text.parse().ok()).unwrap_or(1),
            name,
            scalar,
            format,
        })
    }

    /// Its number type.
    pub(super) fn scalar(&self) -> Result<Scalar> {
        Scalar::named(&self.scalar)
    }

    /// The message with this array as its place.
    pub(super) fn within(&self, error: Diagnostic) -> Diagnostic {
        error.within(&format!("array '{}'", self.name))
    }
}

impl Counts {
    /// From the element `Piece`.
    pub(super) fn declared(piece: &BytesStart<'_>) -> Result<Self> {
        let number = |name| count(piece, name).map(Option::unwrap_or_default);
        Ok(Self {
            points: count(piece, "NumberOfPoints")?.ok_or_else(|| missing("NumberOfPoints"))?,
            lines: number("NumberOfLines")?,
            cells_before: number("NumberOfVerts")?,
            cells_after: number("NumberOfStrips")?.saturating_add(number("NumberOfPolys")?),
        })
    }
}

/// The encoding of the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Encoding {
    /// Number of bytes of the number that gives the length of an array: 4 or 8.
    pub(super) header_bytes: usize,
    pub(super) compressed: bool,
}

impl Encoding {
    /// From the element `VTKFile`.
    pub(super) fn declared(file: &BytesStart<'_>) -> Result<Self> {
        let kind = attribute(file, "type")?.unwrap_or_default();
        if kind != "PolyData" {
            let problem = format!("this VTK file holds '{kind}', not 'PolyData'");
            return Err(Diagnostic::input(
                "",
                problem,
                "save the body as PolyData (.vtp)",
            ));
        }
        if attribute(file, "byte_order")?.as_deref() == Some("BigEndian") {
            return Err(Diagnostic::input(
                "",
                "the numbers are big endian",
                "save the file as little endian or ascii",
            ));
        }
        let header_bytes = match attribute(file, "header_type")?.as_deref() {
            None | Some("UInt32") => 4,
            Some("UInt64") => 8,
            Some(other) => {
                return Err(Diagnostic::input(
                    "",
                    format!("unknown header_type '{other}'"),
                    DAMAGED,
                ));
            }
        };
        let compressed = attribute(file, "compressor")?.is_some_and(|name| !name.is_empty());
        Ok(Self {
            header_bytes,
            compressed,
        })
    }

    /// Refuses compressed values.
    pub(super) fn check(&self, array: &Declared) -> Result<()> {
        if self.compressed && array.format != Format::Ascii && array.shape.is_some() {
            return Err(Diagnostic::input(
                "",
                format!("array '{}' is compressed", array.name),
                "save the file without compression: 'Compressor Type: None' when ParaView saves data, \
                 writer.SetCompressorTypeToNone() in VTK",
            ));
        }
        Ok(())
    }
}

pub(super) fn attribute(element: &BytesStart<'_>, name: &str) -> Result<Option<String>> {
    let found = element
        .try_get_attribute(name)
        .map_err(|error| damaged(&error))?;
    let value =
        found.map(|attribute| attribute.normalized_value(quick_xml::XmlVersion::Implicit1_0));
    Ok(value
        .transpose()
        .map_err(|error| damaged(&error))?
        .map(std::borrow::Cow::into_owned))
}

fn count(element: &BytesStart<'_>, name: &str) -> Result<Option<u64>> {
    let Some(text) = attribute(element, name)? else {
        return Ok(None);
    };
    text.trim()
        .parse()
        .map(Some)
        .map_err(|_| Diagnostic::input("", format!("{name}=\"{text}\" is not a count"), DAMAGED))
}

fn missing(name: &str) -> Diagnostic {
    Diagnostic::input("", format!("the attribute {name} is missing"), DAMAGED)
}

/// The error for a file that is not a VTK file.
pub(super) fn not_vtp() -> Diagnostic {
    Diagnostic::input(
        "",
        "this is not a VTK XML file",
        "a .vtp file begins with <VTKFile type=\"PolyData\" ...>",
    )
}

/// The error for XML that is not well formed.
pub(super) fn damaged(error: &dyn std::fmt::Display) -> Diagnostic {
    Diagnostic::input(
        "",
        format!("the XML is damaged: {error}"),
        "write or copy the file again",
    )
}
