//! Writing VTK XML PolyData (.vtp): what the files of bodies and the frames of a run have in common.
//!
//! The header is text; the arrays follow it as they stand in memory (appended raw, little endian), so that nothing is lost
//! and nothing is converted. Points are particles, lines are bonds of two points each. There are no vertex cells: cell data
//! would have to cover them too. Connectivity and offsets are signed: ParaView refuses unsigned ones.
//!
//! [VTK XML formats](https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html)

use std::fmt::Display;
use std::io::{self, Write};

use crate::xml::escaped;

/// An array with a name that ParaView shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedArray<'a> {
    /// Its name, with the unit if it has one: `velocity_m_s`.
    pub name: &'a str,
    /// One value for each particle or bond.
    pub values: Values<'a>,
}

/// The values of an array: one number or one vector for each particle or bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Values<'a> {
    /// Numbers.
    Scalars(&'a [f64]),
    /// Vectors of 3 components.
    Vectors(&'a [[f64; 3]]),
    /// Counts and indices.
    Counts(&'a [u32]),
    /// Whole numbers with a sign.
    Integers(&'a [i32]),
}

impl Values<'_> {
    /// For how many particles or bonds there are values.
    pub fn len(&self) -> usize {
        match self {
            Self::Scalars(values) => values.len(),
            Self::Vectors(values) => values.len(),
            Self::Counts(values) => values.len(),
            Self::Integers(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn kind(&self) -> &'static str {
        match self {
            Self::Scalars(_) | Self::Vectors(_) => "Float64",
            Self::Counts(_) => "UInt32",
            Self::Integers(_) => "Int32",
        }
    }

    /// Bytes of all values together.
    fn bytes(&self) -> u64 {
        let each = match self {
            Self::Scalars(_) => 8,
            Self::Vectors(_) => 24,
            Self::Counts(_) | Self::Integers(_) => 4,
        };
        each * self.len() as u64
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        match self {
            Self::Scalars(values) => write_array(out, values, f64::to_le_bytes),
            Self::Vectors(values) => write_array(out, values.as_flattened(), f64::to_le_bytes),
            Self::Counts(values) => write_array(out, values, u32::to_le_bytes),
            Self::Integers(values) => write_array(out, values, i32::to_le_bytes),
        }
    }
}

/// Points, lines of two points each, and the data of both.
pub(crate) struct PolyData<'a> {
    pub(crate) points: &'a [[f64; 3]],
    pub(crate) lines: &'a [[u32; 2]],
    pub(crate) point_data: &'a [NamedArray<'a>],
    pub(crate) cell_data: &'a [NamedArray<'a>],
}

impl PolyData<'_> {
    /// Writes the file. `write_fields` writes the field data, with [`write_number`] and [`write_text`].
    ///
    /// # Errors
    /// Those of `out`.
    pub(crate) fn write(
        &self,
        out: &mut dyn Write,
        write_fields: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let (points, lines) = (self.points.len() as u64, self.lines.len() as u64);
        writeln!(out, "<?xml version=\"1.0\"?>")?;
        let header = "byte_order=\"LittleEndian\" header_type=\"UInt64\"";
        writeln!(
            out,
            "<VTKFile type=\"PolyData\" version=\"1.0\" {header}>\n  <PolyData>\n    <FieldData>"
        )?;
        write_fields(out)?;
        let other_cells = "NumberOfVerts=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\"";
        writeln!(out, "    </FieldData>")?;
        writeln!(
            out,
            "    <Piece NumberOfPoints=\"{points}\" NumberOfLines=\"{lines}\" {other_cells}>"
        )?;
        self.declare(out)?;
        write!(
            out,
            "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_"
        )?;
        Values::Vectors(self.points).write(out)?;
        write_array(out, self.lines.as_flattened(), |end| {
            i64::from(end).to_le_bytes()
        })?;
        write_offsets(out, lines)?;
        for array in self.point_data.iter().chain(self.cell_data) {
            array.values.write(out)?;
        }
        writeln!(out, "\n  </AppendedData>\n</VTKFile>")
    }

    /// Says in the header which arrays there are, and where in the appended data each begins.
    fn declare(&self, out: &mut dyn Write) -> io::Result<()> {
        let lines = self.lines.len() as u64;
        let mut end = 0;
        let mut section = |name: &str, arrays: &[Declaration]| {
            writeln!(out, "      <{name}>")?;
            for array in arrays {
                let (kind, shape) = (array.kind, array.shape);
                let name = escaped(array.name);
                writeln!(
                    out,
                    "        <DataArray type=\"{kind}\" Name=\"{name}\"{shape} format=\"appended\" offset=\"{end}\"/>"
                )?;
                end += 8 + array.bytes;
            }
            writeln!(out, "      </{name}>")
        };
        // Connectivity is a list of points, not of pairs.
        let whole = |name, bytes| Declaration {
            kind: "Int64",
            name,
            shape: "",
            bytes,
        };
        let points = NamedArray {
            name: "Points",
            values: Values::Vectors(self.points),
        };
        section("Points", &[Declaration::of(&points)])?;
        section(
            "Lines",
            &[
                whole("connectivity", 16 * lines),
                whole("offsets", 8 * lines),
            ],
        )?;
        section("PointData", &Declaration::all(self.point_data))?;
        section("CellData", &Declaration::all(self.cell_data))
    }
}

/// What the header says of an array.
struct Declaration<'a> {
    kind: &'static str,
    name: &'a str,
    /// An attribute, if the values are vectors.
    shape: &'static str,
    bytes: u64,
}

impl<'a> Declaration<'a> {
    fn all(arrays: &[NamedArray<'a>]) -> Vec<Self> {
        arrays.iter().map(Self::of).collect()
    }

    fn of(array: &NamedArray<'a>) -> Self {
        Self {
            kind: array.values.kind(),
            name: array.name,
            shape: match array.values {
                Values::Vectors(_) => " NumberOfComponents=\"3\"",
                _ => "",
            },
            bytes: array.values.bytes(),
        }
    }
}

/// The shortest text that reads back as the same number.
pub(crate) fn exact(value: f64) -> String {
    format!("{value:e}")
}

/// A field of one number, unless it is not known.
pub(crate) fn write_number(
    out: &mut dyn Write,
    kind: &str,
    name: &str,
    value: Option<impl Display>,
) -> io::Result<()> {
    let Some(value) = value else { return Ok(()) };
    let array = "DataArray";
    writeln!(
        out,
        "      <{array} type=\"{kind}\" Name=\"{name}\" NumberOfTuples=\"1\" format=\"ascii\">{value}</{array}>"
    )
}

/// A field of text, unless it is not known: an array of signed bytes with a zero at its end.
pub(crate) fn write_text(out: &mut dyn Write, name: &str, text: Option<&str>) -> io::Result<()> {
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
fn write_array<T: Copy, const BYTES: usize>(
    out: &mut dyn Write,
    values: &[T],
    bytes_of: impl Fn(T) -> [u8; BYTES],
) -> io::Result<()> {
    out.write_all(&((BYTES * values.len()) as u64).to_le_bytes())?;
    let mut bytes = [0_u8; 8 * 4096];
    for chunk in values.chunks(4096) {
        for (place, &value) in bytes.chunks_exact_mut(BYTES).zip(chunk) {
            place.copy_from_slice(&bytes_of(value));
        }
        out.write_all(&bytes[..BYTES * chunk.len()])?;
    }
    Ok(())
}

/// Where each line ends in the connectivity: 2, 4, 6, ...
fn write_offsets(out: &mut dyn Write, lines: u64) -> io::Result<()> {
    out.write_all(&(8 * lines).to_le_bytes())?;
    for line in 1..=lines {
        out.write_all(&(2 * line).to_le_bytes())?;
    }
    Ok(())
}
