//! Contacts beside bonds: pairs whose ends are bonded, or were and still belong to the same piece.
//!
//! The contact law begins at the overlap at which the ends were bonded, so that it acts in further
//! compression only. This origin stays while the bond holds. Once the bond is broken, it falls with
//! the overlap as that of any pair that [separated while
//! overlapping](crate::physics::contact::relaxation): what presses at the break goes on pressing.

use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::contacts::{Beside, Contacts};

/// Lists the pairs with a contact beside their bond, among all pairs: `pairs` are those of
/// different pieces, or still known from an earlier search; sorted.
pub(in crate::stages) fn list_beside(
    state: &State,
    contacts: &mut Contacts,
    pairs: &mut Vec<[u32; 2]>,
) {
    contacts.scratch.beside.clear();
    let (bonds, poses) = (&state.bonds, &state.particles.poses);
    let Some(clusters) = &state.clusters else {
        return;
    };
    if !bonds.rules.iter().any(|rule| rule.contact_beside) {
        return;
    }
    let is_within =
        |[a, b]: [u32; 2]| clusters.of_particle[a as usize] == clusters.of_particle[b as usize];
    let all = (0..bonds.len()).filter(|&at| bonds.rules[bonds.rule_of(at)].contact_beside);
    let some = all.filter(|&at| is_within(bonds.ends[at]));
    let beside = &mut contacts.scratch.beside;
    beside.extend(some.map(|at| {
        let radii_m = bonds.ends[at].map(|end| poses[end as usize].radius_m());
        let overlap_m = radii_m[0] + radii_m[1] - bonds.initial_length_m(at);
        Beside {
            pair: 0,
            bond: at as u32,
            origin_m: overlap_m.max(0.0),
        }
    }));
    let ends_of = |beside: &Beside| bonds.ends[beside.bond as usize];
    pairs.retain(|&pair| !is_within(pair));
    pairs.extend(beside.iter().map(ends_of));
    pairs.sort_unstable();
    for one in beside {
        one.pair = pairs.partition_point(|pair| *pair < ends_of(one)) as u32;
    }
}

/// Keeps the origin of the law of pairs whose bond holds.
pub(super) fn hold_origins(contacts: &mut Contacts, bonds: &Bonds) {
    for beside in &contacts.scratch.beside {
        if !bonds.is_broken(beside.bond as usize) {
            contacts.histories[beside.pair as usize].damping[3] = beside.origin_m;
        }
    }
}
