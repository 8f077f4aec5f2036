//! The shape of a wall: `plane`, `box`, `cylinder` or `stl`.

use std::path::{Path, PathBuf};

use crate::listing::Listing;
use crate::plain_table::plain_table;
use crate::schema::Kind;
use crate::shape::{
    BOX, BoxShape, CYLINDER, CylinderShape, list_stl, read_box, read_cylinder, refuse_without_stl,
    stl,
};
use crate::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::LENGTH;

/// The shape of a wall, before it is rotated.
#[derive(Debug, Clone, PartialEq)]
pub enum WallShape {
    /// `plane = { point, normal }`, infinite, with a normal of length 1.
    Plane(PlaneShape),
    /// `box = { min, max }`: solid, with particles outside; `min` is below `max` along every axis.
    Box(BoxShape),
    /// `cylinder = { from, to, radius }`: a solid pin, with particles outside.
    Cylinder(CylinderShape),
    /// `stl`, `unit` and `scale`: triangles.
    Stl {
        /// `stl`: the file, resolved against the folder of the scene.
        path: PathBuf,
        /// `unit`: size of the file's unit, m.
        unit_m: f64,
        /// `scale`: a factor on all lengths, 1 unless given.
        scale: f64,
    },
}

plain_table! {
    PLANE = "Plane";
    /// An infinite plane.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct PlaneShape {
        /// A point on the plane.
        point_m: [f64; 3] = new("point", Kind::Vector(&LENGTH)).required("[0, 0, 0]");
        /// Normal into the free side; its length does not matter.
        normal: [f64; 3] = new("normal", Kind::Direction("a normal"))
            .required("[0, 0, 1], into the free side");
    }
}

const SHAPES: [&str; 4] = ["plane", "box", "cylinder", "stl"];

pub(super) fn read(wall: &Table<'_>, folder: &Path) -> Result<WallShape> {
    let one = "a wall has one shape: remove one, or make two walls";
    let Some((key, field)) = wall.at_most_one(&SHAPES, one)? else {
        let remedy = "add plane = { point, normal }, box = { min, max }, cylinder = { from, to, radius } or stl = \"plate.stl\"";
        return Err(wall.fault("has no shape", remedy));
    };
    refuse_without_stl(wall, &["unit", "scale"], key)?;
    match key {
        "plane" => PlaneShape::read(&Table::of(&field, &PLANE)?).map(WallShape::Plane),
        "box" => read_box(&field, "less than", |low, high| low < high).map(WallShape::Box),
        "cylinder" => read_cylinder(&field).map(WallShape::Cylinder),
        _ => {
            let (path, unit_m) = stl(&field, wall, folder)?;
            Ok(WallShape::Stl {
                path,
                unit_m,
                scale: wall.read("scale")?,
            })
        }
    }
}

pub(super) fn list(shape: &WallShape, listing: &mut Listing) {
    match shape {
        WallShape::Plane(of) => listing.table("plane", &PLANE, |listing| of.list(listing)),
        WallShape::Box(of) => listing.table("box", &BOX, |listing| of.list(listing)),
        WallShape::Cylinder(of) => listing.table("cylinder", &CYLINDER, |listing| of.list(listing)),
        WallShape::Stl {
            path,
            unit_m,
            scale,
        } => {
            list_stl(path, *unit_m, listing);
            listing.value("scale", scale);
        }
    }
}
