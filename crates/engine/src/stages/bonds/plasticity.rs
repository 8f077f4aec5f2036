//! Bonds that yield: their plastic flow, and their forces.

use rayon::prelude::*;

use super::damage::{earlier, power_w};
use super::forces::any_bond;
use crate::stages::bonds::one_by_one::add_single_wrenches;
use crate::stages::chunks::CHUNK;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::particles::{Particles, Pose, Wrench};
use crate::state::partitions::Partition;
use dem_physics::bond::plasticity::StressFree;
use dem_physics::bond::total::bond_forces;

/// Bonds that are elastic up to their yield strength.
pub(crate) const PLASTICITY: Stage = Stage {
    bytes: |state| size_of_val(&state.bonds.histories.plastics[..]),
    ..Stage::new("elasto-plastic bonds", |state, _| {
        Need::of(
            any_bond(state, |rule| rule.law.plasticity().is_some()),
            || "bonds have a yield strength".to_owned(),
            "no bond has a yield strength",
        )
    })
};

/// Lets the bonds flow that have reached their yield strength, and adds the forces of all bonds
/// that can yield to the wrenches. Returns the number of bonds computed.
pub(crate) fn compute_plastic_bonds(state: &mut State) -> usize {
    if state.bonds.histories.plastics.is_empty() {
        return 0;
    }
    let drift_s = state.previous_time_step_s;
    state.ledger.plastic_j += flow(&mut state.bonds, &state.particles, drift_s);
    add_elasto_plastic_wrenches(
        &state.bonds,
        &state.particles.poses,
        &mut state.scratch.partitions,
        &mut state.particles.wrenches,
    )
}

/// Adds the forces of all bonds that can yield to the wrenches, with the plastic deformation that
/// they have, and those that have reached their strength to the partitions' lists. Returns their
/// number.
pub(crate) fn add_elasto_plastic_wrenches(
    bonds: &Bonds,
    poses: &[Pose],
    partitions: &mut [Partition],
    wrenches: &mut [Wrench],
) -> usize {
    add_single_wrenches(bonds, poses, partitions, wrenches, |rule| {
        rule.law.plasticity().is_some()
    })
}

/// Lets bonds flow, after a drift of `drift_s`. Returns their plastic work, J.
fn flow(bonds: &mut Bonds, particles: &Particles, drift_s: f64) -> f64 {
    let yielding: Vec<(usize, StressFree)> = (0..bonds.len())
        .into_par_iter()
        .with_min_len(CHUNK)
        .filter_map(|at| Some((at, yielded(bonds, particles, at, drift_s)?)))
        .collect();
    let mut work_j = 0.0;
    for (at, bond) in yielding {
        work_j += bond.plastic.work_j - bonds.histories.plastics[at].work_j;
        bonds.set_stress_free(at, &bond);
    }
    work_j
}

/// Bond `at` after its plastic flow. None: it does not yield.
///
/// Its plastic work is that of the ends in the drift, with the force before it and the new one
/// after it, minus what the bond stores more: the same work as in the balance of energy.
fn yielded(bonds: &Bonds, particles: &Particles, at: usize, drift_s: f64) -> Option<StressFree> {
    let law = bonds.rules[bonds.rule_of(at)].law.plasticity()?;
    let ends = bonds.ends[at].map(|end| end as usize);
    if bonds.is_broken(at) || particles.sleeps(ends[0]) {
        return None;
    }
    let now = ends.map(|end| particles.poses[end].end());
    let (stiffness, before) = (bonds.stiffness(at), bonds.stress_free(at));
    let mut after = law.yielded(&before, &stiffness, bonds.radius_m(at), &now)?;
    let motions = ends.map(|end| &particles.motions[end]);
    let start = [0, 1].map(|end| earlier(&now[end], motions[end], drift_s));
    let [first, last] = [(&before, start), (&after, now)].map(|(bond, ends)| {
        let stiffness = bond.with_levers(&stiffness);
        bond_forces(&stiffness, &bond.direction, &bond.plastic.ends(&ends))
    });
    let given_j = -0.5 * drift_s * (power_w(&first, motions) + power_w(&last, motions));
    after.plastic.work_j += given_j + first.energy.total() - last.energy.total();
    Some(after)
}
