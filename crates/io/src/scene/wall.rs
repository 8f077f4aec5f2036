//! `[walls.NAME]`

mod motion;
mod shape;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::direction::rotation;
use super::field::Field;
use super::names::meaning;
use super::table::Table;
use super::{BodyEntry, Factor, Material, ParticleSet};
use crate::Result;
use crate::units::{ANGLE, LENGTH, VELOCITY};

const KEYS: [&str; 18] = [
    "plane",
    "box",
    "cylinder",
    "stl",
    "unit",
    "scale",
    "material",
    "rotation",
    "tilt",
    "pivot",
    "surface_velocity",
    "velocity",
    "angular_velocity",
    "displacement",
    "turn",
    "servo",
    "ramp",
    "table",
];

/// What particles bounce off. It moves as it is told.
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    /// `plane`, `box`, `cylinder` or `stl`
    pub shape: WallShape,
    /// `material`: a name of `[materials]`.
    pub material: String,
    /// `rotation = { axis, angle }`: turned about the pivot, as a rotation vector, rad. Length 3.
    pub rotation_rad: [f64; 3],
    /// `tilt`: turned about the y axis through the pivot after `rotation`, rad; 0 unless given.
    pub tilt_rad: f64,
    /// `pivot`, m; the origin unless given. Length 3.
    pub pivot_m: [f64; 3],
    /// How it moves; fixed unless given.
    pub motion: WallMotion,
    /// `surface_velocity`: that of a belt, which the shape does not follow, m/s; 0 unless given.
    /// Length 3.
    pub surface_velocity_m_s: [f64; 3],
}

/// What a wall looks like, before it is turned.
#[derive(Debug, Clone, PartialEq)]
pub enum WallShape {
    /// `plane = { point, normal }`, without end.
    Plane {
        /// A point of it, m. Length 3.
        point_m: [f64; 3],
        /// Of length 1, into the free side. Length 3.
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

/// How a wall moves.
#[derive(Debug, Clone, PartialEq)]
pub enum WallMotion {
    /// Not at all.
    Fixed,
    /// `velocity` and `angular_velocity`, with `ramp` or `table`.
    Velocity {
        /// Of the pivot, m/s. Length 3.
        velocity_m_s: [f64; 3],
        /// About the pivot, which moves along, rad/s. Length 3.
        spin_rad_s: [f64; 3],
        /// On both, over time.
        factor: Factor,
    },
    /// `displacement` and `turn`, with `ramp` or `table`.
    Displacement {
        /// Of the pivot, m. Length 3.
        displacement_m: [f64; 3],
        /// About the pivot, which moves along: `turn = { axis, angle }` as a rotation vector, rad.
        /// Length 3.
        turn_rad: [f64; 3],
        /// On both, over time.
        factor: Factor,
    },
    /// `servo = { force, direction, velocity }`, with `ramp` or `table`: moves along `direction`
    /// such that it pushes as wanted.
    Servo {
        /// `force`: what it is to push with along `direction`, N; below 0 against it.
        force_n: f64,
        /// `direction`, of length 1. Length 3.
        direction: [f64; 3],
        /// `velocity`: its largest, m/s; more than 0.
        largest_velocity_m_s: f64,
        /// On the force, over time.
        factor: Factor,
    },
}

pub(super) fn read_all(
    root: &Table<'_>,
    materials: &BTreeMap<String, Material>,
    bodies: &BTreeMap<String, BodyEntry>,
    sets: &BTreeMap<String, ParticleSet>,
    folder: &Path,
) -> Result<BTreeMap<String, Wall>> {
    let mut walls = BTreeMap::new();
    for (name, field) in root.named("walls")? {
        let like = if bodies.contains_key(&name) {
            Some(format!("the body [bodies.{name}]"))
        } else if sets.contains_key(&name) {
            Some(format!("the set [sets.{name}]"))
        } else {
            meaning(&name).map(str::to_owned)
        };
        if let Some(like) = like {
            let problem = format!("{} is named like {like}", field.path);
            let remedy = "give it another name: measures name walls as they do sets and bodies";
            return Err(field.refuse(problem, remedy));
        }
        walls.insert(name, read(&field, materials, folder)?);
    }
    Ok(walls)
}

fn read(field: &Field<'_>, materials: &BTreeMap<String, Material>, folder: &Path) -> Result<Wall> {
    let table = field.table(&KEYS)?;
    Ok(Wall {
        shape: shape::read(&table, folder)?,
        material: table
            .need("material", "\"NAME\", a name in [materials]")?
            .reference(materials.keys(), "materials")?,
        rotation_rad: table
            .read("rotation", |field| rotation(&field))?
            .unwrap_or_default(),
        tilt_rad: table
            .read("tilt", |field| field.quantity(&ANGLE))?
            .unwrap_or_default(),
        pivot_m: table
            .read("pivot", |field| field.vector(&LENGTH))?
            .unwrap_or_default(),
        motion: motion::read(&table)?,
        surface_velocity_m_s: table
            .read("surface_velocity", |field| field.vector(&VELOCITY))?
            .unwrap_or_default(),
    })
}
