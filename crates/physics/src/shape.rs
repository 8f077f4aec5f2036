//! Geometry of bodies made of spheres: mass properties, outer spheres, and rotation of a body.

mod caps;
mod cells;
pub mod fit;
pub mod hull;
pub mod inertia;
pub mod landing;
pub mod outer_layer;
pub mod packing_fit;
pub mod sieve;
pub mod union;
