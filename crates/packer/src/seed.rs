//! The start of a front: the deepest point of the solid, and the first three spheres (Platzer 2022,
//! section 4.1.1).

use crate::geometry::boundary::Boundary;
use crate::geometry::inside::{first_hit, is_inside};
use crate::spheres::Vector3;
use dem_io::Surface;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// A ball inside the solid, local units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InscribedSphere {
    /// Its centre.
    pub centre: Vector3,
    /// Its distance to the surface.
    pub radius: f64,
}

/// Largest number of facets probed for the thickness of the solid behind them.
const MOST_PROBES: usize = 4_000;
/// Number of grid points along the longest edge of the bounding box.
const GRID_POINTS: f64 = 16.0;

/// Points spread over the inside of the solid with their distances to the surface, deepest first:
/// middles of the chords that begin at facets and run inwards (they find every part, however thin),
/// and the points of a coarse grid.
pub fn inner_points(boundary: &Boundary, surface: &Surface) -> Vec<InscribedSphere> {
    let stride = surface.triangles.len().div_ceil(MOST_PROBES);
    let chords: Vec<Vector3> = (0..surface.triangles.len())
        .into_par_iter()
        .filter(|t| t % stride == 0)
        .filter_map(|t| {
            let [a, b, c] = surface.corners(t).map(Vector3::from);
            let inward = -(b - a).cross(&(c - a)).try_normalize(0.0)?;
            let start = (a + b + c) / 3.0;
            let length = first_hit(boundary, &start, &inward, 1e-7)?;
            Some(start + inward * (0.5 * length))
        })
        .collect();
    let extent = surface.extent();
    let spacing = extent.iter().copied().fold(0.0, f64::max) / GRID_POINTS;
    let counts = extent.map(|e| (e / spacing).ceil().max(1.0) as usize);
    let grid = (0..counts.iter().product::<usize>()).map(|at| {
        let cell = [
            at % counts[0],
            at / counts[0] % counts[1],
            at / (counts[0] * counts[1]),
        ];
        Vector3::from([0, 1, 2].map(|k| (cell[k] as f64 + 0.5) * extent[k] / counts[k] as f64))
    });
    let mut points: Vec<Vector3> = chords.into_iter().chain(grid).collect();
    // Of points that nearly coincide (all chords of a ball meet in its middle) one is enough.
    let cell = |p: &Vector3| [p.x, p.y, p.z].map(|x| (x / (0.05 * spacing)).round() as i64);
    points.sort_by_key(cell);
    points.dedup_by_key(|p| cell(p));
    let mut inner: Vec<InscribedSphere> = points
        .into_par_iter()
        .filter(|p| is_inside(boundary, p))
        .filter_map(|centre| {
            boundary
                .nearest(&centre, f64::MAX)
                .map(|near| InscribedSphere {
                    centre,
                    radius: near.distance,
                })
        })
        .collect();
    inner.sort_by(|a, b| b.radius.total_cmp(&a.radius));
    inner
}

/// One random point in each cell of a lattice of about `spacing` over the box from the origin to
/// `extent`, local units, at least a third of a cell apart.
pub fn spread_points(extent: &[f64; 3], spacing: f64, seed: u64) -> Vec<Vector3> {
    let counts = extent.map(|e| (e / spacing).round().max(1.0) as usize);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(u64::MAX);
    (0..counts.iter().product())
        .map(|at: usize| {
            let cell = [
                at % counts[0],
                at / counts[0] % counts[1],
                at / (counts[0] * counts[1]),
            ];
            Vector3::from([0, 1, 2].map(|k| {
                (cell[k] as f64 + 1.0 / 6.0 + 2.0 / 3.0 * random.random::<f64>()) * extent[k]
                    / counts[k] as f64
            }))
        })
        .collect()
}

/// Moves a ball inside the solid to the nearby maximum of `clearance` (local units, negative where
/// forbidden), by steps that halve from `first_step` to `last_step`.
pub(crate) fn climb(
    start: &Vector3,
    first_step: f64,
    last_step: f64,
    clearance: &dyn Fn(&Vector3) -> f64,
) -> InscribedSphere {
    let mut best = InscribedSphere {
        centre: *start,
        radius: clearance(start),
    };
    let mut step = first_step;
    while step > last_step {
        let before = best;
        for direction in directions() {
            let centre = before.centre + direction * step;
            let radius = clearance(&centre);
            if radius > best.radius {
                best = InscribedSphere { centre, radius };
            }
        }
        if best == before {
            step *= 0.5;
        }
    }
    best
}

/// Directions to the neighbours of a point in a cubic lattice, scaled so that those at the corners
/// have length 1.
fn directions() -> impl Iterator<Item = Vector3> {
    let diagonal = 1.0 / 3.0_f64.sqrt();
    (0..27).filter(|at| *at != 13).map(move |at| {
        Vector3::new(
            f64::from(at % 3) - 1.0,
            f64::from(at / 3 % 3) - 1.0,
            f64::from(at / 9) - 1.0,
        ) * diagonal
    })
}

/// The triangles of the wall that may be nearest to a point within `reach` of `base`.
///
/// A distance changes by no more than the distance between two points, so triangles farther away
/// than the nearest one by twice the reach are excluded.
struct NearestAround {
    base: Vector3,
    reach: f64,
    /// Lower bound of the distance from `base` and index; nearest first. None if there are too
    /// many: then the tree is searched.
    triangles: Option<Vec<(f64, u32)>>,
}

/// Largest number of triangles that are listed around a point.
const MOST_LISTED: usize = 1_000;
/// Fraction of a reach within which there were too many at which they are counted again.
const FEWER: f64 = 0.1;
/// Length for which a list lasts, in steps.
const STEPS: f64 = 8.0;

impl NearestAround {
    fn new(boundary: &Boundary, ball: &InscribedSphere, reach: f64) -> Self {
        let limit = ball.radius + 2.0 * reach;
        Self::among(
            boundary.triangles_near(&ball.centre, limit),
            boundary,
            ball,
            reach,
        )
    }

    fn among(
        triangles: impl Iterator<Item = u32>,
        boundary: &Boundary,
        ball: &InscribedSphere,
        reach: f64,
    ) -> Self {
        let mut triangles: Vec<(f64, u32)> = triangles
            .map(|t| (boundary.least_distance(t, &ball.centre), t))
            .filter(|(distance, _)| *distance <= ball.radius + 2.0 * reach)
            .take(MOST_LISTED + 1)
            .collect();
        triangles.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Self {
            base: ball.centre,
            reach,
            triangles: (triangles.len() <= MOST_LISTED).then_some(triangles),
        }
    }

    /// Those for steps of this length from another ball, or shorter ones from this one.
    fn moved(self, boundary: &Boundary, ball: &InscribedSphere, step: f64) -> Self {
        let reach = STEPS * step;
        let moved = (ball.centre - self.base).norm();
        match &self.triangles {
            Some(known) if moved + reach <= self.reach => {
                Self::among(known.iter().map(|(_, t)| *t), boundary, ball, reach)
            }
            Some(_) if moved + step <= self.reach => self,
            None if reach > FEWER * self.reach => self,
            _ => Self::new(boundary, ball, reach),
        }
    }

    /// Distance from `point` to the wall, if it is more than `least`.
    fn distance_above(&self, boundary: &Boundary, point: &Vector3, least: f64) -> Option<f64> {
        let Some(triangles) = &self.triangles else {
            if !boundary.clears(point, least) {
                return None;
            }
            let distance = boundary.nearest(point, f64::MAX)?.distance;
            return (distance > least).then_some(distance);
        };
        let moved = (point - self.base).norm();
        let mut nearest = f64::INFINITY;
        for (from_base, triangle) in triangles {
            if from_base - moved >= nearest {
                break;
            }
            nearest = nearest.min(boundary.nearest_on(*triangle, point).distance);
            if nearest <= least {
                return None;
            }
        }
        Some(nearest)
    }
}

/// As [`climb`], to the place farthest from the wall. The steps are never longer than the distance
/// to the wall, so that the climb stays inside.
fn climb_from_wall(boundary: &Boundary, start: &InscribedSphere) -> InscribedSphere {
    let mut best = *start;
    let mut step = 0.5 * start.radius;
    let mut near = NearestAround::new(boundary, &best, STEPS * step);
    while step > 1e-8 * start.radius {
        let before = best;
        near = near.moved(boundary, &before, step);
        for direction in directions() {
            let centre = before.centre + direction * step;
            if let Some(radius) = near.distance_above(boundary, &centre, best.radius) {
                best = InscribedSphere { centre, radius };
            }
        }
        if best == before {
            step *= 0.5;
        }
    }
    best
}

/// The largest ball that fits into the solid, as found by climbing from the deepest of
/// `inner_points`; of several equal ones the nearest to the middle of the bounding box.
pub fn deepest_point(
    boundary: &Boundary,
    surface: &Surface,
    inner: &[InscribedSphere],
) -> Option<InscribedSphere> {
    let deep = inner
        .iter()
        .take_while(|ball| ball.radius >= 0.9 * inner[0].radius);
    let middle = 0.5 * Vector3::from(surface.extent());
    let mut deep: Vec<&InscribedSphere> = deep.collect();
    deep.sort_by(|a, b| {
        (a.centre - middle)
            .norm()
            .total_cmp(&(b.centre - middle).norm())
    });
    let mut found: Vec<InscribedSphere> = Vec::new();
    for start in deep.into_iter().take(4).chain(inner.first()) {
        // A climb that starts next to a known place would end there again.
        let known =
            |ball: &InscribedSphere| (ball.centre - start.centre).norm() < 0.5 * ball.radius;
        if !found.iter().any(known) {
            found.push(climb_from_wall(boundary, start));
        }
    }
    let deepest = found.iter().map(|ball| ball.radius).fold(0.0, f64::max);
    found
        .into_iter()
        .find(|ball| ball.radius >= deepest * (1.0 - 1e-6))
}

/// Centres for the first spheres of a front around `centre`: as many of the three (radii and
/// reduced radii, local units) as fit, mutually touching.
pub fn first_spheres(
    centre: &Vector3,
    radii: [f64; 3],
    reduced: [f64; 3],
    fits: &dyn Fn(&Vector3, f64) -> bool,
) -> Vec<(Vector3, f64)> {
    let [a, b, c] = reduced;
    // A triangle with sides a + b, a + c, b + c.
    let (ab, ac, bc) = (a + b, a + c, b + c);
    let x = (ab * ab + ac * ac - bc * bc) / (2.0 * ab);
    let corners = [
        Vector3::zeros(),
        Vector3::new(ab, 0.0, 0.0),
        Vector3::new(x, (ac * ac - x * x).max(0.0).sqrt(), 0.0),
    ];
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let mut best: Vec<(Vector3, f64)> = Vec::new();
    // First around the centre, then with the first sphere on it, each in a fixed set of
    // orientations.
    for origin in [middle, Vector3::zeros()] {
        for turn in 0..64 {
            let rotation = nalgebra::UnitQuaternion::from_euler_angles(
                0.41 * f64::from(turn),
                1.3 * f64::from(turn / 4),
                0.77 * f64::from(turn / 2),
            );
            let mut found = Vec::new();
            for k in 0..3 {
                let place = centre + rotation * (corners[k] - origin);
                if fits(&place, radii[k]) {
                    found.push((place, radii[k]));
                } else {
                    break;
                }
            }
            if found.len() > best.len() {
                best = found;
            }
            if best.len() == 3 {
                return best;
            }
        }
    }
    best
}
