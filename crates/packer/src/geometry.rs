//! The solid that a surface bounds: its wall, its inside, and the depth below the wall.
//!
//! [`tree`] <- [`winding`] <- [`union`] <- [`boundary`] <- [`inside`] <- [`depth_map`];
//! [`nearest`] <- [`eight_triangles`] <- [`wall_eights`] <- [`boundary`] <- [`near_triangles`].

pub(crate) mod boundary;
pub(crate) mod depth_map;
mod eight_triangles;
pub(crate) mod inside;
pub(crate) mod near_triangles;
pub(crate) mod nearest;
mod plane;
mod tree;
pub(crate) mod union;
mod wall_eights;
mod winding;
