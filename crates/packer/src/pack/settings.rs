//! Settings and results of a packing.

use crate::sizes::Sizes;
use crate::spheres::Spheres;
use dem_io::Result;
use serde::Serialize;

/// Settings of a packing.
#[derive(Debug, Clone)]
pub struct PackSettings {
    /// Diameters of the spheres.
    pub sizes: Sizes,
    /// Spheres touch at reduced radius = radius / (1 + overlap).
    pub overlap: f64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Fraction by which the front's radii are reduced before they grow to full size. 0: the bare
    /// front. None: chosen so that the spheres are just short of jamming.
    pub densify: Option<f64>,
    /// Starting point of the front, m; the deepest point if not given. Length 3.
    pub seed_point_m: Option<[f64; 3]>,
}

impl PackSettings {
    /// The program's defaults: settled spheres of these sizes with an overlap of 0.25 and seed 1.
    pub fn new(sizes: Sizes) -> Self {
        Self {
            sizes,
            overlap: 0.25,
            seed: 1,
            densify: None,
            seed_point_m: None,
        }
    }
}

/// History of a packing.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct PackHistory {
    /// Starting point of the first front, m. Length 3.
    pub seed_point_m: [f64; 3],
    /// Diameter of the largest ball that fits into the shape, m.
    pub largest_inscribed_diameter_m: f64,
    /// Fraction by which the front's radii were reduced.
    pub densify: f64,
    /// Number of fronts started: one for each seed, and one for each part that the earlier ones
    /// could not reach.
    pub fronts: usize,
    /// Number of spheres scattered at random, largest first, instead of those of the fronts, which
    /// had stopped early. 0 if the spheres are those of the fronts.
    pub scattered: usize,
    /// Number of steps of the settling minimiser.
    pub densify_steps: usize,
    /// Number of spheres of the front that were too many, and left out evenly: before settling, and
    /// while settling where they jammed.
    pub thinned: usize,
    /// Number of spheres removed because they were jammed.
    pub removed: usize,
    /// Number of fronts run. More than one: with some sizes held back because filling the voids had
    /// distorted the distribution, or at other radii because there was too much or far too little
    /// room for settling.
    pub attempts: usize,
    /// Number of spheres put into voids, of sizes that fit there: by the bare front as it advances,
    /// or at the end after settling.
    pub void_fillers: usize,
    /// Number of these at places with the most room, which need not touch three other spheres or
    /// walls.
    pub loose_fillers: usize,
    /// Approximate number of voids that would still take the smallest sphere: extrapolated when
    /// more fillers would distort the sizes.
    pub voids_left: usize,
    /// Part of the solid in which the centre of the smallest sphere could still lie, 0 to 1, from
    /// random points; 0 for a bare front that fills its voids.
    pub room_left: f64,
    /// Number of drawn radii that found no place.
    pub unplaced: usize,
    /// Time for the front, s.
    pub front_seconds: f64,
    /// Time for settling, s.
    pub densify_seconds: f64,
    /// Time for filling voids, s.
    pub fill_seconds: f64,
}

/// Spheres inside a surface, and the history of their packing.
#[derive(Debug, Clone)]
pub struct Packing {
    /// The spheres, sorted along a space-filling curve.
    pub spheres: Spheres,
    /// History of the packing.
    pub history: PackHistory,
}

/// Called with the stage and the completed fraction of it (0 to 1); an error stops the work.
pub type Progress<'a> = &'a dyn Fn(&str, f64) -> Result<()>;
