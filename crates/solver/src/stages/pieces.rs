//! The search for fragments of clusters in which bonds have broken.

use super::bonds::any_bond;
use super::cluster_bytes::{ClusterUser, clusters_bytes};
use super::stage::{NO_SAVING, Need, Stage};
use crate::state::State;
use crate::state::clusters::Clusters;
use crate::state::contacts::Contacts;

/// The search for fragments.
pub(crate) const CLUSTERS: Stage = Stage {
    name: "cluster search",
    within: None,
    need: |state, _| {
        let breaks = state.bonds.rules.iter().any(|rule| rule.criteria.is_some());
        Need::of(
            state.clusters.is_some() && breaks && any_bond(state, |_| true),
            || "in each step in which a bond has broken".to_owned(),
            "no bond can break",
        )
    },
    bytes: |state| clusters_bytes(state, ClusterUser::Fragments),
    saving: NO_SAVING,
};

/// Searches for fragments if bonds have broken. Particles that no bond joins any more may touch
/// from
/// the next step on. Returns the number of clusters searched.
pub(crate) fn find_pieces(state: &mut State) -> usize {
    if state.clusters.is_none() {
        return 0;
    }
    let broken = state.scratch.events.broken.iter().map(|broken| broken.bond);
    state.unsearched.extend(broken);
    if state.unsearched.is_empty() {
        return 0;
    }
    find_pieces_now(state)
}

/// Searches for the fragments of the pieces in which bonds have broken since the last search.
pub(crate) fn find_pieces_now(state: &mut State) -> usize {
    let Some(clusters) = &mut state.clusters else {
        return 0;
    };
    let damaged = clusters.damaged_by(&state.unsearched, &state.bonds);
    state.scratch.events.splits = clusters.update(state.time_s, &damaged, &state.bonds);
    let parted = state.unsearched.drain(..);
    let parted = parted.map(|bond| state.bonds.ends[bond as usize]);
    if let Some(contacts) = &mut state.contacts {
        if contacts.model.self_contact {
            contacts.scratch.self_contacts.parted.extend(parted);
        }
        for split in &state.scratch.events.splits {
            search_for_fragments(contacts, clusters, &split.children);
        }
    }
    damaged.len()
}

/// Requests a search for the neighbours of fragments before the next step. That of the largest is
/// not needed: it stays where it was, and the others find it.
fn search_for_fragments(contacts: &mut Contacts, clusters: &Clusters, fragments: &[u32]) {
    contacts.skin_left_m = -1.0;
    let size = |id: &&u32| (clusters.members(**id).len(), std::cmp::Reverse(**id));
    let largest = fragments.iter().max_by_key(size);
    for id in fragments.iter().filter(|id| Some(*id) != largest) {
        let members = clusters.members(*id);
        contacts.scratch.references.due.extend(members);
    }
}
