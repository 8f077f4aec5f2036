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
use crate::sizes::{ks_distance_by_mass, ks_distance_by_number};
use dem_io::Result;

/// Assesses a packing. The result is the same to the last bit for any number of threads.
///
/// # Errors
/// More spheres than the search tree can number (2^32).
pub fn assess(packing: &BondedPacking) -> Result<Report> {
    let far = depth_needed(packing.spheres);
    // A finite distance also bounds those of the points around.
    let distance_inside = |point| (packing.distance_inside)(point).clamp(-far, far);
    let packing = &BondedPacking {
        distance_inside: &distance_inside,
        ..*packing
    };
    let spheres = packing.spheres;
    let unit = packing.unit_m;
    let count = spheres.radii.len();
    let largest_diameter = 2.0 * spheres.radii.iter().copied().fold(0.0, f64::max);
    let mean_diameter = mean_diameter(spheres);
    let interior_depth = INTERIOR_DEPTH_IN_LARGEST_DIAMETERS * largest_diameter;
    let volume: f64 = spheres
        .radii
        .iter()
        .map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3))
        .sum();
    let fraction_if_disjoint = volume / packing.shape_volume;

    let depths = depth::of_centres(packing, far);
    let sampled = densities::sample(packing, interior_depth, mean_diameter);
    let diameters_m: Vec<f64> = spheres.radii.iter().map(|r| 2.0 * r * unit).collect();
    let bonds_per_particle = packing.bonds.len() as f64 / count.max(1) as f64;

    let mut report = Report {
        particles: count,
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
        sizes_by_number: ks_distance_by_number(&diameters_m, packing.sizes),
        sizes_by_mass: ks_distance_by_mass(&diameters_m, packing.sizes),
        bonds_per_particle,
        mean_coordination: 2.0 * bonds_per_particle,
        contacts: contacts::count(packing, &depths)?,
        pieces: pieces::find(count, packing.bonds),
        fabric: fabric::of(spheres, packing.bonds, |_| true),
        interior_fabric: fabric::of(spheres, packing.bonds, |i| {
            depths[i as usize] > interior_depth
        }),
        thinnest: thickness::thinnest(packing, &depths, mean_diameter),
        warnings: Vec::new(),
    };
    let advised = if count > 1 && bonds_per_particle < ENOUGH_BONDS {
        suggested_bond_range(spheres, packing.crosses_surface)
    } else {
        None
    };
    report.warnings = warnings(&report, advised, packing.parts);
    Ok(report)
}
