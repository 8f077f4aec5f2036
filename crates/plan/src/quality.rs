//! Warnings about bodies that no program has looked at: from a table, or written in the scene.
//! Those
//! of dem-pack are in its files.

use std::collections::BTreeMap;

use dem_io::Body;
use dem_io::disjoint::DisjointSets;
use dem_io::units::{show_length, significant};
use dem_scene::Scene;

use super::bodies::stays_rigid;
use dem_engine::state::clusters::sizes::{Sphere, box_lengths_m};

/// As dem-pack: number of bonds per particle below which a body is hardly rigid, and of particles
/// across below which a body shows its particles more than its material.
const ENOUGH_BONDS: f64 = 3.0;
const ENOUGH_ACROSS: f64 = 10.0;
/// A body of fewer spheres is written by hand, and no packing.
const FEWEST: usize = 20;
/// Width of a chain of spheres over the largest diameter.
const CHAIN: f64 = 1.05;

/// Warnings about the bonded bodies that no program has made, by name.
pub(super) fn warnings(
    scene: &Scene,
    read: &BTreeMap<String, Body>,
) -> BTreeMap<String, Vec<String>> {
    let unseen = read.iter().filter(|(name, body)| {
        let is_bonded = !body.bonds.is_empty() && !stays_rigid(scene, name);
        is_bonded && body.about.program.is_none() && body.about.warnings.is_empty()
    });
    unseen
        .map(|(name, body)| (name.clone(), of_body(body)))
        .collect()
}

fn of_body(body: &Body) -> Vec<String> {
    let count = body.radii.len();
    let mut warnings = Vec::new();
    let mut sets = DisjointSets::new(count);
    for [a, b] in &body.bonds {
        sets.join(*a, *b);
    }
    let (mut pieces, mut largest) = (0, 0);
    for particle in 0..count as u32 {
        if sets.root(particle) == particle {
            pieces += 1;
            largest = largest.max(sets.size(particle) as usize);
        }
    }
    if pieces > 1 {
        warnings.push(format!(
            "it is in {pieces} pieces: {} of {count} particles are not bonded to the largest; add bonds that join them, or make each piece a body of its own",
            count - largest
        ));
    }
    let spheres: Vec<Sphere> = (body.positions.iter().zip(&body.radii))
        .map(|(place, radius)| Sphere::of_unit_density(*place, *radius))
        .collect();
    let [_, width_m, thickness_m] = box_lengths_m(&spheres);
    let diameter_m = 2.0 * body.radii.iter().copied().fold(0.0, f64::max);
    // A bar of single spheres is no packing: its bonds are the material.
    if count < FEWEST || width_m <= CHAIN * diameter_m {
        return warnings;
    }
    let volume = |radius: &f64| radius.powi(3);
    let cubes: f64 = body.radii.iter().map(volume).sum();
    let mean_m = 2.0 * body.radii.iter().map(|r| r * volume(r)).sum::<f64>() / cubes;
    let across = thickness_m / mean_m;
    if across.round() < ENOUGH_ACROSS {
        warnings.push(format!(
            "only about {} particles across the thinnest side of its box ({}): fewer than {ENOUGH_ACROSS} show the particles more than the material; use diameters around {} or less",
            significant(across, 2),
            show_length(thickness_m),
            show_length(thickness_m / ENOUGH_ACROSS),
        ));
    }
    let bonds = body.bonds.len() as f64 / count as f64;
    if bonds < ENOUGH_BONDS {
        warnings.push(format!(
            "{} bonds per particle, fewer than {ENOUGH_BONDS} are hardly rigid; join more neighbours",
            significant(bonds, 3)
        ));
    }
    warnings
}
