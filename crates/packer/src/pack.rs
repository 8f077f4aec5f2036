//! From a surface and sizes to spheres: front, settling, filling of what is left.

use crate::boundary::Boundary;
use crate::front::{Front, FrontSettings};
use crate::grid::Ball;
use crate::inside::is_inside;
use crate::room::{Room, first_share};
use crate::seed::{Inscribed, climb, deepest_point, first_spheres, inner_points, spread_points};
use crate::settle::{WhenJammed, settle};
use crate::sizes::Sizes;
use crate::{Spheres, Vector3};
use dem_io::units::{show_length, significant};
use dem_io::{Diagnostic, Result, Surface};
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;
use std::time::Instant;

/// How a packing is to be made.
#[derive(Debug, Clone)]
pub struct PackSettings {
    /// Diameters of the spheres.
    pub sizes: Sizes,
    /// Spheres touch at reduced radius = radius / (1 + overlap).
    pub overlap: f64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// The front runs at radii smaller by this share; then they grow to full size. 0: the bare front. None: by as much as leaves the [`Room`] wanted.
    pub settle: Option<f64>,
    /// Where the front begins, in metres; the deepest point if not given. Length 3.
    pub seed_point_m: Option<[f64; 3]>,
}

/// What happened while packing.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct PackHistory {
    /// Where the first front began, m. Length 3.
    pub seed_point_m: [f64; 3],
    /// Diameter of the largest ball that fits into the shape, m.
    pub largest_inscribed_diameter_m: f64,
    /// The radii of the front were smaller by this share.
    pub settle: f64,
    /// Fronts started: one for each part that the ones before could not reach.
    pub fronts: usize,
    /// Steps of the settling minimiser.
    pub settling_steps: usize,
    /// Spheres taken out because they were jammed.
    pub taken_out: usize,
    /// How often the front was run: again with other sizes kept back where filling the voids had distorted the distribution.
    pub attempts: usize,
    /// Spheres put into voids, of sizes that fit there: by the bare front as it goes, after settling at the end.
    pub void_fillers: usize,
    /// Those of them that stand where they have most room, and need not touch three others or walls.
    pub loose_fillers: usize,
    /// Voids that would still take the smallest sphere, about: extrapolated when more fillers would distort the sizes.
    pub voids_left: usize,
    /// Radii drawn that found no place.
    pub unplaced: usize,
    /// Time for the front, s.
    pub front_seconds: f64,
    /// Time for settling, s.
    pub settle_seconds: f64,
    /// Time for filling voids, s.
    pub fill_seconds: f64,
}

/// Spheres inside a surface, and how they came there.
#[derive(Debug, Clone)]
pub struct Packing {
    /// The spheres, sorted along a space-filling curve.
    pub spheres: Spheres,
    /// What happened.
    pub history: PackHistory,
}

/// Before settling a front begins in every cube of so many largest diameters: near enough that directions of growth average out,
/// far enough that few fronts meet, since where they meet there is less.
const SEED_SPACING: f64 = 8.0;

/// The bare front fills all voids where the largest radius is at most so many times the smallest.
pub const WIDEST_FILLED: f64 = 1.5 + 1e-6;

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

/// Fronts at most until one leaves the room that settling wants; in small bodies it differs by chance.
const MOST_FRONTS: usize = 4;
/// By this factor a front runs at less smaller radii where the spheres of the one before have jammed, and how often that is done before some are taken out.
const AFTER_JAM: f64 = 0.93;
const MOST_JAMS: usize = 3;

/// Spheres at most: some 30 GB.
const MOST_SPHERES: f64 = 1e8;
/// Cells of the front's grid beyond one per sphere.
const MORE_CELLS: usize = 1_000_000;

/// Spheres around which voids are searched at a time.
const VOID_SEARCH_GROUP: usize = 2000;

/// Told the stage and the share of it that is done (0 to 1); an error stops the work.
pub type Progress<'a> = &'a dyn Fn(&str, f64) -> Result<()>;

/// The inside of a shape, which all its packings have in common.
#[derive(Debug, Clone)]
pub struct Inside {
    /// Points spread over it.
    points: Vec<Inscribed>,
    deepest: Inscribed,
}

impl Inside {
    /// Of a surface.
    ///
    /// # Errors
    /// No point inside.
    pub fn find(surface: &Surface, boundary: &Boundary) -> Result<Self> {
        let points = inner_points(boundary, surface);
        let deepest = deepest_point(boundary, surface, &points).ok_or_else(|| {
            Diagnostic::input(
                surface.source.clone(),
                "no point inside the surface was found",
                "check that it is closed and not flat",
            )
        })?;
        Ok(Self { points, deepest })
    }
}

/// Fills the surface.
///
/// # Errors
/// Sizes that do not fit the shape; a seed point outside; what `progress` returns.
pub fn pack(
    surface: &Surface,
    boundary: &Boundary,
    settings: &PackSettings,
    progress: Progress,
) -> Result<Packing> {
    let started = Instant::now();
    let inside = Inside::find(surface, boundary)?;
    let seconds = started.elapsed().as_secs_f64();
    let packing = pack_if(surface, boundary, &inside, settings, &|_| true, progress)?;
    let mut packing =
        packing.ok_or_else(|| Diagnostic::failed(surface.source.clone(), "given up", ""))?;
    packing.history.front_seconds += seconds;
    Ok(packing)
}

/// Fills the surface, unless the front shows that the packing is not wanted: `is_wanted` is told the sum of the spheres' volumes
/// over the volume of the shape before settling and filling, which take most of the time and change it little. None if it was not.
///
/// # Errors
/// As [`pack`].
pub fn pack_if(
    surface: &Surface,
    boundary: &Boundary,
    inside: &Inside,
    settings: &PackSettings,
    is_wanted: &dyn Fn(f64) -> bool,
    progress: Progress,
) -> Result<Option<Packing>> {
    let mut history = PackHistory::default();
    let started = Instant::now();
    let unit = surface.unit_m;
    let deepest = &inside.deepest;
    history.largest_inscribed_diameter_m = 2.0 * deepest.radius * unit;
    check_sizes_fit(
        surface,
        &settings.sizes,
        history.largest_inscribed_diameter_m,
    )?;
    // Rounded for the same reason as the radii.
    let rounded_share = |share: f64| (1e6 * share).round() * 1e-6;
    let mut share = rounded_share(
        settings
            .settle
            .unwrap_or_else(|| first_share(&settings.sizes)),
    );
    let room = Room::of(surface, &settings.sizes, settings.overlap);
    let seed = seed_point(surface, boundary, settings, deepest)?;
    history.seed_point_m = to_metres(surface, &seed);

    let exact_range = [settings.sizes.min_m(), settings.sizes.max_m()].map(|d| 0.5 * d / unit);
    let step = rounding_step(exact_range[1]);
    let rounded = |r: f64| (r / step).round() * step;
    let full = |u: f64| rounded(0.5 * settings.sizes.quantile_by_number(u) / unit);
    let range = exact_range.map(rounded);
    let extent = Vector3::from(surface.extent());
    let enlarge = 1.0 + settings.overlap;
    let (mut balls, mut fills_voids);
    let (mut fronts, mut jams) = (0, 0);
    loop {
        let shrink = 1.0 - share;
        let small = |u: f64| shrink * full(u);
        fronts += 1;
        let expected = 0.58 * surface.volume_m3()
            / (settings.sizes.mean_volume_m3() * (shrink / (1.0 + settings.overlap)).powi(3))
                .max(f64::MIN_POSITIVE);
        if expected > MOST_SPHERES {
            return Err(Diagnostic::input(
                surface.source.clone(),
                format!(
                    "about {} spheres would fill it, at most {MOST_SPHERES:e} can be handled",
                    significant(expected, 2)
                ),
                "ask for larger diameters, or check the units of --diameter and --unit",
            ));
        }
        // Wider sizes have fewer small spheres than voids: to place them all would change the sizes.
        fills_voids = share == 0.0 && range[1] <= WIDEST_FILLED * range[0];
        let front_settings = |expected: f64, most_too_many: f64| FrontSettings {
            radius: &small,
            radius_range: range.map(|r| shrink * r),
            overlap: settings.overlap,
            wall_factor: (1.0 - 1e-12) / shrink,
            most_cells: MORE_CELLS + expected as usize,
            expected,
            fills_voids,
            most_too_many,
            seed: settings.seed,
        };
        let diameter = 2.0 * range[1] * shrink / (1.0 + settings.overlap);
        let seeds = front_seeds(surface, boundary, settings, &seed, share > 0.0, diameter);
        let mut front = true_front(
            &front_settings,
            expected,
            boundary,
            &extent,
            &mut history,
            &|front, history| {
                run_fronts(
                    front,
                    boundary,
                    &seeds,
                    &inside.points,
                    history,
                    &|placed| progress("front", placed as f64 / expected),
                )
            },
        )?;
        history.unplaced = front.waiting.len();
        history.void_fillers = front.fillers;
        history.loose_fillers = front.loose;
        balls = std::mem::take(&mut front.balls);
        history.voids_left = front.voids_left();
        for ball in &mut balls {
            ball[3] /= shrink;
        }
        let better = room.better_share(share, volume(&balls)).map(rounded_share);
        if let (None, 0, Some(better)) = (settings.settle, jams, better)
            && fronts < MOST_FRONTS
        {
            share = better;
            continue;
        }
        sort_along_curve(&mut balls, range[1]);
        let radii = balls.iter().map(|b| b[3] * enlarge);
        if jams == 0 && !is_wanted(filled_share(surface, radii)) {
            return Ok(None);
        }
        if share == 0.0 {
            break;
        }
        let settling = Instant::now();
        let when_jammed = if settings.settle.is_none() && jams < MOST_JAMS {
            WhenJammed::Stop
        } else {
            WhenJammed::TakeOut
        };
        let settled = settle(
            boundary,
            &mut balls,
            settings.overlap,
            when_jammed,
            &|done| progress("settling", done),
        )?;
        history.settling_steps = settled.steps;
        history.taken_out = settled.taken_out;
        history.settle_seconds += settling.elapsed().as_secs_f64();
        if !settled.is_stopped {
            break;
        }
        jams += 1;
        share = rounded_share(AFTER_JAM * share);
    }
    history.settle = share;
    history.front_seconds = started.elapsed().as_secs_f64() - history.settle_seconds;

    if !fills_voids {
        let started = Instant::now();
        progress("filling voids", 0.0)?;
        let settings_full = |fills_voids: bool| FrontSettings {
            radius: &full,
            radius_range: range,
            overlap: settings.overlap,
            wall_factor: 1.0,
            most_cells: MORE_CELLS + balls.len(),
            expected: balls.len() as f64,
            fills_voids,
            most_too_many: 0.0,
            seed: settings.seed ^ 0x5eed,
        };
        let mut front = Front::new(settings_full(false), boundary, &extent);
        front.adopt(&balls);
        if fill_voids(&mut front, &mut history) {
            let mut filled = Front::new(settings_full(true), boundary, &extent);
            filled.adopt(&front.balls);
            history.voids_left = filled.count_voids();
        }
        history.loose_fillers = history.void_fillers;
        history.fill_seconds = started.elapsed().as_secs_f64();
        balls = front.balls;
    }

    if balls.is_empty() {
        return Err(Diagnostic::input(
            surface.source.clone(),
            format!(
                "no sphere found room: the largest inscribed sphere has diameter {}",
                show_length(history.largest_inscribed_diameter_m)
            ),
            "ask for smaller diameters",
        ));
    }
    let spheres = Spheres {
        positions: balls.iter().map(|b| [b[0], b[1], b[2]]).collect(),
        radii: balls
            .iter()
            .map(|b| (b[3] * enlarge).clamp(exact_range[0], exact_range[1]))
            .collect(),
    };
    Ok(Some(Packing { spheres, history }))
}

/// Sum of the volumes of spheres of these radii (local units) / volume of the shape.
pub fn filled_share(surface: &Surface, radii: impl Iterator<Item = f64>) -> f64 {
    let spheres: f64 = radii
        .map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3))
        .sum();
    spheres * surface.unit_m.powi(3) / surface.volume_m3()
}

/// Runs a front (`run`) of about so many spheres, as its settings are for this number and for how many small spheres too many there may be. Where it fills voids,
/// again until its sizes are true, with sizes kept back that were too many.
fn true_front<'a>(
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

/// Volume of spheres, as if none overlapped another.
fn volume(balls: &[Ball]) -> f64 {
    let cubes: f64 = balls.iter().map(|ball| ball[3].powi(3)).sum();
    4.0 / 3.0 * std::f64::consts::PI * cubes
}

/// A local point in metres.
pub fn to_metres(surface: &Surface, point: &Vector3) -> [f64; 3] {
    [0, 1, 2].map(|k| surface.origin_m[k] + surface.unit_m * point[k])
}

/// Radii are multiples of this, some 2e-10 of the largest: so that a radius is the same number in whatever unit it was given. A difference in the
/// last bit would grow while the spheres settle, until every sphere lay elsewhere.
fn rounding_step(largest: f64) -> f64 {
    (largest.log2().floor() - 32.0).exp2()
}

fn check_sizes_fit(surface: &Surface, sizes: &Sizes, inscribed_m: f64) -> Result<()> {
    let wanted = [
        (sizes.min_m(), "no sphere fits", "smallest"),
        (sizes.max_m(), "the largest spheres fit nowhere", "largest"),
    ];
    for (diameter, problem, which) in wanted {
        if diameter > inscribed_m * (1.0 + 1e-9) {
            return Err(Diagnostic::input(
                surface.source.clone(),
                format!(
                    "{problem}: the largest inscribed sphere has diameter {}, the {which} wanted has {}",
                    show_length(inscribed_m),
                    show_length(diameter)
                ),
                "ask for smaller diameters, or check --unit and --scale",
            ));
        }
    }
    Ok(())
}

fn seed_point(
    surface: &Surface,
    boundary: &Boundary,
    settings: &PackSettings,
    deepest: &Inscribed,
) -> Result<Vector3> {
    let Some(given) = settings.seed_point_m else {
        return Ok(deepest.centre);
    };
    let local = Vector3::from([0, 1, 2].map(|k| (given[k] - surface.origin_m[k]) / surface.unit_m));
    if is_inside(boundary, &local) {
        return Ok(local);
    }
    let inside = to_metres(surface, &deepest.centre)
        .map(show_length)
        .join(", ");
    Err(Diagnostic::input(
        "--seed-point",
        format!(
            "({}) lies outside the shape",
            given.map(show_length).join(", ")
        ),
        format!("the deepest point inside is ({inside})"),
    ))
}

/// The seed and, before settling, others spread over the shape.
fn front_seeds(
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
fn run_fronts(
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

/// Puts spheres into the voids that take at least the smallest one, each of a size drawn among those that fit there,
/// as long as their number does not distort the distribution of sizes by more than a tenth of its statistical noise. Whether it would have, so that voids may be left.
fn fill_voids(front: &mut Front, history: &mut PackHistory) -> bool {
    let one_size = front.settings.radius_range[0] == front.settings.radius_range[1];
    let count = front.balls.len();
    let most = if one_size {
        usize::MAX
    } else {
        (0.1 * 1.36 * (count as f64).sqrt()).ceil() as usize
    };
    // Neighbours in memory are neighbours in space: the search goes round in strides, so that what it finds first is spread evenly.
    let groups = count.div_ceil(VOID_SEARCH_GROUP);
    for group in 0..groups {
        let around: Vec<u32> = (group..count).step_by(groups).map(|i| i as u32).collect();
        fill_voids_around(front, around, most, history);
        if history.void_fillers == most {
            return true;
        }
    }
    false
}

/// Searches around the spheres `around` and then around those that were added, until there are `most` of them.
fn fill_voids_around(
    front: &mut Front,
    mut around: Vec<u32>,
    most: usize,
    history: &mut PackHistory,
) {
    let smallest = front.settings.radius_range[0];
    while !around.is_empty() {
        let first = front.balls.len() as u32;
        for place in front.voids(&around) {
            if history.void_fillers < most && front.fits(&place, smallest) {
                let (centre, radius) = front.fill(&place);
                front.place(&centre, radius);
                history.void_fillers += 1;
            }
        }
        around = (first..front.balls.len() as u32).collect();
    }
}

/// Sorts spheres by the Morton code of cells of edge 4 `radius`, so that neighbours in space are neighbours in memory.
fn sort_along_curve(balls: &mut [Ball], radius: f64) {
    let code = |ball: &Ball| {
        let cell = [0, 1, 2].map(|k| (ball[k] / (4.0 * radius)).clamp(0.0, 2_097_151.0) as u64);
        spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2
    };
    balls.sort_by_cached_key(code);
}

/// The 21 lowest bits of `x`, two zeros between each and the next.
fn spread(x: u64) -> u64 {
    let mut x = x & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}
