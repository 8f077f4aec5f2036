//! Neighbour lists after bodies have been added, removed or replaced: what was there before keeps
//! its last search, under new numbers if these have changed, and only what is new is searched for.

use super::moved::find_left;
use crate::stages::contacts::forces::find_mean_radius;
use crate::state::State;
use crate::state::clumps::Clumps;
use crate::state::contacts::Contacts;
use crate::state::events::REMOVED;
use crate::state::particles::Particles;
use crate::state::search::references::References;
use crate::state::search::rigid_balls::ClumpReference;

/// Adds particles and their clumps, which come after those that were there before, to the last
/// search: they are searched for before the next step. `known`: numbers of particles and clumps
/// before.
pub(crate) fn lengthen_lists(
    contacts: &mut Contacts,
    particles: &Particles,
    clumps: &Clumps,
    [known, known_clumps]: [usize; 2],
) {
    contacts.skin_left_m = -1.0;
    let references = &contacts.scratch.references;
    let knows_all = references.balls.len() == known && references.clumps.len() == known_clumps;
    find_mean_radius(contacts, particles, if knows_all { known } else { 0 });
    let references = &mut contacts.scratch.references;
    if knows_all {
        references.due.extend(known as u32..particles.len() as u32);
        references.balls.resize(particles.len(), [0.0; 4]);
        let count = clumps.all.len();
        references.clumps.resize(count, ClumpReference::default());
    } else {
        contacts.search_all();
    }
}

/// Renumbers the last search. `now`: for each old particle its new number or [`REMOVED`];
/// `is_new`: for each new number whether the particle is new; `old_firsts`: the first sphere of
/// each clump before.
pub(crate) fn renumber_lists(
    state: &mut State,
    now: &[u32],
    is_new: impl Fn(u32) -> bool,
    old_firsts: &[u32],
) {
    let Some(mut contacts) = state.contacts.take() else {
        return;
    };
    find_mean_radius(&mut contacts, &state.particles, 0);
    let own = &mut contacts.scratch.self_contacts;
    own.renumber(now, state.particles.free);
    // Contacts beside bonds are known by the old numbers.
    own.is_changed |= !contacts.scratch.beside.is_empty();
    let stays = |i: u32| Some(now[i as usize]).filter(|&to| to != REMOVED && !is_new(to));
    for wall in &mut state.walls {
        wall.near = wall.near.iter().filter_map(|&i| stays(i)).collect();
        wall.near.sort_unstable();
    }
    let references = &mut contacts.scratch.references;
    let knows_all =
        references.balls.len() == now.len() && references.clumps.len() == old_firsts.len();
    if !knows_all {
        contacts.search_all();
        state.contacts = Some(contacts);
        return;
    }
    let mut balls = vec![None; state.particles.len()];
    for (i, ball) in (0..).zip(&references.balls) {
        if let Some(to) = stays(i) {
            balls[to as usize] = Some(*ball);
        }
    }
    let mut clumps = vec![ClumpReference::default(); state.clumps.all.len()];
    for (&first, reference) in old_firsts.iter().zip(&references.clumps) {
        let carrier = stays(first).and_then(|to| state.clumps.carrier_of(to as usize));
        if let Some(carrier) = carrier {
            clumps[carrier] = *reference;
        }
    }
    let asked = references.due.iter().map(|&i| now[i as usize]);
    let mut due: Vec<u32> = asked.filter(|&to| to != REMOVED).collect();
    due.extend(
        (0..)
            .zip(&balls)
            .filter(|(_, ball)| ball.is_none())
            .map(|(i, _)| i),
    );
    *references = References {
        balls: balls.into_iter().map(Option::unwrap_or_default).collect(),
        clumps,
        due,
        chunks_left_m: Vec::new(),
        clusters: std::mem::take(&mut references.clusters).renumbered(),
    };
    find_left(&state.particles, references);
    contacts.skin_left_m = -1.0;
    state.contacts = Some(contacts);
}
