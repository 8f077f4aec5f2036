//! What contacts have done to the patches of walls: `wall_loads.csv`, a row for each patch, and
//! `wall_loads.vtp`, the patches with the same columns for ParaView, where the walls stood at the
//! start; `frames/loads_000123.vtp`, some of the columns at the time of a frame, where the walls
//! stand then.

use std::io::{self, Write};
use std::path::Path;

use dem_io::body::stored_frame::TIME;
use dem_io::diagnostic::Result;
use dem_io::safe_write::write_file;
use dem_io::text::exact;
use dem_io::vtk::{Cells, NamedArray, PolyData, Values, write_number, write_texts};
use dem_physics::contact::patch_book::PatchBook;
use dem_physics::geometry::patches::Patch;

use super::growing::field;
use dem_io::body::stored_walls::{WALL, WALL_NAMES};

/// A patch of a wall and what contacts have done to it.
#[derive(Debug, Clone, PartialEq)]
pub struct WallPatch {
    /// Number of its wall among the names.
    pub wall: u32,
    /// In space.
    pub patch: Patch,
    /// Its sums; impulses along axes in space.
    pub book: PatchBook,
    /// Volume worn off, m3.
    pub wear_m3: f64,
}

/// A column with its unit, and its value for a patch.
type Quantity = (&'static str, fn(&WallPatch) -> f64);

/// All columns but the name of the wall.
const QUANTITIES: [Quantity; 18] = [
    ("x_m", |one| one.patch.centre_m[0]),
    ("y_m", |one| one.patch.centre_m[1]),
    ("z_m", |one| one.patch.centre_m[2]),
    ("normal_x", |one| one.patch.normal[0]),
    ("normal_y", |one| one.patch.normal[1]),
    ("normal_z", |one| one.patch.normal[2]),
    ("area_m2", |one| one.patch.area_m2),
    ("impulse_x_n_s", |one| one.book.impulse_n_s[0]),
    ("impulse_y_n_s", |one| one.book.impulse_n_s[1]),
    ("impulse_z_n_s", |one| one.book.impulse_n_s[2]),
    ("normal_impulse_n_s", |one| one.book.normal_impulse_n_s),
    ("tangential_impulse_n_s", |one| {
        one.book.tangential_impulse_n_s
    }),
    ("impact_j", |one| one.book.impact_j),
    ("friction_j", |one| one.book.friction_j),
    ("damping_j", |one| one.book.damping_j),
    ("sliding_load_n_m", |one| one.book.sliding_load_n_m),
    ("wear_volume_m3", |one| one.wear_m3),
    ("wear_depth_m", |one| one.wear_m3 / one.patch.area_m2),
];

/// Columns beside a frame.
const FRAME_COLUMNS: [&str; 6] = [
    "area_m2",
    "normal_impulse_n_s",
    "impact_j",
    "friction_j",
    "damping_j",
    "wear_depth_m",
];

/// Writes the table of the patches of walls with these names.
///
/// # Errors
/// The file cannot be written.
pub fn write_wall_loads(path: &Path, names: &[String], patches: &[WallPatch]) -> Result<()> {
    write_file(path, |out| {
        let columns: Vec<&str> = QUANTITIES.iter().map(|(name, _)| *name).collect();
        writeln!(out, "wall,{}", columns.join(","))?;
        for one in patches {
            write!(out, "{}", field(&names[one.wall as usize]))?;
            for (_, value) in QUANTITIES {
                // Adding 0 removes the sign of a zero.
                write!(out, ",{}", exact(value(one) + 0.0))?;
            }
            writeln!(out)?;
        }
        Ok(())
    })
}

/// Writes the same patches as triangles for ParaView.
///
/// # Errors
/// The file cannot be written.
pub fn write_wall_load_cells(path: &Path, names: &[String], patches: &[WallPatch]) -> Result<()> {
    write_file(path, |out| {
        write_cells(out, patches, &QUANTITIES, |out| {
            write_texts(out, WALL_NAMES, names)
        })
    })
}

/// Writes the columns of [`FRAME_COLUMNS`] of the patches at this time, s.
pub(crate) fn write_frame_loads(
    out: &mut dyn Write,
    names: &[String],
    patches: &[WallPatch],
    time_s: f64,
) -> io::Result<()> {
    let mut some = QUANTITIES.to_vec();
    some.retain(|(name, _)| FRAME_COLUMNS.contains(name));
    write_cells(out, patches, &some, |out| {
        write_number(out, "Float64", TIME, Some(exact(time_s)))?;
        write_texts(out, WALL_NAMES, names)
    })
}

fn write_cells(
    out: &mut dyn Write,
    patches: &[WallPatch],
    quantities: &[Quantity],
    fields: impl Fn(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut points_m: Vec<[f64; 3]> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let mut patch_of: Vec<usize> = Vec::new();
    for (number, one) in patches.iter().enumerate() {
        let (first, corners) = (points_m.len() as u32, &one.patch.corners_m);
        points_m.extend(corners);
        let others = 1..(corners.len() as u32).saturating_sub(1);
        triangles.extend(others.map(|k| [first, first + k, first + k + 1]));
        patch_of.resize(triangles.len(), number);
    }
    let wall = |i: usize| patches[patch_of[i]].wall;
    let values = quantities.iter().map(|(_, value)| {
        let patch_of = &patch_of;
        move |i: usize| value(&patches[patch_of[i]])
    });
    let values: Vec<_> = values.collect();
    let mut cell_data = vec![NamedArray {
        name: WALL,
        values: Values::Counts(&wall),
    }];
    for ((name, _), value) in quantities.iter().zip(&values) {
        let values = Values::Scalars(value);
        cell_data.push(NamedArray { name, values });
    }
    PolyData {
        points: points_m.len(),
        place: Values::Vectors(&|i| points_m[i]),
        cells: Cells::Triangles(triangles.len(), &|i| triangles[i]),
        point_data: &[],
        cell_data: &cell_data,
    }
    .write(out, fields)
}
