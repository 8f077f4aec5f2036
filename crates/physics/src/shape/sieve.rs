//! The smallest sieve opening that a fragment passes.
//!
//! A fragment passes a square opening in some direction if a square of that side holds its shadow
//! along the direction. The shadow lies within two pairs of parallel lines at right angles, and
//! each pair is as far apart as the fragment is wide across it. So the smallest opening is the
//! least, over all pairs of directions u and v at right angles, of the larger of the two widths.

use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Directions of view over half a sphere, and square openings turned about each of them, from which
/// the search begins: 11 degrees apart and closer.
const VIEWS: usize = 150;
const TURNS: usize = 8;
/// Number of the best of these that are improved, and the cosine between the views of two above
/// which they count as one.
const STARTS: usize = 8;
const SAME_VIEW: f64 = 0.95;
/// Angles by which a frame is turned to improve it: the first, and the last, rad.
const STEPS: [f64; 2] = [0.12, 1e-4];
/// Smallest relative gain that counts, over the angle of the turn, 1/rad: smaller ones would take
/// many turns and change nothing.
const GAIN: f64 = 0.02;
/// Number of spheres above which only those at the surface are looked at, as seen from some
/// directions: a sphere seen from none of them stands out by 0.3 % of the size at most.
const MANY: usize = 60;
const SURFACE_VIEWS: usize = 300;

/// A sphere: its centre relative to the middle of the fragment, in its principal axes, and its
/// radius, m.
pub type Ball = (Vector3<f64>, f64);

/// The directions across the sides of a square opening.
type Opening = [Vector3<f64>; 2];

/// Side of the smallest square opening that some spheres pass together, m. Zero for none.
pub fn smallest_opening_m(balls: &[Ball]) -> f64 {
    let largest_m = 2.0 * balls.iter().map(|ball| ball.1).fold(0.0, f64::max);
    if balls.len() <= 2 {
        // Two spheres pass one after the other.
        return largest_m;
    }
    let surface = surface(balls);
    let best = starts(&surface)
        .into_iter()
        .map(|opening| improved(&surface, opening))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    best.map_or(largest_m, |(opening, _)| {
        side_m(balls, &opening, f64::INFINITY).unwrap_or(largest_m)
    })
}

/// Extent of the spheres along a direction, m.
fn width_m(balls: &[Ball], along: &Vector3<f64>) -> f64 {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (centre, radius) in balls {
        let at = centre.dot(along);
        low = low.min(at - radius);
        high = high.max(at + radius);
    }
    high - low
}

/// The side of an opening that the spheres just pass, if it is less than `most_m`.
fn side_m(balls: &[Ball], [u, v]: &Opening, most_m: f64) -> Option<f64> {
    let one = width_m(balls, u);
    if one >= most_m {
        return None;
    }
    let side_m = one.max(width_m(balls, v));
    (side_m < most_m).then_some(side_m)
}

/// The spheres that stand out farthest in some direction; all of them if they are few.
fn surface(balls: &[Ball]) -> Vec<Ball> {
    if balls.len() <= MANY {
        return balls.to_vec();
    }
    let mut is_outer = vec![false; balls.len()];
    for view in views(SURFACE_VIEWS) {
        for sense in [view, -view] {
            let reach = |(centre, radius): &Ball| centre.dot(&sense) + radius;
            let farthest = (0..balls.len()).max_by(|a, b| {
                let (a, b) = (&balls[*a], &balls[*b]);
                reach(a).total_cmp(&reach(b))
            });
            if let Some(farthest) = farthest {
                is_outer[farthest] = true;
            }
        }
    }
    let outer = balls.iter().zip(is_outer).filter(|(_, outer)| *outer);
    outer.map(|(ball, _)| *ball).collect()
}

/// Directions spread evenly over half a sphere (a Fibonacci spiral).
fn views(count: usize) -> impl Iterator<Item = Vector3<f64>> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    (0..count).map(move |n| {
        let z = (n as f64 + 0.5) / count as f64;
        let across = (1.0 - z * z).sqrt();
        let (sine, cosine) = (golden * n as f64).sin_cos();
        Vector3::new(across * cosine, across * sine, z)
    })
}

/// The openings from which the search begins: the three along the principal axes, and the best of
/// many.
fn starts(balls: &[Ball]) -> Vec<Opening> {
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut found: Vec<(f64, Opening)> = Vec::with_capacity(VIEWS * TURNS);
    for view in views(VIEWS) {
        let across = if view.x.abs() < 0.6 { x } else { y };
        let first = view.cross(&across).normalize();
        let second = view.cross(&first);
        for turn in 0..TURNS {
            let (sine, cosine) = (FRAC_PI_2 * turn as f64 / TURNS as f64).sin_cos();
            let u = first * cosine + second * sine;
            let v = second * cosine - first * sine;
            let side_m = width_m(balls, &u).max(width_m(balls, &v));
            found.push((side_m, [u, v]));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut starts: Vec<Opening> = Vec::new();
    for (_, opening) in found {
        let view = |[u, v]: &Opening| u.cross(v);
        let is_new = |other: &Opening| view(other).dot(&view(&opening)).abs() < SAME_VIEW;
        if starts.len() < STARTS && starts.iter().all(is_new) {
            starts.push(opening);
        }
    }
    starts.extend([[x, y], [y, z], [z, x]]);
    starts
}

/// An opening turned by smaller and smaller angles as long as it gets smaller, and its side, m.
fn improved(balls: &[Ball], mut opening: Opening) -> (Opening, f64) {
    let [u, v] = &opening;
    let mut least_m = width_m(balls, u).max(width_m(balls, v));
    let mut step = STEPS[0];
    while step > STEPS[1] {
        let mut is_better = false;
        for turn in turns() {
            let turned = UnitQuaternion::from_scaled_axis(turn * step);
            let tried = opening.map(|direction| turned * direction);
            if let Some(side_m) = side_m(balls, &tried, least_m * (1.0 - GAIN * step)) {
                (opening, least_m, is_better) = (tried, side_m, true);
            }
        }
        if !is_better {
            step *= 0.5;
        }
    }
    (opening, least_m)
}

/// Axes of the turns tried: to the neighbours of a point in a cubic lattice. Fewer would not do,
/// since the two sides of an opening are often equal, and both have to decrease.
fn turns() -> impl Iterator<Item = Vector3<f64>> {
    (0..27).filter(|at| *at != 13).map(|at| {
        Vector3::new(
            f64::from(at % 3) - 1.0,
            f64::from(at / 3 % 3) - 1.0,
            f64::from(at / 9) - 1.0,
        )
        .normalize()
    })
}
