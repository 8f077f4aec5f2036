//! The XML of a .vtp file: the arrays that it declares, their roles, and the places of their
//! values.

use quick_xml::events::BytesStart;

use super::decode::{DAMAGED, Scalar};
use super::names::{
    BOND_LENGTH, BOND_RADIUS, BOND_RANGE, LENGTH_UNIT, OVERLAP, PARTICLE_DENSITY, PROGRAM, RADIUS,
    SEED, SHAPE_VOLUME, SOURCE, SOURCE_HASH, VERSION, WARNINGS,
};
use crate::body::{histories, stored_frame as frame, stored_walls as walls};
use crate::diagnostic::{Diagnostic, Result};

/// The type of content as which a file is read, which determines the names of the arrays.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Layout {
    #[default]
    Body,
    Frame,
    Walls,
}

/// The role of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Positions,
    Radii,
    /// Rotations of particles.
    Turns,
    /// Whether a particle of a frame is a sphere of a rigid clump.
    Rigid,
    Connectivity,
    Offsets,
    BondRadii,
    BondLengths,
    Damages,
    /// For the frames of a run: the fragment of each particle, its density, and the broken bonds.
    Clusters,
    Densities,
    Broken,
    /// History of bonds, by its number in [`histories::ALL`].
    History(usize),
    /// The id and the body of each particle, and its velocity.
    Ids,
    Bodies,
    Velocities,
    /// For the walls of a run: the corners of each triangle, where it ends among them, and its
    /// wall.
    Corners,
    CornerOffsets,
    WallNumbers,
    /// Field data of this name.
    Field(&'static str),
    /// Not used.
    Other,
}

/// The encoding of the values of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Ascii,
    Base64,
    /// At this offset of the appended data.
    Appended(u64),
}

/// An array as the header declares it.
#[derive(Debug, Clone)]
pub(super) struct Array {
    pub(super) role: Role,
    pub(super) name: String,
    pub(super) scalar: String,
    pub(super) format: Format,
}

impl Array {
    /// From an element `DataArray` or `Array` inside the element `section`.
    pub(super) fn declared(
        element: &BytesStart<'_>,
        section: &str,
        layout: Layout,
    ) -> Result<Self> {
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
        Ok(Self {
            role: match layout {
                Layout::Body => role_of(section, &name),
                Layout::Frame => role_in_frame(section, &name),
                Layout::Walls => role_in_walls(section, &name),
            },
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

fn role_of(section: &str, name: &str) -> Role {
    const FIELDS: [&str; 11] = [
        VERSION,
        LENGTH_UNIT,
        PROGRAM,
        SOURCE,
        SOURCE_HASH,
        SHAPE_VOLUME,
        PARTICLE_DENSITY,
        OVERLAP,
        BOND_RANGE,
        SEED,
        WARNINGS,
    ];
    match (section, name) {
        ("Points", _) => Role::Positions,
        ("Lines", "connectivity") => Role::Connectivity,
        ("Lines", "offsets") => Role::Offsets,
        ("PointData", RADIUS) => Role::Radii,
        ("PointData", frame::TURN) => Role::Turns,
        ("CellData", BOND_RADIUS) => Role::BondRadii,
        ("CellData", BOND_LENGTH) => Role::BondLengths,
        ("CellData", frame::DAMAGE) => Role::Damages,
        ("CellData", frame::BROKEN) => Role::Broken,
        ("CellData", name) => history(name),
        ("FieldData", _) => FIELDS
            .into_iter()
            .find(|field| *field == name)
            .map_or(Role::Other, Role::Field),
        _ => Role::Other,
    }
}

fn history(name: &str) -> Role {
    let at = histories::ALL.iter().position(|other| *other == name);
    at.map_or(Role::Other, Role::History)
}

fn role_in_frame(section: &str, name: &str) -> Role {
    match (section, name) {
        ("Points", _) => Role::Positions,
        ("Lines", "connectivity") => Role::Connectivity,
        ("Lines", "offsets") => Role::Offsets,
        ("PointData", frame::RADIUS) => Role::Radii,
        ("PointData", frame::TURN) => Role::Turns,
        ("PointData", frame::RIGID) => Role::Rigid,
        ("PointData", frame::FRAGMENT_ID) => Role::Clusters,
        ("PointData", frame::DENSITY) => Role::Densities,
        ("PointData", frame::PARTICLE_ID) => Role::Ids,
        ("PointData", frame::BODY) => Role::Bodies,
        ("PointData", frame::VELOCITY) => Role::Velocities,
        ("CellData", frame::BOND_RADIUS) => Role::BondRadii,
        ("CellData", frame::BOND_LENGTH) => Role::BondLengths,
        ("CellData", frame::DAMAGE) => Role::Damages,
        ("CellData", frame::BROKEN) => Role::Broken,
        ("CellData", name) => history(name),
        ("FieldData", frame::TIME) => Role::Field(frame::TIME),
        ("FieldData", frame::BODY_NAMES) => Role::Field(frame::BODY_NAMES),
        _ => Role::Other,
    }
}

fn role_in_walls(section: &str, name: &str) -> Role {
    const FIELDS: [&str; 4] = [
        frame::TIME,
        walls::WALL_NAMES,
        walls::WALL_FORCES,
        walls::FIXED_WALLS,
    ];
    match (section, name) {
        ("Points", _) => Role::Positions,
        ("Polys", "connectivity") => Role::Corners,
        ("Polys", "offsets") => Role::CornerOffsets,
        ("CellData", walls::WALL) => Role::WallNumbers,
        ("FieldData", _) => FIELDS
            .into_iter()
            .find(|field| *field == name)
            .map_or(Role::Other, Role::Field),
        _ => Role::Other,
    }
}

/// The numbers of points and cells.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Counts {
    pub(super) points: u64,
    pub(super) lines: u64,
    /// Number of vertex cells, whose cell data precede those of the lines.
    pub(super) cells_before: u64,
    /// Number of polygons and strips, whose cell data follow those of the lines.
    pub(super) cells_after: u64,
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
    pub(super) fn check(&self, array: &Array) -> Result<()> {
        if self.compressed && array.format != Format::Ascii && array.role != Role::Other {
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
