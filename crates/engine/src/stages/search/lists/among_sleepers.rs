//! Neighbour lists where bodies may sleep. Those that sleep are in none of them, and only those
//! beside awake particles are looked at: how long a search takes depends on what is awake.

use std::ops::Range;

use rayon::prelude::*;

use crate::stages::chunks::{chunk_of, chunks_of, in_tasks};
use crate::stages::clumps::motion::{place_all, place_awake};
use crate::stages::contacts::forces::{find_mean_radius, list_within, relist};
use crate::stages::ledger::islands::join_at_moving_walls;
use crate::stages::motion::riding::{at_edges, list_riders_beside, look_ahead};
use crate::stages::motion::sleep::{disturbed, freeze_contacts, wake};
use crate::stages::search::neighbours::{ball_of, find_pairs_of_all};
use crate::stages::walls::list_near;
use crate::state::State;
use crate::state::contacts::{ContactScratch, Contacts};
use crate::state::particles::Particles;
use crate::state::search::balls::around;
use crate::state::search::buffers::{AwakeBuffers, SearchBuffers};
use dem_physics::geometry::Bounds;

/// Consecutive particles that have a box around those that are awake.
const PART: usize = 64;

/// Beside more of these than this number, all sleepers of a chunk are searched for.
const MOST_PARTS: usize = 64;

/// Rebuilds all lists, without pairs of sleeping particles. A sleeping body wakes first when
/// something moving is near it. Returns the number of particles searched for.
pub(super) fn list_among_sleepers(state: &mut State) -> usize {
    let mut listed = 0;
    if state
        .sleep
        .as_ref()
        .is_some_and(|sleep| sleep.boxes.is_empty())
    {
        // Somebody has fallen asleep or changed.
        place_all(&state.clumps, &mut state.particles);
    } else {
        place_awake(&state.clumps, &mut state.particles);
    }
    freeze_contacts(state);
    let ending = at_edges(state);
    if !ending.is_empty() {
        wake(state, &ending, "edge");
    }
    let skin_m = skin_m(state);
    loop {
        listed += list_awake(state, skin_m);
        let near = disturbed(state, skin_m);
        if near.is_empty() {
            break;
        }
        wake(state, &near, "near");
    }
    if let Some(contacts) = state.contacts.take() {
        look_ahead(state, &contacts.scratch.buffers.awake.boxes, skin_m);
        state.contacts = Some(contacts);
    }
    listed
}

/// What is nearer than this is listed, m.
fn skin_m(state: &State) -> f64 {
    let moved_m = state.fastest_m_s * state.time_step_s;
    let least_m = state
        .contacts
        .as_ref()
        .map_or(0.0, |contacts| contacts.skin_m);
    // The skin covers at least two steps: see `refer_particle`.
    least_m.max(4.0 * moved_m)
}

/// Lists walls and pairs, without pairs of sleeping particles. Returns the number of particles that
/// may be in a pair.
fn list_awake(state: &mut State, skin_m: f64) -> usize {
    let Some(mut contacts) = state.contacts.take() else {
        return 0;
    };
    let p = &state.particles;
    let of_tasks = &mut contacts.scratch.buffers.reached;
    list_near(&mut state.walls, p, skin_m, of_tasks);
    contacts.skin_left_m = 0.5 * skin_m;
    let mut searched = 0;
    if !contacts.model.alone {
        if state
            .sleep
            .as_ref()
            .is_some_and(|sleep| sleep.boxes.is_empty())
        {
            let boxes = boxes_of_sleepers(state);
            if let Some(sleep) = &mut state.sleep {
                sleep.boxes = boxes;
            }
        }
        let p = &state.particles;
        if contacts.scratch.mean_radius_m == 0.0 {
            find_mean_radius(&mut contacts, p, 0);
        }
        let awake = &mut contacts.scratch.buffers.awake;
        list_boxes_of_awake(p, skin_m, awake);
        let mut riders = list_riders_beside(state, &awake.boxes);
        list_what_may_meet(state, awake);
        if !riders.is_empty() {
            awake.particles.append(&mut riders);
            awake.particles.sort_unstable();
        }
        searched = awake.particles.len();
        let mut pairs = pairs_of_awake(state, &mut contacts, skin_m);
        list_within(state, &mut contacts, &mut pairs);
        relist(&mut contacts, pairs, state);
        if contacts.model.relaxes {
            state.scratch.events.work.relaxing += contacts.relaxing();
        }
    }
    join_at_moving_walls(&mut contacts, state);
    state.contacts = Some(contacts);
    searched
}

/// For each chunk of particles the box around those that sleep and do not ride, m.
fn boxes_of_sleepers(state: &State) -> Vec<Bounds> {
    let p = &state.particles;
    let chunks = chunks_of(p.len()).into_par_iter();
    let rests = |i: &usize| state.rests_asleep(*i);
    let of_chunk = |chunk| box_of(p, chunk_of(chunk, p.len()).filter(rests));
    chunks.map(of_chunk).collect()
}

/// The box around some particles, m.
fn box_of(p: &Particles, some: impl Iterator<Item = usize>) -> Bounds {
    let boxes = some.map(|i| around(&p.poses[i].position_m));
    boxes.fold(Bounds::EMPTY, |all, one| all.with(&one))
}

/// Lists boxes around those that are awake, grown by the skin, m.
fn list_boxes_of_awake(p: &Particles, skin_m: f64, buffers: &mut AwakeBuffers) {
    let box_of_awake = |some: Range<usize>| box_of(p, some.filter(|&i| !p.sleeps(i)));
    let chunks = chunks_of(p.len());
    let of_chunks = in_tasks(chunks.len(), &mut buffers.box_tasks, |chunk, found| {
        found.clear();
        if !p.asleep.is_whole(chunk) {
            let Range { start, end } = chunk_of(chunk, p.len());
            let parts = (start..end).step_by(PART);
            let parts = parts.map(|first| box_of_awake(first..(first + PART).min(end)));
            let awake = parts.filter(|part| *part != Bounds::EMPTY);
            // A little more than the skin, for rounding.
            found.extend(awake.map(|part| part.grown(1.01 * skin_m)));
        }
    });
    buffers.boxes.clear();
    for found in of_chunks {
        buffers.boxes.extend_from_slice(found);
    }
}

/// Lists the particles that may be in a pair, ascending, without riders: those that are awake, and
/// those at rest beside them.
fn list_what_may_meet(state: &State, buffers: &mut AwakeBuffers) {
    let p = &state.particles;
    let of_sleepers = state.sleep.as_ref().map_or(&[][..], |sleep| &sleep.boxes);
    let awake = &buffers.boxes[..];
    let of_chunks = in_tasks(of_sleepers.len(), &mut buffers.tasks, |chunk, task| {
        let beside = &mut task.boxes;
        beside.clear();
        if of_sleepers[chunk] != Bounds::EMPTY {
            let reaching = (0..).zip(awake);
            let reaching = reaching.filter(|(_, part)| part.overlaps(&of_sleepers[chunk]));
            beside.extend(reaching.map(|(n, _)| n).take(MOST_PARTS + 1));
        }
        task.particles.clear();
        if !p.asleep.is_whole(chunk) || !beside.is_empty() {
            let may = |&i: &usize| {
                let ball = around(&p.poses[i].position_m);
                let mut parts = beside.iter().map(|&n| &awake[n as usize]);
                let is_beside = beside.len() > MOST_PARTS || parts.any(|part| part.overlaps(&ball));
                !p.sleeps(i) || (is_beside && state.rests_asleep(i))
            };
            let some = chunk_of(chunk, p.len());
            task.particles.extend(some.filter(may).map(|i| i as u32));
        }
    });
    buffers.particles.clear();
    for task in of_chunks {
        buffers.particles.extend_from_slice(&task.particles);
    }
}

/// Pairs among the particles that may be in one, without those of two that sleep.
fn pairs_of_awake(state: &State, contacts: &mut Contacts, skin_m: f64) -> Vec<[u32; 2]> {
    let p = &state.particles;
    let ContactScratch {
        former_pairs,
        buffers: SearchBuffers { awake, pairs, .. },
        ..
    } = &mut contacts.scratch;
    former_pairs.clear();
    if let Some(clusters) = &state.clusters {
        // All sleeping bodies count as one.
        let none = clusters.history.len() as u32;
        let cluster_of = |&i: &u32| match p.sleeps(i as usize) {
            true => none,
            false => clusters.of_particle[i as usize],
        };
        awake.clusters.clear();
        awake
            .clusters
            .extend(awake.particles.iter().map(cluster_of));
        awake.balls.clear();
        let balls = awake.particles.iter();
        let balls = balls.map(|&i| ball_of(&p.poses[i as usize], skin_m));
        awake.balls.extend(balls);
        find_pairs_of_all(&awake.balls, &awake.clusters, &mut awake.known, pairs);
        let to_all = |pair: &[u32; 2]| pair.map(|i| awake.particles[i as usize]);
        former_pairs.extend(pairs.found.iter().map(to_all));
    }
    std::mem::take(former_pairs)
}
