//! What a wall looks like: `plane`, `box`, `cylinder` or `stl`.

use std::path::Path;

use crate::Result;
use crate::scene::WallShape;
use crate::scene::direction::direction;
use crate::scene::field::Field;
use crate::scene::shape::{corners, cylinder, refuse_without_stl, stl};
use crate::scene::table::Table;
use crate::units::{LENGTH, NUMBER};

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
                scale: wall
                    .read("scale", |field| field.positive(&NUMBER))?
                    .unwrap_or(1.0),
            })
        }
    }
}

fn plane(field: &Field<'_>) -> Result<WallShape> {
    let table = field.table(&["point", "normal"])?;
    let point_m = table.need("point", "[0, 0, 0]")?.vector(&LENGTH)?;
    let normal = table.need("normal", "[0, 0, 1], into the free side")?;
    Ok(WallShape::Plane {
        point_m,
        normal: direction(&normal, "a normal")?,
    })
}
