//! The search for the pieces of clusters in which bonds have broken.

use super::stage::{NO_SAVING, Need, Stage};
use crate::state::State;

/// The search for pieces.
pub const CLUSTERS: Stage = Stage {
    name: "cluster search",
    within: None,
    need: |state, _| {
        let breaks = state.bonds.rules.iter().any(|rule| rule.criteria.is_some());
        Need::of(
            state.clusters.is_some() && breaks && super::bonds::any_bond(state, |_| true),
            || {
                format!(
                    "every {} steps, if bonds have broken",
                    state.model.search.interval
                )
            },
            "no bond can break",
        )
    },
    bytes: |state| clusters_bytes(state, CLUSTERS.name),
    saving: NO_SAVING,
};

/// Looks for pieces if it is time to. Particles that are no more of one cluster may touch from the
/// next step on. Returns how many clusters were searched.
pub fn find_pieces(state: &mut State) -> usize {
    if state.clusters.is_none() {
        return 0;
    }
    let broken = state.scratch.events.broken.iter().map(|broken| broken.bond);
    state.unsearched.extend(broken);
    let unsearched = state.unsearched.len() as u64;
    if !state.model.search.due(state.steps, unsearched) {
        return 0;
    }
    find_pieces_now(state)
}

/// The same, whether it is time to or not.
pub fn find_pieces_now(state: &mut State) -> usize {
    let Some(clusters) = &mut state.clusters else {
        return 0;
    };
    let damaged = clusters.damaged_by(&state.unsearched, &state.bonds);
    state.scratch.events.splits = clusters.update(state.time_s, &damaged, &state.bonds);
    state.unsearched.clear();
    if let (Some(contacts), false) = (&mut state.contacts, state.scratch.events.splits.is_empty()) {
        contacts.skin_left_m = -1.0;
    }
    damaged.len()
}

/// Bytes of what is known of clusters, if the stage of this name needs it: the search for them
/// where bonds can break; else what tells bodies apart that can touch; else clumps, or measures
/// that count pieces.
pub(super) fn clusters_bytes(state: &State, stage: &str) -> usize {
    let breaks = (state.bonds.rules.iter()).any(|rule| rule.criteria.is_some());
    let owner = match (breaks, &state.contacts) {
        (true, _) => CLUSTERS.name,
        (false, Some(_)) => super::listing::SEARCH.name,
        (false, None) if !state.clumps.templates.is_empty() => super::clumps::CLUMPS.name,
        (false, None) => super::watching::OUTPUT.name,
    };
    match &state.clusters {
        Some(clusters) if stage == owner => clusters.bytes(),
        _ => 0,
    }
}
