//! Contact points of a sphere and a wall: plain geometry in the wall's own frame, m.
//!
//! A touch is a point of the wall that is nearer to the centre than the wall around it. A flat or
//! convex wall has one; in a concave corner each side has one. Walls that meet, and the facets of a
//! rough surface, act as one surface: see `one_surface`.
//!
//! Planes, boxes and cylinders are solid: a centre inside is pushed out the shortest way. A
//! [`Mesh`] is a surface with two sides, open or closed: it pushes towards the side of the centre,
//! and a sphere whose centre has passed through is pushed on.

pub mod balls;
pub mod cylinder;
pub mod frame;
pub mod grids;
pub mod mesh;
pub mod one_surface;
pub mod patches;
pub mod plane;
pub mod region;
pub mod solid_box;
pub mod spatial_order;
mod touch;

pub use dem_io::Bounds;
use dem_io::Result;
use serde::Serialize;

pub use cylinder::Cylinder;
pub use frame::Frame;
pub use mesh::Mesh;
pub use one_surface::Place;
use patches::{Divided, Patch, Patches};
pub use plane::Plane;
pub use solid_box::SolidBox;
pub use touch::Touch;

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
        match self {
            Self::Mesh(mesh) => mesh.touches(centre, reach_m, found),
            _ => found.extend(self.only_touch(centre).filter(|t| t.distance_m < reach_m)),
        }
    }

    /// Whether the wall is nearer to `centre` than `reach_m`.
    pub fn is_within(&self, centre: [f64; 3], reach_m: f64) -> bool {
        match self {
            Self::Mesh(mesh) => mesh.is_within(centre, reach_m),
            _ => self
                .only_touch(centre)
                .is_some_and(|touch| touch.distance_m < reach_m),
        }
    }

    /// The nearest point of a wall that has only one. None: of a mesh.
    fn only_touch(&self, centre: [f64; 3]) -> Option<Touch> {
        match self {
            Self::Plane(plane) => Some(plane.touch(centre)),
            Self::Box(solid) => Some(solid.touch(centre)),
            Self::Cylinder(cylinder) => Some(cylinder.touch(centre)),
            Self::Mesh(_) => None,
        }
    }

    /// Points on its surface, in its own frame, m: its corners, and some on its edges and faces; of
    /// a plane a single one.
    pub fn surface_points_m(&self) -> Vec<[f64; 3]> {
        match self {
            Self::Plane(plane) => vec![plane.point_m()],
            Self::Box(solid) => solid.surface_points_m(),
            Self::Cylinder(cylinder) => cylinder.surface_points_m(),
            Self::Mesh(mesh) => mesh.surface_points_m(),
        }
    }

    /// How it is divided into patches.
    fn divided(&self) -> &dyn Divided {
        match self {
            Self::Plane(plane) => plane,
            Self::Box(solid) => solid,
            Self::Cylinder(cylinder) => cylinder,
            Self::Mesh(mesh) => mesh,
        }
    }

    /// The plane, if it is one.
    pub fn plane(&self) -> Option<&Plane> {
        match self {
            Self::Plane(plane) => Some(plane),
            _ => None,
        }
    }

    /// The triangulated surface, if it is one.
    pub fn mesh(&self) -> Option<&Mesh> {
        match self {
            Self::Mesh(mesh) => Some(mesh),
            _ => None,
        }
    }

    /// Whether it is a solid of finite size, out of which a sphere may come on another side than it
    /// went in.
    pub fn is_finite_solid(&self) -> bool {
        match self {
            Self::Box(_) | Self::Cylinder(_) => true,
            Self::Plane(_) | Self::Mesh(_) => false,
        }
    }

    /// What a touch of a sphere of `radius_m` is on. The touch may be in any frame.
    pub fn place(&self, touch: Touch, radius_m: f64) -> Place {
        let feature = touch.feature;
        let (is_flat, is_fine) = match self {
            Self::Plane(_) => (true, false),
            Self::Box(_) => (solid_box::is_face(feature), false),
            Self::Cylinder(_) => (cylinder::is_end(feature), false),
            Self::Mesh(mesh) => (mesh.is_flat(feature), mesh.is_fine(feature, radius_m)),
        };
        Place {
            touch,
            is_flat,
            is_fine,
        }
    }

    /// Whether a point is inside the solid: of a mesh see [`Mesh::holds`].
    pub fn holds(&self, point: [f64; 3]) -> bool {
        match self {
            Self::Mesh(mesh) => mesh.holds(point),
            _ => self.only_touch(point).is_some_and(|t| t.distance_m < 0.0),
        }
    }

    /// Distance of a point from the surface, m; below 0 in a plane, box or cylinder.
    pub fn distance_m(&self, point: [f64; 3]) -> f64 {
        match self {
            Self::Mesh(mesh) => mesh.distance_m(point),
            _ => self
                .only_touch(point)
                .map_or(f64::INFINITY, |t| t.distance_m),
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

impl Divided for Shape {
    fn patches(&self, edge_m: f64) -> Result<Patches> {
        self.divided().patches(edge_m)
    }

    fn count(&self, patches: &Patches) -> Option<u64> {
        self.divided().count(patches)
    }

    fn at(&self, patches: &Patches, point_m: [f64; 3], inward: [f64; 3]) -> u64 {
        self.divided().at(patches, point_m, inward)
    }

    fn patch(&self, patches: &Patches, number: u64) -> Patch {
        self.divided().patch(patches, number)
    }
}
