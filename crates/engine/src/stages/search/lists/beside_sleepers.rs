//! Sleeping bodies beside awake ones: they wake when something moving comes near, before it can
//! touch them. So lists of neighbours are of awake particles alone. How long a look takes depends
//! on what is awake.

use std::ops::Range;

use rayon::prelude::*;

use crate::stages::chunks::{chunk_of, chunks_of, in_tasks};
use crate::stages::clumps::motion::{place_all, place_awake};
use crate::stages::motion::riding::{at_edges, list_riders_beside, look_ahead};
use crate::stages::motion::sleep::{disturbed, freeze_contacts, wake};
use crate::stages::search::neighbours::{ball_of, find_pairs_of_all};
use crate::state::State;
use crate::state::particles::Particles;
use crate::state::search::buffers::AwakeBuffers;
use dem_physics::geometry::Bounds;
use dem_physics::geometry::balls::around;

/// Consecutive particles that have a box around those that are awake.
const PART: usize = 64;

/// Beside more of these than this number, all sleepers of a chunk are looked at.
const MOST_PARTS: usize = 64;

/// Wakes the sleeping bodies that something moving is near, and says how far everything may move
/// until the next look. Returns the number of sleepers looked at, and whether others sleep than at
/// the last look.
pub(super) fn wake_disturbed(state: &mut State) -> (usize, bool) {
    let skin_m = skin_m(state);
    let (Some(sleep), Some(contacts)) = (&state.sleep, &mut state.contacts) else {
        return (0, false);
    };
    contacts.skin_left_m = 0.5 * skin_m;
    let mut is_changed = sleep.boxes.is_empty();
    if sleep.bodies == 0 && !is_changed {
        return (0, false);
    }
    if is_changed {
        place_all(&state.clumps, &mut state.particles);
    } else {
        place_awake(&state.clumps, &mut state.particles);
    }
    freeze_contacts(state);
    let ending = at_edges(state);
    if !ending.is_empty() {
        wake(state, &ending, "edge");
    }
    let mut buffers = match &mut state.contacts {
        Some(contacts) => std::mem::take(&mut contacts.scratch.buffers.awake),
        None => AwakeBuffers::default(),
    };
    let mut looked_at = 0;
    loop {
        let beside = sleepers_beside(state, skin_m, &mut buffers);
        looked_at += buffers.particles.len();
        let near = disturbed(state, beside, skin_m);
        if near.is_empty() {
            break;
        }
        wake(state, &near, "near");
        is_changed = true;
    }
    look_ahead(state, &buffers.boxes, skin_m);
    if let Some(contacts) = &mut state.contacts {
        contacts.scratch.buffers.awake = buffers;
    }
    (looked_at, is_changed)
}

/// What is nearer than this wakes, m.
fn skin_m(state: &State) -> f64 {
    let moved_m = state.fastest_m_s * state.time_step_s;
    let least_m = state
        .contacts
        .as_ref()
        .map_or(0.0, |contacts| contacts.skin_m);
    // The skin covers at least two steps.
    least_m.max(4.0 * moved_m)
}

/// Sleeping particles whose surface is less than `skin_m` from that of an awake one.
fn sleepers_beside(state: &mut State, skin_m: f64, buffers: &mut AwakeBuffers) -> Vec<u32> {
    let sleep = state.sleep.as_ref();
    if sleep.is_some_and(|sleep| sleep.boxes.is_empty()) {
        let boxes = boxes_of_sleepers(state);
        if let Some(sleep) = &mut state.sleep {
            sleep.boxes = boxes;
        }
    }
    list_boxes_of_awake(&state.particles, skin_m, buffers);
    let mut riders = list_riders_beside(state, &buffers.boxes);
    list_at_rest_beside(state, buffers);
    let AwakeBuffers {
        particles: sleepers,
        balls,
        bodies,
        known,
        pairs,
        ..
    } = buffers;
    if !riders.is_empty() {
        sleepers.append(&mut riders);
        sleepers.sort_unstable();
    }
    if sleepers.is_empty() {
        return Vec::new();
    }
    let p = &state.particles;
    let all_sleepers = box_of(p, sleepers.iter().map(|&i| i as usize)).grown(1.01 * skin_m);
    let is_beside =
        |i: &usize| !p.sleeps(*i) && around(&p.poses[*i].position_m).overlaps(&all_sleepers);
    let chunks = chunks_of(p.len()).filter(|&chunk| !p.asleep.is_whole(chunk));
    let awake = chunks
        .flat_map(|chunk| chunk_of(chunk, p.len()))
        .filter(is_beside);
    let both = sleepers.iter().map(|&i| i as usize).chain(awake);
    balls.clear();
    balls.extend(both.map(|i| ball_of(&p.poses[i], skin_m)));
    // All that sleep count as one body, and all that are awake as another.
    bodies.clear();
    bodies.extend((0..balls.len()).map(|n| u32::from(n >= sleepers.len())));
    find_pairs_of_all(balls, bodies, known, pairs);
    let near = pairs.found.iter().map(|[n, _]| sleepers[*n as usize]);
    near.collect()
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

/// Lists the particles at rest beside boxes around those that are awake, ascending.
fn list_at_rest_beside(state: &State, buffers: &mut AwakeBuffers) {
    let p = &state.particles;
    let of_sleepers = state.sleep.as_ref().map_or(&[][..], |sleep| &sleep.boxes);
    let awake = &buffers.boxes[..];
    let of_chunks = in_tasks(of_sleepers.len(), &mut buffers.tasks, |chunk, task| {
        let beside = &mut task.boxes;
        beside.clear();
        task.particles.clear();
        if of_sleepers[chunk] == Bounds::EMPTY {
            return;
        }
        let reaching = (0..).zip(awake);
        let reaching = reaching.filter(|(_, part)| part.overlaps(&of_sleepers[chunk]));
        beside.extend(reaching.map(|(n, _)| n).take(MOST_PARTS + 1));
        if beside.is_empty() {
            return;
        }
        let is_beside = |&i: &usize| {
            let ball = around(&p.poses[i].position_m);
            let mut parts = beside.iter().map(|&n| &awake[n as usize]);
            state.rests_asleep(i)
                && (beside.len() > MOST_PARTS || parts.any(|part| part.overlaps(&ball)))
        };
        let some = chunk_of(chunk, p.len());
        task.particles
            .extend(some.filter(is_beside).map(|i| i as u32));
    });
    buffers.particles.clear();
    for task in of_chunks {
        buffers.particles.extend_from_slice(&task.particles);
    }
}
