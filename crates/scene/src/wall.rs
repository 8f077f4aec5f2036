//! `[walls.NAME]`

pub(super) mod loads;
pub(super) mod motion;

pub use loads::Loads as WallLoads;
pub use motion::WallMotion;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::body::BodyEntry;
use super::direction::ROTATION;
use super::factor::{RAMP, TABLE};
use super::field::Field;
use super::group::ParticleGroup;
use super::listing::Listing;
use super::material::Material;
use super::names::meaning;
use super::plain_table::plain_table;
use super::schema::{Kind, table_schema};
use super::shape::{
    BOX, BoxShape, CYLINDER, CylinderShape, UNIT, list_stl, read_box, read_cylinder,
    refuse_without_stl, stl,
};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ANGLE, ANGULAR_VELOCITY, FREQUENCY, LENGTH, VELOCITY};
use dem_physics::geometry::{Cylinder, Mesh, Plane, Shape, SolidBox};

table_schema! {
    /// A rigid wall of one shape. It is fixed unless it has a velocity, a displacement, a servo, an
    /// orbit or a gyration.
    pub(super) static WALL = "[walls.NAME]";

    /// An infinite plane.
    table("plane", &PLANE);
    /// A solid box, with particles outside.
    table("box", &BOX);
    /// A solid cylinder, with particles outside.
    table("cylinder", &CYLINDER);
    /// File of the surface's triangles (STL, OBJ, PLY or 3MF), relative to the folder of the scene;
    /// requires `unit`, but for a 3MF.
    text("stl", "a file");
    UNIT;
    /// Factor on all lengths of the file.
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
    /// Displacement of the pivot. Requires a `ramp`, a `table` that begins at 0, or a `frequency`,
    /// with which it is the amplitude.
    vector("displacement", &LENGTH);
    /// Rotation about the pivot. Requires a `ramp`, a `table` that begins at 0, or a `frequency`,
    /// with which it is the amplitude.
    table("angular_displacement", &ROTATION).or(0.0);
    /// The wall swings: `displacement` and `angular_displacement` have the factor
    /// sin(2 pi f t + phase) - sin(phase).
    quantity("frequency", &FREQUENCY).positive();
    /// Phase of the swing at the start: at 0 deg the wall is in the middle of its way, at -90 deg
    /// at its beginning, at rest, and goes twice the `displacement`.
    quantity("phase", &ANGLE).or(0.0);
    /// Servo control: the wall moves such that it exerts a given force.
    table("servo", &motion::SERVO);
    /// Books what contacts do to each patch of the wall, where impacts hit it and where it wears.
    table("loads", &loads::LOADS).otherwise("not booked");
    /// Circular vibration, such as that of a screen.
    table("orbit", &motion::ORBIT);
    /// The axis of the wall goes round a cone, such as that of a cone crusher's mantle.
    table("gyration", &motion::GYRATION);
    RAMP;
    TABLE;
}

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
        /// `unit`: size of the file's unit, m. None: the file says so, as a 3MF does.
        unit_m: Option<f64>,
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
    /// `loads`: how what contacts do to it is booked. None: it is not.
    pub loads: Option<WallLoads>,
}

impl WallShape {
    /// The shape in a frame whose origin is the pivot, m. `read` gives the surface in a file with
    /// this unit, m, or its own, and this scale, in that frame.
    pub fn in_frame_of(
        &self,
        pivot_m: [f64; 3],
        read: impl FnOnce(&Path, Option<f64>, f64) -> Result<Mesh>,
    ) -> Result<Shape> {
        let from_pivot = |point: [f64; 3]| [0, 1, 2].map(|k| point[k] - pivot_m[k]);
        Ok(match self {
            Self::Plane(PlaneShape { point_m, normal }) => {
                Shape::Plane(Plane::new(from_pivot(*point_m), *normal)?)
            }
            Self::Box(BoxShape { min_m, max_m }) => {
                Shape::Box(SolidBox::new(from_pivot(*min_m), from_pivot(*max_m))?)
            }
            Self::Cylinder(pin) => {
                let ends = [from_pivot(pin.from_m), from_pivot(pin.to_m)];
                Shape::Cylinder(Cylinder::new(ends, pin.radius_m)?)
            }
            Self::Stl {
                path,
                unit_m,
                scale,
            } => Shape::Mesh(read(path, *unit_m, *scale)?),
        })
    }

    /// Two points halfway between which its middle is, m; of a plane twice its point. None: the
    /// triangles are in a file.
    pub fn ends_m(&self) -> Option<[[f64; 3]; 2]> {
        match self {
            Self::Plane(plane) => Some([plane.point_m; 2]),
            Self::Box(of) => Some([of.min_m, of.max_m]),
            Self::Cylinder(pin) => Some([pin.from_m, pin.to_m]),
            Self::Stl { .. } => None,
        }
    }

    /// Radius of a ball that fits behind each point of its surface, m; 0 for triangles, whose edges
    /// may be arbitrarily sharp.
    pub fn inner_radius_m(&self) -> f64 {
        match self {
            Self::Plane(_) => f64::INFINITY,
            Self::Box(BoxShape { min_m, max_m }) => {
                let sides = [0, 1, 2].map(|k| 0.5 * (max_m[k] - min_m[k]));
                sides.into_iter().fold(f64::INFINITY, f64::min)
            }
            Self::Cylinder(pin) => {
                let [x, y, z] = [0, 1, 2].map(|k| pin.to_m[k] - pin.from_m[k]);
                let length_m = (x * x + y * y + z * z).sqrt();
                pin.radius_m.min(0.5 * length_m)
            }
            Self::Stl { .. } => 0.0,
        }
    }
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
    let (key, shape) = read_shape(&table, folder)?;
    Ok(Wall {
        shape,
        material: table
            .need("material")?
            .reference(materials.keys(), "materials")?,
        rotation_rad: table.read("rotation")?,
        pivot_m: table.read("pivot")?,
        motion: motion::read(&table)?,
        surface_velocity_m_s: table.read("surface_velocity")?,
        loads: table.read_by("loads", |field| loads::read(&field, key))?,
    })
}

pub(super) fn list(wall: &Wall, listing: &mut Listing) {
    list_shape(&wall.shape, listing);
    listing.text("material", &wall.material);
    listing.value("pivot", &wall.pivot_m);
    listing.value("rotation", &wall.rotation_rad);
    listing.value("surface_velocity", &wall.surface_velocity_m_s);
    motion::list(&wall.motion, listing);
    if let Some(loads) = &wall.loads {
        listing.table("loads", &loads::LOADS, |listing| loads.list(listing));
    }
}

const SHAPES: [&str; 4] = ["plane", "box", "cylinder", "stl"];

/// The key of the shape of a wall, and the shape.
fn read_shape(wall: &Table<'_>, folder: &Path) -> Result<(&'static str, WallShape)> {
    let one = "a wall has one shape: remove one, or make two walls";
    let Some((key, field)) = wall.at_most_one(&SHAPES, one)? else {
        let remedy = "add plane = { point, normal }, box = { min, max }, cylinder = { from, to, radius } or stl = \"plate.stl\"";
        return Err(wall.fault("has no shape", remedy));
    };
    refuse_without_stl(wall, &["unit", "scale"], key)?;
    let shape = match key {
        "plane" => WallShape::Plane(PlaneShape::read(&Table::of(&field, &PLANE)?)?),
        "box" => WallShape::Box(read_box(&field, "less than", |low, high| low < high)?),
        "cylinder" => WallShape::Cylinder(read_cylinder(&field)?),
        _ => {
            let (path, unit_m) = stl(&field, wall, folder)?;
            let scale = wall.read("scale")?;
            WallShape::Stl {
                path,
                unit_m,
                scale,
            }
        }
    };
    Ok((key, shape))
}

fn list_shape(shape: &WallShape, listing: &mut Listing) {
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
