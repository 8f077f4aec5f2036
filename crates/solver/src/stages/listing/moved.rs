//! Which particles have moved too far from where they were when their neighbours were last
//! searched for, and the balls around the others.

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::physics::rotation::rotation;
use crate::stages::chunks::{CHUNK, chunk_of, chunks_of};
use crate::stages::clumps::{place_of, speed_m_s};
use crate::state::State;
use crate::state::balls::Ball;
use crate::state::clumps::{Clump, Clumps, Template};
use crate::state::contacts::Contacts;
use crate::state::groups::is_large;
use crate::state::particles::{Particles, Pose};
use crate::state::references::References;
use crate::state::rigid_balls::ClumpReference;

/// Number of steps that a particle may go on at its present speed until its next search.
const STEPS: f64 = 30.0;
/// The same for a clump: its spheres are many, but few of them are near something.
const STEPS_OF_CLUMP: f64 = 40.0;
/// Largest distance that a clump may move between two searches, as a multiple of the radius of its
/// largest sphere.
const FARTHEST_OF_CLUMP: f64 = 1.0;
/// A search is due when something has less than this fraction of its distance left.
const NOW: f64 = 0.1;
/// Then every free particle is searched for that has less than this fraction left.
const SOON: f64 = 0.5;
/// And every clump that has less than this fraction left, if it would use up what it has in this
/// number of steps at its present speed.
const SOON_OF_CLUMP: (f64, f64) = (0.9, 30.0);
/// After two more steps like the last, unlisted particles could overlap.
const STEPS_LEFT: f64 = 2.0;

/// Clumps that a task gives new references.
const CLUMPS_AT_ONCE: usize = 64;

/// What is to be searched for.
#[derive(Default)]
pub(super) struct Due {
    /// Free particles, ascending.
    pub(super) particles: Vec<u32>,
    /// Numbers of clumps, ascending.
    pub(super) clumps: Vec<usize>,
}

impl Due {
    pub(super) fn is_empty(&self) -> bool {
        self.particles.is_empty() && self.clumps.is_empty()
    }
}

/// Whether it is to be found out what is due. Otherwise nothing has used up its distance, and
/// nothing is requested.
pub(super) fn may_be_due(state: &State, contacts: &Contacts) -> bool {
    let references = &contacts.scratch.references;
    let chunks = references.chunks_left_m.iter();
    let mut chunks = chunks.zip(&state.scratch.chunks_moved_m);
    let mut clumps = references.clumps.iter().zip(&state.clumps.all);
    contacts.skin_left_m < 0.0
        || references.balls.len() != state.particles.len()
        || chunks.any(|(left_m, moved_m)| *left_m < STEPS_LEFT * moved_m)
        || clumps.any(|(reference, clump)| reference.left_m < STEPS_LEFT * clump.moved_m)
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

/// Finds what is due. None: everything, as at the start.
pub(super) fn due(state: &State, references: &mut References) -> Option<Due> {
    let p = &state.particles;
    if references.balls.len() != p.len() || references.clumps.len() != state.clumps.all.len() {
        return None;
    }
    if !is_urgent(state, references) {
        return Some(Due::default());
    }
    let step_s = state.cycle_s();
    let (loose, carried): (Vec<u32>, Vec<u32>) =
        references.due.iter().partition(|i| (**i as usize) < p.free);
    let is_due = |i: &u32| {
        let i = *i as usize;
        let [left_m, allowance_m] = free_left_m(p, references, i);
        left_m < least_m(SOON * allowance_m, p.motions[i].speed_m_s() * step_s)
    };
    let free = (0..p.free as u32).into_par_iter().with_min_len(CHUNK);
    let mut particles: Vec<u32> = free.filter(is_due).collect();
    particles.extend(loose);
    particles.sort_unstable();
    particles.dedup();
    let carriers = carried.iter();
    let carriers = carriers.filter_map(|&i| state.clumps.carrier_of(i as usize));
    let mut clumps: Vec<usize> = carriers.collect();
    for (n, (clump, reference)) in (state.clumps.all.iter())
        .zip(&mut references.clumps)
        .enumerate()
    {
        reference.left_m = clump_left_m(&state.clumps, clump, reference);
        let (fraction, steps) = SOON_OF_CLUMP;
        let [now_m, soon_m] = [NOW, fraction].map(|part| part * reference.allowance_m);
        let soon_m = soon_m.min(steps * clump.moved_m).max(now_m);
        if reference.left_m < least_m(soon_m, clump.moved_m) {
            clumps.push(n);
        }
    }
    clumps.sort_unstable();
    clumps.dedup();
    Some(Due { particles, clumps })
}

/// Whether anything is due, among the chunks and clumps that have used up what was surely left.
/// Of those that are not, it finds what is left.
fn is_urgent(state: &State, references: &mut References) -> bool {
    let p = &state.particles;
    let mut urgent = !references.due.is_empty();
    for chunk in 0..references.chunks_left_m.len() {
        let moved_m = state.scratch.chunks_moved_m.get(chunk).copied();
        if references.chunks_left_m[chunk] < STEPS_LEFT * moved_m.unwrap_or(0.0) {
            let mut least_left_m = f64::INFINITY;
            for i in chunk_of(chunk, p.free) {
                let [left_m, allowance_m] = free_left_m(p, references, i);
                least_left_m = least_left_m.min(left_m);
                let moved_m = p.motions[i].speed_m_s() * state.cycle_s();
                urgent |= left_m < least_m(NOW * allowance_m, moved_m);
            }
            references.chunks_left_m[chunk] = least_left_m;
        }
    }
    for (clump, reference) in state.clumps.all.iter().zip(&mut references.clumps) {
        if reference.left_m < STEPS_LEFT * clump.moved_m {
            reference.left_m = clump_left_m(&state.clumps, clump, reference);
            urgent |= reference.left_m < least_m(NOW * reference.allowance_m, clump.moved_m);
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

/// Distance that must be left, m, or a new search is due: `enough_m`, or a few steps of `moved_m` if
/// that is more.
#[inline(always)]
fn least_m(enough_m: f64, moved_m: f64) -> f64 {
    enough_m.max(STEPS_LEFT * moved_m)
}

/// Finds the distances left to the chunks, after a search.
pub(super) fn find_left(particles: &Particles, references: &mut References) {
    let chunks = chunks_of(particles.free);
    let left = chunks.into_par_iter();
    let left = left.map(|chunk| chunk_left_m(particles, references, chunk));
    references.chunks_left_m = left.collect();
}

/// The least distance that the particles of a chunk may still move, m.
fn chunk_left_m(particles: &Particles, references: &References, chunk: usize) -> f64 {
    let left = chunk_of(chunk, particles.free).map(|i| free_left_m(particles, references, i)[0]);
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

/// Gives a free particle, which moves this far in a step, m, a new ball.
pub(super) fn refer_particle(contacts: &mut Contacts, i: usize, pose: &Pose, moved_m: f64) {
    let allowance_m = match contacts.model.allowances {
        None => 0.5 * contacts.skin_m,
        Some(fractions) => {
            let [least_m, most_m] = fractions.map(|fraction| fraction * pose.radius_m());
            (STEPS * moved_m).clamp(least_m, most_m)
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
    let mut left = &mut balls[state.particles.free..];
    let mut work = Vec::with_capacity(some.len());
    let mut some = some.iter().peekable();
    for (at, (clump, reference)) in state.clumps.all.iter().zip(clumps).enumerate() {
        let count = state.clumps.spheres_of(clump).len();
        let (own, others) = std::mem::take(&mut left).split_at_mut(count);
        left = others;
        if some.next_if(|due| **due == at).is_some() {
            work.push((clump, reference, own));
        }
    }
    let work = work.into_par_iter().with_min_len(CLUMPS_AT_ONCE);
    work.for_each(|(clump, reference, balls)| {
        let template = state.clumps.template(clump);
        let known_m = known.largest_m(clump.template as usize);
        let largest_m = known_m.unwrap_or_else(|| template.largest_m());
        let moved_m = speed_m_s(clump, state.clumps.template(clump)) * state.cycle_s();
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
    });
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
