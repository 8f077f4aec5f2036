//! Contact points of a sphere and a wall: plain geometry in the wall's own frame, m.
//!
//! A touch is a point of the wall that is nearer to the centre than the wall around it. A flat or
//! convex wall has one; in a concave corner each side has one.
//!
//! Planes, boxes and cylinders are solid: a centre inside is pushed out the shortest way. A
//! [`Mesh`] is a surface with two sides, open or closed: it pushes towards the side of the centre,
//! and a sphere whose centre has passed through is pushed on.

pub(crate) mod cylinder;
pub(crate) mod frame;
pub(crate) mod mesh;
pub(crate) mod plane;
pub(crate) mod solid_box;

pub use dem_io::Bounds;
use nalgebra::Vector3;
use serde::Serialize;

pub use cylinder::Cylinder;
pub use frame::Frame;
pub use mesh::Mesh;
pub use plane::Plane;
pub use solid_box::SolidBox;

/// A point where a sphere may touch a wall. `point = centre + distance_m * normal`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Nearest point of the wall's surface, m. Length 3.
    pub point: [f64; 3],
    /// Unit vector into the wall: from the centre towards the point, or away from it if the centre
    /// is inside a solid. Length 3.
    pub normal: [f64; 3],
    /// From the centre to the point, m; negative if the centre is inside a solid.
    pub distance_m: f64,
    /// Flat part, straight edge, corner, ... of the wall: stays the same while a sphere slides over
    /// it. The numbering depends on the shape.
    pub feature: u32,
}

/// Points nearer than this coincide: its square does not underflow.
const SMALLEST_M: f64 = 1e-100;

impl Touch {
    /// Touch from the centre `c` to the `point`; with the normal `otherwise` if they coincide.
    fn towards(
        c: Vector3<f64>,
        point: Vector3<f64>,
        otherwise: Vector3<f64>,
        feature: u32,
    ) -> Self {
        let apart = point - c;
        let distance_m = apart.norm();
        let normal = if distance_m > SMALLEST_M {
            apart / distance_m
        } else {
            otherwise
        };
        Self {
            point: point.into(),
            normal: normal.into(),
            distance_m,
            feature,
        }
    }

    /// Touch for a centre `c` on or under the surface, whose normal out of the wall is `outward`.
    fn under(c: Vector3<f64>, outward: Vector3<f64>, depth_m: f64, feature: u32) -> Self {
        Self {
            point: (c + depth_m * outward).into(),
            normal: (-outward).into(),
            distance_m: -depth_m,
            feature,
        }
    }
}

/// The shape of a wall.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub enum Shape {
    /// A half-space.
    Plane(Plane),
    /// A solid box.
    Box(SolidBox),
    /// A solid cylinder.
    Cylinder(Cylinder),
    /// A triangulated surface.
    Mesh(Mesh),
}

impl Default for Shape {
    /// A plane without direction, as a placeholder.
    fn default() -> Self {
        Self::Plane(Plane::default())
    }
}

impl Shape {
    /// Adds all points where the wall is nearer than `reach_m` to `centre`, each once. Equal input
    /// gives equal order.
    pub fn touches(&self, centre: [f64; 3], reach_m: f64, found: &mut Vec<Touch>) {
        let touch = match self {
            Self::Plane(plane) => plane.touch(centre),
            Self::Box(solid) => solid.touch(centre),
            Self::Cylinder(cylinder) => cylinder.touch(centre),
            Self::Mesh(mesh) => return mesh.touches(centre, reach_m, found),
        };
        if touch.distance_m < reach_m {
            found.push(touch);
        }
    }

    /// The box around it, m. Infinite for a plane.
    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Plane(plane) => plane.bounds(),
            Self::Box(solid) => solid.bounds(),
            Self::Cylinder(cylinder) => cylinder.bounds(),
            Self::Mesh(mesh) => mesh.bounds(),
        }
    }
}

/// Whether all numbers are finite.
fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|x| x.is_finite())
}
