//! One attempt at a front.

use crate::front::SizeQuota;
use crate::sizes::Sizes;

/// The largest size over the smallest up to which the bare front fills all voids.
const WIDEST_FILLED: f64 = 1.5 + 1e-6;

/// One front.
#[derive(Debug, Clone)]
pub(super) struct Attempt {
    /// Its radii are smaller by this fraction.
    pub(super) shrink: f64,
    /// Voids are filled as it goes: only then the rest counts.
    pub(super) fills_voids: bool,
    /// Spheres placed by the attempt before, if there was one.
    pub(super) expected: Option<f64>,
    /// Surplus of small spheres that is allowed, in roots of the number of spheres.
    pub(super) most_too_many: f64,
    /// The sizes to begin with, which keep back those of which there were too many.
    pub(super) quota: Option<SizeQuota>,
}

/// True if sizes are so alike that all voids can be filled. Wider ones have fewer small spheres
/// than voids: to place them all would change the sizes.
pub(crate) fn can_fill_voids(sizes: &Sizes) -> bool {
    sizes.max_m() <= WIDEST_FILLED * sizes.min_m()
}
