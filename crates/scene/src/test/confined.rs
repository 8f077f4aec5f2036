//! What holds the body of a shear test besides its crosshead: walls that keep a pressure on its
//! sides, or a force that presses its halves together.

use crate::listing::Listing;
use crate::table::Table;
use crate::wall::{Wall, WallShape};
use dem_io::diagnostic::Result;
use std::collections::BTreeMap;

/// Largest cosine between directions that are square to each other.
const SQUARE: f64 = 1e-6;

/// The walls on the sides of a triaxial test.
#[derive(Debug, Clone, PartialEq)]
pub struct Confinement {
    /// `lateral_walls`: planes around the body, in one or two opposite pairs. Length 2 or 4.
    pub walls: Vec<String>,
    /// `confining_pressure` that each keeps on its side of the body, Pa.
    pub pressure_pa: f64,
}

/// The stress that presses the halves of a direct shear test together.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalStress {
    /// `normal_stress` on the shear plane, Pa; 0: none.
    pub stress_pa: f64,
    /// `normal`: direction in which the driven half is pressed, of length 1, along an axis and
    /// square to the direction of the test. Length 3.
    pub direction: [f64; 3],
}

/// `names`: of the lateral walls, which are in `walls`.
pub(super) fn confinement(
    test: &Table<'_>,
    names: Vec<String>,
    crosshead: &[String],
    direction: [f64; 3],
    walls: &BTreeMap<String, Wall>,
) -> Result<Confinement> {
    let field = test.need("lateral_walls")?;
    if !is_along_an_axis(direction) {
        let remedy = "write [1, 0, 0], [0, 1, 0], [0, 0, 1] or the opposite";
        let along = test.need("direction")?;
        return Err(along.wrong("along x, y or z, as the sides are square to it", remedy));
    }
    let mut normals: Vec<[f64; 3]> = Vec::new();
    for (item, name) in field.items()?.into_iter().zip(&names) {
        if crosshead.contains(name) {
            let problem = format!("is \"{name}\", which is the crosshead");
            return Err(item.fault(problem, "name each wall once"));
        }
        let wall = &walls[name];
        let normal = match wall.shape {
            WallShape::Plane(plane) if wall.rotation_rad == [0.0; 3] => plane.normal,
            _ => [0.0; 3],
        };
        if !is_along_an_axis(normal) || dot(normal, direction).abs() > SQUARE {
            let problem = format!(
                "is \"{name}\", which is no plane along the direction of the test and square to an axis"
            );
            let remedy =
                "write plane = { point, normal }, with the normal towards the body along x, y or z";
            return Err(item.fault(problem, remedy));
        }
        normals.push(normal);
    }
    let opposite = |a: &[f64; 3]| {
        normals
            .iter()
            .filter(|b| dot(*a, **b) < SQUARE - 1.0)
            .count()
    };
    let same = |a: &[f64; 3]| {
        normals
            .iter()
            .filter(|b| dot(*a, **b) > 1.0 - SQUARE)
            .count()
    };
    if normals.is_empty() || normals.iter().any(|n| opposite(n) != 1 || same(n) != 1) {
        let limit = "two or four planes, in opposite pairs";
        return Err(field.wrong(limit, "name a wall on each of two opposite sides"));
    }
    Ok(Confinement {
        walls: names,
        pressure_pa: test.read("confining_pressure")?,
    })
}

pub(super) fn normal_stress(test: &Table<'_>, direction: [f64; 3]) -> Result<NormalStress> {
    let field = test.need("normal")?;
    let normal: [f64; 3] = test.read("normal")?;
    if !is_along_an_axis(normal) || dot(normal, direction).abs() > SQUARE {
        let limit = "along x, y or z and square to direction";
        return Err(field.wrong(limit, "press along another axis than that of the shear"));
    }
    Ok(NormalStress {
        stress_pa: test.read("normal_stress")?,
        direction: normal,
    })
}

pub(super) fn list_confinement(confinement: &Confinement, listing: &mut Listing) {
    listing.text("lateral_walls", confinement.walls.join(", "));
    listing.value("confining_pressure", &confinement.pressure_pa);
}

pub(super) fn list_normal_stress(normal: &NormalStress, listing: &mut Listing) {
    listing.value("normal_stress", &normal.stress_pa);
    listing.value("normal", &normal.direction);
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

/// Whether exactly one component is not 0.
pub(super) fn is_along_an_axis(direction: [f64; 3]) -> bool {
    direction.iter().filter(|c| **c != 0.0).count() == 1
}
