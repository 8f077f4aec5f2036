//! One attempt at a front.

use crate::front::SizeQuota;
use crate::sizes::Sizes;

/// Largest ratio of the largest to the smallest size for which the bare front fills all voids.
const WIDEST_FILLED: f64 = 1.5 + 1e-6;

/// Settings of one front.
#[derive(Debug, Clone)]
pub(super) struct Attempt {
    /// Fraction by which its radii are reduced.
    pub(super) shrink: f64,
    /// True if voids are filled during the front; the fields below only apply then.
    pub(super) fills_voids: bool,
    /// Number of spheres placed by the previous attempt, if there was one.
    pub(super) expected: Option<f64>,
    /// Allowed surplus of small spheres, in square roots of the number of spheres.
    pub(super) most_too_many: f64,
    /// The quota to begin with, which holds back sizes that were in surplus.
    pub(super) quota: Option<SizeQuota>,
}

/// True if the sizes are similar enough that all voids can be filled. Wider distributions have
/// fewer small spheres than there are voids: placing them all would change the sizes.
pub(crate) fn can_fill_voids(sizes: &Sizes) -> bool {
    sizes.max_m() <= WIDEST_FILLED * sizes.min_m()
}
