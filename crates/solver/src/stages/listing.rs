//! Neighbour lists: particles near walls, pairs of particles, and the spheres of clumps that are in
//! either.

mod among_sleepers;
mod moved;
mod renumbered;

use dem_scene::WallMotion;
use rayon::prelude::*;

pub(super) use self::renumbered::{lengthen_lists, renumber_lists};

use self::among_sleepers::list_among_sleepers;
use self::moved::{Due, due, find_left, may_be_due, refer_clumps, refer_particle, use_up};
use super::chunks::CHUNK;
use super::clumps;
use super::cluster_bytes::{ClusterUser, clusters_bytes};
use super::contacts::{find_mean_radius, list_beside, relist};
use super::levels::foresee_walls;
use super::neighbours::overlapping_pairs;
use super::sleep::begins_to_move;
use super::stage::{NO_SAVING, Need, Stage};
use super::walls::{plane_in_space, reaches};
use crate::state::State;
use crate::state::balls::{Ball, ball_around};
use crate::state::bridges::Bridges;
use crate::state::clumps::Clumps;
use crate::state::contacts::Contacts;
use crate::state::groups::{KnownClusters, Searched};
use crate::state::references::References;
use crate::state::rigid_balls::ClumpReference;
use crate::state::walls::Wall;

/// The neighbour search.
pub(crate) const SEARCH: Stage = Stage {
    name: "neighbour search",
    within: None,
    need: |state, _| {
        Need::of(
            state.contacts.is_some(),
            || "when something may have come near".to_owned(),
            "nothing can touch",
        )
    },
    bytes: |state| {
        let contacts = state.contacts.as_ref();
        let of_contacts = contacts.map_or(0, |c| {
            size_of_val(&c.pairs[..]) + size_of_val(&c.lost_j[..]) + c.materials.len()
        });
        of_contacts + clusters_bytes(state, ClusterUser::Contacts)
    },
    saving: NO_SAVING,
};

/// Subtracts the displacement in a drift from the skin left until the lists are rebuilt.
pub(crate) fn use_up_skin(state: &mut State) -> usize {
    if let Some(contacts) = &mut state.contacts {
        let moved_m = state.fastest_m_s * state.time_step_s;
        contacts.moved_m = moved_m;
        contacts.scratch.close_skin_left_m -= moved_m;
        if state.sleep.is_some() {
            contacts.skin_left_m -= moved_m;
            if contacts.skin_left_m < moved_m {
                // After one more step like this, unlisted particles could overlap.
                contacts.skin_left_m = -1.0;
            }
        }
    }
    if let (Some(contacts), None) = (&mut state.contacts, &state.sleep) {
        let references = &mut contacts.scratch.references;
        use_up(&state.scratch.chunks_moved_m, &state.clumps, references);
    }
    0
}

/// Rebuilds the lists of what may have come near something since the last time. Returns the number
/// of particles searched for.
pub(crate) fn renew_lists(state: &mut State) -> usize {
    let Some(contacts) = &mut state.contacts else {
        return 0;
    };
    if begins_to_move(
        state.sleep.as_ref(),
        &state.walls,
        [state.time_s, state.time_step_s],
    ) {
        contacts.search_all();
    }
    if state.sleep.is_some() {
        if contacts.skin_left_m < 0.0 {
            let searched = list_among_sleepers(state);
            if let Some(contacts) = state.contacts.take() {
                list_near_spheres(state, &contacts.pairs);
                state.contacts = Some(contacts);
            }
            return searched;
        }
        return 0;
    }
    let searched = search_for_moved(state);
    list_near_moving_walls(state);
    searched
}

/// Searches for the neighbours of the particles that have moved too far. Returns their number.
fn search_for_moved(state: &mut State) -> usize {
    let Some(mut contacts) = state.contacts.take() else {
        return 0;
    };
    let mut searched = 0;
    if may_be_due(state, &contacts) {
        contacts.skin_left_m = 0.0;
        searched = match due(state, &mut contacts.scratch.references) {
            Some(due) if due.is_empty() => 0,
            Some(due) => search_for(state, &mut contacts, &due),
            None => search_for_all(state, &mut contacts),
        };
        contacts.scratch.references.due.clear();
    }
    state.contacts = Some(contacts);
    searched
}

/// Searches for the neighbours of all particles.
fn search_for_all(state: &mut State, contacts: &mut Contacts) -> usize {
    find_mean_radius(contacts, &state.particles, 0);
    let references = &mut contacts.scratch.references;
    references.balls = vec![[0.0; 4]; state.particles.len()];
    references.clumps = vec![ClumpReference::default(); state.clumps.all.len()];
    references.clusters = KnownClusters::default();
    for wall in &mut state.walls {
        wall.skin_left_m = skin_m(wall, contacts.skin_m);
    }
    search_for(state, contacts, &everything(state))
}

fn everything(state: &State) -> Due {
    Due {
        particles: (0..state.particles.free as u32).collect(),
        clumps: (0..state.clumps.all.len()).collect(),
    }
}

/// Searches for the neighbours of what is due: moves its balls, and lists the pairs and walls that
/// they overlap.
fn search_for(state: &mut State, contacts: &mut Contacts, due: &Due) -> usize {
    for &i in &due.particles {
        let i = i as usize;
        let speed_m_s = state.particles.motions[i].speed_m_s();
        let moved_m = speed_m_s * state.cycle_s();
        refer_particle(contacts, i, &state.particles.poses[i], moved_m);
    }
    let clusters = state.clusters.as_ref();
    refer_clumps(contacts, state, &due.clumps, clusters.is_none());
    find_left(&state.particles, &mut contacts.scratch.references);
    let seeks = seeks(state, due);
    let some = seeks.contains(&false).then_some(&seeks[..]);
    let References {
        balls,
        clusters: known,
        clumps: references,
        ..
    } = &mut contacts.scratch.references;
    let searched = Searched {
        balls,
        clusters: clusters.map_or(&[], |clusters| &clusters.of_particle),
        seeks: some,
        clumps: Some((&state.clumps, references)),
    };
    known.update(&searched);
    let small = of_small(known, &state.clumps, due);
    for wall in &mut state.walls {
        let near = reached(wall, known, &searched, &small);
        wall.near.retain(|&i| !seeks[i as usize]);
        wall.near.extend(near);
        wall.near.sort_unstable();
    }
    let mut pairs = Vec::new();
    if clusters.is_some() && !contacts.model.alone {
        pairs = overlapping_pairs(&searched, known);
        if some.is_some() {
            pairs = with_others(&contacts.pairs, pairs, &seeks);
        }
    }
    list_beside(state, contacts, &mut pairs);
    list_near_spheres(state, &pairs);
    relist(contacts, pairs, &state.particles);
    note_relisting(state);
    if contacts.model.relaxes {
        state.scratch.events.work.relaxing += contacts.relaxing();
    }
    seeks.iter().filter(|&&seeks| seeks).count()
}

/// With steps by body, the groups have lists of their own, which are to be made again.
fn note_relisting(state: &mut State) {
    if let Some(levels) = &mut state.levels {
        levels.scratch.is_relisted = true;
    }
}

/// For each particle whether it is due.
fn seeks(state: &State, due: &Due) -> Vec<bool> {
    let mut seeks = vec![false; state.particles.len()];
    for &i in &due.particles {
        seeks[i as usize] = true;
    }
    for &at in &due.clumps {
        seeks[state.clumps.spheres_of(&state.clumps.all[at])].fill(true);
    }
    seeks
}

/// What is due and is in no large cluster.
fn of_small(known: &KnownClusters, clumps: &Clumps, due: &Due) -> Vec<u32> {
    let free = due.particles.iter().copied();
    let clumps_due = due.clumps.iter().map(|&at| &clumps.all[at]);
    let spheres = clumps_due.filter(|clump| !known.is_in_large(clump.first));
    let spheres = spheres.flat_map(|clump| clumps.spheres_of(clump));
    free.filter(|&i| !known.is_in_large(i))
        .chain(spheres.map(|i| i as u32))
        .collect()
}

/// The particles that a wall reaches before its skin is used up, of those that seek: of small
/// clusters `small`, and of large ones those of blocks that it may reach.
fn reached(wall: &Wall, known: &KnownClusters, searched: &Searched<'_>, small: &[u32]) -> Vec<u32> {
    let reaches = reaches(wall);
    let is_reached = |[x, y, z, radius_m]: Ball| reaches([x, y, z], radius_m + wall.skin_left_m);
    let of_small = small.par_iter().with_min_len(CHUNK).copied();
    let of_small = of_small.filter(|&i| is_reached(searched.balls[i as usize]));
    let mut reached: Vec<u32> = of_small.collect();
    let seeks = |i: u32| searched.seeks.is_none_or(|seeks| seeks[i as usize]);
    let of_large = known.large.par_iter().filter(|large| {
        let any_seeks = searched.seeks.is_none() || large.seeks;
        any_seeks && is_reached(ball_around(&large.bounds))
    });
    let plane = plane_in_space(wall);
    let of_large = of_large.flat_map_iter(|large| {
        if let (Some(body), Some(plane)) = (&large.rigid, plane) {
            let members = known.groups.members(large.group);
            let places = body.near_plane(plane, wall.skin_left_m).into_iter();
            return places.map(|place| members[place]).collect();
        }
        let mut near = Vec::new();
        for (block, ball) in large.blocks.around.iter().enumerate() {
            if is_reached(large.in_space(ball)) {
                let balls = large.balls_of(block, searched.balls, &known.groups);
                let balls = balls.filter(|&(i, ball)| seeks(i) && is_reached(ball));
                near.extend(balls.map(|(i, _)| i));
            }
        }
        near
    });
    reached.par_extend(of_large);
    reached
}

/// The pairs found for the particles that seek, and the known pairs of the others: sorted.
fn with_others(known: &[[u32; 2]], found: Vec<[u32; 2]>, seeks: &[bool]) -> Vec<[u32; 2]> {
    let stays = |pair: &&[u32; 2]| !pair.iter().any(|&i| seeks[i as usize]);
    let mut known = known.iter().filter(stays).copied().peekable();
    let mut pairs = Vec::with_capacity(found.len() + known.size_hint().1.unwrap_or(0));
    for pair in found {
        while let Some(other) = known.next_if(|other| *other < pair) {
            pairs.push(other);
        }
        pairs.push(pair);
    }
    pairs.extend(known);
    pairs
}

/// Lists the spheres of clumps that are in pairs, near walls or at liquid bridges, and puts them in
/// place.
fn list_near_spheres(state: &mut State, pairs: &[[u32; 2]]) {
    if state.clumps.all.is_empty() {
        return;
    }
    let at_walls = state.walls.iter().flat_map(|wall| &wall.near);
    let at_bridges = state.bridges.iter().flat_map(Bridges::particles);
    let near = pairs
        .iter()
        .flatten()
        .chain(at_walls)
        .copied()
        .chain(at_bridges);
    clumps::list_near(&mut state.clumps, &mut state.particles, near);
}

/// Lists what is near the walls that have moved too far since they were last listed.
fn list_near_moving_walls(state: &mut State) {
    foresee_walls(state);
    let Some(mut contacts) = state.contacts.take() else {
        return;
    };
    let is_due = |wall: &Wall| wall.skin_left_m < 2.0 * wall.moved_m;
    if state.walls.iter().any(is_due) {
        let References {
            balls,
            clusters: known,
            clumps,
            ..
        } = &mut contacts.scratch.references;
        let clusters = state.clusters.as_ref();
        let searched = Searched {
            balls,
            clusters: clusters.map_or(&[], |clusters| &clusters.of_particle),
            seeks: None,
            clumps: Some((&state.clumps, clumps)),
        };
        // Bodies may have been removed since the last search.
        if !known.are_those_of(searched.clusters) {
            known.update(&searched);
        }
        let small = of_small(known, &state.clumps, &everything(state));
        for wall in state.walls.iter_mut().filter(|wall| is_due(wall)) {
            wall.skin_left_m = skin_m(wall, contacts.skin_m);
            wall.near = reached(wall, known, &searched, &small);
            wall.near.sort_unstable();
        }
        list_near_spheres(state, &contacts.pairs);
        note_relisting(state);
    }
    state.contacts = Some(contacts);
}

/// Distance that a wall may move before what is near it is listed again, m.
fn skin_m(wall: &Wall, least_m: f64) -> f64 {
    match wall.model.motion {
        WallMotion::Fixed => 0.0,
        _ => least_m.max(4.0 * wall.moved_m),
    }
}
