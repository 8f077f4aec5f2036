//! From a surface and sizes to spheres: front, settling, filling of what is left.

mod fronts;
mod voids;

use self::fronts::{front_seeds, run_fronts, true_front};
use self::voids::fill_voids;
use crate::boundary::Boundary;
use crate::front::{Front, FrontSettings};
use crate::grid::Ball;
use crate::inside::is_inside;
use crate::room::{Room, first_share};
use crate::seed::{Inscribed, deepest_point, inner_points};
use crate::settle::{WhenJammed, settle};
use crate::sizes::Sizes;
use crate::{Spheres, Vector3};
use dem_io::units::{show_length, significant};
use dem_io::{Diagnostic, Result, Surface};
use serde::Serialize;
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
    /// How often the front was run: again with other sizes kept back where filling the voids had distorted the distribution, or at another share where it had left
    /// too much room for settling or too little.
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

/// The largest size over the smallest up to which the bare front fills all voids.
const WIDEST_FILLED: f64 = 1.5 + 1e-6;

/// Fronts at most until one leaves the room that settling wants; in small bodies it differs by chance.
const MOST_FRONTS: usize = 4;
/// By this factor a front runs at less smaller radii where the spheres of the one before have jammed, and how often that is done before some are taken out.
const AFTER_JAM: f64 = 0.93;
const MOST_JAMS: usize = 3;

/// Spheres at most: some 30 GB.
const MOST_SPHERES: f64 = 1e8;
/// Cells of the front's grid beyond one per sphere.
const MORE_CELLS: usize = 1_000_000;

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

/// Whether sizes are so alike that all voids can be filled. Wider ones have fewer small spheres than voids: to place them all would change the sizes.
pub fn can_fill_voids(sizes: &Sizes) -> bool {
    sizes.max_m() <= WIDEST_FILLED * sizes.min_m()
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
    let chooses = settings.settle.is_none();
    let room = chooses.then(|| Room::of(surface, &settings.sizes, settings.overlap));
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
            / (settings.sizes.mean_volume_m3() * (shrink / enlarge).powi(3)).max(f64::MIN_POSITIVE);
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
        fills_voids = share == 0.0 && can_fill_voids(&settings.sizes);
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
        let diameter = 2.0 * range[1] * shrink / enlarge;
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
        if jams == 0 {
            let filled = volume(balls.iter().map(|b| b[3]));
            if let Some(room) = &room
                && let Some(better) = room.better_share(share, filled)
                && fronts < MOST_FRONTS
            {
                share = rounded_share(better);
                continue;
            }
            let radii = balls.iter().map(|b| b[3] * enlarge);
            if !is_wanted(filled_share(surface, radii)) {
                return Ok(None);
            }
        }
        sort_along_curve(&mut balls, range[1]);
        if share == 0.0 {
            break;
        }
        let settling = Instant::now();
        let when_jammed = if chooses && jams < MOST_JAMS {
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
    volume(radii) * surface.unit_m.powi(3) / surface.volume_m3()
}

/// Sum of the volumes of spheres of these radii.
fn volume(radii: impl Iterator<Item = f64>) -> f64 {
    radii
        .map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3))
        .sum()
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
