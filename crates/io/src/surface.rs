//! The closed surface of a solid, ready for use: welded, oriented, repaired, checked.
//!
//! # Inside
//! The signed crossings of a ray from a point with all triangles (+1 where it leaves the solid
//! through one, -1 where it enters) add up to the winding number of the surface around the point.
//! The solid is where it is positive. For shells that do not cross, this is "inside an outer shell
//! and in no cavity"; shells that cross or overlap form their union.

pub(crate) mod build;

mod duplicates;
mod frame;
mod holes;
mod intersections;
mod mesh;
mod nesting;
pub(crate) mod open;
mod rays;
mod refusals;
mod sets;
mod shells;
mod solid;
mod t_junctions;
mod union_volume;
mod warnings;
mod weld;

pub use build::{ReadSettings, read_surface};
pub use open::{OpenSurface, read_open_surface};
pub use solid::{Repairs, Shell, Surface};
