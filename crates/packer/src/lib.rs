//! Fills a closed surface with overlapping spheres (advancing front, then settling) and joins them by bonds.
//!
//! Everything here works in the local units of the [`dem_io::Surface`], unless a name says otherwise.

pub mod bonds;
pub mod boundary;
pub mod cli;
pub mod density;
pub mod depth_map;
pub mod front;
pub mod grid;
pub mod halo;
pub mod inside;
pub mod ledger;
pub mod make;
pub mod pack;
pub mod quality;
mod rims;
pub mod room;
pub mod seed;
pub mod settle;
pub mod sizes;
pub mod union;

/// A point or direction in local units.
pub type Vector3 = nalgebra::Vector3<f64>;

/// Spheres of a packing, in local units of the surface.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Spheres {
    /// Centres. One per sphere.
    pub positions: Vec<[f64; 3]>,
    /// Radii (not reduced by the overlap). One per sphere.
    pub radii: Vec<f64>,
}
