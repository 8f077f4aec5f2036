//! Which stage the memory of the cluster data belongs to.

use crate::state::State;

/// A stage that may need the cluster data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClusterUser {
    /// The search for fragments.
    Fragments,
    /// The search for contacts.
    Contacts,
    /// Clumps.
    Clumps,
    /// Measures.
    Measures,
}

/// Bytes of the cluster data, if they belong to this stage: to the search for fragments if bonds
/// can break; otherwise to the contacts, which need to tell bodies apart; otherwise to clumps, or
/// to measures that count fragments.
pub(crate) fn clusters_bytes(state: &State, stage: ClusterUser) -> usize {
    let breaks = (state.bonds.rules.iter()).any(|rule| rule.criteria.is_some());
    let owner = match (breaks, &state.contacts) {
        (true, _) => ClusterUser::Fragments,
        (false, Some(_)) => ClusterUser::Contacts,
        (false, None) if !state.clumps.templates.is_empty() => ClusterUser::Clumps,
        (false, None) => ClusterUser::Measures,
    };
    match &state.clusters {
        Some(clusters) if stage == owner => clusters.bytes(),
        _ => 0,
    }
}
