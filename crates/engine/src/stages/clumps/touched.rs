//! Clumps that touch the walls and bodies that their triggers name.

use crate::state::State;
use crate::state::rules::Touches;

/// Sets `touched` to whether each clump touches what its trigger names; to none if no trigger names
/// anything. Returns the number of contacts read.
pub(super) fn find_touched(state: &State, touched: &mut Vec<bool>) -> usize {
    touched.clear();
    let mut names = state.model.rules.triggers.iter().flatten();
    if !names.any(|trigger| trigger.touches.is_some()) {
        return 0;
    }
    touched.resize(state.clumps.all.len(), false);
    by_walls(state, touched) + by_bodies(state, touched)
}

/// What the trigger of a clump names.
fn touches_of(state: &State, clump: usize) -> Option<&Touches> {
    let base = state.base_of(state.clumps.all[clump].template) as usize;
    let trigger = state.model.rules.triggers.get(base)?.as_ref()?;
    trigger.touches.as_ref()
}

fn by_walls(state: &State, touched: &mut [bool]) -> usize {
    let triggers = || state.model.rules.triggers.iter().flatten();
    let touches = || triggers().filter_map(|trigger| trigger.touches.as_ref());
    let mut read = 0;
    for (number, wall) in state.walls.iter().enumerate() {
        if !touches().any(|touches| touches.walls.contains(&number)) {
            continue;
        }
        let touching = wall.touching.iter();
        for touch in touching.filter(|touch| touch.history.overlap_m() > 0.0) {
            let Some(clump) = state.clumps.carrier_of(touch.particle as usize) else {
                continue;
            };
            read += 1;
            let names = touches_of(state, clump);
            touched[clump] |= names.is_some_and(|names| names.walls.contains(&number));
        }
    }
    read
}

fn by_bodies(state: &State, touched: &mut [bool]) -> usize {
    let mut triggers = state.model.rules.triggers.iter().flatten();
    let names_any = |touches: &Touches| !touches.bodies.is_empty();
    let (Some(contacts), Some(clusters), true) = (
        &state.contacts,
        &state.clusters,
        triggers.any(|trigger| trigger.touches.as_ref().is_some_and(names_any)),
    ) else {
        return 0;
    };
    let mut read = 0;
    let touching = contacts.pairs.iter().zip(&contacts.histories);
    for (&[a, b], _) in touching.filter(|(_, history)| history.overlap_m() > 0.0) {
        for (own, other) in [(a, b), (b, a)] {
            let Some(clump) = state.clumps.carrier_of(own as usize) else {
                continue;
            };
            read += 1;
            let other = clusters.of_particle[other as usize] as usize;
            let body = clusters.history[other].body;
            let names = touches_of(state, clump);
            touched[clump] |= names.is_some_and(|names| names.bodies.contains(&body));
        }
    }
    read
}
