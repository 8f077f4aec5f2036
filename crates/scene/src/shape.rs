//! Shapes shared by groups, walls and regions.

use std::path::{Path, PathBuf};

use super::field::Field;
use super::listing::Listing;
use super::numbers::quantity;
use super::paths::named_path;
use super::schema::{Key, Kind, Schema, words_of};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{LENGTH, LENGTH_UNITS, length_unit_m};

pub(super) static BOX: Schema = Schema {
    title: "Box",
    doc: "A box along the axes.",
    keys: &[
        Key::new("min", Kind::Vector(&LENGTH), "Smallest corner.").required("[0, 0, 0]"),
        Key::new("max", Kind::Vector(&LENGTH), "Largest corner.").required("[1, 1, 1]"),
    ],
};

pub(super) static SPHERE: Schema = Schema {
    title: "Sphere",
    doc: "A sphere.",
    keys: &[
        Key::new("centre", Kind::Vector(&LENGTH), "Its centre.").required("[0, 0, 0]"),
        Key::quantity("radius", &LENGTH, "Its radius.")
            .positive()
            .required("\"5 mm\""),
    ],
};

pub(super) static CYLINDER: Schema = Schema {
    title: "Cylinder",
    doc: "A solid cylinder.",
    keys: &[
        Key::new("from", Kind::Vector(&LENGTH), "Centre of one end.").required("[0, 0, 0]"),
        Key::new(
            "to",
            Kind::Vector(&LENGTH),
            "Centre of the other end, different from `from`.",
        )
        .required("[0, 0, \"10 mm\"]"),
        Key::quantity("radius", &LENGTH, "Its radius.")
            .positive()
            .required("\"5 mm\""),
    ],
};

/// The key `unit`, for `stl`.
pub(super) const UNIT: Key = Key::new(
    "unit",
    Kind::Either(&[
        Kind::Word(|| words_of(&LENGTH_UNITS)),
        Kind::Text("a unit of length"),
    ]),
    "Unit of length of the STL file; required with `stl`.",
)
.sometimes_required("\"mm\", the file's unit of length");

/// The smallest and the largest corner of a box `{ min, max }`, m. `holds` is the condition for
/// both along each axis; `limit` is its text.
pub(super) fn corners(
    field: &Field<'_>,
    limit: &str,
    holds: impl Fn(f64, f64) -> bool,
) -> Result<[[f64; 3]; 2]> {
    let table = Table::of(field, &BOX)?;
    let min: [f64; 3] = table.read("min")?;
    let max: [f64; 3] = table.read("max")?;
    let upper = table.need("max")?;
    for (axis, (low, high)) in ["x", "y", "z"].iter().zip(min.into_iter().zip(max)) {
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
    Ok([min, max])
}

/// Centre and radius of a sphere `{ centre, radius }`, m.
pub(super) fn sphere(field: &Field<'_>) -> Result<([f64; 3], f64)> {
    let table = Table::of(field, &SPHERE)?;
    Ok((table.read("centre")?, table.read("radius")?))
}

/// Centres of the ends, which differ, and radius of a cylinder `{ from, to, radius }`, m.
pub(super) fn cylinder(field: &Field<'_>) -> Result<([[f64; 3]; 2], f64)> {
    let table = Table::of(field, &CYLINDER)?;
    let from_m: [f64; 3] = table.read("from")?;
    let to_m: [f64; 3] = table.read("to")?;
    let end = table.need("to")?;
    if from_m == to_m {
        let [x, y, z] = to_m;
        let problem = format!("is [{x}, {y}, {z}] m, where from is");
        return Err(end.fault(problem, "a cylinder needs a length: move one of them"));
    }
    Ok(([from_m, to_m], table.read("radius")?))
}

/// The file of triangles named by `field`, a key of `table`, and the size of the file's `unit`, m.
pub(super) fn stl(field: &Field<'_>, table: &Table<'_>, folder: &Path) -> Result<(PathBuf, f64)> {
    let path = named_path(field, folder)?;
    if path.as_os_str() == "-" {
        return Err(field.wrong("a file", "write a name such as \"plate.stl\""));
    }
    let unit = table.need("unit")?;
    let Ok(name) = unit.text() else {
        return Err(unit.wrong("a unit of length", "write its name, such as \"mm\""));
    };
    let unit_m = length_unit_m(name).map_err(|error| {
        let problem = format!("{}: {}", unit.path, error.problem);
        unit.refuse(problem, error.remedy)
    })?;
    Ok((path, unit_m))
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

pub(super) fn list_box(min_m: [f64; 3], max_m: [f64; 3], listing: &mut Listing) {
    listing.table("box", &BOX, |listing| {
        listing.value("min", &min_m);
        listing.value("max", &max_m);
    });
}

pub(super) fn list_sphere(centre_m: [f64; 3], radius_m: f64, listing: &mut Listing) {
    listing.table("sphere", &SPHERE, |listing| {
        listing.value("centre", &centre_m);
        listing.value("radius", &radius_m);
    });
}

pub(super) fn list_cylinder(ends_m: [[f64; 3]; 2], radius_m: f64, listing: &mut Listing) {
    listing.table("cylinder", &CYLINDER, |listing| {
        listing.value("from", &ends_m[0]);
        listing.value("to", &ends_m[1]);
        listing.value("radius", &radius_m);
    });
}

pub(super) fn list_stl(file: &Path, unit_m: f64, listing: &mut Listing) {
    listing.text("stl", file.display().to_string());
    listing.text("unit", quantity(unit_m, "m"));
}
