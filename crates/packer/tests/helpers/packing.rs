//! Packings with seed 1 unless a test sets another.

use super::facets::Facets;
use super::solids::{local_facets, surface_of};
use dem_pack::{Basis, Sizes};
use dem_pack::{PackSettings, Packing, pack};

pub(crate) fn settings(diameter: &str, overlap: f64, settle: Option<f64>) -> PackSettings {
    PackSettings {
        sizes: Sizes::parse(diameter, Basis::Number).unwrap(),
        overlap,
        seed: 1,
        densify: settle,
        seed_point_m: None,
    }
}

/// The facets in local units, and the packing of the solid that they bound.
pub(crate) fn pack_with(facets: &Facets, settings: &PackSettings) -> (Facets, Packing) {
    let (surface, _) = surface_of(facets);
    let packing = pack(&surface, settings, &|_, _| Ok(())).unwrap();
    (local_facets(&surface), packing)
}
