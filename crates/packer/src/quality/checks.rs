//! The part of a report on which the warnings depend.

use super::bonded_packing::{BondedPacking, INTERIOR_DEPTH_IN_LARGEST_DIAMETERS, mean_diameter};
use super::contacts::{self, Contacts};
use super::fabric::{self, Fabric};
use super::pieces::{self, Pieces};
use super::thickness::{self, Thinnest};
use crate::bonds::suggested_bond_range;
use crate::sizes::{Fit, ks_distance_by_mass, ks_distance_by_number};
use dem_io::Result;

/// Number of bonds per particle below which a body is hardly rigid.
pub(super) const ENOUGH_BONDS: f64 = 4.0;

/// What the warnings depend on.
pub(super) struct Checks {
    pub(super) particles: usize,
    pub(super) bonds_per_particle: f64,
    pub(super) sizes_by_number: Fit,
    pub(super) sizes_by_mass: Fit,
    pub(super) contacts: Contacts,
    pub(super) pieces: Pieces,
    pub(super) interior_fabric: Option<Fabric>,
    pub(super) thinnest: Option<Thinnest>,
    /// Where there are too few bonds.
    pub(super) advised_bond_range: Option<f64>,
}

impl Checks {
    /// `depths` are those of the centres below the wall, local units, one per sphere.
    pub(super) fn new(packing: &BondedPacking, depths: &[f64]) -> Result<Self> {
        let spheres = packing.spheres;
        let particles = spheres.radii.len();
        let diameters_m: Vec<f64> =
            (spheres.radii.iter().map(|r| 2.0 * r * packing.unit_m)).collect();
        let interior_depth = interior_depth(packing);
        let mut checks = Self {
            particles,
            bonds_per_particle: packing.bonds.len() as f64 / particles.max(1) as f64,
            sizes_by_number: ks_distance_by_number(&diameters_m, packing.sizes),
            sizes_by_mass: ks_distance_by_mass(&diameters_m, packing.sizes),
            contacts: contacts::count(packing, depths)?,
            pieces: pieces::find(particles, packing.bonds),
            interior_fabric: fabric::of(spheres, packing.bonds, |i| {
                depths[i as usize] > interior_depth
            }),
            thinnest: thickness::thinnest(packing, depths, mean_diameter(spheres)),
            advised_bond_range: None,
        };
        if particles > 1 && checks.bonds_per_particle < ENOUGH_BONDS {
            checks.advised_bond_range = suggested_bond_range(spheres, packing.crosses_surface);
        }
        Ok(checks)
    }
}

/// Depth at which the interior begins, local units.
pub(super) fn interior_depth(packing: &BondedPacking) -> f64 {
    let largest_radius = packing.spheres.radii.iter().copied().fold(0.0, f64::max);
    INTERIOR_DEPTH_IN_LARGEST_DIAMETERS * 2.0 * largest_radius
}
