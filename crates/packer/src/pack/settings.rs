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
    /// The front runs at radii smaller by this fraction; then they grow to full size. 0: the bare
    /// front. None: by as much as leaves the spheres just short of jamming.
    pub densify: Option<f64>,
    /// Starting point of the front, in metres; the deepest point if not given. Length 3.
    pub seed_point_m: Option<[f64; 3]>,
}

impl PackSettings {
    /// Settled spheres of these sizes with an overlap of 0.25 and seed 1, as the program packs them
    /// unless told otherwise.
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

/// The course of a packing.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct PackHistory {
    /// Starting point of the first front, m. Length 3.
    pub seed_point_m: [f64; 3],
    /// Diameter of the largest ball that fits into the shape, m.
    pub largest_inscribed_diameter_m: f64,
    /// The radii of the front were smaller by this fraction.
    pub densify: f64,
    /// Fronts started: one for each seed, and one for each part that the ones before could not
    /// reach.
    pub fronts: usize,
    /// Steps of the settling minimiser.
    pub densify_steps: usize,
    /// Spheres removed because they were jammed.
    pub removed: usize,
    /// Number of fronts run: again with other sizes kept back where filling the voids had distorted
    /// the distribution, or at other radii where it had left too much room for settling or too
    /// little.
    pub attempts: usize,
    /// Spheres put into voids, of sizes that fit there: by the bare front as it goes, after
    /// settling at the end.
    pub void_fillers: usize,
    /// Those of them that stand where they have most room, and need not touch three others or
    /// walls.
    pub loose_fillers: usize,
    /// Voids that would still take the smallest sphere, about: extrapolated when more fillers would
    /// distort the sizes.
    pub voids_left: usize,
    /// Radii drawn that found no place.
    pub unplaced: usize,
    /// Time for the front, s.
    pub front_seconds: f64,
    /// Time for settling, s.
    pub densify_seconds: f64,
    /// Time for filling voids, s.
    pub fill_seconds: f64,
}

/// Spheres inside a surface, and how they came there.
#[derive(Debug, Clone)]
pub struct Packing {
    /// The spheres, sorted along a space-filling curve.
    pub spheres: Spheres,
    /// The course of the packing.
    pub history: PackHistory,
}

/// Called with the stage and the fraction of it that is done (0 to 1); an error stops the work.
pub type Progress<'a> = &'a dyn Fn(&str, f64) -> Result<()>;
