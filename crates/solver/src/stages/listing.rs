//! The lists of what is near what: particles at walls, pairs of particles, and the spheres of clumps that are in either.
//!
//! Bodies that sleep are in none of them; those that something moving is near to wake first.

use super::clumps;
use super::contacts::list_contacts;
use super::sleep::{begins_to_move, disturbed, keep_touches, wake};
use super::walls::list_near;
use crate::clock::Stage;
use crate::state::State;

/// Makes the lists anew if something may have come near since they were made.
pub fn renew_lists(state: &mut State) {
    let resumed = state.sleep.as_mut().is_some_and(|sleep| {
        sleep.events.clear();
        std::mem::take(&mut sleep.is_resumed)
    });
    let Some(contacts) = &mut state.contacts else {
        return;
    };
    if begins_to_move(
        state.sleep.as_ref(),
        &state.walls,
        [state.time_s, state.time_step_s],
    ) {
        contacts.skin_left_m = -1.0;
    }
    let skin_left_m = contacts.skin_left_m;
    if skin_left_m >= 0.0 && !resumed {
        return;
    }
    clumps::place_all(&state.clumps, &mut state.particles);
    keep_touches(state);
    loop {
        list_awake(state);
        if skin_left_m >= 0.0 {
            // The run from which this one goes on woke nobody here, and makes its next lists when this room is used up.
            leave_out_sleepers(state);
            if let Some(contacts) = &mut state.contacts {
                contacts.skin_left_m = skin_left_m;
            }
            break;
        }
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
}

/// Lists walls and pairs. Of two that sleep no pair is made.
fn list_awake(state: &mut State) {
    let moved_m = state.fastest_m_s * state.time_step_s;
    let (Some(contacts), p) = (&mut state.contacts, &state.particles) else {
        return;
    };
    // Room for two steps at least: who is first seen when it overlaps already would be taken for the piece of a body, and relax.
    let skin_m = contacts.skin_m.max(4.0 * moved_m);
    state.clock.did(Stage::Search, p.len());
    list_near(&mut state.walls, p, skin_m);
    if contacts.alone {
        contacts.skin_left_m = 0.5 * skin_m;
        return;
    }
    let clusters = state.clusters.as_ref();
    let of_particle = clusters.map_or(&[][..], |c| &c.of_particle);
    if p.asleep.is_empty() {
        list_contacts(contacts, of_particle, p, skin_m);
    } else {
        // All that sleep are as one body.
        let none = clusters.map_or(0, |c| c.history.len() as u32);
        let of_one = |(&id, &asleep): (&u32, &bool)| if asleep { none } else { id };
        let numbers: Vec<u32> = of_particle.iter().zip(&p.asleep).map(of_one).collect();
        list_contacts(contacts, &numbers, p, skin_m);
    }
    if contacts.relaxes {
        state.clock.did(Stage::Relaxation, contacts.relaxing());
    }
}

/// Takes the pairs of an awake particle and one that sleeps from the list.
fn leave_out_sleepers(state: &mut State) {
    let (Some(contacts), p) = (&mut state.contacts, &state.particles) else {
        return;
    };
    let is_awake = |pair: &[u32; 2]| pair.iter().all(|&i| !p.sleeps(i as usize));
    (contacts.pairs, contacts.histories) = contacts
        .pairs
        .iter()
        .zip(&contacts.histories)
        .filter(|(pair, _)| is_awake(pair))
        .map(|(pair, history)| (*pair, *history))
        .unzip();
    contacts.divide(p.len(), contacts.wanted_partitions.max(1));
}
