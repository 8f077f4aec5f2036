//! The arrays of a frame, read by their names: the header that this program writes as text, and
//! after it the numbers.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use dem_io::diagnostic::{Diagnostic, Result};

/// Largest length of a line of the header. Lines hold one element each.
const LONGEST_LINE: u64 = 1 << 20;

/// Some arrays of a frame, all as numbers of 64 bits, in SI units.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Arrays {
    /// Number of points.
    pub points: usize,
    /// Number of lines.
    pub lines: usize,
    /// Simulated time, s. None: the file gives none.
    pub time_s: Option<f64>,
    named: BTreeMap<String, Array>,
    texts: BTreeMap<String, Vec<String>>,
}

/// An array of a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Array {
    /// Its numbers, those of each point or line after the other.
    pub values: Vec<f64>,
    /// Numbers of each point or line: 1, or 3 for vectors.
    pub components: usize,
    /// True if the file holds them as whole numbers: counts, indices, flags.
    pub is_whole: bool,
}

impl Arrays {
    /// The values of an array, three for each vector. Names are `PointData/radius_m`,
    /// `CellData/broken`, `Points/positions_m`, `Lines/connectivity`. None: it was not asked for,
    /// or the file does not have it.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        self.named.get(name).map(|array| array.values.as_slice())
    }

    /// All arrays that were read, by their names.
    pub fn named(&self) -> &BTreeMap<String, Array> {
        &self.named
    }

    /// The texts of a field, such as the names of bodies. Empty: the file does not have it.
    pub fn texts(&self, name: &str) -> &[String] {
        self.texts.get(name).map_or(&[], Vec::as_slice)
    }
}

/// An array that the header declares.
struct Declared {
    name: String,
    kind: String,
    components: usize,
    offset: u64,
}

/// Reads those arrays of a frame or of its walls that are named in `wanted`, as in [`Arrays::get`];
/// refuses files that this program did not write.
pub fn read_arrays(path: &Path, wanted: &[&str]) -> Result<Arrays> {
    open_and_read(path, &|name| wanted.contains(&name))
}

/// Reads all arrays of a frame or of its walls.
pub fn read_all_arrays(path: &Path) -> Result<Arrays> {
    open_and_read(path, &|_| true)
}

fn open_and_read(path: &Path, is_wanted: &dyn Fn(&str) -> bool) -> Result<Arrays> {
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    let file = File::open(path).map_err(|error| {
        within(Diagnostic::input(
            "",
            format!("cannot be opened: {error}"),
            "",
        ))
    })?;
    let mut input = BufReader::with_capacity(1 << 16, file);
    read(&mut input, is_wanted).map_err(within)
}

fn read<R: Read + Seek>(
    input: &mut BufReader<R>,
    is_wanted: &dyn Fn(&str) -> bool,
) -> Result<Arrays> {
    let mut arrays = Arrays::default();
    let mut declared = Vec::new();
    let mut section = String::new();
    let mut line = String::new();
    loop {
        line.clear();
        let read = input.take(LONGEST_LINE).read_line(&mut line);
        if read.map_err(|error| damaged(&error.to_string()))? == 0 {
            return Err(damaged("it ends within its header"));
        }
        let element = line.trim_start();
        if element.starts_with("<AppendedData") {
            break;
        }
        if element.starts_with("<Piece") {
            let count = |name| attribute(element, name).and_then(|text| text.parse().ok());
            let points = count("NumberOfPoints");
            arrays.points = points.ok_or_else(|| damaged("it has no number of points"))?;
            arrays.lines = count("NumberOfLines").unwrap_or(0);
        } else if let Some(name) = opened(element) {
            name.clone_into(&mut section);
        }
        if attribute(element, "Name") == Some("TimeValue") {
            arrays.time_s = field_text(element).and_then(|text| text.parse().ok());
        }
        if let Some((name, texts)) = field_texts(element) {
            arrays.texts.insert(name, texts);
        }
        declared.extend(declaration(element, &section));
    }
    let start = data_start(input)?;
    for array in declared {
        if is_wanted(&array.name) {
            let values = values(input, start, &array).map_err(|error| error.within(&array.name))?;
            let read = Array {
                values,
                components: array.components,
                is_whole: !array.kind.starts_with("Float"),
            };
            arrays.named.insert(array.name, read);
        }
    }
    Ok(arrays)
}

/// The name of a section that opens here.
fn opened(element: &str) -> Option<&str> {
    let name = element.strip_prefix('<')?.trim_end().strip_suffix('>')?;
    let sections = ["Points", "Lines", "Polys", "PointData", "CellData"];
    sections.contains(&name).then_some(name)
}

/// An array in the data after the header.
fn declaration(element: &str, section: &str) -> Option<Declared> {
    let element = element.strip_prefix("<DataArray")?;
    let offset = attribute(element, "offset")?.parse().ok()?;
    let name = attribute(element, "Name")?;
    Some(Declared {
        // There is one array of positions, whatever its name.
        name: match section {
            "Points" => "Points/positions_m".to_owned(),
            _ => format!("{section}/{name}"),
        },
        kind: attribute(element, "type")?.to_owned(),
        components: attribute(element, "NumberOfComponents")
            .and_then(|text| text.parse().ok())
            .unwrap_or(1),
        offset,
    })
}

/// The values of a field, which stand in the header between tags.
fn field_text(element: &str) -> Option<&str> {
    let text = element.split_once('>')?.1;
    text.split('<').next().map(str::trim)
}

/// The name of a field of texts, and its texts: bytes with a zero at the end of each.
fn field_texts(element: &str) -> Option<(String, Vec<String>)> {
    let field = element.strip_prefix("<Array type=\"String\"")?;
    let bytes = field_text(element)?.split_whitespace();
    let bytes: Option<Vec<u8>> = bytes
        .map(|byte| byte.parse::<i16>().ok().map(|byte| byte as u8))
        .collect();
    let bytes = bytes?;
    let whole = bytes.strip_suffix(&[0]).unwrap_or(&bytes);
    let texts = whole.split(|byte| *byte == 0);
    let texts = texts.map(|text| String::from_utf8_lossy(text).into_owned());
    Some((attribute(field, "Name")?.to_owned(), texts.collect()))
}

fn attribute<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let start = element.find(&format!(" {name}=\""))? + name.len() + 3;
    element[start..].split('"').next()
}

/// The place behind the underscore before the data.
fn data_start<R: Read + Seek>(input: &mut BufReader<R>) -> Result<u64> {
    let mut skipped = Vec::new();
    let read = input.take(64).read_until(b'_', &mut skipped);
    if read.is_err() || skipped.last() != Some(&b'_') {
        return Err(damaged("it has no data behind its header"));
    }
    input
        .stream_position()
        .map_err(|error| damaged(&error.to_string()))
}

fn values<R: Read + Seek>(
    input: &mut BufReader<R>,
    start: u64,
    array: &Declared,
) -> Result<Vec<f64>> {
    let fail = |error: std::io::Error| damaged(&error.to_string());
    let place = start.checked_add(array.offset);
    let place = place.ok_or_else(|| damaged("its offset is too large"))?;
    input.seek(SeekFrom::Start(place)).map_err(fail)?;
    let mut size = [0; 8];
    input.read_exact(&mut size).map_err(fail)?;
    let mut bytes = Vec::new();
    let size = u64::from_le_bytes(size);
    if input.take(size).read_to_end(&mut bytes).map_err(fail)? as u64 != size {
        return Err(damaged("it ends within this array"));
    }
    match array.kind.as_str() {
        "Float64" => Ok(numbers(&bytes, f64::from_le_bytes)),
        "Float32" => Ok(numbers(&bytes, |b| f64::from(f32::from_le_bytes(b)))),
        "Int64" => Ok(numbers(&bytes, |b| i64::from_le_bytes(b) as f64)),
        "UInt64" => Ok(numbers(&bytes, |b| u64::from_le_bytes(b) as f64)),
        "Int32" => Ok(numbers(&bytes, |b| f64::from(i32::from_le_bytes(b)))),
        "UInt32" => Ok(numbers(&bytes, |b| f64::from(u32::from_le_bytes(b)))),
        "UInt8" => Ok(numbers(&bytes, |[b]| f64::from(b))),
        other => Err(damaged(&format!("its numbers are of the type '{other}'"))),
    }
}

fn numbers<const SIZE: usize>(bytes: &[u8], number: impl Fn([u8; SIZE]) -> f64) -> Vec<f64> {
    let (whole, _) = bytes.as_chunks::<SIZE>();
    whole.iter().map(|bytes| number(*bytes)).collect()
}

fn damaged(problem: &str) -> Diagnostic {
    Diagnostic::input(
        "",
        format!("this is not a frame of a run: {problem}"),
        "only files that dem-run wrote are read here",
    )
}
