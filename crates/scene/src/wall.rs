//! `[walls.NAME]`

pub(super) mod motion;
mod shape;

pub use motion::WallMotion;
pub use shape::{PlaneShape, WallShape};

use std::collections::BTreeMap;
use std::path::Path;

use super::body::BodyEntry;
use super::direction::ROTATION;
use super::factor::{RAMP, TABLE};
use super::field::Field;
use super::group::ParticleGroup;
use super::listing::Listing;
use super::material::Material;
use super::names::meaning;
use super::schema::table_schema;
use super::shape::{BOX, CYLINDER, UNIT};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ANGULAR_VELOCITY, LENGTH, VELOCITY};

table_schema! {
    /// A rigid wall of one shape. It is fixed unless it has a velocity, a displacement or a servo.
    pub(super) static WALL = "[walls.NAME]";

    /// An infinite plane.
    table("plane", &shape::PLANE);
    /// A solid box, with particles outside.
    table("box", &BOX);
    /// A solid cylinder, with particles outside.
    table("cylinder", &CYLINDER);
    /// STL file of the surface, relative to the folder of the scene; requires `unit`.
    text("stl", "a file");
    UNIT;
    /// Factor on all lengths of the STL file.
    number("scale").positive().or(1.0);
    /// Its material.
    text("material", "a name in [materials]").required("\"NAME\", a name in [materials]");
    /// Initial rotation about the pivot.
    table("rotation", &ROTATION).or(0.0);
    /// Centre of rotation.
    vector("pivot", &LENGTH);
    /// Velocity of the surface of a belt, whose shape stays in place; in space, not rotated with
    /// the wall.
    vector("surface_velocity", &VELOCITY);
    /// Velocity of the pivot.
    vector("velocity", &VELOCITY);
    /// Angular velocity about the pivot, which moves with the wall.
    vector("angular_velocity", &ANGULAR_VELOCITY);
    /// Displacement of the pivot. Requires a `ramp` or `table` that begins at 0.
    vector("displacement", &LENGTH);
    /// Rotation about the pivot. Requires a `ramp` or `table` that begins at 0.
    table("angular_displacement", &ROTATION).or(0.0);
    /// Servo control: the wall moves such that it exerts a given force.
    table("servo", &motion::SERVO);
    RAMP;
    TABLE;
}

/// A wall, fixed or moving.
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    /// `plane`, `box`, `cylinder` or `stl`
    pub shape: WallShape,
    /// `material`: a name of `[materials]`.
    pub material: String,
    /// `rotation = { axis, angle }`: rotation about the pivot, as a rotation vector, rad. Length 3.
    pub rotation_rad: [f64; 3],
    /// `pivot`, m; the origin unless given. Length 3.
    pub pivot_m: [f64; 3],
    /// Its motion; fixed unless given.
    pub motion: WallMotion,
    /// `surface_velocity`: velocity of a belt's surface, which the shape does not follow, m/s; 0
    /// unless given. Length 3.
    pub surface_velocity_m_s: [f64; 3],
}

pub(super) fn read_all(
    root: &Table<'_>,
    materials: &BTreeMap<String, Material>,
    bodies: &BTreeMap<String, BodyEntry>,
    groups: &BTreeMap<String, ParticleGroup>,
    folder: &Path,
) -> Result<BTreeMap<String, Wall>> {
    let mut walls = BTreeMap::new();
    for (name, field) in root.named("walls")? {
        let like = if bodies.contains_key(&name) {
            Some(format!("the body [bodies.{name}]"))
        } else if groups.contains_key(&name) {
            Some(format!("the group [groups.{name}]"))
        } else {
            meaning(&name).map(str::to_owned)
        };
        if let Some(like) = like {
            let remedy = "give it another name: measures name walls as they do groups and bodies";
            return Err(field.fault(format!("is named like {like}"), remedy));
        }
        walls.insert(name, read(&field, materials, folder)?);
    }
    Ok(walls)
}

fn read(field: &Field<'_>, materials: &BTreeMap<String, Material>, folder: &Path) -> Result<Wall> {
    let table = Table::of(field, &WALL)?;
    Ok(Wall {
        shape: shape::read(&table, folder)?,
        material: table
            .need("material")?
            .reference(materials.keys(), "materials")?,
        rotation_rad: table.read("rotation")?,
        pivot_m: table.read("pivot")?,
        motion: motion::read(&table)?,
        surface_velocity_m_s: table.read("surface_velocity")?,
    })
}

pub(super) fn list(wall: &Wall, listing: &mut Listing) {
    shape::list(&wall.shape, listing);
    listing.text("material", &wall.material);
    listing.value("pivot", &wall.pivot_m);
    listing.value("rotation", &wall.rotation_rad);
    listing.value("surface_velocity", &wall.surface_velocity_m_s);
    motion::list(&wall.motion, listing);
}
