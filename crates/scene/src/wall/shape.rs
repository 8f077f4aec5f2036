//! The shape of a wall: `plane`, `box`, `cylinder` or `stl`.

use std::path::{Path, PathBuf};

use crate::field::Field;
use crate::listing::Listing;
use crate::schema::{Key, Kind, Schema};
use crate::shape::{corners, cylinder, list_box, list_cylinder, list_stl, refuse_without_stl, stl};
use crate::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::LENGTH;

/// The shape of a wall, before it is rotated.
#[derive(Debug, Clone, PartialEq)]
pub enum WallShape {
    /// `plane = { point, normal }`, infinite.
    Plane {
        /// A point of it, m. Length 3.
        point_m: [f64; 3],
        /// Normal of length 1, into the free side. Length 3.
        normal: [f64; 3],
    },
    /// `box = { min, max }`: solid, with particles outside.
    Box {
        /// Smallest corner, m. Length 3.
        min: [f64; 3],
        /// Largest corner, m: above the smallest along every axis. Length 3.
        max: [f64; 3],
    },
    /// `cylinder = { from, to, radius }`: a solid pin, with particles outside.
    Cylinder {
        /// Centre of one end, m. Length 3.
        from_m: [f64; 3],
        /// Centre of the other end, m, elsewhere. Length 3.
        to_m: [f64; 3],
        /// Radius, m.
        radius_m: f64,
    },
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

pub(super) static PLANE: Schema = Schema {
    title: "Plane",
    doc: "An infinite plane.",
    keys: &[
        Key::new("point", Kind::Vector(&LENGTH), "A point on the plane.").required("[0, 0, 0]"),
        Key::new(
            "normal",
            Kind::Direction("a normal"),
            "Normal into the free side; its length does not matter.",
        )
        .required("[0, 0, 1], into the free side"),
    ],
};

const SHAPES: [&str; 4] = ["plane", "box", "cylinder", "stl"];

pub(super) fn read(wall: &Table<'_>, folder: &Path) -> Result<WallShape> {
    let one = "a wall has one shape: remove one, or make two walls";
    let Some((key, field)) = wall.at_most_one(&SHAPES, one)? else {
        let remedy = "add plane = { point, normal }, box = { min, max }, cylinder = { from, to, radius } or stl = \"plate.stl\"";
        return Err(wall.fault("has no shape", remedy));
    };
    refuse_without_stl(wall, &["unit", "scale"], key)?;
    match key {
        "plane" => plane(&field),
        "box" => {
            let [min, max] = corners(&field, "less than", |low, high| low < high)?;
            Ok(WallShape::Box { min, max })
        }
        "cylinder" => {
            let ([from_m, to_m], radius_m) = cylinder(&field)?;
            Ok(WallShape::Cylinder {
                from_m,
                to_m,
                radius_m,
            })
        }
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

fn plane(field: &Field<'_>) -> Result<WallShape> {
    let table = Table::of(field, &PLANE)?;
    Ok(WallShape::Plane {
        point_m: table.read("point")?,
        normal: table.read("normal")?,
    })
}

pub(super) fn list(shape: &WallShape, listing: &mut Listing) {
    match shape {
        WallShape::Plane { point_m, normal } => listing.table("plane", &PLANE, |listing| {
            listing.value("point", point_m);
            listing.value("normal", normal);
        }),
        WallShape::Box { min, max } => list_box(*min, *max, listing),
        WallShape::Cylinder {
            from_m,
            to_m,
            radius_m,
        } => list_cylinder([*from_m, *to_m], *radius_m, listing),
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
