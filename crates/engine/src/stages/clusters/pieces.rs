//! The search for fragments of clusters in which bonds have broken.

use super::bytes::{ClusterUser, clusters_bytes};
use crate::stages::bonds::forces::any_bond;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::clusters::Clusters;
use crate::state::contacts::Contacts;

/// The search for fragments.
pub(crate) const CLUSTERS: Stage = Stage {
    bytes: |state| clusters_bytes(state, ClusterUser::Fragments),
    ..Stage::new("cluster search", |state, _| {
        let breaks = state.bonds.rules.iter().any(|rule| rule.criteria.is_some());
        Need::of(
            state.clusters.is_some() && breaks && any_bond(state, |_| true),
            || "in each step in which a bond has broken".to_owned(),
            "no bond can break",
        )
    })
};

/// Searches for the fragments of the pieces in which bonds have broken in this step. Returns the
/// number of clusters searched.
pub(crate) fn find_pieces(state: &mut State) -> usize {
    let broken = &state.scratch.events.broken;
    if broken.is_empty() {
        return 0;
    }
    let broken: Vec<u32> = broken.iter().map(|broken| broken.bond).collect();
    find_pieces_of(state, &broken)
}

/// Searches for the fragments of the pieces of these broken bonds. Particles that no bond joins any
/// more may touch from the next step on. Returns the number of clusters searched.
pub fn find_pieces_of(state: &mut State, broken: &[u32]) -> usize {
    let Some(clusters) = &mut state.clusters else {
        return 0;
    };
    let damaged = clusters.damaged_by(broken, &state.bonds);
    state.scratch.events.splits = clusters.update(state.time_s, &damaged, &state.bonds);
    if let Some(contacts) = &mut state.contacts {
        if contacts.model.self_contact {
            let parted = broken.iter().map(|&bond| state.bonds.ends[bond as usize]);
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
