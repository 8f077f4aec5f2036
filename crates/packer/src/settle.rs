//! Settling: the spheres of a front that ran at smaller radii grow to their full size while an energy of their overlaps, with each other
//! and with the wall, is minimised to nothing.
//!
//! E = 1/2 sum over pairs (g_a + g_b - d)^2 + 1/2 sum over spheres (r - wall distance)^2, each where positive; g is the reduced radius.
//! The minimiser is damped dynamics: v <- (1 - c) v + response F, x <- x + v, with a damping c that falls as the steps go on (Nesterov 1983 has
//! c = 3 / step; here less falls off at first). The response takes the place of 1 / mass: it is less where many neighbours make a sphere's surroundings stiff
//! (adaptive dynamic relaxation, Underwood 1983), so that one step length suits all. FIRE, which stops the motion when it runs uphill, was
//! tried first: it takes three to four times the steps and jams at a density lower by 0.008, where light damping shakes the spheres past each other.
//! Below the jamming density it ends without overlap; radii are held larger than wanted by `MARGIN` meanwhile, so that at
//! their true size the spheres do not overlap at all.

mod near;

use self::near::{CHUNK, Near, squared_distance};
use crate::Vector3;
use crate::boundary::Boundary;
use crate::grid::Ball;
use crate::inside::is_inside;
use dem_io::{Diagnostic, Result};
use pulp::{Arch, NullaryFnOnce};
use rayon::prelude::*;

/// Relative surplus of the radii while settling.
const MARGIN: f64 = 5e-5;

/// Neighbours are listed this far beyond contact, in mean radii.
const SKIN: f64 = 0.8;
/// At its true size no sphere may stand out of the wall by more than this part of its radius when settling ends. Two spheres overlap by less
/// than the surplus of one of them then, so not at all at their true sizes.
const STANDS_OUT: f64 = 1e-10;
/// Share of the velocity that damping takes in step n: `DAMPING` / n, between the two limits.
const DAMPING: f64 = 9.0;
const DAMPING_LIMITS: [f64; 2] = [0.01, 0.03];
/// Velocity that a unit of force gives in a step to a sphere of few neighbours; with half as much again the dynamics becomes unstable.
const LARGEST_RESPONSE: f64 = 0.75;
/// So many listed neighbours are few: 6 of them touch. With more the response is less in proportion.
const FEW_NEIGHBOURS: f64 = 10.0;
/// A centre that is nearer to the wall than this share of its radius may have been pushed through it.
const BEYOND: f64 = 0.9;
/// No sphere moves farther in a step, in mean radii: centres that begin almost on each other are not shot through a wall.
const LARGEST_MOVE: f64 = 0.2;

/// Steps before spheres are taken out, at first and then between one time and the next.
const PATIENCE: [usize; 2] = [1500, 200];
/// Share of the spheres taken out the first time; each further time twice as many, up to the second share.
const TAKEN_OUT: [f64; 2] = [0.001, 0.016];
/// After so many steps settling is given up.
const MOST_STEPS: usize = 60_000;

/// A coordinate far from everything, in local units.
const FAR: f64 = 1e6;
/// Neighbours handled at once.
const LANES: usize = 4;

/// What is to be done with spheres that are jammed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhenJammed {
    /// A few are taken out, until the rest has room.
    TakeOut,
    /// Settling ends: they are to be fewer from the start.
    Stop,
}

/// How a settling run ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// Steps of the minimiser.
    pub steps: usize,
    /// Spheres taken out because they were jammed.
    pub taken_out: usize,
    /// Whether it was stopped because spheres were jammed: they still overlap.
    pub is_stopped: bool,
}

/// Spheres with what the minimiser knows of them.
struct State<'a> {
    boundary: &'a Boundary,
    balls: Vec<Ball>,
    /// Radius over reduced radius: 1 + overlap.
    enlarge: f64,
    /// x, y, z and 0, as `force`: four numbers each, like the spheres, so that all four are handled at once.
    velocity: Vec<[f64; 4]>,
    force: Vec<[f64; 4]>,
    /// Velocity gained per step and unit of force: less for spheres with many neighbours.
    response: Vec<f64>,
    near: Near,
    /// The spheres as they were when neighbours were listed.
    listed_at: Vec<Ball>,
    skin: f64,
    largest_move: f64,
}

/// Moves `balls` (centre, reduced radius at full size) until none overlaps another or the wall. Where they are jammed, some are taken out, if that is wanted:
/// of the pairs that overlap most the one with the higher index, which favours no size, and spheres that overlap the wall as much.
///
/// `progress` is told the share of the work done.
///
/// # Errors
/// What `progress` returns; no end after very many steps.
pub fn settle(
    boundary: &Boundary,
    balls: &mut Vec<Ball>,
    overlap: f64,
    when_jammed: WhenJammed,
    progress: &dyn Fn(f64) -> Result<()>,
) -> Result<Settled> {
    let mut settled = Settled {
        steps: 0,
        taken_out: 0,
        is_stopped: false,
    };
    if balls.is_empty() {
        return Ok(settled);
    }
    for ball in balls.iter_mut() {
        ball[3] *= 1.0 + MARGIN;
    }
    let mut state = State::new(boundary, std::mem::take(balls), 1.0 + overlap);
    let mut patience = PATIENCE[0];
    let mut share = TAKEN_OUT[0];
    loop {
        let worst = state.forces();
        if worst < MARGIN {
            break;
        }
        if settled.steps >= MOST_STEPS {
            return Err(Diagnostic::failed(
                "--settle",
                format!(
                    "the spheres still overlap by {:.1e} of their radius after {MOST_STEPS} steps",
                    worst
                ),
                "use a smaller share, or --settle 0 for the bare front",
            ));
        }
        if settled.steps >= patience {
            if when_jammed == WhenJammed::Stop {
                settled.is_stopped = true;
                return Ok(settled);
            }
            patience += PATIENCE[1];
            settled.taken_out += state.take_out_jammed(share);
            share = TAKEN_OUT[1].min(2.0 * share);
        } else {
            settled.steps += 1;
            let damping =
                (DAMPING / settled.steps as f64).clamp(DAMPING_LIMITS[0], DAMPING_LIMITS[1]);
            if state.accelerate_and_move(damping) {
                state.list_neighbours();
            }
        }
        if settled.steps.is_multiple_of(16) {
            progress((worst.ln() / MARGIN.ln()).clamp(0.0, 1.0))?;
        }
    }
    *balls = state.balls;
    // Spheres that began almost on the wall may have been pushed through it.
    let inside: Vec<bool> = balls
        .par_iter()
        .map(|b| is_inside(boundary, &Vector3::new(b[0], b[1], b[2])))
        .collect();
    let mut inside = inside.into_iter();
    let before = balls.len();
    balls.retain(|_| inside.next().unwrap_or(false));
    settled.taken_out += before - balls.len();
    for ball in balls.iter_mut() {
        ball[3] /= 1.0 + MARGIN;
    }
    Ok(settled)
}

impl<'a> State<'a> {
    fn new(boundary: &'a Boundary, balls: Vec<Ball>, enlarge: f64) -> Self {
        let n = balls.len();
        let mean = balls.iter().map(|b| b[3]).sum::<f64>() / n as f64;
        let mut state = Self {
            boundary,
            balls,
            enlarge,
            velocity: vec![[0.0; 4]; n],
            force: vec![[0.0; 4]; n],
            response: Vec::new(),
            near: Near::default(),
            listed_at: Vec::new(),
            skin: SKIN * mean,
            largest_move: LARGEST_MOVE * mean,
        };
        state.list_neighbours();
        state
    }

    /// Takes spheres out of the pairs that overlap most, and lets the rest come to rest. Returns how many.
    fn take_out_jammed(&mut self, share: f64) -> usize {
        let mut worst: Vec<(f64, usize)> = (0..self.balls.len())
            .into_par_iter()
            .map(|i| {
                let ball = &self.balls[i];
                let earlier = (self.near.spheres.of(i).iter()).filter(|j| (**j as usize) < i);
                let overlap = |j: &u32| {
                    let other = &self.balls[*j as usize];
                    (ball[3] + other[3] - squared_distance(ball, other).sqrt())
                        / ball[3].min(other[3])
                };
                let spheres = earlier.map(overlap).fold(0.0, f64::max);
                let centre = Vector3::new(ball[0], ball[1], ball[2]);
                let radius = ball[3] * self.enlarge;
                let wall = self.boundary.nearest(&centre, radius);
                let wall = wall.map_or(0.0, |near| wall_overlap(radius, near.distance));
                (spheres.max(wall), i)
            })
            .filter(|(overlap, _)| *overlap > MARGIN)
            .collect();
        worst.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        worst.truncate((self.balls.len() as f64 * share).ceil() as usize);
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

    /// Lists, for each sphere, the others that could come to touch it before the lists are made again.
    fn list_neighbours(&mut self) {
        let balls = &self.balls;
        // The old lists make room for the new ones.
        self.near = Near::default();
        self.near = Near::list(self.boundary, balls, self.enlarge, self.skin);
        self.listed_at.clone_from(balls);
        self.response = (0..balls.len())
            .map(|i| {
                let neighbours = self.near.spheres.of(i).len() + self.near.walls.of(i).len();
                LARGEST_RESPONSE * (FEW_NEIGHBOURS / neighbours as f64).min(1.0)
            })
            .collect();
    }

    /// Forces at the present positions. Returns the largest overlap, in radii.
    fn forces(&mut self) -> f64 {
        let (boundary, balls, near, enlarge) =
            (self.boundary, &self.balls, &self.near, self.enlarge);
        self.force
            .par_chunks_mut(CHUNK)
            .enumerate()
            .map(|(chunk, part)| {
                Arch::new().dispatch(ForcesOn {
                    force: part,
                    first: chunk * CHUNK,
                    boundary,
                    balls,
                    near,
                    enlarge,
                })
            })
            .reduce(|| 0.0, f64::max)
    }

    /// v = (1 - damping) v + response F; x += v. Returns whether a sphere is now farther than half the skin from where it was listed.
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

/// By how much a sphere of this radius, `MARGIN` larger than true, stands out of a wall at this distance from its centre, as a share of the radius.
/// Not at all if it fits at its true size: a sphere between two walls may have no room for the surplus.
fn wall_overlap(radius: f64, distance: f64) -> f64 {
    let stands_out = radius / (1.0 + MARGIN) * (1.0 - STANDS_OUT) > distance;
    if stands_out {
        1.0 - distance / radius
    } else {
        0.0
    }
}

/// The forces on the spheres from number `first` on, one for each of `force`: a call that is compiled for AVX2 as well.
struct ForcesOn<'a> {
    force: &'a mut [[f64; 4]],
    first: usize,
    boundary: &'a Boundary,
    balls: &'a [Ball],
    near: &'a Near,
    enlarge: f64,
}

impl NullaryFnOnce for ForcesOn<'_> {
    /// The largest overlap, in radii.
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let Self {
            force,
            first,
            boundary,
            balls,
            near,
            enlarge,
        } = self;
        let mut worst = 0.0_f64;
        let mut touched = Vec::new();
        for (k, f) in force.iter_mut().enumerate() {
            let ball = balls[first + k];
            let mut push = Push::default();
            let (groups, rest) = near.spheres.of(first + k).as_chunks::<LANES>();
            for group in groups {
                push.add(&ball, group.map(|j| balls[j as usize]));
            }
            if !rest.is_empty() {
                // Filled up with points far away, which touch nothing.
                let mut last = [[FAR, FAR, FAR, 0.0]; LANES];
                for (other, j) in last.iter_mut().zip(rest) {
                    *other = balls[*j as usize];
                }
                push.add(&ball, last);
            }
            let (mut total, worst_overlap) = push.sum();
            worst = worst.max(worst_overlap / ball[3]);
            let walls = near.walls.of(first + k);
            if !walls.is_empty() {
                let (centre, radius) = (Vector3::new(ball[0], ball[1], ball[2]), ball[3] * enlarge);
                boundary.walls(walls.iter().copied(), &centre, radius, &mut touched);
                // A centre that was pushed through the wall is drawn back.
                let side = match touched.first() {
                    Some(wall)
                        if wall.distance < BEYOND * radius
                            && boundary.is_behind_nearest(walls.iter().copied(), &centre)
                                == Some(false) =>
                    {
                        -1.0
                    }
                    _ => 1.0,
                };
                for wall in &touched {
                    let overlap = radius - side * wall.distance;
                    let push = side * overlap / wall.distance;
                    for axis in 0..3 {
                        total[axis] += push * (ball[axis] - wall.point[axis]);
                    }
                    worst = worst.max(wall_overlap(radius, side * wall.distance));
                }
            }
            *f = [total[0], total[1], total[2], 0.0];
        }
        worst
    }
}

/// Forces and largest overlaps of the neighbours of one sphere, in `LANES` sums that are added up at the end.
#[derive(Default)]
struct Push {
    force: [[f64; LANES]; 3],
    overlap: [f64; LANES],
}

impl Push {
    /// Adds `LANES` neighbours of `ball`, all at once and without a branch: whether near spheres touch changes too often to be predicted.
    #[expect(
        clippy::needless_range_loop,
        reason = "several arrays side by side, lane by lane"
    )]
    #[inline(always)]
    fn add(&mut self, ball: &Ball, others: [Ball; LANES]) {
        let mut d = [[0.0; LANES]; 3];
        let (mut squared, mut touching, mut overlap, mut push) =
            ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            for axis in 0..3 {
                d[axis][k] = ball[axis] - others[k][axis];
            }
            touching[k] = ball[3] + others[k][3];
        }
        for k in 0..LANES {
            squared[k] = d[0][k] * d[0][k] + d[1][k] * d[1][k] + d[2][k] * d[2][k];
        }
        let distance = squared.map(f64::sqrt);
        for k in 0..LANES {
            overlap[k] = if touching[k] > distance[k] {
                touching[k] - distance[k]
            } else {
                0.0
            };
        }
        for k in 0..LANES {
            push[k] = overlap[k] / distance[k];
        }
        for k in 0..LANES {
            self.overlap[k] = if overlap[k] > self.overlap[k] {
                overlap[k]
            } else {
                self.overlap[k]
            };
            for axis in 0..3 {
                self.force[axis][k] += push[k] * d[axis][k];
            }
        }
    }

    /// The whole force and the largest overlap.
    fn sum(&self) -> ([f64; 3], f64) {
        (
            self.force.map(|lanes| lanes.iter().sum()),
            self.overlap.iter().copied().fold(0.0, f64::max),
        )
    }
}
