//! The minimiser of the overlaps' energy: damped dynamics.

use super::forces::{ForcesOn, MARGIN, wall_overlap};
use super::inside::find_inside;
use super::neighbours::{CHUNK, NeighbourLists, squared_distance};
use super::walls::WallLists;
use crate::geometry::boundary::Boundary;
use crate::grid::WIDEST_CLASS;
use crate::pack::shrink::thin_out;
use crate::spheres::{ReducedSphere, centre_of};
use dem_io::{Diagnostic, Result};
use rayon::prelude::*;

/// Skin: distance beyond contact up to which neighbours are listed, in mean radii.
const SKIN: f64 = 0.8;
/// Fraction of the velocity that damping removes in step n: `DAMPING` / n, between the two limits.
const DAMPING: f64 = 9.0;
const DAMPING_LIMITS: [f64; 2] = [0.01, 0.03];
/// The damping once no two spheres overlap by more than `NEARLY_DONE` of a radius: they have found
/// their places, and what is left only has to decay. After `SLOW` such steps only slow motions are
/// left, which light damping stops sooner. Where large spheres lie among many small ones all
/// motions are slow.
const LAST_DAMPING: [f64; 2] = [0.1, 0.03];
const SLOW: usize = 100;
const NEARLY_DONE: f64 = 0.03;
/// Limits of the fraction of its radius that a sphere moves at the wall until it is measured anew:
/// planes stand for the wall for so long.
const PLANES_LAST: [f64; 2] = [5e-4, 0.5];
/// That fraction over the largest overlap, in radii, once this is small. Facets that lean by up to
/// 14 degrees from a nearer plane have no plane of their own. After a move such a facet may stick
/// out of that plane by a quarter of the move, here by twice the overlap, and mostly by much less.
/// With 4 and with 12, densifying takes as long.
const PLANES_LAST_OVERLAPS: f64 = 8.0;
/// Velocity that a unit of force gives per step to a sphere of few neighbours; 1.5 times this value
/// makes the dynamics unstable.
const LARGEST_RESPONSE: f64 = 0.75;
/// Number of listed neighbours up to which they are few: 6 of them touch. With more, the response
/// decreases in proportion.
const FEW_NEIGHBOURS: f64 = 10.0;
/// Number of triangles of the wall that count as neighbours: more walls than that do not meet.
const MOST_WALLS: usize = 3;
/// Largest move of a sphere in a step, in mean radii: centres that begin almost at the same place
/// are not shot through a wall, and the few fastest spheres do not set how often neighbours are
/// listed. With half of it spheres are not shaken past each other.
const LARGEST_MOVE: f64 = 0.1;

/// Number of steps before spheres are left or taken out: the first time, and between later times.
const PATIENCE: [usize; 2] = [1000, 200];
/// Part of the spheres left out evenly each time, and the number of times.
const THINNED_OUT: f64 = 0.009;
const MOST_THINNINGS: usize = 3;
/// Fraction of the spheres taken out the first time; it doubles each time, up to the second value.
const TAKEN_OUT: [f64; 2] = [0.001, 0.016];
/// Number of steps after which settling fails.
const MOST_STEPS: usize = 60_000;

/// Treatment of spheres that are jammed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhenJammed {
    /// A few of those that overlap most are taken out, until the rest has room.
    TakeOut,
    /// Some are left out evenly, without regard to size, `MOST_THINNINGS` times at most. Then a few
    /// are taken out.
    ThinOut,
}

/// Result of a settling run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Settled {
    /// Number of steps of the minimiser.
    pub steps: usize,
    /// Number of spheres left out evenly because they were jammed.
    pub thinned: usize,
    /// Number of spheres taken out because they were jammed.
    pub taken_out: usize,
}

/// Spheres with the variables of the minimiser.
struct State<'a> {
    boundary: &'a Boundary,
    balls: Vec<ReducedSphere>,
    /// Radius over reduced radius: 1 + overlap.
    enlarge: f64,
    /// x, y, z and 0, like `force`: four numbers each, as for the spheres, so that all four are
    /// processed at once.
    velocity: Vec<[f64; 4]>,
    force: Vec<[f64; 4]>,
    /// Velocity gained per step and unit of force: less for spheres with many neighbours.
    response: Vec<f64>,
    near: NeighbourLists,
    walls: WallLists<'a>,
    /// The spheres when neighbours were listed last.
    listed_at: Vec<ReducedSphere>,
    skin: f64,
    largest_move: f64,
    /// The largest overlap at the last positions, in radii.
    worst: f64,
}

/// Moves spheres (reduced radii at full size) until none overlaps another or the wall. If they are
/// jammed, some are taken out on request: of the pairs that overlap most the one with the higher
/// index, which favours no size, and spheres that overlap the wall as much.
///
/// `progress` is called with the completed fraction of the work. No convergence after very many
/// steps is an error.
pub fn minimise_overlaps(
    boundary: &Boundary,
    balls: &mut Vec<ReducedSphere>,
    overlap: f64,
    when_jammed: WhenJammed,
    progress: &dyn Fn(f64) -> Result<()>,
) -> Result<Settled> {
    let mut settled = Settled::default();
    if balls.is_empty() {
        return Ok(settled);
    }
    for ball in balls.iter_mut() {
        ball[3] *= 1.0 + MARGIN;
    }
    let mut state = State::new(boundary, std::mem::take(balls), 1.0 + overlap);
    let mut thinnings = match when_jammed {
        WhenJammed::TakeOut => 0,
        WhenJammed::ThinOut => MOST_THINNINGS,
    };
    let mut patience = PATIENCE[0];
    let mut fraction = TAKEN_OUT[0];
    let mut nearly_done = if state.is_wide() { SLOW } else { 0 };
    loop {
        let mut worst = state.forces();
        if worst < MARGIN {
            // The walls may be known approximately only.
            state.walls.forget();
            worst = state.forces();
            if worst < MARGIN {
                break;
            }
        }
        if settled.steps >= MOST_STEPS {
            return Err(Diagnostic::failed(
                "--densify",
                format!(
                    "the spheres still overlap by {worst:.1e} of their radius after {MOST_STEPS} steps"
                ),
                "use a smaller fraction, or --densify 0 for the bare front",
            ));
        }
        if settled.steps >= patience {
            patience += PATIENCE[1];
            if thinnings > 0 {
                thinnings -= 1;
                settled.thinned += state.thin_out();
            } else {
                settled.taken_out += state.take_out_jammed(fraction);
                fraction = TAKEN_OUT[1].min(2.0 * fraction);
            }
        } else {
            settled.steps += 1;
            nearly_done += usize::from(worst < NEARLY_DONE);
            if state.accelerate_and_move(damping(settled.steps, worst, nearly_done)) {
                state.list_neighbours();
            }
        }
        if settled.steps.is_multiple_of(16) {
            progress((worst.ln() / MARGIN.ln()).clamp(0.0, 1.0))?;
        }
    }
    settled.taken_out += state.take_out_those_outside();
    *balls = state.balls;
    for ball in balls.iter_mut() {
        ball[3] /= 1.0 + MARGIN;
    }
    Ok(settled)
}

/// The fraction of the velocity that is removed in a step, for the largest overlap in radii and the
/// number of steps in which overlaps were nearly done.
fn damping(step: usize, largest_overlap: f64, nearly_done: usize) -> f64 {
    if largest_overlap < NEARLY_DONE {
        LAST_DAMPING[usize::from(nearly_done > SLOW)]
    } else {
        (DAMPING / step as f64).clamp(DAMPING_LIMITS[0], DAMPING_LIMITS[1])
    }
}

/// The fraction of its radius that a sphere may move while planes stand for the wall, if the
/// largest overlap is `worst` radii. At an edge that points inwards the wall is then farther than
/// its plane by about half of that overlap at most.
fn planes_last(worst: f64) -> f64 {
    let [least, most] = PLANES_LAST;
    worst
        .sqrt()
        .min(PLANES_LAST_OVERLAPS * worst)
        .clamp(least, most)
}

impl<'a> State<'a> {
    fn new(boundary: &'a Boundary, balls: Vec<ReducedSphere>, enlarge: f64) -> Self {
        let n = balls.len();
        let mean = balls.iter().map(|b| b[3]).sum::<f64>() / n as f64;
        let skin = SKIN * mean;
        let mut state = Self {
            boundary,
            walls: WallLists::new(boundary, &balls, enlarge, skin),
            balls,
            enlarge,
            velocity: vec![[0.0; 4]; n],
            force: vec![[0.0; 4]; n],
            response: Vec::new(),
            near: NeighbourLists::default(),
            listed_at: Vec::new(),
            skin,
            largest_move: LARGEST_MOVE * mean,
            worst: f64::INFINITY,
        };
        state.list_neighbours();
        state
    }

    /// True if there are small spheres among much larger ones.
    fn is_wide(&self) -> bool {
        let radii = || self.balls.iter().map(|ball| ball[3]);
        let largest = radii().fold(0.0, f64::max);
        radii().fold(largest, f64::min) * WIDEST_CLASS < largest
    }

    /// Leaves out some spheres evenly, and lets the others come to rest. Returns the number left
    /// out.
    fn thin_out(&mut self) -> usize {
        let boundary = self.boundary;
        let mut balls = std::mem::take(&mut self.balls);
        let number = thin_out(&mut balls, THINNED_OUT);
        *self = Self::new(boundary, balls, self.enlarge);
        number
    }

    /// Takes spheres out of the pairs that overlap most, and lets the others come to rest. Returns
    /// the number taken out.
    fn take_out_jammed(&mut self, fraction: f64) -> usize {
        let mut worst: Vec<(f64, usize)> = (0..self.balls.len())
            .into_par_iter()
            .map(|i| {
                let ball = &self.balls[i];
                let earlier = self.near.of(i).iter().filter(|j| (**j as usize) < i);
                let overlap = |j: &u32| {
                    let other = &self.balls[*j as usize];
                    (ball[3] + other[3] - squared_distance(ball, other).sqrt())
                        / ball[3].min(other[3])
                };
                let spheres = earlier.map(overlap).fold(0.0, f64::max);
                let centre = centre_of(ball);
                let radius = ball[3] * self.enlarge;
                let wall = self.boundary.nearest(&centre, radius);
                let wall = wall.map_or(0.0, |near| wall_overlap(radius, near.distance));
                (spheres.max(wall), i)
            })
            .filter(|(overlap, _)| *overlap > MARGIN)
            .collect();
        worst.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        worst.truncate((self.balls.len() as f64 * fraction).ceil() as usize);
        let mut out = vec![false; self.balls.len()];
        for (_, i) in &worst {
            out[*i] = true;
        }
        let mut index = 0;
        self.balls.retain(|_| {
            index += 1;
            !out[index - 1]
        });
        let boundary = self.boundary;
        *self = Self::new(boundary, std::mem::take(&mut self.balls), self.enlarge);
        worst.len()
    }

    /// Takes out spheres that began almost on the wall and were pushed through it. Returns their
    /// number.
    fn take_out_those_outside(&mut self) -> usize {
        let inside = find_inside(self.boundary, &self.balls, &self.near, &self.walls);
        let mut inside = inside.into_iter();
        let before = self.balls.len();
        self.balls.retain(|_| inside.next().unwrap_or(false));
        before - self.balls.len()
    }

    /// Lists, for each sphere, the others that it could touch before the lists are rebuilt.
    fn list_neighbours(&mut self) {
        let balls = &self.balls;
        // Frees the old lists before the new ones are allocated.
        self.near = NeighbourLists::default();
        self.near = NeighbourLists::new(balls, self.skin);
        self.walls.renew(balls);
        self.listed_at.clone_from(balls);
        let neighbours = (0..balls.len()).map(|i| self.near.of(i).len());
        let response = |n: usize| LARGEST_RESPONSE * (FEW_NEIGHBOURS / n as f64).min(1.0);
        self.response = neighbours.map(response).collect();
        for (i, triangles) in self.walls.triangles() {
            let walls = triangles.count().min(MOST_WALLS);
            self.response[i] = response(self.near.of(i).len() + walls);
        }
    }

    /// Forces at the present positions. Returns the largest overlap, in radii.
    fn forces(&mut self) -> f64 {
        let (boundary, balls, enlarge) = (self.boundary, &self.balls, self.enlarge);
        let planes_last = planes_last(self.worst);
        let force = self.force.par_chunks_mut(CHUNK);
        let spheres = self.near.chunks.par_iter();
        let walls = self.walls.chunks.par_iter_mut();
        self.worst = (force, spheres, walls)
            .into_par_iter()
            .enumerate()
            .map(|(chunk, (force, spheres, walls))| {
                let on = ForcesOn {
                    force,
                    first: chunk * CHUNK,
                    boundary,
                    balls,
                    spheres,
                    walls,
                    enlarge,
                    planes_last,
                };
                on.find()
            })
            .reduce(|| 0.0, f64::max);
        self.worst
    }

    /// v = (1 - damping) v + response F; x += v. Returns true if a sphere has moved by more than
    /// half the skin since it was listed.
    fn accelerate_and_move(&mut self, damping: f64) -> bool {
        let keep = 1.0 - damping;
        let most = self.largest_move;
        let balls = self.balls.par_chunks_mut(CHUNK);
        let velocity = self.velocity.par_chunks_mut(CHUNK);
        let force = self.force.par_chunks(CHUNK);
        let response = self.response.par_chunks(CHUNK);
        let listed_at = self.listed_at.par_chunks(CHUNK);
        let farthest = (balls, velocity, force, response, listed_at)
            .into_par_iter()
            .map(|(balls, velocity, force, response, listed_at)| {
                let mut farthest = 0.0;
                for k in 0..balls.len() {
                    let v = &mut velocity[k];
                    for axis in 0..4 {
                        v[axis] = keep * v[axis] + response[k] * force[k][axis];
                    }
                    let speed_squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
                    if speed_squared > most * most {
                        *v = v.map(|v| v * most / speed_squared.sqrt());
                    }
                    let mut moved = [0.0; 4];
                    for axis in 0..4 {
                        balls[k][axis] += v[axis];
                        moved[axis] = balls[k][axis] - listed_at[k][axis];
                    }
                    let squared = moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2];
                    farthest = if squared > farthest {
                        squared
                    } else {
                        farthest
                    };
                }
                farthest
            })
            .reduce(|| 0.0, f64::max);
        farthest > (0.5 * self.skin).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::super::walls::ChunkOfWalls;
    use super::*;
    use crate::geometry::inside::is_inside;
    use crate::geometry::surface_in_mm;
    use crate::spheres::Vector3;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn planes_hide_no_more_than_a_few_overlaps() -> Result<()> {
        let mut random = rand::rngs::ChaCha8Rng::seed_from_u64(24);
        let mut hidden = 0;
        for stl in [
            &include_bytes!("../../../../../data/shapes/torus.stl")[..],
            &include_bytes!("../../../../../data/shapes/rock.stl")[..],
        ] {
            let surface = surface_in_mm(stl)?;
            let boundary = Boundary::new(&surface)?;
            let extent = surface.extent();
            for _ in 0..4000 {
                let centre = Vector3::from(extent.map(|most| random.random_range(0.0..most)));
                let near = boundary.nearest(&centre, 0.1 * extent[0]);
                let Some(near) = near.filter(|_| is_inside(&boundary, &centre)) else {
                    continue;
                };
                let worst = 10.0_f64.powf(random.random_range(-4.0..-0.7));
                let radius = near.distance * (1.0 + worst);
                let lasts = planes_last(worst) * radius;
                let ball = [centre.x, centre.y, centre.z, radius];
                let mut walls = WallLists::new(&boundary, &[ball], 1.0, SKIN * radius);
                let ChunkOfWalls {
                    near,
                    listed_at,
                    search,
                } = &mut walls.chunks[0];
                let mut overlap_at = |ball: &ReducedSphere| {
                    let mut overlap = 0.0_f64;
                    let sphere = (ball, radius, &listed_at[0]);
                    near[0].touching(&boundary, sphere, lasts, search, |_, height| {
                        overlap = overlap.max(radius - height);
                    });
                    overlap
                };
                let exact = |centre: &Vector3| {
                    let near = boundary.nearest(centre, radius);
                    near.map_or(0.0, |near| radius - near.distance)
                };
                let off = overlap_at(&ball) - exact(&centre);
                assert!(off.abs() < 1e-12 * extent[0], "{off}");
                let direction = [(); 3].map(|()| random.random_range(-1.0..1.0));
                let moved = centre + 0.999 * lasts * Vector3::from(direction).normalize();
                let left = exact(&moved) - overlap_at(&[moved.x, moved.y, moved.z, radius]);
                assert!(left <= 2.5 * worst * radius, "{worst}: {}", left / radius);
                hidden += usize::from(left > 0.1 * worst * radius);
            }
        }
        assert!(hidden > 100, "{hidden}");
        Ok(())
    }
}
