//! Relaxation after breakage: two particles of one parent that no longer belong to the same cluster
//! may overlap without ever having been in contact.
//!
//! Source: Platzer 2022, section 4.3 (algorithm 4 with its comparison corrected). The overlap d0 at
//! separation is the origin of their contact law: force law(d - d0) for d > d0. For d < d0 there is
//! no force and d0 becomes d; below a least overlap the pair is ordinary again. So fracture
//! surfaces can press on each other but never fly apart.
//!
//! A least overlap above 0 makes the force jump from 0 to law(least) when the pair becomes
//! ordinary, which adds a small energy; with 0 no energy is ever created.

use crate::number::Number;

/// Overlap of a relaxing pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxed<T = f64> {
    /// Overlap for the contact law, m; not above 0: no force.
    pub overlap_m: T,
    /// Origin from now on, m; 0 if the pair is ordinary again.
    pub origin_m: T,
}

/// Overlap for the contact law of a pair with overlap `overlap_m` and origin `origin_m`, which
/// becomes ordinary below `least_m` (the setting times R*), m.
#[inline(always)]
pub fn relaxed<T: Number>(overlap_m: T, origin_m: T, least_m: T) -> Relaxed<T> {
    let lower = overlap_m.minimum(origin_m);
    let origin = (lower - least_m).if_positive(lower);
    Relaxed {
        overlap_m: overlap_m - origin,
        origin_m: origin,
    }
}
