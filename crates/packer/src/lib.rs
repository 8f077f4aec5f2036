//! Fills the solid of an STL, OBJ, PLY or 3MF file with overlapping spheres and joins them by bonds.
//!
//! [`pack()`] gives the spheres of a [`dem_io::Surface`] in its local units, [`make_body`] a
//! complete body in metres with its bonds and a report on its quality. The spheres are placed by an
//! advancing front (Lozano et al. 2016; Platzer 2022) and settled.
//!
//! ```
//! use dem_io::surface::{ReadSettings, read_surface};
//! use dem_pack::{Basis, PackSettings, Sizes, pack};
//!
//! let stl = std::fs::read("../../data/shapes/bar.stl")?;
//! let reading = ReadSettings { unit_m: Some(1e-3), scale: 1.0, fill_holes: false };
//! let surface = read_surface(&stl, "bar.stl", reading)?;
//! let sizes = Sizes::parse("6mm..8mm", Basis::Number)?;
//! let packing = pack(&surface, &PackSettings::new(sizes), &|_stage, _done| Ok(()))?;
//! assert!(packing.spheres.radii.len() > 200);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod body;
mod bond_spheres;
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

pub use body::{BodyReport, BodySettings, StageSeconds, make_body, make_body_only};
pub use bond_spheres::bond_spheres;
pub use bonds::{
    BondSettings, CrossesSurface, bond_lengths, bond_radii, bond_range_for, find_bonds,
};
pub use density::DensitySearch;
pub use pack::{PackHistory, PackSettings, Packing, Progress, pack};
pub use quality::{
    BondQuality, Contacts, Fabric, Fraction, Layer, Pieces, Report, Thinnest, bond_fabric,
};
pub use sizes::{Basis, Fit, Sizes, ks_distance_by_mass, ks_distance_by_number};
pub use spheres::Spheres;

/// The individual stages, for the tests of this crate. They may change at any time.
#[doc(hidden)]
pub mod internals {
    pub use crate::bonds::{close_pairs, suggested_bond_range};
    pub use crate::density::{
        Begun, MOST_PACKINGS, NEAR_ENOUGH, Try, USUAL_FRACTION, judged, next_overlap, overlap_for,
    };
    pub use crate::front::halo::{Halo, Neighbours};
    pub use crate::geometry::boundary::Boundary;
    pub use crate::geometry::depth_map::DepthMap;
    pub use crate::geometry::inside::{first_hit, is_inside};
    pub use crate::geometry::near_triangles::NearTriangles;
    pub use crate::geometry::union::outer_pieces;
    pub use crate::grid::Grid;
    pub use crate::pack::settle::{Settled, SizeClasses, WallLists, WhenJammed, minimise_overlaps};
    pub use crate::pack::shrink::FillTarget;
    pub use crate::quality::{
        BondedPacking, DEFAULT_GAP_LIMIT, assess, chi_squared_5_exceeds, depth_needed,
    };
    pub use crate::seed::{
        InscribedSphere, deepest_point, first_spheres, inner_points, spread_points,
    };
    pub use crate::sizes::{Curve, SieveCurve, parse_sieve_curve};
    pub use crate::spheres::{ReducedSphere, Vector3};
}
