//! The close pairs of the Verlet list: only these are computed, until others may have come close.

use super::input::StepInput;
use crate::stages::bonds::blocks::fetch_soon_of;
use crate::state::contacts::{ContactPartition, Contacts};
use crate::state::particles::Pose;
use dem_physics::lanes::{Lanes, MOST};
use dem_physics::number::Vec3;

/// Prefetch distance of second particles, in contacts.
const AHEAD: usize = 32;
/// Largest number of steps, at the present speed, until the next check of all pairs; and the
/// smallest, below which all are checked in each step.
const STEPS: [f64; 2] = [32.0, 4.0];
/// Pairs farther apart than this fraction of the mean radius are not computed.
const CLOSE: f64 = 1.0 / 128.0;

/// Pairs closer than this, m, are computed until a particle may have moved almost half of it: until
/// then none of the others can touch, however positions are rounded. 0 if that would be soon: then
/// all pairs are checked in each step.
pub(super) fn close_m(contacts: &Contacts) -> f64 {
    let [most_m, least_m] = STEPS.map(|steps| 2.0 * steps * contacts.moved_m);
    let close_m = most_m.min(CLOSE * contacts.scratch.mean_radius_m);
    if close_m < least_m { 0.0 } else { close_m }
}

/// Lists the contacts of a partition that are close.
#[inline(always)]
pub(super) fn look<T: Lanes>(
    proof: T::Proof,
    partition: &mut ContactPartition,
    scene: &StepInput<'_>,
) {
    for [of_border, own] in &mut partition.close {
        of_border.clear();
        own.clear();
    }
    find_border(partition, scene);
    find_own::<T>(proof, partition, scene);
}

/// Lists the contacts of the border that are close, or touched in the step before: an attraction
/// that ends within this step still acts on both ends.
fn find_border(partition: &mut ContactPartition, scene: &StepInput<'_>) {
    let (contacts, poses) = (scene.contacts, scene.poses);
    for (n, &at) in (0..).zip(&partition.border) {
        let pair = contacts.pairs[at as usize];
        let [a, b] = pair.map(|i| &poses[i as usize]);
        let reach = a.radius_m() + b.radius_m() + contacts.scratch.close_m;
        let touched = partition.border_histories[n as usize].overlap_m() > 0.0;
        if touched || (b.place() - a.place()).norm_squared() < reach * reach {
            partition.close[contacts.kind(pair)][0].push(n);
        }
    }
}

/// Lists those of its own contacts that are close, or were at the previous check: their end may
/// have to be recorded.
#[inline(always)]
fn find_own<T: Lanes>(proof: T::Proof, partition: &mut ContactPartition, scene: &StepInput<'_>) {
    let poses = scene.poses;
    let own = partition.own.clone();
    let pairs = &scene.contacts.pairs[..own.end];
    let close_m = T::all(proof, scene.contacts.scratch.close_m);
    let (of_first_kind, of_others) = partition.close.split_at_mut(1);
    let list = &mut of_first_kind[0][1];
    list.resize(own.len() + MOST, 0);
    let close = &mut list[..];
    let mut count = 0;
    for (first, was_close) in own.clone().step_by(MOST).zip(&mut partition.was_close) {
        for &[_, soon] in pairs
            .get(first + AHEAD..first + AHEAD + MOST)
            .unwrap_or_default()
        {
            fetch_soon_of(poses, soon as usize);
        }
        let eight = &pairs[first..(first + MOST).min(own.end)];
        let now = near::<T>(proof, eight, poses, close_m);
        // Unpredictable, so it is computed without a branch.
        let listed = usize::from(now | *was_close);
        *was_close = now;
        for lane in 0..MOST {
            close[count] = (first + lane) as u32;
            count += listed >> lane & 1;
        }
    }
    list.truncate(count);
    if !of_others.is_empty() {
        list.retain(|&at| {
            let kind = scene.contacts.kind(pairs[at as usize]);
            if kind > 0 {
                of_others[kind - 1][1].push(at);
            }
            kind == 0
        });
    }
}

/// For each of up to eight pairs a bit, lowest first: whether the two are closer than `close_m`.
#[inline(always)]
fn near<T: Lanes>(proof: T::Proof, pairs: &[[u32; 2]], poses: &[Pose], close_m: T) -> u8 {
    let mut bits = 0;
    for first in (0..pairs.len()).step_by(T::COUNT) {
        let row = |lane: usize, end: usize| {
            let pair = pairs[(first + lane).min(pairs.len() - 1)];
            poses[pair[end] as usize].position_m
        };
        let [ax, ay, az, radius_a] = T::columns(proof, |lane| row(lane, 0));
        let [bx, by, bz, radius_b] = T::columns(proof, |lane| row(lane, 1));
        let reach = radius_a + radius_b + close_m;
        let apart = Vec3(bx - ax, by - ay, bz - az);
        bits |= (reach * reach).above(apart.square()) << first;
    }
    bits & (0xff >> (MOST - pairs.len()))
}
