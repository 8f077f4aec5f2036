//! The overlap that gives a wanted solid density (Platzer 2022, section 4.5.1.5): a root search over packings.

use crate::boundary::Boundary;
use crate::pack::{PackSettings, Packing, Progress, pack};
use dem_io::units::significant;
use dem_io::{Diagnostic, Result, Surface};
use serde::Serialize;

/// The search ends when the density is as near as this, relative.
pub const NEAR_ENOUGH: f64 = 1e-3;
/// Densities are near the wanted one up to this, relative: more than chance makes.
const NEAR: f64 = 0.01;
/// Packings tried at most.
const MOST_PACKINGS: usize = 30;
/// Overlaps nearer to each other than this are not tried twice: they change the density by less than chance does.
const FINEST_STEP: f64 = 1e-5;
/// Overlaps are below this: a sphere must not swallow its neighbour's centre.
pub const LARGEST_OVERLAP: f64 = 1.0;

/// What was looked for and how close it came.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DensitySearch {
    /// Wanted mass of the particles / volume of the shape, kg/m3.
    pub wanted_kg_m3: f64,
    /// Found, kg/m3.
    pub found_kg_m3: f64,
    /// found / wanted - 1.
    pub relative_error: f64,
    /// The overlap that gives it.
    pub overlap: f64,
    /// How many packings were made.
    pub packings: usize,
}

impl DensitySearch {
    /// What a user should know, if the density was missed.
    pub fn warning(&self) -> Option<String> {
        (self.relative_error.abs() > NEAR_ENOUGH).then(|| {
            format!(
                "the solid density is off by {} %, more than {} %, after {} packings: with few particles it differs by chance; try \
                 another --seed, or smaller diameters",
                significant(100.0 * self.relative_error, 2),
                100.0 * NEAR_ENOUGH,
                self.packings
            )
        })
    }
}

/// A packing that was tried: its overlap and the share of the shape that its particles' volumes add up to.
#[derive(Debug, Clone, Copy)]
struct Try {
    overlap: f64,
    filled: f64,
}

/// Packs with the overlap that gives `wanted_kg_m3` for particles of `particle_kg_m3`; sets it in `settings`. Two packings
/// of nearly the same overlap differ by chance, so that the search goes on around the root of their
/// mean until one is near enough, and keeps the nearest of all. The seconds in the history of the packing are those of all tries.
///
/// # Errors
/// As [`pack`]; a density that no overlap from 0 to below 1 gives.
pub fn pack_to_density(
    surface: &Surface,
    boundary: &Boundary,
    settings: &mut PackSettings,
    wanted_kg_m3: f64,
    particle_kg_m3: f64,
    progress: Progress,
) -> Result<(Packing, DensitySearch)> {
    let target = wanted_kg_m3 / particle_kg_m3;
    settings.overlap = overlap_for(target, USUAL_SHARE).clamp(0.0, 0.9);
    let mut tries: Vec<Try> = Vec::new();
    let mut best: Option<(Try, Packing)> = None;
    let mut seconds = [0.0; 3];
    while tries.len() < MOST_PACKINGS {
        let packing = pack(surface, boundary, settings, progress)?;
        let history = &packing.history;
        seconds[0] += history.front_seconds;
        seconds[1] += history.settle_seconds;
        seconds[2] += history.fill_seconds;
        let tried = Try {
            overlap: settings.overlap,
            filled: filled_share(surface, &packing),
        };
        tries.push(tried);
        let off = |t: &Try| (t.filled / target - 1.0).abs();
        if best.as_ref().is_none_or(|(b, _)| off(&tried) < off(b)) {
            best = Some((tried, packing));
        }
        if off(&tried) <= NEAR_ENOUGH {
            break;
        }
        let next = next_overlap(&tries, target);
        if next < 0.0 && tried.overlap == 0.0 && off(&tried) <= NEAR {
            break;
        }
        if next >= LARGEST_OVERLAP || (next < 0.0 && tried.overlap == 0.0) {
            let reduced = tried.filled / (1.0 + tried.overlap).powi(3);
            return Err(unreachable(wanted_kg_m3, particle_kg_m3, reduced));
        }
        settings.overlap = next.max(0.0);
    }
    let Some((found, mut packing)) = best else {
        return Err(unreachable(wanted_kg_m3, particle_kg_m3, USUAL_SHARE));
    };
    settings.overlap = found.overlap;
    let history = &mut packing.history;
    [
        history.front_seconds,
        history.settle_seconds,
        history.fill_seconds,
    ] = seconds;
    Ok((
        packing,
        DensitySearch {
            wanted_kg_m3,
            found_kg_m3: found.filled * particle_kg_m3,
            relative_error: found.filled / target - 1.0,
            overlap: found.overlap,
            packings: tries.len(),
        },
    ))
}

/// The overlap to try after these: a Newton step on the mean of the tries near the target, so that chance averages out, or
/// else on the nearest. The share in r_gen hardly changes, so that the density goes with (1 + overlap)^3.
fn next_overlap(tries: &[Try], target: f64) -> f64 {
    let off = |t: &Try| (t.filled / target - 1.0).abs();
    let least = tries.iter().map(off).fold(f64::INFINITY, f64::min);
    let (mut sum, mut count) = (0.0, 0.0);
    for t in tries.iter().filter(|t| off(t) <= least.max(NEAR)) {
        sum += t.filled / (1.0 + t.overlap).powi(3);
        count += 1.0;
    }
    let mut next = overlap_for(target, sum / count);
    // The same overlap would give the same packing.
    let is_tried = |o: f64| tries.iter().any(|t| (t.overlap - o).abs() < FINEST_STEP);
    let mut step = FINEST_STEP;
    while next > 0.0 && is_tried(next) {
        step *= -2.0;
        next += step;
    }
    next
}

/// Share of the shape that spheres reduced to r_gen fill, about. Volumes of true radii are (1 + overlap)^3 as large.
const USUAL_SHARE: f64 = 0.59;

/// Sum of the particles' volumes / volume of the shape.
pub fn filled_share(surface: &Surface, packing: &Packing) -> f64 {
    let spheres: f64 = packing
        .spheres
        .radii
        .iter()
        .map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3))
        .sum();
    spheres * surface.unit_m.powi(3) / surface.volume_m3()
}

fn overlap_for(target: f64, reduced: f64) -> f64 {
    (target / reduced).cbrt() - 1.0
}

fn unreachable(wanted: f64, particle: f64, reduced: f64) -> Diagnostic {
    let (least, most) = (particle * reduced, particle * reduced * 8.0);
    Diagnostic::input(
        "--solid-density",
        format!(
            "{wanted} kg/m3 cannot be reached with particles of {particle} kg/m3: without overlap the body has {least:.0} kg/m3, at overlap 1 {most:.0}"
        ),
        "change --solid-density or --particle-density",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Overlaps tried for a body whose share in r_gen falls with the overlap and scatters by up to `scatter`.
    fn search(target: f64, scatter: f64) -> Vec<Try> {
        let mut tries = vec![];
        let mut overlap = overlap_for(target, USUAL_SHARE).max(0.0);
        while tries.len() < MOST_PACKINGS {
            let chance = (overlap * 1e6).sin() * scatter;
            let reduced = (0.60 - 0.05 * overlap) * (1.0 + chance);
            let filled = reduced * (1.0 + overlap).powi(3);
            tries.push(Try { overlap, filled });
            if (filled / target - 1.0).abs() <= NEAR_ENOUGH {
                break;
            }
            overlap = next_overlap(&tries, target);
        }
        tries
    }

    #[test]
    fn a_smooth_density_is_met_in_few_packings_and_a_scattering_one_in_more() {
        for target in [0.62, 0.7, 0.8, 1.0, 1.5, 2.5] {
            for (scatter, most) in [(0.0, 3), (0.002, MOST_PACKINGS)] {
                let tries = search(target, scatter);
                let last = tries[tries.len() - 1];
                assert!(
                    tries.len() <= most && (last.filled / target - 1.0).abs() <= NEAR_ENOUGH,
                    "{target} {scatter}: {tries:?}"
                );
            }
        }
    }

    #[test]
    fn no_overlap_is_tried_twice() {
        // Nothing is near enough: a step in the density at the target.
        let mut tries: Vec<Try> = Vec::new();
        let mut overlap = 0.3;
        for _ in 0..MOST_PACKINGS {
            let filled = if overlap < 0.31 { 0.98 } else { 1.02 };
            assert!(tries.iter().all(|t| t.overlap != overlap), "{tries:?}");
            tries.push(Try { overlap, filled });
            overlap = next_overlap(&tries, 1.0);
            assert!((0.0..1.0).contains(&overlap), "{tries:?}");
        }
    }
}
