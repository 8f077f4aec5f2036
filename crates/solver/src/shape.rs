//! Geometry of bodies made of spheres: mass properties, which spheres can be touched, and how a
//! body has turned.

mod caps;
mod cells;
pub mod fit;
pub mod inertia;
pub mod outer_layer;
mod union;
