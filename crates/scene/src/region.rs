//! `[regions.NAME]`

use std::path::{Path, PathBuf};

use super::field::Field;
use super::listing::Listing;
use super::schema::{Key, Schema};
use super::shape::{
    BOX, CYLINDER, SPHERE, UNIT, corners, cylinder, list_box, list_cylinder, list_sphere, list_stl,
    refuse_without_stl, sphere, stl,
};
use super::table::Table;
use dem_io::diagnostic::Result;

const SHAPES: [&str; 4] = ["box", "sphere", "cylinder", "stl"];

pub(super) static REGION: Schema = Schema {
    title: "[regions.NAME]",
    doc: "A part of space of one shape. It has no surface.",
    keys: &[
        Key::table("box", &BOX, "A box."),
        Key::table("sphere", &SPHERE, "A sphere."),
        Key::table("cylinder", &CYLINDER, "A cylinder."),
        Key::text(
            "stl",
            "a file",
            "STL file of a closed surface, relative to the folder of the scene; requires `unit`.",
        ),
        UNIT,
    ],
};

/// A region of space, without walls.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    /// `box = { min, max }`
    Box {
        /// Smallest corner, m. Length 3.
        min_m: [f64; 3],
        /// Largest corner, m: above the smallest along every axis. Length 3.
        max_m: [f64; 3],
    },
    /// `sphere = { centre, radius }`
    Sphere {
        /// Centre, m. Length 3.
        centre_m: [f64; 3],
        /// Radius, m.
        radius_m: f64,
    },
    /// `cylinder = { from, to, radius }`
    Cylinder {
        /// Centre of one end, m. Length 3.
        from_m: [f64; 3],
        /// Centre of the other end, m, elsewhere. Length 3.
        to_m: [f64; 3],
        /// Radius, m.
        radius_m: f64,
    },
    /// `stl` and `unit`: the region enclosed by a closed surface. The reader of the file checks
    /// whether it is closed.
    Stl {
        /// `stl`: the file, resolved against the folder of the scene.
        file: PathBuf,
        /// `unit`: size of the file's unit, m.
        unit_m: f64,
    },
}

pub(super) fn read(field: &Field<'_>, folder: &Path) -> Result<Region> {
    let table = Table::of(field, &REGION)?;
    let one = "a region has one shape: remove one, or make two regions";
    let Some((key, field)) = table.at_most_one(&SHAPES, one)? else {
        let remedy = "add box = { min, max }, sphere = { centre, radius }, cylinder = { from, to, radius } or stl = \"room.stl\"";
        return Err(table.fault("has no shape", remedy));
    };
    refuse_without_stl(&table, &["unit"], key)?;
    Ok(match key {
        "box" => {
            let [min_m, max_m] = corners(&field, "less than", |low, high| low < high)?;
            Region::Box { min_m, max_m }
        }
        "sphere" => {
            let (centre_m, radius_m) = sphere(&field)?;
            Region::Sphere { centre_m, radius_m }
        }
        "cylinder" => {
            let ([from_m, to_m], radius_m) = cylinder(&field)?;
            Region::Cylinder {
                from_m,
                to_m,
                radius_m,
            }
        }
        _ => {
            let (file, unit_m) = stl(&field, &table, folder)?;
            Region::Stl { file, unit_m }
        }
    })
}

pub(super) fn list(region: &Region, listing: &mut Listing) {
    match region {
        Region::Box { min_m, max_m } => list_box(*min_m, *max_m, listing),
        Region::Sphere { centre_m, radius_m } => list_sphere(*centre_m, *radius_m, listing),
        Region::Cylinder {
            from_m,
            to_m,
            radius_m,
        } => list_cylinder([*from_m, *to_m], *radius_m, listing),
        Region::Stl { file, unit_m } => list_stl(file, *unit_m, listing),
    }
}
