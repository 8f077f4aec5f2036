//! How good a packing is: density, sizes, bonds, contacts, fabric, and what a user should know before using it.

mod contacts;
mod densities;
mod depth;
mod fabric;
mod pieces;
mod points;
mod text;
mod thickness;

use crate::Spheres;
use crate::bonds::{CrossesSurface, WELL_BONDED, suggested_bonding_radius};
use crate::sizes::{Fit, Sizes, ks_distance_by_mass, ks_distance_by_number};
pub use contacts::Contacts;
use dem_io::Result;
use dem_io::units::{show_length, significant};
pub use densities::{Layer, Share};
pub use fabric::Fabric;
pub use pieces::Pieces;
use serde::{Deserialize, Serialize};
pub use thickness::Thinnest;

/// Contacts are counted up to a gap of this share of the smaller radius: settled spheres keep moving a little until none overlaps, and
/// so stay apart by a few thousandths, seldom more than this.
pub const DEFAULT_GAP_LIMIT: f64 = 0.02;
/// The interior begins so many largest diameters from the wall.
pub const INTERIOR_DEPTH_IN_LARGEST_DIAMETERS: f64 = 2.0;
/// Below so many particles across, a body shows its particles more than its material.
const ENOUGH_ACROSS: f64 = 10.0;
/// A body with fewer bonds per particle is hardly rigid.
const ENOUGH_BONDS: f64 = 4.0;
/// Overlaps (in r_gen) and protrusions beyond this share of a radius are not rounding.
const EXACT: f64 = 1e-9;
/// Sizes are called wrong beyond so many times the statistical limit: chance alone goes beyond once in 2,000 packings,
/// beyond the limit itself once in 20.
const CLEARLY_OFF: f64 = 1.5;
/// A fabric that chance makes more rarely than this is called anisotropic.
const RARE: f64 = 0.01;

/// What is to be judged. Lengths in local units of the surface.
#[derive(Clone, Copy)]
pub struct Packing<'a> {
    /// The spheres, with true radii.
    pub spheres: &'a Spheres,
    /// Spheres touch at r_gen = r/(1 + overlap).
    pub overlap: f64,
    /// Bonded pairs, the smaller index first, each once.
    pub bonds: &'a [[u32; 2]],
    /// The bonds are all pairs up to this times the sum of their radii, but for those with surface between them; 0 if the
    /// bonds were chosen otherwise.
    pub bonding_radius: f64,
    /// The sizes that were asked for.
    pub sizes: &'a Sizes,
    /// One local unit in metres.
    pub unit_m: f64,
    /// Volume of the solid, local units cubed.
    pub shape_volume: f64,
    /// Largest corner of the bounding box, whose smallest is the origin. Length 3.
    pub extent: [f64; 3],
    /// Density of the particles' material, kg/m3, if known.
    pub particle_density_kg_m3: Option<f64>,
    /// Distance of each centre to the surface, exact where finite; the others are measured. One per sphere.
    pub wall_distance: &'a [f64],
    /// Distance of a point to the surface, positive inside the solid; may be infinite farther than [`depth_needed`].
    /// Outside it is negative or zero, and at most as far below zero as the surface is away. The only slow part: called a
    /// few hundred thousand times.
    pub distance_inside: &'a (dyn Fn([f64; 3]) -> f64 + Sync),
    /// Least and largest value that `distance_inside` can have at a point, if that is known for less than the distance costs.
    pub distance_bounds: &'a (dyn Fn([f64; 3]) -> [f64; 2] + Sync),
    /// Whether surface lies between two spheres; asked only to advise a bonding radius.
    pub crosses_surface: CrossesSurface<'a>,
    /// Largest gap of a contact, as a share of the smaller radius: [`DEFAULT_GAP_LIMIT`].
    pub gap_limit: f64,
    /// Separate parts of the shape: a body in as many pieces is whole.
    pub parts: usize,
}

/// Distances to the wall matter up to here, local units; farther is all the same.
pub fn depth_needed(spheres: &Spheres) -> f64 {
    let largest = 2.0 * spheres.radii.iter().copied().fold(0.0, f64::max);
    (INTERIOR_DEPTH_IN_LARGEST_DIAMETERS * largest)
        .max(thickness::CAP_IN_MEAN_DIAMETERS * mean_diameter(spheres))
}

fn mean_diameter(spheres: &Spheres) -> f64 {
    2.0 * spheres.radii.iter().sum::<f64>() / spheres.radii.len().max(1) as f64
}

/// How good a packing is. Shares are between 0 and 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Number of spheres.
    pub particles: usize,
    /// Number of bonds.
    pub bonds: usize,
    /// They are all pairs up to this times the sum of their radii, but for those with surface between them; 0 if they were
    /// chosen otherwise.
    pub bonding_radius: f64,
    /// Mean diameter by number, m.
    pub mean_diameter_m: f64,
    /// Overlap of the packing.
    pub overlap: f64,
    /// Volume of the solid, m3.
    pub shape_volume_m3: f64,
    /// Sum of the particles' masses divided by the volume of the solid, kg/m3.
    pub solid_density_kg_m3: Option<f64>,
    /// Share of the solid filled by the union of the spheres.
    pub union_density: Share,
    /// Share of the solid filled by the spheres reduced to r_gen, which do not overlap: exact.
    pub generating_density: f64,
    /// Depth at which the interior begins, m: two largest diameters.
    pub interior_depth_m: f64,
    /// Share of the interior filled by the union of the spheres. None without interior.
    pub interior_union_density: Option<Share>,
    /// Share of the interior filled by the spheres reduced to r_gen. None without interior.
    pub interior_generating_density: Option<Share>,
    /// Density (r_gen) in layers from the wall inwards, a quarter of a mean diameter each.
    pub wall_profile: Vec<Layer>,
    /// Density (r_gen) of the interior in ten slabs along the longest side of the shape.
    pub slab_profile: Vec<Layer>,
    /// Sizes placed against sizes asked for, by number.
    pub sizes_by_number: Fit,
    /// Sizes placed against sizes asked for, by mass.
    pub sizes_by_mass: Fit,
    /// Bonds divided by particles, as the thesis counts (4.87).
    pub bonds_per_particle: f64,
    /// Mean number of bonds that a particle has: twice as many.
    pub mean_coordination: f64,
    /// Who touches whom.
    pub contacts: Contacts,
    /// What the bonds hold together.
    pub pieces: Pieces,
    /// Directions of all bonds. None without bonds.
    pub fabric: Option<Fabric>,
    /// Directions of the bonds of the interior: those with one end in it count half. None without such.
    pub interior_fabric: Option<Fabric>,
    /// The thinnest part. None without particles.
    pub thinnest: Option<Thinnest>,
    /// One sentence for each thing that a user should know, with advice.
    pub warnings: Vec<String>,
}

impl Report {
    /// The report for a person, about twenty aligned lines.
    pub fn text(&self) -> String {
        text::of(self)
    }
}

/// Judges a packing. Same result to the last bit for any number of threads.
///
/// # Errors
/// More spheres than the search tree can number (2^32).
pub fn assess(packing: &Packing) -> Result<Report> {
    let far = depth_needed(packing.spheres);
    // Finite, a distance also bounds those of the points around.
    let distance_inside = |point| (packing.distance_inside)(point).clamp(-far, far);
    let packing = &Packing {
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
    let share_if_disjoint = volume / packing.shape_volume;

    let depths = depth::of_centres(packing, far);
    let sampled = densities::sample(packing, interior_depth, mean_diameter);
    let diameters_m: Vec<f64> = spheres.radii.iter().map(|r| 2.0 * r * unit).collect();
    let bonds_per_particle = packing.bonds.len() as f64 / count.max(1) as f64;

    let mut report = Report {
        particles: count,
        bonds: packing.bonds.len(),
        bonding_radius: packing.bonding_radius,
        mean_diameter_m: mean_diameter * unit,
        overlap: packing.overlap,
        shape_volume_m3: packing.shape_volume * unit.powi(3),
        solid_density_kg_m3: packing
            .particle_density_kg_m3
            .map(|density| density * share_if_disjoint),
        union_density: sampled.union_density,
        generating_density: share_if_disjoint / (1.0 + packing.overlap).powi(3),
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
        suggested_bonding_radius(spheres, packing.crosses_surface)
    } else {
        None
    };
    report.warnings = warnings(&report, advised, packing.parts);
    Ok(report)
}

fn warnings(report: &Report, advised_bonding_radius: Option<f64>, parts: usize) -> Vec<String> {
    let mut warnings = Vec::new();
    let contacts = &report.contacts;
    if contacts.largest_overlap > EXACT {
        warnings.push(format!(
            "spheres overlap in r_gen by up to {} of a radius: the packing is not finished: please report the command",
            significant(contacts.largest_overlap, 2)
        ));
    }
    if contacts.largest_protrusion > EXACT {
        warnings.push(format!(
            "spheres stand out of the surface by up to {} of a radius: please report the command",
            significant(contacts.largest_protrusion, 2)
        ));
    }
    if let Some(thinnest) = report
        .thinnest
        .as_ref()
        .filter(|t| t.particles_across.round() < ENOUGH_ACROSS)
    {
        warnings.push(format!(
            "only about {} particles across the thinnest part ({}): fewer than {ENOUGH_ACROSS} show the particles more than the \
             material; use diameters around {} or less",
            significant(thinnest.particles_across, 2),
            show_length(thinnest.thickness_m),
            show_length(significant_down(thinnest.thickness_m / ENOUGH_ACROSS)),
        ));
    }
    let pieces = &report.pieces;
    if pieces.count > parts.max(1) {
        warnings.push(format!(
            "the body is in {} pieces: {} of {} particles are not bonded to the largest; a larger --bonding-radius or smaller \
             particles join them",
            pieces.count, pieces.outside_largest, report.particles
        ));
    }
    if report.particles > 1 && report.bonds_per_particle < ENOUGH_BONDS {
        let advice = match advised_bonding_radius {
            Some(radius) => format!("--bonding-radius {radius} gives {WELL_BONDED}"),
            None => "use smaller particles".to_owned(),
        };
        warnings.push(format!(
            "{} bonds per particle, fewer than {ENOUGH_BONDS} are hardly rigid; {advice}",
            significant(report.bonds_per_particle, 3)
        ));
    }
    for (fit, by) in [
        (report.sizes_by_number, "number"),
        (report.sizes_by_mass, "mass"),
    ] {
        if fit.distance > CLEARLY_OFF * fit.limit_95 {
            warnings.push(format!(
                "sizes are off by {} by {by} (Kolmogorov-Smirnov), chance seldom exceeds {}; use a shape larger beside the \
                 particles, or a narrower distribution",
                significant(fit.distance, 2),
                significant(fit.limit_95, 2)
            ));
        }
    }
    if let Some(fabric) = report.interior_fabric.as_ref().filter(|f| f.chance < RARE) {
        warnings.push(format!(
            "bonds prefer a direction in the interior (eigenvalue {} off by {} sigma, chance {}): cracks will too; another \
             --seed or a larger --settle helps",
            significant(fabric.eigenvalues[0], 3),
            significant(fabric.largest_deviation_in_sigma, 2),
            significant(fabric.chance, 1)
        ));
    }
    warnings
}

/// Rounded down to two digits.
fn significant_down(value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let step = 10.0_f64.powf(value.log10().floor() - 1.0);
    (value / step * (1.0 + 1e-12)).floor() * step
}
