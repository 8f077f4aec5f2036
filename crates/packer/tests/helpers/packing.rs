//! Packings with seed 1 unless a test says otherwise.

use super::facets::Facets;
use super::solids::{local_facets, surface_of};
use dem_pack::pack::{PackSettings, Packing, pack};
use dem_pack::sizes::{By, Sizes};

pub(crate) fn settings(diameter: &str, overlap: f64, settle: Option<f64>) -> PackSettings {
    PackSettings {
        sizes: Sizes::parse(diameter, By::Number).unwrap(),
        overlap,
        seed: 1,
        settle,
        seed_point_m: None,
    }
}

/// The facets in local units, and the packing of the solid that they bound.
pub(crate) fn pack_with(facets: &Facets, settings: &PackSettings) -> (Facets, Packing) {
    let (surface, boundary) = surface_of(facets);
    let packing = pack(&surface, &boundary, settings, &|_, _| Ok(())).unwrap();
    (local_facets(&surface), packing)
}
