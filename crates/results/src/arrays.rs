//! The arrays of a frame, read by their names.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use dem_io::body::stored_frame::{BODY_NAMES, TIME};
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::open_input;
pub use dem_io::vtp::Array;
use dem_io::vtp::{Reader, Shape};

/// Largest number of bytes of the names of all bodies.
const MOST_BYTES_OF_NAMES: u64 = 1 << 20;

/// Some arrays of a frame, all as numbers of 64 bits, in SI units.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Arrays {
    /// Number of points.
    pub points: usize,
    /// Number of lines.
    pub lines: usize,
    /// Simulated time, s. None: the file gives none.
    pub time_s: Option<f64>,
    /// Names of the bodies. Empty: the file gives none.
    pub body_names: Vec<String>,
    named: BTreeMap<String, Array>,
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
    read(open_input(path)?, is_wanted).map_err(within)
}

fn read(mut input: BufReader<File>, is_wanted: &dyn Fn(&str) -> bool) -> Result<Arrays> {
    let shape = |section: &str, name: &str| match section {
        "FieldData" if [TIME, BODY_NAMES].contains(&name) => {
            Some(Shape::Field(MOST_BYTES_OF_NAMES))
        }
        // There is one array of positions, whatever its name.
        "Points" => is_wanted("Points/positions_m").then_some(Shape::Any),
        "Lines" | "Polys" | "PointData" | "CellData" => {
            is_wanted(&format!("{section}/{name}")).then_some(Shape::Any)
        }
        _ => None,
    };
    let file = Reader::open(&mut input, &shape)?.read_used()?;
    let counts = file.counts();
    Ok(Arrays {
        points: counts.points as usize,
        lines: counts.lines as usize,
        time_s: file.float(TIME),
        body_names: file.texts(BODY_NAMES)?,
        named: file.into_named(),
    })
}
