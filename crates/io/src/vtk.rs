//! Writing of VTK XML PolyData (.vtp), shared by the files of bodies and the frames of a run.
//!
//! The header is text. The arrays follow it as binary numbers (appended raw, little endian), so
//! that nothing is lost. Each value is computed when it is written, so that no array is held in
//! memory, and there is one value for every point or line. Points are particles, lines are bonds of
//! two points each. There are no vertex cells: cell data would have to include them. Connectivity
//! and offsets are signed: ParaView refuses unsigned ones.
//!
//! [VTK XML formats](https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html)

use std::fmt::Display;
use std::io::{self, Write};

use crate::xml::escaped;

/// An array with its name in ParaView.
#[derive(Clone, Copy)]
pub struct NamedArray<'a> {
    /// Its name, with the unit if it has one: `velocity_m_s`.
    pub name: &'a str,
    /// One value for each particle or bond.
    pub values: Values<'a>,
}

/// The values of an array: one number or one vector for each particle or bond, found by its index.
#[derive(Clone, Copy)]
pub enum Values<'a> {
    /// Numbers.
    Scalars(&'a dyn Fn(usize) -> f64),
    /// Vectors of 3 components.
    Vectors(&'a dyn Fn(usize) -> [f64; 3]),
    /// Counts and indices.
    Counts(&'a dyn Fn(usize) -> u32),
    /// Whole numbers with a sign.
    Integers(&'a dyn Fn(usize) -> i32),
}

impl Values<'_> {
    fn kind(&self) -> &'static str {
        match self {
            Self::Scalars(_) | Self::Vectors(_) => "Float64",
            Self::Counts(_) => "UInt32",
            Self::Integers(_) => "Int32",
        }
    }

    /// Number of bytes of each value.
    fn bytes(&self) -> u64 {
        match self {
            Self::Scalars(_) => 8,
            Self::Vectors(_) => 24,
            Self::Counts(_) | Self::Integers(_) => 4,
        }
    }

    /// Writes the values of the indices below `count`.
    fn write(&self, out: &mut dyn Write, count: usize) -> io::Result<()> {
        match self {
            Self::Scalars(value) => write_array(out, count, |i| [value(i).to_le_bytes()]),
            Self::Vectors(value) => write_array(out, count, |i| value(i).map(f64::to_le_bytes)),
            Self::Counts(value) => write_array(out, count, |i| [value(i).to_le_bytes()]),
            Self::Integers(value) => write_array(out, count, |i| [value(i).to_le_bytes()]),
        }
    }
}

/// Points, lines of two points each, and the data of both.
pub struct PolyData<'a> {
    /// Number of points.
    pub points: usize,
    /// Position of each point.
    pub place: &'a dyn Fn(usize) -> [f64; 3],
    /// Number of lines.
    pub lines: usize,
    /// The two points of each line.
    pub ends: &'a dyn Fn(usize) -> [u32; 2],
    /// Arrays of the points.
    pub point_data: &'a [NamedArray<'a>],
    /// Arrays of the lines.
    pub cell_data: &'a [NamedArray<'a>],
}

impl PolyData<'_> {
    /// Writes the file. `write_fields` writes the field data, with [`write_number`] and
    /// `write_text`.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(
        &self,
        out: &mut dyn Write,
        write_fields: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let (points, lines) = (self.points, self.lines);
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
        Values::Vectors(self.place).write(out, points)?;
        write_array(out, lines, |line| {
            (self.ends)(line).map(|end| i64::from(end).to_le_bytes())
        })?;
        // The end of each line in the connectivity: 2, 4, 6, ...
        write_array(out, lines, |line| [(2 * (line as i64 + 1)).to_le_bytes()])?;
        for (arrays, count) in [(self.point_data, points), (self.cell_data, lines)] {
            for array in arrays {
                array.values.write(out, count)?;
            }
        }
        writeln!(out, "\n  </AppendedData>\n</VTKFile>")
    }

    /// Declares the arrays in the header, and their offsets in the appended data.
    fn declare(&self, out: &mut dyn Write) -> io::Result<()> {
        let lines = self.lines as u64;
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
            values: Values::Vectors(self.place),
        };
        section("Points", &[Declaration::of(&points, self.points)])?;
        section(
            "Lines",
            &[
                whole("connectivity", 16 * lines),
                whole("offsets", 8 * lines),
            ],
        )?;
        section("PointData", &Declaration::all(self.point_data, self.points))?;
        section("CellData", &Declaration::all(self.cell_data, self.lines))
    }
}

/// The declaration of an array in the header.
struct Declaration<'a> {
    kind: &'static str,
    name: &'a str,
    /// An attribute, if the values are vectors.
    shape: &'static str,
    bytes: u64,
}

impl<'a> Declaration<'a> {
    fn all(arrays: &[NamedArray<'a>], count: usize) -> Vec<Self> {
        arrays.iter().map(|array| Self::of(array, count)).collect()
    }

    fn of(array: &NamedArray<'a>, count: usize) -> Self {
        Self {
            kind: array.values.kind(),
            name: array.name,
            shape: match array.values {
                Values::Vectors(_) => " NumberOfComponents=\"3\"",
                _ => "",
            },
            bytes: array.values.bytes() * count as u64,
        }
    }
}

/// The shortest text that reads back as the same number.
pub fn exact(value: f64) -> String {
    format!("{value:e}")
}

/// A field of one number, unless it is unknown.
pub fn write_number(
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

/// A field of text, unless it is unknown: an array of signed bytes with a zero at its end.
pub(crate) fn write_text(out: &mut dyn Write, name: &str, text: Option<&str>) -> io::Result<()> {
    text.map_or(Ok(()), |text| write_texts(out, name, &[text]))
}

/// A field of texts, unless there are none: each as signed bytes with a zero at its end.
pub(crate) fn write_texts(
    out: &mut dyn Write,
    name: &str,
    texts: &[impl AsRef<str>],
) -> io::Result<()> {
    let count = texts.len();
    if count == 0 {
        return Ok(());
    }
    write!(
        out,
        "      <Array type=\"String\" Name=\"{name}\" NumberOfTuples=\"{count}\" format=\"ascii\">"
    )?;
    for (at, text) in texts.iter().enumerate() {
        for byte in text.as_ref().bytes() {
            write!(out, "{} ", byte.cast_signed())?;
        }
        write!(out, "0{}", if at + 1 < count { " " } else { "" })?;
    }
    writeln!(out, "</Array>")
}

/// Number of values collected before they are written, and the largest number of bytes of each.
const AT_ONCE: usize = 1024;
const MOST_BYTES: usize = 24;

/// One array: its size in bytes, then its values, each of this number of numbers.
fn write_array<const NUMBERS: usize, const BYTES: usize>(
    out: &mut dyn Write,
    count: usize,
    bytes_of: impl Fn(usize) -> [[u8; BYTES]; NUMBERS],
) -> io::Result<()> {
    const { assert!(NUMBERS * BYTES <= MOST_BYTES) };
    let each = NUMBERS * BYTES;
    out.write_all(&((each * count) as u64).to_le_bytes())?;
    let mut bytes = [0_u8; MOST_BYTES * AT_ONCE];
    for first in (0..count).step_by(AT_ONCE) {
        let some = first..(first + AT_ONCE).min(count);
        for (place, i) in bytes.chunks_exact_mut(each).zip(some.clone()) {
            place.copy_from_slice(bytes_of(i).as_flattened());
        }
        out.write_all(&bytes[..each * some.len()])?;
    }
    Ok(())
}
