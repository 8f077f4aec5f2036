//! Viscous forces of damped bonds on the particles, from the velocities half a step ago. They are
//! computed together with the bond forces, and once more in steps in which bonds break, since the
//! ends of these have other velocities then.

use super::bonds::{BONDS, any_bond, damping_wrenches};
use super::stage::{Need, Saving, Stage};
use crate::state::State;
use crate::state::particles::Wrench;

/// ns per bond of a body of 25,547 particles: see doc/leave-out.md.
const BOND_DAMPING_NS: f64 = 19.3;

/// Damping of bonds.
pub const BOND_DAMPING: Stage = Stage {
    name: "bond damping",
    within: Some(BONDS.name),
    need: |state, _| {
        Need::of(
            any_bond(state, |rule| rule.damped),
            || "bonds are damped".to_owned(),
            "no bond is damped: no relative velocities",
        )
    },
    bytes: |state| {
        let resistances = if any_damped(state) {
            size_of_val(&state.scratch.bond_resistance[..])
        } else {
            0
        };
        size_of_val(&state.bonds.damping[..]) + resistances
    },
    saving: |state| {
        let of_bonds = Saving::of(state.bonds.len(), size_of::<[f64; 4]>(), BOND_DAMPING_NS)?;
        Some(Saving {
            bytes: of_bonds.bytes + state.particles.free * size_of::<Wrench>(),
            ..of_bonds
        })
    },
};

/// Whether any rule has viscous damping.
pub(super) fn any_damped(state: &State) -> bool {
    state.bonds.rules.iter().any(|rule| rule.damped)
}

/// Sets the damping forces of bonds, if not done with the bond forces. Returns the number of bonds
/// computed.
pub(crate) fn compute_bond_damping(state: &mut State) -> usize {
    let bonds_broke = !state.scratch.events.broken.is_empty();
    if bonds_broke && !state.scratch.bond_resistance.is_empty() {
        let p = &state.particles;
        let resisting = &mut state.scratch.bond_resistance;
        damping_wrenches(
            &state.bonds,
            &p.poses,
            &p.motions,
            &mut state.scratch.partitions,
            resisting,
        );
    }
    state
        .scratch
        .partitions
        .iter()
        .map(|partition| partition.computed.damped)
        .sum()
}
