//! Neighbour lists where bodies may sleep. Those that sleep are in none of them, and only those
//! beside awake particles are looked at: how long a search takes depends on what is awake.

use std::ops::Range;

use rayon::prelude::*;

use crate::geometry::Bounds;
use crate::stages::chunks::{chunk_of, chunks_of};
use crate::stages::clumps::place_all;
use crate::stages::contacts::{find_mean_radius, relist};
use crate::stages::neighbours::{ball_of, pairs_of_all};
use crate::stages::sleep::{disturbed, freeze_contacts, wake};
use crate::stages::walls::list_near;
use crate::state::State;
use crate::state::balls::{Ball, around};
use crate::state::particles::Particles;

/// Consecutive particles that have a box around those that are awake.
const PART: usize = 64;

/// Beside more of these than this number, all sleepers of a chunk are searched for.
const MOST_PARTS: usize = 64;

/// Rebuilds all lists, without pairs of sleeping particles. A sleeping body wakes first when
/// something moving is near it. Returns the number of particles searched for.
pub(super) fn list_among_sleepers(state: &mut State) -> usize {
    let mut listed = 0;
    place_all(&state.clumps, &mut state.particles);
    freeze_contacts(state);
    loop {
        listed += list_awake(state);
        let near = disturbed(state);
        if near.is_empty() {
            break;
        }
        wake(state, &near, "near");
    }
    listed
}

/// Lists walls and pairs, without pairs of sleeping particles. Returns the number of particles that
/// may be in a pair.
fn list_awake(state: &mut State) -> usize {
    let moved_m = state.fastest_m_s * state.time_step_s;
    let (Some(contacts), Some(sleep)) = (&mut state.contacts, &mut state.sleep) else {
        return 0;
    };
    let p = &state.particles;
    // The skin covers at least two steps: see `refer_particle`.
    let skin_m = contacts.skin_m.max(4.0 * moved_m);
    list_near(&mut state.walls, p, skin_m);
    contacts.skin_left_m = 0.5 * skin_m;
    if contacts.model.alone {
        return 0;
    }
    if sleep.boxes.is_empty() {
        sleep.boxes = boxes_of_sleepers(p);
    }
    let some = may_meet(p, &sleep.boxes, skin_m);
    if contacts.scratch.mean_radius_m == 0.0 {
        find_mean_radius(contacts, p, 0);
    }
    let pairs = pairs_of(state, &some, skin_m);
    let Some(contacts) = &mut state.contacts else {
        return 0;
    };
    relist(contacts, pairs, &state.particles);
    if contacts.model.relaxes {
        state.scratch.events.work.relaxing += contacts.relaxing();
    }
    some.len()
}

/// For each chunk of particles the box around those that sleep, m.
fn boxes_of_sleepers(p: &Particles) -> Vec<Bounds> {
    let chunks = chunks_of(p.len()).into_par_iter();
    let of_chunk = |chunk| box_of(p, chunk_of(chunk, p.len()).filter(|&i| p.sleeps(i)));
    chunks.map(of_chunk).collect()
}

/// The box around some particles, m.
fn box_of(p: &Particles, some: impl Iterator<Item = usize>) -> Bounds {
    let boxes = some.map(|i| around(&p.poses[i].position_m));
    boxes.fold(Bounds::EMPTY, |all, one| all.with(&one))
}

/// The particles that may be in a pair, ascending: those that are awake, and those asleep beside
/// them. `boxes`: around the sleepers of each chunk.
fn may_meet(p: &Particles, boxes: &[Bounds], skin_m: f64) -> Vec<u32> {
    let members = |chunk: usize| chunk_of(chunk, p.len());
    let chunks = (0..boxes.len()).into_par_iter();
    let any_awake = |chunk: &usize| !p.asleep.is_whole(*chunk);
    let box_of_awake = |some: Range<usize>| box_of(p, some.filter(|&i| !p.sleeps(i)));
    let awake = chunks.clone().filter(any_awake).flat_map_iter(|chunk| {
        let Range { start, end } = members(chunk);
        let parts = (start..end).step_by(PART);
        parts.map(move |first| box_of_awake(first..(first + PART).min(end)))
    });
    // A little more than the skin, for rounding.
    let awake = awake.filter(|part| *part != Bounds::EMPTY);
    let awake: Vec<Bounds> = awake.map(|part| part.grown(1.01 * skin_m)).collect();
    let of_chunk = |chunk: usize| {
        let mut near: Vec<&Bounds> = Vec::new();
        if boxes[chunk] != Bounds::EMPTY {
            let beside = awake.iter().filter(|part| part.overlaps(&boxes[chunk]));
            near.extend(beside.take(MOST_PARTS + 1));
        }
        let some = match any_awake(&chunk) || !near.is_empty() {
            true => members(chunk),
            false => 0..0,
        };
        let may = move |&i: &usize| {
            let ball = around(&p.poses[i].position_m);
            !p.sleeps(i) || near.len() > MOST_PARTS || near.iter().any(|part| part.overlaps(&ball))
        };
        some.filter(may).map(|i| i as u32)
    };
    chunks.flat_map_iter(of_chunk).collect()
}

/// Pairs among some particles, without those of two that sleep.
fn pairs_of(state: &State, some: &[u32], skin_m: f64) -> Vec<[u32; 2]> {
    let p = &state.particles;
    let Some(clusters) = &state.clusters else {
        return Vec::new();
    };
    // All sleeping bodies count as one.
    let none = clusters.history.len() as u32;
    let cluster_of = |&i: &u32| match p.sleeps(i as usize) {
        true => none,
        false => clusters.of_particle[i as usize],
    };
    let numbers: Vec<u32> = some.iter().map(cluster_of).collect();
    let balls = some.iter().map(|&i| ball_of(&p.poses[i as usize], skin_m));
    let balls: Vec<Ball> = balls.collect();
    let pairs = pairs_of_all(&balls, &numbers);
    let to_all = |pair: [u32; 2]| pair.map(|i| some[i as usize]);
    pairs.into_iter().map(to_all).collect()
}
