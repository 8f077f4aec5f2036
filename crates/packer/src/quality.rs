//! The quality of a packing: density, sizes, bonds, contacts, fabric, and warnings.

mod bonded_packing;
mod checks;
mod contacts;
mod densities;
mod depth;
mod fabric;
mod pieces;
mod points;
mod report;
mod text;
mod thickness;
mod unshaped;
mod warnings;

use self::bonded_packing::mean_diameter;
pub use self::bonded_packing::{BondedPacking, DEFAULT_GAP_LIMIT, depth_needed};
use self::checks::{Checks, interior_depth};
pub use self::contacts::Contacts;
pub use self::densities::{Fraction, Layer};
pub use self::fabric::{Fabric, chi_squared_5_exceeds, of as bond_fabric};
pub use self::pieces::Pieces;
pub use self::report::Report;
pub use self::thickness::Thinnest;
pub use self::unshaped::BondQuality;
use self::warnings::warnings;
use dem_io::Result;

/// Assesses a packing. The result is the same to the last bit for any number of threads.
pub fn assess(packing: &BondedPacking) -> Result<Report> {
    with_finite_depths(packing, |packing| {
        let depths = depth::of_centres(packing, depth_needed(packing.spheres));
        Ok(report(packing, Checks::new(packing, &depths)?))
    })
}

/// The thinnest part and the warnings of [`assess`] without the rest, of which the densities take
/// longest.
pub(crate) fn find_warnings(packing: &BondedPacking) -> Result<(Option<Thinnest>, Vec<String>)> {
    with_finite_depths(packing, |packing| {
        let depths = depth::of_centres(packing, depth_needed(packing.spheres));
        let checks = Checks::new(packing, &depths)?;
        Ok((checks.thinnest, warnings(&checks, packing.parts)))
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

/// The complete report.
fn report(packing: &BondedPacking, checks: Checks) -> Report {
    let warnings = warnings(&checks, packing.parts);
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
        coarse: checks.thinnest.and_then(|thinnest| thinnest.few()),
        warnings,
    }
}
