//! Neighbour lists: particles near walls, pairs of particles, and the spheres of clumps that are in
//! either.
//!
//! Sleeping bodies are in none of them; a sleeping body wakes first when something moving is near
//! it.

use super::clumps;
use super::contacts::list_contacts;
use super::pieces::clusters_bytes;
use super::sleep::{begins_to_move, disturbed, freeze_contacts, wake};
use super::stage::{NO_SAVING, Need, Stage};
use super::walls::list_near;
use crate::state::State;

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
        of_contacts + clusters_bytes(state, SEARCH.name)
    },
    saving: NO_SAVING,
};

/// Subtracts the displacement in a drift from the skin left until the lists are rebuilt.
pub(crate) fn use_up_skin(state: &mut State) -> usize {
    if let Some(contacts) = &mut state.contacts {
        let moved_m = state.fastest_m_s * state.time_step_s;
        contacts.moved_m = moved_m;
        contacts.scratch.close_skin_left_m -= moved_m;
        contacts.skin_left_m -= moved_m;
        if contacts.skin_left_m < moved_m {
            // After one more step like this, unlisted particles could overlap.
            contacts.skin_left_m = -1.0;
        }
    }
    0
}

/// Rebuilds the lists if something may have come near since the last time. Returns the number of
/// particles processed.
pub(crate) fn renew_lists(state: &mut State) -> usize {
    let Some(contacts) = &mut state.contacts else {
        return 0;
    };
    if begins_to_move(
        state.sleep.as_ref(),
        &state.walls,
        [state.time_s, state.time_step_s],
    ) {
        contacts.skin_left_m = -1.0;
    }
    if contacts.skin_left_m >= 0.0 {
        return 0;
    }
    let mut listed = 0;
    clumps::place_all(&state.clumps, &mut state.particles);
    freeze_contacts(state);
    loop {
        list_awake(state);
        listed += state.particles.len();
        let near = disturbed(state);
        if near.is_empty() {
            break;
        }
        wake(state, &near, "near");
    }
    let p = &mut state.particles;
    if let Some(contacts) = &state.contacts {
        let at_walls = state.walls.iter().flat_map(|wall| &wall.near);
        let near = contacts.pairs.iter().flatten().chain(at_walls).copied();
        clumps::list_near(&mut state.clumps, p, near);
    }
    listed
}

/// Lists walls and pairs, without pairs of sleeping particles.
fn list_awake(state: &mut State) {
    let moved_m = state.fastest_m_s * state.time_step_s;
    let (Some(contacts), p) = (&mut state.contacts, &state.particles) else {
        return;
    };
    // The skin covers at least two steps: a pair that is first listed when it already overlaps
    // would be treated as fragments of one body, and its overlap would relax.
    let skin_m = contacts.skin_m.max(4.0 * moved_m);
    list_near(&mut state.walls, p, skin_m);
    if contacts.model.alone {
        contacts.skin_left_m = 0.5 * skin_m;
        return;
    }
    let clusters = state.clusters.as_ref();
    let of_particle = clusters.map_or(&[][..], |c| &c.of_particle);
    if p.asleep.is_empty() {
        list_contacts(contacts, of_particle, p, skin_m);
    } else {
        // All sleeping bodies count as one.
        let none = clusters.map_or(0, |c| c.history.len() as u32);
        let of_one = |(&id, &asleep): (&u32, &bool)| if asleep { none } else { id };
        let numbers: Vec<u32> = of_particle.iter().zip(&p.asleep).map(of_one).collect();
        list_contacts(contacts, &numbers, p, skin_m);
    }
    if contacts.model.relaxes {
        state.scratch.events.work.relaxing += contacts.relaxing();
    }
}
