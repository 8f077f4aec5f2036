//! Neighbour lists: particles near walls, pairs of particles, and the spheres of clumps that are in
//! either.

mod beside_sleepers;
mod moved;
mod renumbered;

use dem_scene::WallMotion;

pub(crate) use self::renumbered::{lengthen_lists, renumber_lists};

use self::beside_sleepers::wake_disturbed;
use self::moved::{find_due, find_left, may_be_due, refer_clumps, refer_particles, use_up};
use super::neighbours::{MOST_TASKS, find_pairs};
use crate::stages::chunks::{chunk_of, chunks_of, in_tasks, nth_range};
use crate::stages::clumps::motion::list_near;
use crate::stages::clusters::bytes::{ClusterUser, clusters_bytes};
use crate::stages::contacts::forces::{find_mean_radius, list_within, relist};
use crate::stages::ledger::islands::join_at_moving_walls;
use crate::stages::motion::riding::{is_due, use_up_approach};
use crate::stages::motion::sleep::begins_to_move;
use crate::stages::stage::{Need, Stage};
use crate::stages::walls::{plane_in_space, reaches};
use crate::state::State;
use crate::state::bridges::Bridges;
use crate::state::clumps::Clumps;
use crate::state::clusters::Clusters;
use crate::state::contacts::Contacts;
use crate::state::search::buffers::{Due, NearBuffers, SearchBuffers};
use crate::state::search::clusters::{KnownClusters, LargeCluster, Searched};
use crate::state::search::references::References;
use crate::state::search::rigid_balls::ClumpReference;
use crate::state::walls::Wall;
use dem_physics::geometry::balls::{Ball, ball_around};

/// The neighbour search.
pub(crate) const SEARCH: Stage = Stage {
    bytes: |state| {
        let contacts = state.contacts.as_ref();
        let of_contacts = contacts.map_or(0, |c| {
            let lists = size_of_val(&c.pairs[..]) + size_of_val(&c.scratch.former_pairs[..]);
            let kept = c.scratch.buffers.bytes() + c.islands.bytes();
            lists + kept + size_of_val(&c.lost_j[..]) + c.materials.len()
        });
        of_contacts + clusters_bytes(state, ClusterUser::Contacts)
    },
    ..Stage::new("neighbour search", |state, _| {
        Need::of(
            state.contacts.is_some(),
            || "when something may have come near".to_owned(),
            "nothing can touch",
        )
    })
};

/// Subtracts the displacement in a drift from the skin left until the lists are rebuilt.
pub(crate) fn use_up_skin(state: &mut State) -> usize {
    if let Some(contacts) = &mut state.contacts {
        let moved_m = state.fastest_m_s * state.time_step_s;
        contacts.moved_m = moved_m;
        let own = &mut contacts.scratch.self_contacts;
        own.use_up(&state.scratch.chunks_moved_m);
        contacts.scratch.close_skin_left_m -= moved_m;
        if state.sleep.is_some() {
            contacts.skin_left_m -= moved_m;
            if contacts.skin_left_m < moved_m {
                // After one more step like this, unlisted particles could overlap.
                contacts.skin_left_m = -1.0;
            }
        }
    }
    if let (Some(sleep), Some(contacts)) = (&mut state.sleep, &state.contacts)
        && !sleep.riders.is_empty()
    {
        let riding_m_s = use_up_approach(sleep, contacts.moved_m, state.time_step_s);
        state.fastest_m_s = state.fastest_m_s.max(riding_m_s);
    }
    if let Some(contacts) = &mut state.contacts {
        let references = &mut contacts.scratch.references;
        use_up(&state.scratch.chunks_moved_m, &state.clumps, references);
    }
    0
}

/// Rebuilds the lists of what may have come near something since the last time. Returns the number
/// of particles searched for.
pub(crate) fn renew_lists(state: &mut State) -> usize {
    let sleep = state.sleep.as_ref();
    let is_due = is_due(state) || begins_to_move(sleep, &state.walls, state.moment());
    let Some(contacts) = &mut state.contacts else {
        return 0;
    };
    if is_due {
        contacts.skin_left_m = -1.0;
    }
    let mut searched = 0;
    if state.sleep.is_some() && contacts.skin_left_m < 0.0 {
        let (looked_at, is_changed) = wake_disturbed(state);
        searched += looked_at;
        if is_changed {
            leave_out_sleepers(state);
        }
    }
    searched += search_for_moved(state);
    list_self_contacts(state);
    list_near_moving_walls(state);
    searched
}

/// Takes sleeping particles out of the lists.
fn leave_out_sleepers(state: &mut State) {
    let Some(mut contacts) = state.contacts.take() else {
        return;
    };
    let p = &state.particles;
    let is_awake = |i: u32| !p.sleeps(i as usize);
    for wall in &mut state.walls {
        wall.near.retain(|&i| is_awake(i));
    }
    let mut pairs = std::mem::take(&mut contacts.scratch.former_pairs);
    pairs.clear();
    let both_awake = |pair: &&[u32; 2]| pair.iter().all(|&i| is_awake(i));
    pairs.extend(contacts.pairs.iter().filter(both_awake));
    // Contacts that were frozen and taken back in one look are there twice.
    pairs.dedup();
    let mut near = std::mem::take(&mut contacts.scratch.buffers.near);
    list_near_spheres(state, &pairs, &mut near);
    contacts.scratch.buffers.near = near;
    put_in_list(state, &mut contacts, pairs);
    state.contacts = Some(contacts);
}

/// Searches for the neighbours of the particles that have moved too far. Returns their number.
fn search_for_moved(state: &mut State) -> usize {
    let Some(mut contacts) = state.contacts.take() else {
        return 0;
    };
    let mut searched = 0;
    if may_be_due(state, &contacts) {
        if state.sleep.is_none() {
            contacts.skin_left_m = 0.0;
        }
        let mut buffers = std::mem::take(&mut contacts.scratch.buffers);
        if knows_all(state, &contacts.scratch.references) {
            find_due(state, &mut contacts.scratch.references, &mut buffers);
        } else {
            begin_anew(state, &mut contacts);
            everything(state, &mut buffers.due);
            let p = &state.particles;
            buffers.seeks.clear();
            buffers.seeks.extend((0..p.len()).map(|i| !p.sleeps(i)));
        }
        if !buffers.due.is_empty() {
            searched = search_for(state, &mut contacts, &mut buffers);
        }
        contacts.scratch.buffers = buffers;
        contacts.scratch.references.due.clear();
    }
    state.contacts = Some(contacts);
    searched
}

/// Lists the pairs within pieces anew if they have changed since all pairs were listed.
fn list_self_contacts(state: &mut State) {
    let is_changed = |contacts: &mut Contacts| contacts.scratch.self_contacts.is_changed;
    let Some(mut contacts) = state.contacts.take_if(is_changed) else {
        return;
    };
    let mut pairs = std::mem::take(&mut contacts.scratch.former_pairs);
    pairs.clone_from(&contacts.pairs);
    put_in_list(state, &mut contacts, pairs);
    state.contacts = Some(contacts);
}

/// Whether it is known where everything was at its last search. Not so at the start.
fn knows_all(state: &State, references: &References) -> bool {
    references.balls.len() == state.particles.len()
        && references.clumps.len() == state.clumps.all.len()
}

/// Forgets the last search, before everything is searched for.
fn begin_anew(state: &mut State, contacts: &mut Contacts) {
    find_mean_radius(contacts, &state.particles, 0);
    let references = &mut contacts.scratch.references;
    references.balls = vec![[0.0; 4]; state.particles.len()];
    references.clumps = vec![ClumpReference::default(); state.clumps.all.len()];
    references.chunks_left_m.clear();
    references.clusters = KnownClusters::default();
    for wall in &mut state.walls {
        wall.skin_left_m = skin_m(wall, contacts.skin_m);
    }
}

/// All that are awake.
fn everything(state: &State, due: &mut Due) {
    let p = &state.particles;
    let clumps = state.clumps.all.iter().enumerate();
    due.clear();
    due.particles
        .extend((0..p.free as u32).filter(|&i| !p.sleeps(i as usize)));
    due.clumps
        .extend(clumps.filter(|(_, clump)| !clump.asleep).map(|(n, _)| n));
}

/// Searches for the neighbours of what is due: moves its balls, and lists the pairs and walls that
/// they overlap.
fn search_for(state: &mut State, contacts: &mut Contacts, buffers: &mut SearchBuffers) -> usize {
    let due = &buffers.due;
    refer_particles(contacts, state, &due.particles);
    let clusters = state.clusters.as_ref();
    refer_clumps(contacts, state, &due.clumps, clusters.is_none());
    find_left(&state.particles, &mut contacts.scratch.references);
    let seeks = &buffers.seeks[..];
    let some = seeks.contains(&false).then_some(seeks);
    let References {
        balls,
        clusters: known,
        clumps: references,
        ..
    } = &mut contacts.scratch.references;
    let (of_particle, clusters_ever) = numbers_of(clusters);
    let searched = Searched {
        balls,
        clusters: of_particle,
        clusters_ever,
        seeks: some,
        asleep: &state.particles.asleep,
        clumps: Some((&state.clumps, references)),
    };
    known.update(&searched);
    list_loose(known, &state.clumps, due, &mut buffers.loose);
    for wall in &mut state.walls {
        let mut near = std::mem::take(&mut wall.near);
        near.retain(|&i| !seeks[i as usize]);
        add_reached(
            wall,
            known,
            &searched,
            &buffers.loose,
            &mut buffers.reached,
            &mut near,
        );
        near.sort_unstable();
        wall.near = near;
    }
    let mut pairs = std::mem::take(&mut contacts.scratch.former_pairs);
    pairs.clear();
    if clusters.is_some() && !contacts.model.alone {
        find_pairs(&searched, known, &mut buffers.pairs);
        let found = &mut buffers.pairs.found;
        match some {
            Some(seeks) => add_with_others(&contacts.pairs, found, seeks, &mut pairs),
            None => std::mem::swap(&mut pairs, found),
        }
    }
    list_near_spheres(state, &pairs, &mut buffers.near);
    put_in_list(state, contacts, pairs);
    join_at_moving_walls(contacts, state);
    seeks.iter().filter(|&&seeks| seeks).count()
}

/// Lists these pairs of different pieces, and those within pieces.
fn put_in_list(state: &mut State, contacts: &mut Contacts, mut pairs: Vec<[u32; 2]>) {
    list_within(state, contacts, &mut pairs);
    relist(contacts, pairs, state);
    if contacts.model.relaxes {
        state.scratch.events.work.relaxing += contacts.relaxing();
    }
}

/// The cluster of each particle, and how many clusters there have been: see [`Searched`].
fn numbers_of(clusters: Option<&Clusters>) -> (&[u32], Option<usize>) {
    match clusters {
        Some(clusters) => (&clusters.of_particle, Some(clusters.history.len())),
        None => (&[], None),
    }
}

/// Lists what is due and is in no large cluster.
fn list_loose(known: &KnownClusters, clumps: &Clumps, due: &Due, loose: &mut Vec<u32>) {
    let free = due.particles.iter().copied();
    let clumps_due = due.clumps.iter().map(|&at| &clumps.all[at]);
    let spheres = clumps_due.filter(|clump| !known.is_in_large(clump.first));
    let spheres = spheres.flat_map(|clump| clumps.spheres_of(clump));
    let free = free.filter(|&i| !known.is_in_large(i));
    loose.clear();
    loose.extend(free.chain(spheres.map(|i| i as u32)));
}

/// Adds the particles that a wall reaches before its skin is used up, of those that seek: of small
/// clusters `loose`, and of large ones those of blocks that it may reach. `of_tasks`: kept for
/// their memory.
fn add_reached(
    wall: &Wall,
    known: &KnownClusters,
    searched: &Searched<'_>,
    loose: &[u32],
    of_tasks: &mut Vec<Vec<u32>>,
    reached: &mut Vec<u32>,
) {
    let reaches = reaches(wall);
    let is_reached = |[x, y, z, radius_m]: Ball| reaches([x, y, z], radius_m + wall.skin_left_m);
    let plane = plane_in_space(wall);
    let of_large = |large: &LargeCluster, found: &mut Vec<u32>| {
        let sleeps = searched.sleeps(known.groups.members(large.group));
        let any_seeks = !sleeps && (searched.seeks.is_none() || large.seeks);
        if !any_seeks || !is_reached(ball_around(&large.bounds)) {
            return;
        }
        if let (Some(body), Some(plane)) = (&large.rigid, plane) {
            let members = known.groups.members(large.group);
            body.each_near_plane(plane, wall.skin_left_m, |place| found.push(members[place]));
            return;
        }
        for (block, ball) in large.blocks.around.iter().enumerate() {
            if is_reached(large.in_space(ball)) {
                let balls = large.balls_of(block, searched.balls, &known.groups);
                let balls = balls.filter(|&(i, ball)| searched.is_seeking(i) && is_reached(ball));
                found.extend(balls.map(|(i, _)| i));
            }
        }
    };
    let chunks = chunks_of(loose.len());
    let each = known.large.len().div_ceil(MOST_TASKS).max(1);
    let count = chunks.len() + known.large.len().div_ceil(each);
    let tasks = in_tasks(count, of_tasks, |task, found| {
        found.clear();
        if chunks.contains(&task) {
            let some = loose[chunk_of(task, loose.len())].iter().copied();
            found.extend(some.filter(|&i| is_reached(searched.balls[i as usize])));
        } else {
            let some = nth_range(task - chunks.len(), each, known.large.len());
            for large in &known.large[some] {
                of_large(large, found);
            }
        }
    });
    for found in tasks {
        reached.extend_from_slice(found);
    }
}

/// Adds the pairs found for the particles that seek, and the known pairs of the others: sorted.
fn add_with_others(
    known: &[[u32; 2]],
    found: &[[u32; 2]],
    seeks: &[bool],
    pairs: &mut Vec<[u32; 2]>,
) {
    let stays = |pair: &&[u32; 2]| !pair.iter().any(|&i| seeks[i as usize]);
    let mut known = known.iter().filter(stays).copied().peekable();
    for &pair in found {
        while let Some(other) = known.next_if(|other| *other < pair) {
            pairs.push(other);
        }
        pairs.push(pair);
    }
    pairs.extend(known);
}

/// Lists the spheres of clumps that are in pairs, near walls or at liquid bridges, and puts them in
/// place.
fn list_near_spheres(state: &mut State, pairs: &[[u32; 2]], buffers: &mut NearBuffers) {
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
    list_near(&mut state.clumps, &mut state.particles, near, buffers);
}

/// Lists what is near the walls that have moved too far since they were last listed.
fn list_near_moving_walls(state: &mut State) {
    let Some(mut contacts) = state.contacts.take() else {
        return;
    };
    let is_due = |wall: &Wall| wall.skin_left_m < 2.0 * wall.moved_m;
    if state.walls.iter().any(is_due) {
        let mut buffers = std::mem::take(&mut contacts.scratch.buffers);
        everything(state, &mut buffers.due);
        let References {
            balls,
            clusters: known,
            clumps,
            ..
        } = &mut contacts.scratch.references;
        let (clusters, clusters_ever) = numbers_of(state.clusters.as_ref());
        let searched = Searched {
            balls,
            clusters,
            clusters_ever,
            seeks: None,
            asleep: &state.particles.asleep,
            clumps: Some((&state.clumps, clumps)),
        };
        // Bodies may have been removed since the last search.
        if !known.are_those_of(&searched) {
            known.update(&searched);
        }
        let SearchBuffers {
            due,
            loose,
            reached,
            ..
        } = &mut buffers;
        list_loose(known, &state.clumps, due, loose);
        for wall in state.walls.iter_mut().filter(|wall| is_due(wall)) {
            wall.skin_left_m = skin_m(wall, contacts.skin_m);
            let mut near = std::mem::take(&mut wall.near);
            near.clear();
            add_reached(wall, known, &searched, loose, reached, &mut near);
            near.sort_unstable();
            wall.near = near;
        }
        list_near_spheres(state, &contacts.pairs, &mut buffers.near);
        contacts.scratch.buffers = buffers;
        join_at_moving_walls(&mut contacts, state);
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
