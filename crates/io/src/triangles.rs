//! Files of triangles -> facets: STL, OBJ, PLY and 3MF. The contents of a file say which it is; its
//! name counts where they do not.

mod obj;
mod other_formats;
mod ply;
mod polygon;
mod three_mf;
pub(crate) mod words;

use crate::diagnostic::{Diagnostic, Result};
use crate::stl::{self, Facets, REMEDY_REPAIR};
use crate::units::significant;
use std::io::{self, Read};
use std::path::Path;

/// The endings of the names of files of triangles, in lower case.
pub const ENDINGS: [&str; 4] = ["stl", "obj", "ply", "3mf"];

/// Largest distance of a corner from the middle of all, over that of the median corner.
const MOST_APART: f64 = 1e9;
/// Units that differ by less than this part are the same.
const SAME_UNIT: f64 = 1e-9;

/// Largest number of bytes of a file that is no file of the disk, and of padding after the last
/// facet of an STL there.
const MOST_STREAM: u64 = 1 << 30;
const MOST_PADDING: u64 = 1 << 20;

/// A format of files of triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Stl,
    Obj,
    Ply,
    ThreeMf,
}

impl Format {
    /// By the ending of a name, in lower case.
    fn by_ending(ending: &str) -> Option<Self> {
        Some(match ending {
            "stl" => Self::Stl,
            "obj" => Self::Obj,
            "ply" => Self::Ply,
            "3mf" => Self::ThreeMf,
            _ => return None,
        })
    }

    /// By the contents. `text` are those without marks of an encoding.
    fn by_contents(bytes: &[u8], text: &[u8]) -> Option<Self> {
        if stl::is_stl(bytes, text) {
            Some(Self::Stl)
        } else if ply::is_ply(bytes) {
            Some(Self::Ply)
        } else if three_mf::is_zip(bytes) {
            Some(Self::ThreeMf)
        } else if obj::is_obj(text) {
            Some(Self::Obj)
        } else {
            None
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Stl => "STL",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::ThreeMf => "3MF",
        }
    }
}

/// Reads the triangles of a file. `name` is that of the file.
///
/// # Errors
/// A file of another format, no facet, missing bytes, a coordinate that is not a finite number, an
/// index of no corner, a polygon that is not flat, or text that does not follow the grammar.
pub(crate) fn read_facets(bytes: &[u8], name: &str) -> Result<Facets> {
    let ending = ending(Path::new(name));
    let by_name = Format::by_ending(&ending);
    if bytes.is_empty() {
        let problem = match by_name.unwrap_or(Format::Stl) {
            vowel @ (Format::Stl | Format::Obj) => {
                format!("not an {}: the file is empty", vowel.name())
            }
            other => format!("not a {}: the file is empty", other.name()),
        };
        return Err(Diagnostic::input("", problem, stl::REMEDY_OTHER));
    }
    let decoded = stl::text_of_utf_16(bytes);
    let text = decoded.as_deref().unwrap_or(bytes);
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let by_contents = Format::by_contents(bytes, text);
    // Archives of other formats begin as a 3MF does.
    let is_sure = by_contents.is_some_and(|format| by_name.is_some() || format != Format::ThreeMf);
    let other = other_formats::refusal(text, &ending);
    if let Some(refusal) = other.filter(|_| !is_sure) {
        return Err(refusal);
    }
    let format = by_contents.or(by_name).unwrap_or(Format::Stl);
    let mut facets = match format {
        Format::Stl => stl::read_facets(bytes, text),
        Format::Obj => obj::read(text),
        Format::Ply => ply::read(bytes),
        Format::ThreeMf => three_mf::read(bytes),
    }?;
    if let Some(named) = by_name.filter(|named| *named != format) {
        facets.warnings.push(format!(
            "The name ends as that of a file of the format {}; the contents are {}, and were read so.",
            named.name(),
            format.name()
        ));
    }
    if facets.corners.is_empty() {
        let problem = format!("the {} contains no triangles", format.name());
        return Err(Diagnostic::input("", problem, "export the shape again"));
    }
    refuse_damaged(&facets.corners)?;
    Ok(facets)
}

/// The bytes of a file that comes through a pipe or a device, which may have no end: reading stops
/// where an STL of that beginning would end, and more bytes are refused.
pub fn read_stream(input: &mut dyn Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    input
        .take(stl::BINARY_START as u64)
        .read_to_end(&mut bytes)?;
    let is_binary =
        !stl::is_text(&bytes) && stl::text_of_utf_16(&bytes).is_none() && !three_mf::is_zip(&bytes);
    let end = match stl::binary_length(&bytes) {
        Some(length) if is_binary => (length as u64 + MOST_PADDING).min(MOST_STREAM),
        _ => MOST_STREAM,
    };
    input
        .take(end + 1 - bytes.len() as u64)
        .read_to_end(&mut bytes)?;
    if bytes.len() as u64 > end {
        return Err(io::Error::other(format!(
            "it goes on after {end} bytes, where its first bytes let it end"
        )));
    }
    Ok(bytes)
}

/// The bytes of a file of triangles; one that is no file of the disk, such as a named pipe, is read
/// as by [`read_stream`].
pub fn read_triangle_file(path: &Path) -> io::Result<Vec<u8>> {
    if std::fs::metadata(path)?.is_file() {
        return std::fs::read(path);
    }
    read_stream(&mut std::fs::File::open(path)?)
}

/// Metres in one unit of a file, times `scale`. The unit is `given`, or else that which the file
/// has. None: there is neither.
///
/// # Errors
/// The two differ, or the product is no positive number.
pub(crate) fn unit_m(facets: &Facets, given: Option<f64>, scale: f64) -> Result<Option<f64>> {
    let (own, unit_m) = (facets.unit_m, given.or(facets.unit_m));
    let scaled_m = unit_m.unwrap_or(1.0) * scale;
    if !(scaled_m > 0.0 && scaled_m.is_finite()) {
        let problem = format!("a unit of the file is {scaled_m} m");
        return Err(Diagnostic::input(
            "",
            problem,
            "give a positive unit and scale",
        ));
    }
    if let (Some(own_m), Some(given_m)) = (own, given)
        && (own_m / given_m - 1.0).abs() > SAME_UNIT
    {
        let problem = format!(
            "a unit of the file is {} m, as it says itself, not {} m",
            significant(own_m, 6),
            significant(given_m, 6)
        );
        let remedy = "leave the unit out; a scale makes the shape larger or smaller";
        return Err(Diagnostic::input("", problem, remedy));
    }
    Ok(unit_m.map(|unit_m| unit_m * scale))
}

/// Whether the name is that of a file of triangles.
pub fn is_named_so(path: &Path) -> bool {
    ENDINGS.contains(&ending(path).as_str())
}

/// The refusal, with advice, of a file with a name of another format of shapes. None: it has none,
/// or that of a body.
pub(crate) fn refusal_by_name(path: &Path) -> Option<Diagnostic> {
    let ending = ending(path);
    other_formats::refusal(b"", &ending).filter(|_| ending != "vtp")
}

/// Whether the name is that of a file that has a unit of its own.
pub fn has_unit_by_name(path: &Path) -> bool {
    ending(path) == "3mf"
}

fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default();
    ending.to_string_lossy().to_ascii_lowercase()
}

/// Refuses a corner so far from all others that these would be a point beside it: a number of the
/// file is damaged.
fn refuse_damaged(corners: &[[[f64; 3]; 3]]) -> Result<()> {
    let median = |mut all: Vec<f64>| {
        let middle = all.len() / 2;
        *all.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    let of_axis = |k: usize| median(corners.iter().flatten().map(|corner| corner[k]).collect());
    let middle = [0, 1, 2].map(of_axis);
    let distance = |corner: &[f64; 3]| {
        let [x, y, z] = [0, 1, 2].map(|k| corner[k] - middle[k]);
        x.hypot(y).hypot(z)
    };
    let usual = median(corners.iter().flatten().map(distance).collect());
    let limit = MOST_APART * usual;
    for (index, facet) in corners.iter().enumerate() {
        let far = facet.iter().position(|corner| distance(corner) > limit);
        if let Some(at) = far.filter(|_| usual > 0.0) {
            let [x, y, z] = facet[at].map(|x| significant(x, 3));
            let problem = format!(
                "corner {} is at ({x}, {y}, {z}), {} times as far from the middle as the others: the number is damaged",
                at + 1,
                significant(distance(&facet[at]) / usual, 2)
            );
            return Err(Diagnostic::input(
                format!("triangle {} of {}", index + 1, corners.len()),
                problem,
                REMEDY_REPAIR,
            ));
        }
    }
    Ok(())
}
