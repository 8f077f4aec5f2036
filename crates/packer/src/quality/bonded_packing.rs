//! The packing to assess: spheres, their bonds, and the solid that they fill.

use crate::bonds::CrossesSurface;
use crate::sizes::Sizes;
use crate::spheres::Spheres;

/// Largest gap of a contact, as a fraction of the smaller radius: settled spheres keep moving a
/// little until none overlaps, and so stay apart by a few thousandths, seldom more than this.
pub const DEFAULT_GAP_LIMIT: f64 = 0.02;
/// Distance from the wall at which the interior begins, in largest diameters.
pub(super) const INTERIOR_DEPTH_IN_LARGEST_DIAMETERS: f64 = 2.0;
/// Half of the largest thickness that is measured.
pub(super) const CAP_IN_MEAN_DIAMETERS: f64 = 10.0;

/// A packing with its bonds, to be assessed. Lengths in local units of the surface.
#[derive(Clone, Copy)]
pub struct BondedPacking<'a> {
    /// The spheres, with true radii.
    pub spheres: &'a Spheres,
    /// Spheres touch at r_gen = r/(1 + overlap).
    pub overlap: f64,
    /// Bonded pairs, the smaller index first, each once.
    pub bonds: &'a [[u32; 2]],
    /// If the bonds are all pairs up to a multiple of the sum of their radii, except those with
    /// surface between them: that multiple. 0 if the bonds were chosen otherwise.
    pub bond_range: f64,
    /// The requested sizes.
    pub sizes: &'a Sizes,
    /// One local unit in metres.
    pub unit_m: f64,
    /// Volume of the solid, local units cubed.
    pub shape_volume: f64,
    /// Largest corner of the bounding box, whose smallest is the origin. Length 3.
    pub extent: [f64; 3],
    /// Density of the particles' material, kg/m3, if known.
    pub particle_density_kg_m3: Option<f64>,
    /// Distance of each centre to the surface, exact where finite; the others are measured. One per
    /// sphere.
    pub wall_distance: &'a [f64],
    /// Distance of a point to the surface, positive inside the solid; may be infinite farther than
    /// [`depth_needed`]. Outside it is negative or zero, and at most as far below zero as the
    /// surface is away. The only slow part: called a few hundred thousand times.
    pub distance_inside: &'a (dyn Fn([f64; 3]) -> f64 + Sync),
    /// Lower and upper bound of `distance_inside` at a point, if known at less cost than the
    /// distance.
    pub distance_bounds: &'a (dyn Fn([f64; 3]) -> [f64; 2] + Sync),
    /// True if surface lies between two spheres; only called to suggest a bond range.
    pub crosses_surface: CrossesSurface<'a>,
    /// Largest gap of a contact, as a fraction of the smaller radius: [`DEFAULT_GAP_LIMIT`].
    pub gap_limit: f64,
    /// Number of separate parts of the shape: a body with the same number of pieces is complete.
    pub parts: usize,
}

/// Depth in local units beyond which distances to the wall make no difference.
pub fn depth_needed(spheres: &Spheres) -> f64 {
    let largest = 2.0 * spheres.radii.iter().copied().fold(0.0, f64::max);
    (INTERIOR_DEPTH_IN_LARGEST_DIAMETERS * largest)
        .max(CAP_IN_MEAN_DIAMETERS * mean_diameter(spheres))
}

pub(super) fn mean_diameter(spheres: &Spheres) -> f64 {
    2.0 * spheres.radii.iter().sum::<f64>() / spheres.radii.len().max(1) as f64
}
