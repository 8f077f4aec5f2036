//! Settling: the spheres of a front that ran at smaller radii grow to their full size while an
//! energy of their overlaps, with each other and with the wall, is minimised to nothing.
//!
//! E = 1/2 sum over pairs (g_a + g_b - d)^2 + 1/2 sum over spheres (r - wall distance)^2, each
//! where positive; g is the reduced radius. The minimiser is damped dynamics: v <- (1 - c) v +
//! response F, x <- x + v, with a damping c that falls as the steps go on (Nesterov 1983 has c = 3
//! / step; here less falls off at first). The response takes the place of 1 / mass: it is less
//! where many neighbours make a sphere's surroundings stiff (adaptive dynamic relaxation, Underwood
//! 1983), so that one step length suits all. FIRE, which stops the motion when it runs uphill, was
//! tried first: it takes three to four times the steps and jams at a density lower by 0.008, where
//! light damping shakes the spheres past each other. Below the jamming density it ends without
//! overlap; radii are held larger than wanted by `MARGIN` meanwhile, so that at their true size the
//! spheres do not overlap at all.

mod forces;
mod minimiser;
mod neighbours;

pub use self::minimiser::{Settled, WhenJammed, minimise_overlaps};
use super::job::Job;
use super::settings::Progress;
use crate::spheres::ReducedSphere;
use dem_io::Result;

/// Third act: spheres of a front whose radii were smaller by `shrink`, at full size, are moved
/// until none overlaps another or the wall. Those of the bare front (`shrink` 0) stay where they
/// are.
///
/// # Errors
/// As [`minimise_overlaps`].
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
    let progress = |done: f64| progress("settling", done);
    let overlap = job.settings.overlap;
    minimise_overlaps(
        &job.solid.boundary,
        spheres,
        overlap,
        when_jammed,
        &progress,
    )
}
