//! Settling: the spheres of a front with reduced radii grow to their full size while an energy of
//! their overlaps, with each other and with the wall, is minimised to zero.
//!
//! E = 1/8 sum over pairs ((g^2 - d^2) / g)^2 + 1/2 sum over spheres (r - wall distance)^2, each
//! where positive; g is the sum of two reduced radii. For small overlaps the first term is 1/2
//! (g - d)^2; it takes no square root. The minimiser is damped dynamics: v <- (1 - c) v +
//! response F, x <- x + v, with a damping c that decreases with the number of steps (Nesterov 1983
//! has c = 3 / step; here it decreases less at first). The response replaces 1 / mass: it is
//! smaller where many neighbours make a sphere's surroundings stiff (adaptive dynamic relaxation,
//! Underwood 1983), so that one step length suits all. FIRE, which stops the motion when it runs
//! uphill, takes three to four times the steps and jams at a density lower by 0.008, where light
//! damping shakes the spheres past each other. Below the jamming density settling ends without
//! overlap: the radii are meanwhile larger by `MARGIN`, so that at their true size the spheres do
//! not overlap at all.

mod cells;
#[cfg(target_arch = "x86_64")]
mod eight;
mod forces;
mod inside;
mod minimiser;
mod neighbours;
#[cfg(all(test, target_arch = "x86_64"))]
mod tests;
mod walls;

pub use self::cells::SizeClasses;
pub use self::minimiser::{Settled, WhenJammed, minimise_overlaps};
pub use self::walls::WallLists;
use super::job::Job;
use super::settings::Progress;
use crate::spheres::ReducedSphere;
use dem_io::Result;

/// Third step: spheres of a front whose radii were reduced by `shrink` are moved at full size until
/// none overlaps another or the wall. Those of the bare front (`shrink` 0) stay where they are.
pub(super) fn settle(
    job: &Job,
    shrink: f64,
    when_jammed: WhenJammed,
    spheres: &mut Vec<ReducedSphere>,
    progress: Progress,
) -> Result<Settled> {
    if shrink == 0.0 {
        return Ok(Settled::default());
    }
    settle_all(job, when_jammed, spheres, progress)
}

/// Moves spheres at full size until none overlaps another or the wall.
pub(super) fn settle_all(
    job: &Job,
    when_jammed: WhenJammed,
    spheres: &mut Vec<ReducedSphere>,
    progress: Progress,
) -> Result<Settled> {
    let progress = |done: f64| progress("densifying", done);
    let overlap = job.settings.overlap;
    minimise_overlaps(
        &job.solid.boundary,
        spheres,
        overlap,
        when_jammed,
        &progress,
    )
}
