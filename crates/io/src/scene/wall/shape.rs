//! What a wall looks like: `plane`, `box`, `cylinder` or `stl`.

use std::path::Path;

use crate::Result;
use crate::scene::field::Field;
use crate::scene::listing::Listing;
use crate::scene::schema::{Key, Kind, Schema};
use crate::scene::shape::{
    corners, cylinder, list_box, list_cylinder, list_stl, refuse_without_stl, stl,
};
use crate::scene::table::Table;
use crate::scene::wall::WallShape;
use crate::units::LENGTH;

pub(super) static PLANE: Schema = Schema {
    title: "Plane",
    doc: "A plane without end.",
    keys: &[
        Key::new("point", Kind::Vector(&LENGTH), "A point of it.").required("[0, 0, 0]"),
        Key::new(
            "normal",
            Kind::Direction("a normal"),
            "Into the free side; its length does not matter.",
        )
        .required("[0, 0, 1], into the free side"),
    ],
};

const SHAPES: [&str; 4] = ["plane", "box", "cylinder", "stl"];

pub(super) fn read(wall: &Table<'_>, folder: &Path) -> Result<WallShape> {
    let mut given = wall.given(&SHAPES);
    let Some((key, field)) = given.next() else {
        let problem = format!("{} has no shape", wall.path);
        let remedy = "add plane = { point, normal }, box = { min, max }, cylinder = { from, to, radius } or stl = \"plate.stl\"";
        return Err(wall.refuse(problem, remedy));
    };
    if let Some((_, second)) = given.next() {
        let problem = format!("{} stands beside {key}", second.path);
        let remedy = "a wall has one shape: remove one, or make two walls";
        return Err(second.refuse(problem, remedy));
    }
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
