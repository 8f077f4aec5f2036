//! Shapes that sets, walls and regions share.

use std::path::{Path, PathBuf};

use super::field::Field;
use super::read::named_path;
use super::table::Table;
use crate::Result;
use crate::units::{LENGTH, length_unit_m};

/// The smallest and the largest corner of a box `{ min, max }`, m. `holds` for both along each
/// axis; `limit` says in words what min must be to max.
pub(super) fn corners(
    field: &Field<'_>,
    limit: &str,
    holds: impl Fn(f64, f64) -> bool,
) -> Result<[[f64; 3]; 2]> {
    let table = field.table(&["min", "max"])?;
    let min = table.need("min", "[0, 0, 0]")?.vector(&LENGTH)?;
    let upper = table.need("max", "[1, 1, 1]")?;
    let max = upper.vector(&LENGTH)?;
    for (axis, (low, high)) in ["x", "y", "z"].iter().zip(min.into_iter().zip(max)) {
        if !holds(low, high) {
            let problem = format!(
                "{} is {high} m along {axis}, but min is {low} m",
                upper.path
            );
            let remedy = if low > high {
                format!("min must be {limit} max: swap them")
            } else {
                format!("min must be {limit} max: move one of them")
            };
            return Err(upper.refuse(problem, remedy));
        }
    }
    Ok([min, max])
}

/// Centre and radius of a sphere `{ centre, radius }`, m.
pub(super) fn sphere(field: &Field<'_>) -> Result<([f64; 3], f64)> {
    let table = field.table(&["centre", "radius"])?;
    Ok((
        table.need("centre", "[0, 0, 0]")?.vector(&LENGTH)?,
        table.need("radius", "\"5 mm\"")?.positive(&LENGTH)?,
    ))
}

/// Centres of the ends, which differ, and radius of a cylinder `{ from, to, radius }`, m.
pub(super) fn cylinder(field: &Field<'_>) -> Result<([[f64; 3]; 2], f64)> {
    let table = field.table(&["from", "to", "radius"])?;
    let from_m = table.need("from", "[0, 0, 0]")?.vector(&LENGTH)?;
    let end = table.need("to", "[0, 0, \"10 mm\"]")?;
    let to_m = end.vector(&LENGTH)?;
    if from_m == to_m {
        let [x, y, z] = to_m;
        let problem = format!("{} is [{x}, {y}, {z}] m, where from is", end.path);
        return Err(end.refuse(problem, "a cylinder needs a length: move one of them"));
    }
    let radius_m = table.need("radius", "\"5 mm\"")?.positive(&LENGTH)?;
    Ok(([from_m, to_m], radius_m))
}

/// The file of triangles that `field`, a key of `table`, names, and the size of the file's `unit`,
/// m.
pub(super) fn stl(field: &Field<'_>, table: &Table<'_>, folder: &Path) -> Result<(PathBuf, f64)> {
    let path = named_path(field, folder)?;
    if path.as_os_str() == "-" {
        return Err(field.wrong("a file", "write a name such as \"plate.stl\""));
    }
    let unit = table.need("unit", "\"mm\", the file's unit of length")?;
    let Ok(name) = unit.text() else {
        return Err(unit.wrong("a unit of length", "write its name, such as \"mm\""));
    };
    let unit_m = length_unit_m(name).map_err(|error| {
        let problem = format!("{}: {}", unit.path, error.problem);
        unit.refuse(problem, error.remedy)
    })?;
    Ok((path, unit_m))
}

/// Refuses `keys`, which act on `stl`, where the shape is `key`.
pub(super) fn refuse_without_stl(
    table: &Table<'_>,
    keys: &[&'static str],
    key: &str,
) -> Result<()> {
    match table.given(keys).next() {
        Some((_, of_stl)) if key != "stl" => {
            let problem = format!("{} stands without stl, on which it acts", of_stl.path);
            Err(of_stl.refuse(problem, format!("remove it: lengths of a {key} have units")))
        }
        _ => Ok(()),
    }
}
