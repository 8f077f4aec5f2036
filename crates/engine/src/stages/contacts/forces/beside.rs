//! Contacts beside bonds: pairs whose ends are bonded, or were and still belong to the same piece.
//!
//! The contact law begins at the overlap at which the ends were bonded, so that it acts in further
//! compression only. This origin stays while the bond holds. Once the bond is broken, it falls with
//! the overlap as that of any pair that [separated while
//! overlapping](dem_physics::contact::relaxation): what presses at the break goes on pressing.

use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::clusters::Clusters;
use crate::state::contacts::{Beside, Contacts};

/// Lists the pairs within pieces among all pairs: those with a contact beside their bond, and those
/// that no bond joins. `pairs` are those of different pieces, or still known from an earlier
/// search; sorted.
pub(crate) fn list_within(state: &State, contacts: &mut Contacts, pairs: &mut Vec<[u32; 2]>) {
    let scratch = &mut contacts.scratch;
    scratch.self_contacts.is_changed = false;
    scratch.beside.clear();
    let Some(clusters) = &state.clusters else {
        return;
    };
    let bonds = &state.bonds;
    let has_beside = bonds.rules.iter().any(|rule| rule.contact_beside);
    if bonds.is_empty() || !(has_beside || contacts.model.self_contact) {
        return;
    }
    pairs.retain(|&pair| !clusters.is_within(pair));
    let own = scratch.self_contacts.pairs.iter().copied();
    let known = pairs.len();
    pairs.extend(own.filter(|&pair| is_listed(state, clusters, pair)));
    if has_beside {
        list_beside(state, clusters, &mut scratch.beside);
        let ends = |beside: &Beside| bonds.ends[beside.bond as usize];
        pairs.extend(scratch.beside.iter().map(ends));
    }
    if pairs.len() > known {
        pairs.sort_unstable();
        pairs.dedup();
    }
    for one in &mut scratch.beside {
        let ends = bonds.ends[one.bond as usize];
        one.pair = pairs.partition_point(|pair| *pair < ends) as u32;
    }
}

/// Whether a pair is of one piece that is awake.
fn is_listed(state: &State, clusters: &Clusters, pair: [u32; 2]) -> bool {
    clusters.is_within(pair) && !state.particles.sleeps(pair[0] as usize)
}

/// Lists the contacts beside bonds.
fn list_beside(state: &State, clusters: &Clusters, beside: &mut Vec<Beside>) {
    let (bonds, poses) = (&state.bonds, &state.particles.poses);
    let all = (0..bonds.len()).filter(|&at| bonds.rules[bonds.rule_of(at)].contact_beside);
    let some = all.filter(|&at| clusters.is_within(bonds.ends[at]));
    beside.extend(some.map(|at| {
        let radii_m = bonds.ends[at].map(|end| poses[end as usize].radius_m());
        let overlap_m = radii_m[0] + radii_m[1] - bonds.initial_length_m(at);
        Beside {
            pair: 0,
            bond: at as u32,
            origin_m: overlap_m.max(0.0),
        }
    }));
}

/// Keeps the origin of the law of pairs whose bond holds.
pub(super) fn hold_origins(contacts: &mut Contacts, bonds: &Bonds) {
    for beside in &contacts.scratch.beside {
        if !bonds.is_broken(beside.bond as usize) {
            contacts.histories[beside.pair as usize].damping[3] = beside.origin_m;
        }
    }
}
