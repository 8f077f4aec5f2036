//! What a wall looks like: `plane`, `box`, `cylinder` or `stl`.

use std::path::Path;

use crate::Result;
use crate::scene::WallShape;
use crate::scene::direction::direction;
use crate::scene::field::Field;
use crate::scene::read::named_path;
use crate::scene::set::corners;
use crate::scene::table::Table;
use crate::units::{LENGTH, NUMBER, length_unit_m};

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
    if let (Some((_, of_stl)), true) = (wall.given(&["unit", "scale"]).next(), key != "stl") {
        let problem = format!("{} stands without stl, on which it acts", of_stl.path);
        return Err(of_stl.refuse(problem, format!("remove it: lengths of a {key} have units")));
    }
    match key {
        "plane" => plane(&field),
        "box" => {
            let [min, max] = corners(&field, "less than", |low, high| low < high)?;
            Ok(WallShape::Box { min, max })
        }
        "cylinder" => cylinder(&field),
        _ => stl(&field, wall, folder),
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

fn cylinder(field: &Field<'_>) -> Result<WallShape> {
    let table = field.table(&["from", "to", "radius"])?;
    let from_m = table.need("from", "[0, 0, 0]")?.vector(&LENGTH)?;
    let end = table.need("to", "[0, 0, \"10 mm\"]")?;
    let to_m = end.vector(&LENGTH)?;
    if from_m == to_m {
        let [x, y, z] = to_m;
        let problem = format!("{} is [{x}, {y}, {z}] m, where from is", end.path);
        return Err(end.refuse(problem, "a cylinder needs a length: move one of them"));
    }
    Ok(WallShape::Cylinder {
        from_m,
        to_m,
        radius_m: table.need("radius", "\"5 mm\"")?.positive(&LENGTH)?,
    })
}

fn stl(field: &Field<'_>, wall: &Table<'_>, folder: &Path) -> Result<WallShape> {
    let path = named_path(field, folder)?;
    if path.as_os_str() == "-" {
        return Err(field.wrong("a file", "write a name such as \"plate.stl\""));
    }
    let unit = wall.need("unit", "\"mm\", the file's unit of length")?;
    let Ok(name) = unit.text() else {
        return Err(unit.wrong("a unit of length", "write its name, such as \"mm\""));
    };
    let unit_m = length_unit_m(name).map_err(|error| {
        let problem = format!("{}: {}", unit.path, error.problem);
        unit.refuse(problem, error.remedy)
    })?;
    Ok(WallShape::Stl {
        path,
        unit_m,
        scale: wall
            .read("scale", |field| field.positive(&NUMBER))?
            .unwrap_or(1.0),
    })
}
