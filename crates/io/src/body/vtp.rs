//! Bodies as VTK XML PolyData (.vtp), which ParaView and PyVista open as they stand.
//!
//! Layout: points = particles (Float64, m), lines = bonds (two points each), point data `radius`, cell data `bond_radius`
//! and `bond_initial_length` (m), field data: `body_format_version`, `length_unit` and one array for each known field of
//! [`About`]. The header is text; the arrays follow it as they stand in memory (appended raw, little endian),
//! so that nothing is lost and nothing is converted. There are no vertex cells: cell data would have to cover them too.
//! Connectivity and offsets are signed: ParaView refuses unsigned ones.
//!
//! [VTK XML formats](https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html)

mod contents;
mod decode;
mod header;
mod read;

pub use read::read;

use std::io::{self, Write};

use super::{About, Body};

/// Version of this layout. Files of a later one are refused.
pub const FORMAT_VERSION: u64 = 1;

const RADIUS: &str = "radius";
const BOND_RADIUS: &str = "bond_radius";
const BOND_LENGTH: &str = "bond_initial_length";
const VERSION: &str = "body_format_version";
const LENGTH_UNIT: &str = "length_unit";
const METRE: &str = "m";

/// Names of the field data, in the order of [`About`].
const PROGRAM: &str = "program";
const SOURCE: &str = "source";
const SOURCE_HASH: &str = "source_hash";
const SHAPE_VOLUME: &str = "shape_volume_m3";
const PARTICLE_DENSITY: &str = "particle_density_kg_m3";
const OVERLAP: &str = "overlap";
const BONDING_RADIUS: &str = "bonding_radius";
const SEED: &str = "seed";

/// Writes a body as .vtp. It must keep the rules of [`Body::check`].
///
/// # Errors
/// Those of `out`.
pub fn write(body: &Body, out: &mut dyn Write) -> io::Result<()> {
    let (particles, bonds) = (body.positions.len() as u64, body.bonds.len() as u64);
    let mut arrays = Appended { out, end: 0 };
    writeln!(arrays.out, "<?xml version=\"1.0\"?>")?;
    let header = "byte_order=\"LittleEndian\" header_type=\"UInt64\"";
    writeln!(
        arrays.out,
        "<VTKFile type=\"PolyData\" version=\"1.0\" {header}>\n  <PolyData>\n    <FieldData>"
    )?;
    write_fields(&body.about, arrays.out)?;
    let other_cells = "NumberOfVerts=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\"";
    writeln!(arrays.out, "    </FieldData>")?;
    writeln!(
        arrays.out,
        "    <Piece NumberOfPoints=\"{particles}\" NumberOfLines=\"{bonds}\" {other_cells}>"
    )?;
    arrays.declare("Points", &[("Float64", "Points", 3)], particles)?;
    arrays.declare(
        "Lines",
        &[("Int64", "connectivity", 2), ("Int64", "offsets", 1)],
        bonds,
    )?;
    arrays.declare("PointData", &[("Float64", RADIUS, 1)], particles)?;
    arrays.declare(
        "CellData",
        &[("Float64", BOND_RADIUS, 1), ("Float64", BOND_LENGTH, 1)],
        bonds,
    )?;
    write!(
        arrays.out,
        "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_"
    )?;
    let out = arrays.out;
    write_array(out, body.positions.as_flattened(), f64::to_le_bytes)?;
    write_array(out, body.bonds.as_flattened(), |end| {
        i64::from(end).to_le_bytes()
    })?;
    write_offsets(out, bonds)?;
    write_array(out, &body.radii, f64::to_le_bytes)?;
    write_array(out, &body.bond_radii, f64::to_le_bytes)?;
    write_array(out, &body.bond_lengths, f64::to_le_bytes)?;
    writeln!(out, "\n  </AppendedData>\n</VTKFile>")
}

/// Declares the arrays in the header and keeps count of where in the appended data the next one begins.
struct Appended<'a> {
    out: &'a mut dyn Write,
    end: u64,
}

impl Appended<'_> {
    /// One section of arrays, each with `tuples` times its number of components; all of 8 bytes a value.
    fn declare(
        &mut self,
        section: &str,
        arrays: &[(&str, &str, u64)],
        tuples: u64,
    ) -> io::Result<()> {
        writeln!(self.out, "      <{section}>")?;
        for (kind, name, components) in arrays {
            // Connectivity is a list of points, not of tuples.
            let shape = if *components == 3 {
                " NumberOfComponents=\"3\""
            } else {
                ""
            };
            let end = self.end;
            writeln!(
                self.out,
                "        <DataArray type=\"{kind}\" Name=\"{name}\"{shape} format=\"appended\" offset=\"{end}\"/>"
            )?;
            self.end += 8 + 8 * tuples * components;
        }
        writeln!(self.out, "      </{section}>")
    }
}

fn write_fields(about: &About, out: &mut dyn Write) -> io::Result<()> {
    write_number(out, "UInt64", VERSION, Some(FORMAT_VERSION))?;
    write_text(out, LENGTH_UNIT, Some(METRE))?;
    write_text(out, PROGRAM, about.program.as_deref())?;
    write_text(out, SOURCE, about.source.as_deref())?;
    write_number(out, "UInt64", SOURCE_HASH, about.source_hash)?;
    write_number(
        out,
        "Float64",
        SHAPE_VOLUME,
        about.shape_volume_m3.map(exact),
    )?;
    write_number(
        out,
        "Float64",
        PARTICLE_DENSITY,
        about.particle_density_kg_m3.map(exact),
    )?;
    write_number(out, "Float64", OVERLAP, about.overlap.map(exact))?;
    write_number(
        out,
        "Float64",
        BONDING_RADIUS,
        about.bonding_radius.map(exact),
    )?;
    write_number(out, "UInt64", SEED, about.seed)
}

/// The shortest text that reads back as the same number.
fn exact(value: f64) -> String {
    format!("{value:e}")
}

fn write_number(
    out: &mut dyn Write,
    kind: &str,
    name: &str,
    value: Option<impl std::fmt::Display>,
) -> io::Result<()> {
    let Some(value) = value else { return Ok(()) };
    let array = "DataArray";
    writeln!(
        out,
        "      <{array} type=\"{kind}\" Name=\"{name}\" NumberOfTuples=\"1\" format=\"ascii\">{value}</{array}>"
    )
}

/// Text is an array of signed bytes with a zero at its end.
fn write_text(out: &mut dyn Write, name: &str, text: Option<&str>) -> io::Result<()> {
    let Some(text) = text else { return Ok(()) };
    write!(
        out,
        "      <Array type=\"String\" Name=\"{name}\" NumberOfTuples=\"1\" format=\"ascii\">"
    )?;
    for byte in text.bytes() {
        write!(out, "{} ", byte.cast_signed())?;
    }
    writeln!(out, "0</Array>")
}

/// One array: its size in bytes, then its values.
fn write_array<T: Copy>(
    out: &mut dyn Write,
    values: &[T],
    bytes_of: impl Fn(T) -> [u8; 8],
) -> io::Result<()> {
    out.write_all(&(8 * values.len() as u64).to_le_bytes())?;
    let mut bytes = [0_u8; 8 * 4096];
    for chunk in values.chunks(4096) {
        for (place, &value) in bytes.chunks_exact_mut(8).zip(chunk) {
            place.copy_from_slice(&bytes_of(value));
        }
        out.write_all(&bytes[..8 * chunk.len()])?;
    }
    Ok(())
}

/// Where each bond ends in the connectivity: 2, 4, 6, ...
fn write_offsets(out: &mut dyn Write, bonds: u64) -> io::Result<()> {
    out.write_all(&(8 * bonds).to_le_bytes())?;
    for bond in 1..=bonds {
        out.write_all(&(2 * bond).to_le_bytes())?;
    }
    Ok(())
}
