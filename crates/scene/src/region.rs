//! `[regions.NAME]`

use std::path::{Path, PathBuf};

use super::field::Field;
use super::listing::Listing;
use super::schema::table_schema;
use super::shape::{
    BOX, BoxShape, CYLINDER, CylinderShape, SPHERE, SphereShape, UNIT, list_stl, read_box,
    read_cylinder, read_sphere, refuse_without_stl, stl,
};
use super::table::Table;
use dem_io::diagnostic::Result;

const SHAPES: [&str; 4] = ["box", "sphere", "cylinder", "stl"];

table_schema! {
    /// A part of space of one shape. It has no surface.
    pub(super) static REGION = "[regions.NAME]";

    /// A box.
    table("box", &BOX);
    /// A sphere.
    table("sphere", &SPHERE);
    /// A cylinder.
    table("cylinder", &CYLINDER);
    /// File of a closed surface of triangles (STL, OBJ, PLY or 3MF), relative to the folder of the
    /// scene; requires `unit`, but for a 3MF.
    text("stl", "a file");
    UNIT;
}

/// A region of space, without walls.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    /// `box = { min, max }`, with `min` below `max` along every axis.
    Box(BoxShape),
    /// `sphere = { centre, radius }`
    Sphere(SphereShape),
    /// `cylinder = { from, to, radius }`
    Cylinder(CylinderShape),
    /// `stl` and `unit`: the region enclosed by a closed surface. The reader of the file checks
    /// whether it is closed.
    Stl {
        /// `stl`: the file, resolved against the folder of the scene.
        file: PathBuf,
        /// `unit`: size of the file's unit, m. None: the file says so, as a 3MF does.
        unit_m: Option<f64>,
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
        "box" => Region::Box(read_box(&field, "less than", |low, high| low < high)?),
        "sphere" => Region::Sphere(read_sphere(&field)?),
        "cylinder" => Region::Cylinder(read_cylinder(&field)?),
        _ => {
            let (file, unit_m) = stl(&field, &table, folder)?;
            Region::Stl { file, unit_m }
        }
    })
}

pub(super) fn list(region: &Region, listing: &mut Listing) {
    match region {
        Region::Box(of) => listing.table("box", &BOX, |listing| of.list(listing)),
        Region::Sphere(of) => listing.table("sphere", &SPHERE, |listing| of.list(listing)),
        Region::Cylinder(of) => listing.table("cylinder", &CYLINDER, |listing| of.list(listing)),
        Region::Stl { file, unit_m } => list_stl(file, *unit_m, listing),
    }
}
