//! Fronts of a packing: where they begin, again wherever room is left, and again from the start until the sizes are true.

use super::{PackHistory, PackSettings};
use crate::Vector3;
use crate::boundary::Boundary;
use crate::front::{Front, FrontSettings};
use crate::inside::is_inside;
use crate::seed::{Inscribed, climb, first_spheres, spread_points};
use dem_io::{Result, Surface};
use rayon::prelude::*;
use std::ops::Range;

/// Before settling a front begins in every cube of so many largest diameters: near enough that directions of growth average out,
/// far enough that few fronts meet, since where they meet there is less.
const SEED_SPACING: f64 = 8.0;

/// How many small spheres too many there may be in a bare front for voids to be filled, in roots of the number of spheres: at first many times
/// what chance does, to learn how many voids there are (10 in a ball of half a million spheres, less in all else that can be filled);
/// in the last attempt a third of it, whatever voids that leaves.
const MOST_TOO_MANY: [f64; 2] = [20.0, 0.5];
/// Runs of a bare front at most.
const MOST_ATTEMPTS: usize = 9;
/// A front is kept if the number of spheres up to any size is off by less than this many roots of the number of spheres: half of what chance
/// does, after some attempts two thirds.
const MOST_IMBALANCE: [f64; 2] = [0.68, 0.9];
const STRICT_ATTEMPTS: usize = 4;
/// The next attempt is the last one where the number is off by more than so many roots, what chance does, and by more than this part of what it
/// was off by in the attempt before: what can be evened out falls to a third or less while it is that much.
const HOPELESS_IMBALANCE: f64 = 1.36;
const SLOWEST_FALL: f64 = 0.6;

/// Runs a front (`run`) of about so many spheres, as its settings are for this number and for how many small spheres too many there may be. Where it fills voids,
/// again until its sizes are true, with sizes kept back that were too many.
pub(super) fn true_front<'a>(
    settings: &dyn Fn(f64, f64) -> FrontSettings<'a>,
    expected: f64,
    boundary: &'a Boundary,
    extent: &Vector3,
    history: &mut PackHistory,
    run: &dyn Fn(&mut Front<'a>, &mut PackHistory) -> Result<()>,
) -> Result<Front<'a>> {
    let mut front = Front::new(settings(expected, MOST_TOO_MANY[0]), boundary, extent);
    let mut is_last = !front.settings.fills_voids;
    let (mut attempts, mut last_imbalance) = (0, f64::INFINITY);
    loop {
        attempts += 1;
        history.attempts += 1;
        history.fronts = 0;
        run(&mut front, history)?;
        let placed = front.balls.len() as f64;
        let imbalance = front.ledger.imbalance() / placed.sqrt();
        let most_imbalance = MOST_IMBALANCE[usize::from(attempts > STRICT_ATTEMPTS)];
        if is_last || (imbalance < most_imbalance && !front.has_left_voids()) {
            return Ok(front);
        }
        // Where too few small spheres can be kept back for all voids, more attempts would not change that.
        let is_hopeless = attempts == 1 && front.has_left_voids()
            || imbalance > HOPELESS_IMBALANCE.max(SLOWEST_FALL * last_imbalance);
        is_last = is_hopeless || attempts + 1 == MOST_ATTEMPTS;
        last_imbalance = imbalance;
        let ledger = front.ledger.corrected();
        let most_too_many = MOST_TOO_MANY[usize::from(is_last)];
        front = Front::new(settings(placed, most_too_many), boundary, extent);
        // Nothing is kept back where voids are left anyway.
        if !is_last {
            front.ledger = ledger;
        }
    }
}

/// The seed and, before settling, others spread over the shape.
pub(super) fn front_seeds(
    surface: &Surface,
    boundary: &Boundary,
    settings: &PackSettings,
    seed: &Vector3,
    settles: bool,
    diameter: f64,
) -> Vec<Vector3> {
    let mut seeds = vec![*seed];
    if settles {
        let others = spread_points(&surface.extent(), SEED_SPACING * diameter, settings.seed);
        seeds.par_extend(
            others
                .into_par_iter()
                .filter(|p| (p - seed).norm() > 2.0 * diameter && is_inside(boundary, p)),
        );
    }
    seeds
}

/// Starts fronts at the seeds, and again wherever room is left that no front has reached.
pub(super) fn run_fronts(
    front: &mut Front,
    boundary: &Boundary,
    seeds: &[Vector3],
    inner: &[Inscribed],
    history: &mut PackHistory,
    progress: &dyn Fn(usize) -> Result<()>,
) -> Result<()> {
    let mut queue = Vec::new();
    for seed in seeds {
        let first = place_first_spheres(front, boundary, seed);
        history.fronts += usize::from(!first.is_empty());
        queue.extend(first);
    }
    front.advance(&queue, progress)?;
    // What no front has reached: other shells, and rooms behind a neck narrower than a sphere.
    for place in inner {
        let smallest = front.smallest_next();
        let reduced = front.reduced(smallest);
        if place.radius < 0.5 * smallest || front.gap(&place.centre, reduced) < 0.9 * reduced {
            continue;
        }
        // The steps are never longer than the distance to the wall, so that the climb stays on its side of it.
        let reach = 4.0 * front.settings.radius_range[1];
        let clearance = |p: &Vector3| {
            let to_spheres = front.reach_to_spheres(p, reach);
            let wall = boundary.nearest(p, to_spheres * front.settings.wall_factor);
            wall.map_or(to_spheres, |near| {
                near.distance / front.settings.wall_factor
            })
        };
        let room = climb(&place.centre, 0.5 * smallest, 1e-6 * smallest, &clearance);
        if room.radius >= smallest {
            let first: Vec<u32> = place_first_spheres(front, boundary, &room.centre).collect();
            history.fronts += usize::from(!first.is_empty());
            front.advance(&first, progress)?;
        }
    }
    Ok(())
}

/// Places as many of the first three spheres around `seed` as find room. Returns their indices.
fn place_first_spheres(front: &mut Front, boundary: &Boundary, seed: &Vector3) -> Range<u32> {
    let draws = front.next_draws();
    let radii = draws.map(|u| front.radius(u));
    let reduced = radii.map(|r| front.reduced(r));
    let placed = first_spheres(seed, radii, reduced, &|centre, radius| {
        front.fits(centre, radius) && is_inside(boundary, centre)
    });
    front.waiting.extend_from_slice(&draws[placed.len()..]);
    front.begin(seed);
    let first = front.balls.len() as u32;
    for (centre, radius) in &placed {
        front.place(centre, *radius);
    }
    first..front.balls.len() as u32
}
