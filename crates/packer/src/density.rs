//! The overlap that gives a target solid density (Platzer 2022, section 4.5.1.5): a root search
//! over packings.

use crate::pack::{PackSettings, Packing, Progress, Solid, pack_if};
use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use serde::Serialize;
use std::cell::Cell;
use std::time::Instant;

/// Relative error of the density at which the search ends.
pub const NEAR_ENOUGH: f64 = 1e-3;
/// Relative error up to which a density is near the target: more than chance causes.
const NEAR: f64 = 0.01;
/// Largest number of packings begun.
pub const MOST_PACKINGS: usize = 30;
/// Smallest difference between two overlaps that are both tried: smaller ones change the density by
/// less than chance does.
const FINEST_STEP: f64 = 1e-5;
/// Limit of the overlap: a sphere must not contain the centre of its neighbour.
pub(crate) const LARGEST_OVERLAP: f64 = 1.0;
/// Largest overlap that is tried: so close to the limit that the density is almost the largest
/// possible.
const LARGEST_TRIED: f64 = 0.999;

/// The target density and the one found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DensitySearch {
    /// Target mass of the particles / volume of the shape, kg/m3.
    pub wanted_kg_m3: f64,
    /// Value found, kg/m3.
    pub found_kg_m3: f64,
    /// found / wanted - 1.
    pub relative_error: f64,
    /// The overlap that gives it.
    pub overlap: f64,
    /// Number of packings begun.
    pub packings: usize,
    /// Number of packings completed: those whose front had nearly the target density.
    pub finished: usize,
}

impl DensitySearch {
    /// A warning, if the density was missed.
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

/// A packing that was tried.
#[derive(Debug, Clone, Copy)]
pub struct Try {
    /// Overlap o.
    pub overlap: f64,
    /// Sum of the spheres' volumes / volume of the shape; the expected value if the packing was not
    /// completed.
    pub filled: f64,
}

/// A packing that was begun.
#[derive(Debug, Clone, Copy)]
pub struct Begun {
    /// Overlap o.
    pub overlap: f64,
    /// Sum of the spheres' volumes / volume of the shape after the front.
    pub front: f64,
    /// The same fraction after settling and filling, if the packing was completed.
    pub filled: Option<f64>,
}

/// Expected ratio of the final fraction to that of the front: the median of the completed packings.
fn gain(begun: &[Begun]) -> f64 {
    let gains = begun.iter().filter_map(|b| Some(b.filled? / b.front));
    median(gains).unwrap_or(1.0)
}

/// The median: of packings that jammed, from which spheres were left out, and of the others, which
/// are denser, the mean may be the density of none.
fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// The packings begun, each with the fraction that it fills or is expected to.
pub fn judged(begun: &[Begun]) -> Vec<Try> {
    let gain = gain(begun);
    let judge = |b: &Begun| Try {
        overlap: b.overlap,
        filled: b.filled.unwrap_or(b.front * gain),
    };
    begun.iter().map(judge).collect()
}

/// Largest relative error of a front that is worth settling and filling, given the error of the
/// nearest completed packing. The first packing shows how settling and filling change the density.
/// Each later one must promise half the error of the nearest one, or an error small enough to end
/// the search.
fn largest_promising(nearest: Option<f64>) -> f64 {
    nearest.map_or(NEAR, |off| (0.5 * off).max(NEAR_ENOUGH))
}

/// A search for the overlap of a target density.
struct Search {
    /// Target sum of the spheres' volumes / volume of the shape.
    target: f64,
    begun: Vec<Begun>,
    /// The packing that came nearest.
    best: Option<(Try, Packing)>,
    /// Times of all packings for the front, settling and filling, s. Length 3.
    seconds: [f64; 3],
}

impl Search {
    /// Relative error of a fraction compared with the target.
    fn off(&self, filled: f64) -> f64 {
        (filled / self.target - 1.0).abs()
    }

    /// True if a front that filled this fraction is worth settling and filling.
    fn is_promising(&self, overlap: f64, front: f64) -> bool {
        let is_limit = overlap == 0.0 || overlap == LARGEST_TRIED;
        let is_last = self.begun.len() + 1 == MOST_PACKINGS;
        let nearest = self.best.as_ref().map(|(best, _)| self.off(best.filled));
        is_limit
            || (is_last && self.best.is_none())
            || self.off(front * gain(&self.begun)) <= largest_promising(nearest)
    }

    /// Packs with an overlap, and stops after the front if it is not promising. Returns the
    /// fraction filled if the packing was completed.
    fn try_overlap(
        &mut self,
        solid: &Solid,
        settings: &PackSettings,
        progress: Progress,
    ) -> Result<Option<f64>> {
        let started = Instant::now();
        let overlap = settings.overlap;
        let front = Cell::new(0.0);
        let is_wanted = |filled: f64| {
            front.set(filled);
            self.is_promising(overlap, filled)
        };
        let packing = pack_if(solid, settings, &is_wanted, progress)?;
        let filled = packing
            .as_ref()
            .map(|packing| solid.filled_fraction(packing.spheres.radii.iter().copied()));
        self.begun.push(Begun {
            overlap,
            front: front.get(),
            filled,
        });
        match packing.zip(filled) {
            None => self.seconds[0] += started.elapsed().as_secs_f64(),
            Some((packing, filled)) => self.keep_nearer(Try { overlap, filled }, packing),
        }
        Ok(filled)
    }

    /// Keeps a packing if it came nearer than those before.
    fn keep_nearer(&mut self, found: Try, packing: Packing) {
        let history = &packing.history;
        self.seconds[0] += history.front_seconds;
        self.seconds[1] += history.densify_seconds;
        self.seconds[2] += history.fill_seconds;
        let before = self.best.as_ref().map(|(best, _)| self.off(best.filled));
        if before.is_none_or(|before| self.off(found.filled) < before) {
            self.best = Some((found, packing));
        }
    }
}

/// Packs with the overlap that gives `wanted_kg_m3` for particles of `particle_kg_m3`, and sets it
/// in `settings`. Two packings of nearly the same overlap differ by chance, so the search continues
/// around the root of their median until one is near enough, and keeps the nearest of all. The
/// front predicts the density well, so most tries end after it. The times in the history of the
/// packing are the sums over all tries. Refuses a density that no overlap from 0 to below 1 gives.
pub(crate) fn pack_to_density(
    solid: &Solid,
    settings: &mut PackSettings,
    wanted_kg_m3: f64,
    particle_kg_m3: f64,
    progress: Progress,
) -> Result<(Packing, DensitySearch)> {
    let mut search = Search {
        target: wanted_kg_m3 / particle_kg_m3,
        begun: Vec::new(),
        best: None,
        seconds: [0.0; 3],
    };
    settings.overlap = overlap_for(search.target, USUAL_FRACTION).clamp(0.0, 0.9);
    while search.begun.len() < MOST_PACKINGS {
        let overlap = settings.overlap;
        let filled = search.try_overlap(solid, settings, progress)?;
        if filled.is_some_and(|filled| search.off(filled) <= NEAR_ENOUGH) {
            break;
        }
        let next = next_overlap(&judged(&search.begun), search.target);
        let is_beyond =
            (next < 0.0 && overlap == 0.0) || (next >= LARGEST_TRIED && overlap == LARGEST_TRIED);
        if let Some(filled) = filled.filter(|_| is_beyond) {
            if search.off(filled) <= NEAR {
                break;
            }
            let limit = Try { overlap, filled };
            return Err(unreachable(wanted_kg_m3, particle_kg_m3, limit));
        }
        settings.overlap = next.clamp(0.0, LARGEST_TRIED);
    }
    let Some((found, mut packing)) = search.best else {
        return Err(Diagnostic::failed(
            "--solid-density",
            "nothing was packed",
            "",
        ));
    };
    settings.overlap = found.overlap;
    let history = &mut packing.history;
    [
        history.front_seconds,
        history.densify_seconds,
        history.fill_seconds,
    ] = search.seconds;
    let found = DensitySearch {
        wanted_kg_m3,
        found_kg_m3: found.filled * particle_kg_m3,
        relative_error: found.filled / search.target - 1.0,
        overlap: found.overlap,
        packings: search.begun.len(),
        finished: search.begun.iter().filter(|b| b.filled.is_some()).count(),
    };
    Ok((packing, found))
}

/// The next overlap to try: a Newton step on the median of the tries near the target, so that
/// chance counts less, or else on the nearest one. The fraction filled in r_gen hardly changes, so
/// the density is proportional to (1 + overlap)^3.
pub fn next_overlap(tries: &[Try], target: f64) -> f64 {
    let off = |t: &Try| (t.filled / target - 1.0).abs();
    let least = tries.iter().map(off).fold(f64::INFINITY, f64::min);
    let near = tries.iter().filter(|t| off(t) <= least.max(NEAR));
    let reduced = median(near.map(|t| t.filled / (1.0 + t.overlap).powi(3)));
    let root = overlap_for(target, reduced.unwrap_or(USUAL_FRACTION));
    let is_tried = |o: f64| tries.iter().any(|t| (t.overlap - o).abs() < FINEST_STEP);
    if root <= 0.0 || !is_tried(root) {
        return root;
    }
    // The same overlap would give the same packing: the nearest one beside it, below or above.
    let beside = (1..).flat_map(|n| {
        let away = 2.0 * f64::from(n) * FINEST_STEP;
        [root - away, root + away]
    });
    let mut untried = beside.filter(|o| *o > 0.0 && !is_tried(*o));
    untried.next().unwrap_or(root)
}

/// Approximate fraction of the shape that spheres reduced to r_gen fill. Volumes of true radii are
/// (1 + overlap)^3 times as large.
pub const USUAL_FRACTION: f64 = 0.59;

/// Overlap at which spheres that fill the fraction `reduced` with their reduced radii fill
/// `target`.
pub fn overlap_for(target: f64, reduced: f64) -> f64 {
    (target / reduced).cbrt() - 1.0
}

/// The error for a density outside the range between the packings of the smallest and the largest
/// overlap.
fn unreachable(wanted: f64, particle: f64, limit: Try) -> Diagnostic {
    let has = particle * limit.filled;
    let most_or_least = if limit.overlap == 0.0 {
        format!("the least is {has:.0} kg/m3, without overlap")
    } else {
        format!("the most is {has:.0} kg/m3, at overlap {}", limit.overlap)
    };
    Diagnostic::input(
        "--solid-density",
        format!(
            "{wanted} kg/m3 cannot be reached with particles of {particle} kg/m3: {most_or_least}"
        ),
        "change --solid-density or --particle-density",
    )
}
