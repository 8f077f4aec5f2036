//! Writing of VTK XML PolyData (.vtp), shared by the files of bodies and the frames of a run.
//!
//! The header is text. The arrays follow it as binary numbers (appended raw, little endian), so
//! that nothing is lost. Each value is computed when it is written, so that no array is held in
//! memory, and there is one value for every point or cell. Points are particles and cells lines of
//! two points, their bonds; or cells are the triangles of walls. There are no vertex cells: cell
//! data would have to include them. Connectivity and offsets are signed: ParaView refuses unsigned
//! ones.
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
    /// One value for each point or cell.
    pub values: Values<'a>,
}

/// The values of an array: a number, a vector or small numbers for each point or cell, found by its
/// index.
#[derive(Clone, Copy)]
pub enum Values<'a> {
    /// Numbers.
    Scalars(&'a dyn Fn(usize) -> f64),
    /// Vectors of 3 components.
    Vectors(&'a dyn Fn(usize) -> [f64; 3]),
    /// Vectors of 3 components in single precision.
    SingleVectors(&'a dyn Fn(usize) -> [f32; 3]),
    /// Counts and indices.
    Counts(&'a dyn Fn(usize) -> u32),
    /// Whole numbers with a sign.
    Integers(&'a dyn Fn(usize) -> i32),
    /// This many zeros and ones each, those of each index after those of the one before.
    Flags(usize, &'a [f64]),
    /// This many numbers each, in the same order.
    Tuples(usize, &'a [f64]),
}

impl Values<'_> {
    fn kind(&self) -> &'static str {
        match self {
            Self::Scalars(_) | Self::Vectors(_) | Self::Tuples(..) => "Float64",
            Self::SingleVectors(_) => "Float32",
            Self::Counts(_) => "UInt32",
            Self::Integers(_) => "Int32",
            Self::Flags(..) => "UInt8",
        }
    }

    /// Number of bytes of each value.
    fn bytes(&self) -> u64 {
        match self {
            Self::Scalars(_) => 8,
            Self::Vectors(_) => 24,
            Self::SingleVectors(_) => 12,
            Self::Counts(_) | Self::Integers(_) => 4,
            Self::Flags(count, _) => *count as u64,
            Self::Tuples(count, _) => 8 * *count as u64,
        }
    }

    /// Writes the values of the indices below `count`.
    fn write(&self, out: &mut dyn Write, count: usize) -> io::Result<()> {
        match self {
            Self::Scalars(value) => write_array(out, count, |i| [value(i).to_le_bytes()]),
            Self::Vectors(value) => write_array(out, count, |i| value(i).map(f64::to_le_bytes)),
            Self::SingleVectors(value) => {
                write_array(out, count, |i| value(i).map(f32::to_le_bytes))
            }
            Self::Counts(value) => write_array(out, count, |i| [value(i).to_le_bytes()]),
            Self::Integers(value) => write_array(out, count, |i| [value(i).to_le_bytes()]),
            Self::Flags(components, values) => {
                write_array(out, components * count, |i| [[u8::from(values[i] != 0.0)]])
            }
            Self::Tuples(components, values) => {
                write_array(out, components * count, |i| [values[i].to_le_bytes()])
            }
        }
    }
}

/// Cells of a file, all of one kind, found by their index.
#[derive(Clone, Copy)]
pub enum Cells<'a> {
    /// Lines: their number, and the two points of each.
    Lines(usize, &'a dyn Fn(usize) -> [u32; 2]),
    /// Triangles: their number, and the three points of each.
    Triangles(usize, &'a dyn Fn(usize) -> [u32; 3]),
}

impl Cells<'_> {
    fn count(&self) -> usize {
        match self {
            Self::Lines(count, _) | Self::Triangles(count, _) => *count,
        }
    }

    /// Name of their section, type of their numbers, and its bytes. Triangles of a wall are written
    /// again in each frame: their points are few enough for small numbers.
    fn section(&self) -> (&'static str, &'static str, u64) {
        match self {
            Self::Lines(..) => ("Lines", "Int64", 8),
            Self::Triangles(..) => ("Polys", "Int32", 4),
        }
    }

    /// Number of points of each.
    fn corners(&self) -> u64 {
        match self {
            Self::Lines(..) => 2,
            Self::Triangles(..) => 3,
        }
    }

    /// Writes the points of the cells, and where each cell ends among them: 2, 4, 6, ...
    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        match self {
            Self::Lines(count, points) => {
                write_array(out, *count, |line| {
                    points(line).map(|point| i64::from(point).to_le_bytes())
                })?;
                write_array(out, *count, |line| [(2 * (line as i64 + 1)).to_le_bytes()])
            }
            Self::Triangles(count, points) => {
                write_array(out, *count, |triangle| {
                    points(triangle).map(|point| point.cast_signed().to_le_bytes())
                })?;
                write_array(out, *count, |triangle| {
                    [(3 * (triangle as i32 + 1)).to_le_bytes()]
                })
            }
        }
    }
}

/// Points, cells, and the data of both.
pub struct PolyData<'a> {
    /// Number of points.
    pub points: usize,
    /// Position of each point, m: vectors.
    pub place: Values<'a>,
    /// Lines or triangles between the points.
    pub cells: Cells<'a>,
    /// Arrays of the points.
    pub point_data: &'a [NamedArray<'a>],
    /// Arrays of the cells.
    pub cell_data: &'a [NamedArray<'a>],
}

impl PolyData<'_> {
    /// Writes the file. `write_fields` writes the field data, with [`write_number`] and
    /// `write_text`.
    pub fn write(
        &self,
        out: &mut dyn Write,
        write_fields: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let (points, cells) = (self.points, self.cells.count());
        let (section, ..) = self.cells.section();
        writeln!(out, "<?xml version=\"1.0\"?>")?;
        let header = "byte_order=\"LittleEndian\" header_type=\"UInt64\"";
        writeln!(
            out,
            "<VTKFile type=\"PolyData\" version=\"1.0\" {header}>\n  <PolyData>\n    <FieldData>"
        )?;
        write_fields(out)?;
        writeln!(out, "    </FieldData>")?;
        let other = match self.cells {
            Cells::Lines(..) => "Polys",
            Cells::Triangles(..) => "Lines",
        };
        let none = format!("NumberOfVerts=\"0\" NumberOfStrips=\"0\" NumberOf{other}=\"0\"");
        writeln!(
            out,
            "    <Piece NumberOfPoints=\"{points}\" NumberOf{section}=\"{cells}\" {none}>"
        )?;
        self.declare(out)?;
        write!(
            out,
            "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_"
        )?;
        self.place.write(out, points)?;
        self.cells.write(out)?;
        for (arrays, count) in [(self.point_data, points), (self.cell_data, cells)] {
            for array in arrays {
                array.values.write(out, count)?;
            }
        }
        writeln!(out, "\n  </AppendedData>\n</VTKFile>")
    }

    /// Declares the arrays in the header, and their offsets in the appended data.
    fn declare(&self, out: &mut dyn Write) -> io::Result<()> {
        let cells = self.cells.count() as u64;
        let (cell_section, kind, bytes) = self.cells.section();
        let mut end = 0;
        let mut section = |name: &str, arrays: &[Declaration]| {
            writeln!(out, "      <{name}>")?;
            for array in arrays {
                let (kind, shape) = (array.kind, &array.shape);
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
            kind,
            name,
            shape: String::new(),
            bytes,
        };
        let points = NamedArray {
            name: "Points",
            values: self.place,
        };
        section("Points", &[Declaration::of(&points, self.points)])?;
        section(
            cell_section,
            &[
                whole("connectivity", self.cells.corners() * bytes * cells),
                whole("offsets", bytes * cells),
            ],
        )?;
        section("PointData", &Declaration::all(self.point_data, self.points))?;
        section(
            "CellData",
            &Declaration::all(self.cell_data, self.cells.count()),
        )
    }
}

/// The declaration of an array in the header.
struct Declaration<'a> {
    kind: &'static str,
    name: &'a str,
    /// An attribute, if the values are vectors.
    shape: String,
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
                Values::Vectors(_) | Values::SingleVectors(_) => components(3),
                Values::Tuples(1, _) => String::new(),
                Values::Flags(count, _) | Values::Tuples(count, _) => components(count),
                _ => String::new(),
            },
            bytes: array.values.bytes() * count as u64,
        }
    }
}

fn components(count: usize) -> String {
    format!(" NumberOfComponents=\"{count}\"")
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

/// A field of vectors of 3 components, unless there are none.
pub fn write_vectors(out: &mut dyn Write, name: &str, vectors: &[[f64; 3]]) -> io::Result<()> {
    let count = vectors.len();
    if count == 0 {
        return Ok(());
    }
    let values: Vec<String> = vectors.as_flattened().iter().map(|x| exact(*x)).collect();
    let values = values.join(" ");
    writeln!(
        out,
        "      <DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"3\" NumberOfTuples=\"{count}\" format=\"ascii\">{values}</DataArray>"
    )
}

/// A field of text, unless it is unknown: an array of signed bytes with a zero at its end.
pub fn write_text(out: &mut dyn Write, name: &str, text: Option<&str>) -> io::Result<()> {
    text.map_or(Ok(()), |text| write_texts(out, name, &[text]))
}

/// A field of texts, unless there are none: each as signed bytes with a zero at its end.
pub fn write_texts(out: &mut dyn Write, name: &str, texts: &[impl AsRef<str>]) -> io::Result<()> {
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
