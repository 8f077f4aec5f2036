//! Fills a closed surface with overlapping spheres (advancing front, then settling) and joins them by
//! bonds.

mod body;
mod bonds;
pub mod cli;
mod density;
mod front;
mod geometry;
mod grid;
mod pack;
mod quality;
mod seed;
mod sizes;
mod spheres;

pub use body::{BodyReport, BodySettings, StageSeconds, make_body};
pub use bonds::{CrossesSurface, bond_lengths, bond_radii, bonding_radius_for, find_bonds};
pub use density::DensitySearch;
pub use pack::{PackHistory, PackSettings, Packing, Progress, pack};
pub use quality::{Contacts, Fabric, Fraction, Layer, Pieces, Report, Thinnest};
pub use sizes::{Basis, Fit, Sizes, ks_distance_by_mass, ks_distance_by_number};
pub use spheres::Spheres;

/// Stages one by one, for the tests of this crate: they may change at any time.
#[doc(hidden)]
pub mod internals {
    pub use crate::bonds::{close_pairs, suggested_bonding_radius};
    pub use crate::front::halo::{Halo, Neighbours};
    pub use crate::geometry::boundary::Boundary;
    pub use crate::geometry::depth_map::DepthMap;
    pub use crate::geometry::inside::{first_hit, is_inside};
    pub use crate::geometry::union::outer_pieces;
    pub use crate::pack::settle::{Settled, WhenJammed, minimise_overlaps};
    pub use crate::pack::shrink::FillTarget;
    pub use crate::quality::{BondedPacking, DEFAULT_GAP_LIMIT, assess, depth_needed};
    pub use crate::seed::{
        InscribedSphere, deepest_point, first_spheres, inner_points, spread_points,
    };
    pub use crate::spheres::{ReducedSphere, Vector3};
}
