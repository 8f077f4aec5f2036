//! Shapes shared by groups, walls and regions.

use std::path::{Path, PathBuf};

use super::field::Field;
use super::listing::Listing;
use super::numbers::quantity;
use super::paths::named_path;
use super::plain_table::plain_table;
use super::schema::{Key, Kind, words_of};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::triangles::has_unit_by_name;
use dem_io::units::{LENGTH, length_unit_m};

plain_table! {
    BOX = "Box";
    /// A box along the axes.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct BoxShape {
        /// Smallest corner.
        min_m: [f64; 3] = new("min", Kind::Vector(&LENGTH)).required("[0, 0, 0]");
        /// Largest corner.
        max_m: [f64; 3] = new("max", Kind::Vector(&LENGTH)).required("[1, 1, 1]");
    }
}

plain_table! {
    SPHERE = "Sphere";
    /// A sphere.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct SphereShape {
        /// Its centre.
        centre_m: [f64; 3] = new("centre", Kind::Vector(&LENGTH)).required("[0, 0, 0]");
        /// Its radius.
        radius_m: f64 = quantity("radius", &LENGTH).positive().required("\"5 mm\"");
    }
}

plain_table! {
    CYLINDER = "Cylinder";
    /// A solid cylinder.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct CylinderShape {
        /// Centre of one end.
        from_m: [f64; 3] = new("from", Kind::Vector(&LENGTH)).required("[0, 0, 0]");
        /// Centre of the other end, different from `from`.
        to_m: [f64; 3] = new("to", Kind::Vector(&LENGTH)).required("[0, 0, \"10 mm\"]");
        /// Its radius.
        radius_m: f64 = quantity("radius", &LENGTH).positive().required("\"5 mm\"");
    }
}

/// The key `unit`, for `stl`.
pub(super) const UNIT: Key = Key::new(
    "unit",
    Kind::Either(&[
        Kind::Word(|| words_of(LENGTH.units)),
        Kind::Text("a unit of length"),
    ]),
    "Unit of length of the file; required with `stl`, but for a 3MF, which has its own.",
)
.sometimes_required("\"mm\", the file's unit of length");

/// A box whose corners satisfy `holds` along each axis; `limit` is the text of that.
pub(super) fn read_box(
    field: &Field<'_>,
    limit: &str,
    holds: impl Fn(f64, f64) -> bool,
) -> Result<BoxShape> {
    let table = Table::of(field, &BOX)?;
    let corners = BoxShape::read(&table)?;
    let upper = table.need("max")?;
    for (k, axis) in ["x", "y", "z"].iter().enumerate() {
        let (low, high) = (corners.min_m[k], corners.max_m[k]);
        if !holds(low, high) {
            let problem = format!("is {high} m along {axis}, but min is {low} m");
            let remedy = if low > high {
                format!("min must be {limit} max: swap them")
            } else {
                format!("min must be {limit} max: move one of them")
            };
            return Err(upper.fault(problem, remedy));
        }
    }
    Ok(corners)
}

pub(super) fn read_sphere(field: &Field<'_>) -> Result<SphereShape> {
    SphereShape::read(&Table::of(field, &SPHERE)?)
}

/// A cylinder, whose ends differ.
pub(super) fn read_cylinder(field: &Field<'_>) -> Result<CylinderShape> {
    let table = Table::of(field, &CYLINDER)?;
    let [from_m, to_m]: [[f64; 3]; 2] = [table.read("from")?, table.read("to")?];
    let end = table.need("to")?;
    if from_m == to_m {
        let [x, y, z] = to_m;
        let problem = format!("is [{x}, {y}, {z}] m, where from is");
        return Err(end.fault(problem, "a cylinder needs a length: move one of them"));
    }
    CylinderShape::read(&table)
}

/// The file of triangles named by `field`, a key of `table`, and the size of the file's `unit`, m,
/// which a 3MF need not have here.
pub(super) fn stl(
    field: &Field<'_>,
    table: &Table<'_>,
    folder: &Path,
) -> Result<(PathBuf, Option<f64>)> {
    let path = named_path(field, folder)?;
    if path.as_os_str() == "-" {
        return Err(field.wrong("a file", "write a name such as \"plate.stl\""));
    }
    if has_unit_by_name(&path) && table.get("unit").is_none() {
        return Ok((path, None));
    }
    let unit = table.need("unit")?;
    let Ok(name) = unit.text() else {
        return Err(unit.wrong("a unit of length", "write its name, such as \"mm\""));
    };
    let unit_m = length_unit_m(name).map_err(|error| {
        let problem = format!("{}: {}", unit.path, error.problem);
        unit.refuse(problem, error.remedy)
    })?;
    Ok((path, Some(unit_m)))
}

/// Refuses `keys`, which apply to `stl`, if the shape is `key`.
pub(super) fn refuse_without_stl(
    table: &Table<'_>,
    keys: &[&'static str],
    key: &str,
) -> Result<()> {
    match table.given(keys).next() {
        Some((_, of_stl)) if key != "stl" => {
            let problem = "has no effect without stl";
            Err(of_stl.fault(problem, format!("remove it: lengths of a {key} have units")))
        }
        _ => Ok(()),
    }
}

pub(super) fn list_stl(file: &Path, unit_m: Option<f64>, listing: &mut Listing) {
    listing.text("stl", file.display().to_string());
    let unit = unit_m.map_or("that of the file".to_owned(), |unit_m| {
        quantity(unit_m, "m")
    });
    listing.text("unit", unit);
}
