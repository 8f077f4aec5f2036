//! The solid that a surface bounds: its wall, its inside, and the depth below the wall.
//!
//! [`tree`] <- [`winding`] <- [`union`] <- [`boundary`] <- [`inside`] <- [`depth_map`].

pub(crate) mod boundary;
pub(crate) mod depth_map;
pub(crate) mod inside;
mod plane;
mod tree;
pub(crate) mod union;
mod winding;
