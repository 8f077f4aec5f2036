//! The quality of a packing: density, sizes, bonds, contacts, fabric, and warnings.

mod bonded_packing;
mod contacts;
mod densities;
mod depth;
mod fabric;
mod pieces;
mod points;
mod report;
mod text;
mod thickness;
mod warnings;

pub use self::bonded_packing::{BondedPacking, DEFAULT_GAP_LIMIT, depth_needed};
use self::bonded_packing::{INTERIOR_DEPTH_IN_LARGEST_DIAMETERS, mean_diameter};
pub use self::contacts::Contacts;
pub use self::densities::{Fraction, Layer};
pub use self::fabric::{Fabric, chi_squared_5_exceeds};
pub use self::pieces::Pieces;
pub use self::report::Report;
pub use self::thickness::Thinnest;
use self::warnings::{ENOUGH_BONDS, warnings};
use crate::bonds::suggested_bond_range;
use crate::sizes::{Fit, ks_distance_by_mass, ks_distance_by_number};
use dem_io::Result;

/// Assesses a packing. The result is the same to the last bit for any number of threads.
///
/// # Errors
/// More spheres than the search tree can number (2^32).
pub fn assess(packing: &BondedPacking) -> Result<Report> {
    with_finite_depths(packing, |packing| {
        let depths = depth::of_centres(packing, depth_needed(packing.spheres));
        let checks = Checks::new(packing, &depths)?;
        Ok(report(packing, checks))
    })
}

/// The warnings of [`assess`] without what no warning needs, of which the densities take longest.
///
/// # Errors
/// As [`assess`].
pub(crate) fn find_warnings(packing: &BondedPacking) -> Result<Vec<String>> {
    with_finite_depths(packing, |packing| {
        let depths = depth::of_centres(packing, depth_needed(packing.spheres));
        Ok(Checks::new(packing, &depths)?.warnings)
    })
}

/// Calls `judge` with the same packing, whose distances inside are limited to those needed: a
/// finite distance also bounds those of the points around.
fn with_finite_depths<T>(
    packing: &BondedPacking,
    judge: impl FnOnce(&BondedPacking) -> Result<T>,
) -> Result<T> {
    let far = depth_needed(packing.spheres);
    let distance_inside = |point| (packing.distance_inside)(point).clamp(-far, far);
    judge(&BondedPacking {
        distance_inside: &distance_inside,
        ..*packing
    })
}

/// The part of a report on which the warnings depend.
struct Checks {
    particles: usize,
    bonds_per_particle: f64,
    sizes_by_number: Fit,
    sizes_by_mass: Fit,
    contacts: Contacts,
    pieces: Pieces,
    interior_fabric: Option<Fabric>,
    thinnest: Option<Thinnest>,
    warnings: Vec<String>,
}

impl Checks {
    /// `depths` are those of the centres below the wall, local units, one per sphere.
    fn new(packing: &BondedPacking, depths: &[f64]) -> Result<Self> {
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
            warnings: Vec::new(),
        };
        let advised = if particles > 1 && checks.bonds_per_particle < ENOUGH_BONDS {
            suggested_bond_range(spheres, packing.crosses_surface)
        } else {
            None
        };
        checks.warnings = warnings(&checks, advised, packing.parts);
        Ok(checks)
    }
}

/// Depth at which the interior begins, local units.
fn interior_depth(packing: &BondedPacking) -> f64 {
    let largest_radius = packing.spheres.radii.iter().copied().fold(0.0, f64::max);
    INTERIOR_DEPTH_IN_LARGEST_DIAMETERS * 2.0 * largest_radius
}

/// The complete report.
fn report(packing: &BondedPacking, checks: Checks) -> Report {
    let spheres = packing.spheres;
    let unit = packing.unit_m;
    let (interior_depth, mean_diameter) = (interior_depth(packing), mean_diameter(spheres));
    let volume: f64 = spheres
        .radii
        .iter()
        .map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3))
        .sum();
    let fraction_if_disjoint = volume / packing.shape_volume;
    let sampled = densities::sample(packing, interior_depth, mean_diameter);
    Report {
        particles: checks.particles,
        bonds: packing.bonds.len(),
        bond_range: packing.bond_range,
        mean_diameter_m: mean_diameter * unit,
        overlap: packing.overlap,
        shape_volume_m3: packing.shape_volume * unit.powi(3),
        solid_density_kg_m3: packing
            .particle_density_kg_m3
            .map(|density| density * fraction_if_disjoint),
        union_density: sampled.union_density,
        generating_density: fraction_if_disjoint / (1.0 + packing.overlap).powi(3),
        interior_depth_m: interior_depth * unit,
        interior_union_density: sampled.interior_union_density,
        interior_generating_density: sampled.interior_generating_density,
        wall_profile: sampled.wall_profile,
        slab_profile: sampled.slab_profile,
        sizes_by_number: checks.sizes_by_number,
        sizes_by_mass: checks.sizes_by_mass,
        bonds_per_particle: checks.bonds_per_particle,
        mean_coordination: 2.0 * checks.bonds_per_particle,
        contacts: checks.contacts,
        pieces: checks.pieces,
        fabric: fabric::of(spheres, packing.bonds, |_| true),
        interior_fabric: checks.interior_fabric,
        thinnest: checks.thinnest,
        warnings: checks.warnings,
    }
}
