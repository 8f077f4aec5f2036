//! Which particles have moved too far from where they were when their neighbours were last
//! searched for, and the balls around the others.

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::stages::chunks::{CHUNK, chunk_of, chunks_of};
use crate::stages::clumps::motion::{place_of, speed_m_s};
use crate::state::State;
use crate::state::clumps::{Clump, Clumps, Template};
use crate::state::contacts::Contacts;
use crate::state::particles::{Particles, Pose};
use crate::state::search::buffers::{Due, SearchBuffers};
use crate::state::search::clusters::is_large;
use crate::state::search::references::References;
use crate::state::search::rigid_balls::ClumpReference;
use dem_physics::geometry::balls::Ball;
use dem_physics::rotation::rotation;

/// The distance of a free particle is also at least that for this fraction of the speed of the
/// fastest in its chunk: particles of a chunk are mostly near each other, so that it may be hit.
const OF_FASTEST: f64 = 0.5;
/// Number of steps that a particle may go on at its present speed until its next search.
const STEPS: f64 = 80.0;
/// The same for a clump: its spheres are many, but few of them are near something.
const STEPS_OF_CLUMP: f64 = 40.0;
/// Largest distance that a clump may move between two searches, as a multiple of the radius of its
/// largest sphere.
const FARTHEST_OF_CLUMP: f64 = 1.0;
/// When a search is due, every free particle is searched for that has less than this fraction of
/// its distance left: a search takes almost as long for few particles as for many.
const SOON: f64 = 0.8;
/// A search is due when a clump has less than this fraction of its distance left.
const NOW_OF_CLUMP: f64 = 0.1;
/// Then every clump that has less than this fraction left, if it would use up what it has in this
/// number of steps at its present speed.
const SOON_OF_CLUMP: (f64, f64) = (0.9, 30.0);
/// After two more steps like the last, unlisted particles could overlap.
const STEPS_LEFT: f64 = 2.0;

/// Clumps that a task gives new references.
const CLUMPS_AT_ONCE: usize = 64;

/// Whether it is to be found out what is due. Otherwise nothing has used up its distance, and
/// nothing is requested.
pub(super) fn may_be_due(state: &State, contacts: &Contacts) -> bool {
    let references = &contacts.scratch.references;
    let chunks = references.chunks_left_m.iter();
    let mut chunks = chunks.zip(&state.scratch.chunks_moved_m);
    let mut clumps = references.clumps.iter().zip(&state.clumps.all);
    contacts.skin_left_m < 0.0
        || !references.due.is_empty()
        || references.balls.len() != state.particles.len()
        || chunks.any(|(left_m, moved_m)| *left_m < STEPS_LEFT * moved_m)
        || clumps.any(|(reference, clump)| {
            !clump.asleep && reference.left_m < STEPS_LEFT * clump.moved_m
        })
}

/// Subtracts the displacements in a drift from the distances left.
pub(super) fn use_up(chunks_moved_m: &[f64], clumps: &Clumps, references: &mut References) {
    for (left_m, moved_m) in references.chunks_left_m.iter_mut().zip(chunks_moved_m) {
        *left_m -= moved_m;
    }
    for (reference, clump) in references.clumps.iter_mut().zip(&clumps.all) {
        reference.left_m -= clump.moved_m;
    }
}

/// Finds what is due: what is requested, and if anything else is urgent, all that soon would be.
pub(super) fn find_due(
    state: &State,
    references: &mut References,
    SearchBuffers { due, seeks, .. }: &mut SearchBuffers,
) {
    due.clear();
    let is_urgent = is_urgent(state, references);
    if !is_urgent && references.due.is_empty() {
        return;
    }
    let p = &state.particles;
    let step_s = state.time_step_s;
    let is_due = |i: usize| {
        if p.sleeps(i) {
            return false;
        }
        let [left_m, allowance_m] = free_left_m(p, references, i);
        left_m < least_m(SOON * allowance_m, p.motions[i].speed_m_s() * step_s)
    };
    seeks.clear();
    seeks.resize(p.len(), false);
    if is_urgent {
        let free = seeks[..p.free].par_iter_mut().with_min_len(CHUNK);
        free.enumerate().for_each(|(i, seeks)| *seeks = is_due(i));
    }
    for &i in references.due.iter().filter(|i| !p.sleeps(**i as usize)) {
        match state.clumps.carrier_of(i as usize) {
            Some(clump) => due.clumps.push(clump),
            None => seeks[i as usize] = true,
        }
    }
    let free = (0..).zip(&seeks[..p.free]);
    due.particles
        .extend(free.filter(|(_, seeks)| **seeks).map(|(i, _)| i));
    if is_urgent {
        add_clumps_soon_due(state, references, due);
    }
    due.clumps.sort_unstable();
    due.clumps.dedup();
    for &at in &due.clumps {
        seeks[state.clumps.spheres_of(&state.clumps.all[at])].fill(true);
    }
}

/// Adds the clumps that would soon be due.
fn add_clumps_soon_due(state: &State, references: &mut References, due: &mut Due) {
    let clumps = state.clumps.all.iter().zip(&mut references.clumps);
    for (n, (clump, reference)) in clumps.enumerate().filter(|(_, (clump, _))| !clump.asleep) {
        reference.left_m = clump_left_m(&state.clumps, clump, reference);
        let (fraction, steps) = SOON_OF_CLUMP;
        let [now_m, soon_m] = [NOW_OF_CLUMP, fraction].map(|part| part * reference.allowance_m);
        let soon_m = soon_m.min(steps * clump.moved_m).max(now_m);
        if reference.left_m < least_m(soon_m, clump.moved_m) {
            due.clumps.push(n);
        }
    }
}

/// Whether anything is due that is not requested, among the chunks and clumps that have used up
/// what was surely left. Of those that are not, it finds what is left.
fn is_urgent(state: &State, references: &mut References) -> bool {
    let p = &state.particles;
    let mut urgent = false;
    for chunk in 0..references.chunks_left_m.len() {
        let moved_m = state.scratch.chunks_moved_m.get(chunk).copied();
        if references.chunks_left_m[chunk] < STEPS_LEFT * moved_m.unwrap_or(0.0) {
            let mut least_left_m = f64::INFINITY;
            for i in chunk_of(chunk, p.free).filter(|&i| !p.sleeps(i)) {
                let [left_m, _] = free_left_m(p, references, i);
                least_left_m = least_left_m.min(left_m);
                let moved_m = p.motions[i].speed_m_s() * state.time_step_s;
                urgent |= left_m < STEPS_LEFT * moved_m;
            }
            references.chunks_left_m[chunk] = least_left_m;
        }
    }
    for (clump, reference) in state.clumps.all.iter().zip(&mut references.clumps) {
        if !clump.asleep && reference.left_m < STEPS_LEFT * clump.moved_m {
            reference.left_m = clump_left_m(&state.clumps, clump, reference);
            urgent |=
                reference.left_m < least_m(NOW_OF_CLUMP * reference.allowance_m, clump.moved_m);
        }
    }
    urgent
}

/// Distance that a free particle may still move, and that which it may move in all, m.
#[inline(always)]
fn free_left_m(particles: &Particles, references: &References, i: usize) -> [f64; 2] {
    let (pose, [x, y, z, radius_m]) = (&particles.poses[i], references.balls[i]);
    let allowance_m = radius_m - pose.radius_m();
    let left_m = allowance_m - (pose.place() - Vector3::new(x, y, z)).norm();
    [left_m, allowance_m]
}

/// Distance that must be left, m, or a new search is due: `enough_m`, or a few steps of `moved_m`
/// if that is more.
#[inline(always)]
fn least_m(enough_m: f64, moved_m: f64) -> f64 {
    enough_m.max(STEPS_LEFT * moved_m)
}

/// Finds the distances left to the chunks, after a search.
pub(super) fn find_left(particles: &Particles, references: &mut References) {
    let chunks = chunks_of(particles.free);
    let mut chunks_left_m = std::mem::take(&mut references.chunks_left_m);
    let left = chunks.into_par_iter();
    let left = left.map(|chunk| chunk_left_m(particles, references, chunk));
    left.collect_into_vec(&mut chunks_left_m);
    references.chunks_left_m = chunks_left_m;
}

/// The least distance that the awake particles of a chunk may still move, m.
fn chunk_left_m(particles: &Particles, references: &References, chunk: usize) -> f64 {
    let awake = chunk_of(chunk, particles.free).filter(|&i| !particles.sleeps(i));
    let left = awake.map(|i| free_left_m(particles, references, i)[0]);
    left.fold(f64::INFINITY, f64::min)
}

/// Distance that each sphere of a clump may still move, m, at least.
fn clump_left_m(clumps: &Clumps, clump: &Clump, reference: &ClumpReference) -> f64 {
    let moved_m = (Vector3::from(clump.place_m) - Vector3::from(reference.place_m)).norm();
    // The chord of an angle is at most twice the difference of the quaternions, of which each
    // rotation has two.
    let apart = |sign: f64| {
        let of_axis = |k: usize| (clump.turned[k] - sign * reference.turned[k]).powi(2);
        (0..4).map(of_axis).sum::<f64>().sqrt()
    };
    let turned = 2.0 * apart(1.0).min(apart(-1.0));
    reference.allowance_m - moved_m - turned * clumps.template(clump).reach_m
}

/// Gives these free particles, ascending, new balls.
pub(super) fn refer_particles(contacts: &mut Contacts, state: &State, some: &[u32]) {
    let p = &state.particles;
    let moved_m = |i: usize| p.motions[i].speed_m_s() * state.time_step_s;
    for some in some.chunk_by(|&a, &b| a as usize / CHUNK == b as usize / CHUNK) {
        let chunk = some[0] as usize / CHUNK;
        let fastest_m = chunk_of(chunk, p.free).map(moved_m).fold(0.0, f64::max);
        for &i in some {
            let i = i as usize;
            refer_particle(contacts, i, &p.poses[i], [moved_m(i), fastest_m]);
        }
    }
}

/// Gives a free particle a new ball. `moved_m`: how far it moves in a step, and how far the fastest
/// in its chunk, m.
fn refer_particle(contacts: &mut Contacts, i: usize, pose: &Pose, moved_m: [f64; 2]) {
    let [moved_m, fastest_m] = moved_m;
    let allowance_m = match contacts.model.allowances {
        None => 0.5 * contacts.skin_m,
        Some(fractions) => {
            let [least_m, most_m] = fractions.map(|fraction| fraction * pose.radius_m());
            let steps_m = STEPS * moved_m.max(OF_FASTEST * fastest_m);
            steps_m.clamp(least_m, most_m)
        }
    };
    // At least two steps: a pair that is first listed when it already overlaps would be treated
    // as fragments of one body, and its overlap would relax.
    let allowance_m = allowance_m.max(2.0 * moved_m);
    let [x, y, z, radius_m] = pose.position_m;
    contacts.scratch.references.balls[i] = [x, y, z, radius_m + allowance_m];
}

/// Gives these clumps, ascending, new references, and the spheres of small ones new balls; those of
/// large ones only if `all_balls`.
pub(super) fn refer_clumps(
    contacts: &mut Contacts,
    state: &State,
    some: &[usize],
    all_balls: bool,
) {
    let (allowances, skin_m) = (contacts.model.allowances, contacts.skin_m);
    let References {
        balls,
        clumps,
        clusters: known,
        ..
    } = &mut contacts.scratch.references;
    let refer = |clump: &Clump, reference: &mut ClumpReference, balls: &mut [Ball]| {
        let template = state.clumps.template(clump);
        let known_m = known.largest_m(clump.template as usize);
        let largest_m = known_m.unwrap_or_else(|| template.largest_m());
        let moved_m = speed_m_s(clump, template) * state.time_step_s;
        let allowance_m = match allowances {
            None => 0.5 * skin_m,
            Some([least, _]) => {
                (STEPS_OF_CLUMP * moved_m).clamp(least * largest_m, FARTHEST_OF_CLUMP * largest_m)
            }
        };
        let allowance_m = allowance_m.max(2.0 * moved_m);
        *reference = ClumpReference {
            place_m: clump.place_m,
            turned: clump.turned,
            allowance_m,
            left_m: allowance_m,
        };
        if all_balls || !is_large(template.outer.len()) {
            put_balls(template, clump, allowance_m, balls);
        }
    };
    let clumps = ClumpsToRefer {
        first: 0,
        all: &state.clumps.all,
        references: clumps,
        balls: &mut balls[state.particles.free..],
    };
    clumps.refer(some, &refer);
}

/// Consecutive clumps that get new references.
struct ClumpsToRefer<'a> {
    /// Number of the first.
    first: usize,
    all: &'a [Clump],
    references: &'a mut [ClumpReference],
    /// Of their spheres, which follow one another.
    balls: &'a mut [Ball],
}

impl ClumpsToRefer<'_> {
    /// Calls `refer` with each of `some`, ascending, on as many threads as there are.
    fn refer(
        self,
        some: &[usize],
        refer: &(impl Fn(&Clump, &mut ClumpReference, &mut [Ball]) + Sync),
    ) {
        let (Some(first), Some(_)) = (self.all.first(), some.first()) else {
            return;
        };
        let ball_of = |clump: &Clump| (clump.first - first.first) as usize;
        if self.all.len() <= CLUMPS_AT_ONCE {
            for &at in some {
                let at = at - self.first;
                let end = self.all.get(at + 1).map_or(self.balls.len(), ball_of);
                let own = &mut self.balls[ball_of(&self.all[at])..end];
                refer(&self.all[at], &mut self.references[at], own);
            }
            return;
        }
        let half = self.all.len() / 2;
        let (all, other_all) = self.all.split_at(half);
        let (references, other_references) = self.references.split_at_mut(half);
        let (balls, other_balls) = self.balls.split_at_mut(ball_of(&other_all[0]));
        let own = ClumpsToRefer {
            first: self.first,
            all,
            references,
            balls,
        };
        let other = ClumpsToRefer {
            first: self.first + half,
            all: other_all,
            references: other_references,
            balls: other_balls,
        };
        let (some, other_some) = some.split_at(some.partition_point(|&at| at < other.first));
        rayon::join(|| own.refer(some, refer), || other.refer(other_some, refer));
    }
}

/// Sets balls, one for each sphere of a clump.
fn put_balls(template: &Template, clump: &Clump, allowance_m: f64, balls: &mut [Ball]) {
    let to_space = rotation(clump.turned).to_rotation_matrix();
    for (ball, &sphere) in balls.iter_mut().zip(template.outer.iter()) {
        let [x, y, z] = place_of(template, sphere as usize, clump, &to_space).into();
        let radius_m = template.spheres[sphere as usize].radius_m * template.scale;
        *ball = [x, y, z, radius_m + allowance_m];
    }
}
