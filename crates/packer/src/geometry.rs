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

/// A surface in millimetres, for tests.
#[cfg(test)]
pub(crate) fn surface_in_mm(stl: &[u8]) -> dem_io::Result<dem_io::Surface> {
    let settings = dem_io::surface::ReadSettings {
        unit_m: Some(1e-3),
        scale: 1.0,
        fill_holes: false,
    };
    dem_io::surface::read_surface(stl, "shape", settings)
}
