//! The order of spheres in memory.

use crate::grid::curve_position;
use crate::spheres::ReducedSphere;

/// Sorts spheres by the Morton code of cells of edge 4 `radius`, so that neighbours in space are
/// neighbours in memory.
pub(super) fn sort_along_curve(spheres: &mut [ReducedSphere], radius: f64) {
    spheres.sort_by_cached_key(|s| curve_position([s[0], s[1], s[2]], 4.0 * radius));
}
