//! Flat joints: failure and friction of their elements, and their forces.

use rayon::prelude::*;

use super::damage::{earlier, power_w};
use super::forces::any_bond;
use crate::stages::bonds::one_by_one::add_single_wrenches;
use crate::stages::chunks::CHUNK;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::bonds::histories::column_bytes;
use crate::state::particles::Particles;
use dem_physics::bond::flat_joint::{Change, Element, change};

/// Bonds whose section consists of elements.
pub(crate) const FLAT_JOINTS: Stage = Stage {
    bytes: |state| column_bytes(&state.bonds.histories.joints),
    ..Stage::new("flat joints", |state, _| {
        Need::of(
            any_bond(state, |rule| rule.law.flat_joint().is_some()),
            || "bonds are flat joints".to_owned(),
            "no bond is a flat joint",
        )
    })
};

/// Lets elements fail and slide, and adds the forces of all flat joints to the wrenches. Returns
/// the number of joints computed.
pub(crate) fn compute_flat_joints(state: &mut State) -> usize {
    if state.bonds.histories.joints.is_empty() {
        return 0;
    }
    change_elements(state);
    add_single_wrenches(
        &state.bonds,
        &state.particles.poses,
        &mut state.scratch.partitions,
        &mut state.particles.wrenches,
        |rule| rule.law.flat_joint().is_some(),
    )
}

/// Lets elements fail and slide. What that takes is friction, except for what elements that fail
/// release beyond it.
fn change_elements(state: &mut State) {
    let drift_s = state.previous_time_step_s;
    let (bonds, particles) = (&mut state.bonds, &state.particles);
    let known = &*bonds;
    let changes: Vec<(usize, Change, f64)> = (0..known.len())
        .into_par_iter()
        .with_min_len(CHUNK)
        .filter_map(|at| changed(known, particles, at, drift_s))
        .collect();
    for (at, change, spent_j) in changes {
        if change.failed.is_some() {
            state.ledger.released_j += spent_j - change.friction_j;
            state.ledger.joint_friction_j += change.friction_j;
        } else {
            state.ledger.joint_friction_j += spent_j;
        }
        let joint = &mut bonds.histories.joints[at];
        joint.elements = change.elements;
        joint.last_failure = change.failed.or(joint.last_failure);
    }
}

/// The change of joint `at` in a kick after a drift of `drift_s`, and the energy that it takes, J.
/// None: nothing changes.
///
/// That energy is the work of the ends in the drift, with the force before it and the new one after
/// it, minus what the joint stores more: the same work as in the balance of energy. Elements that
/// only open or close take none.
fn changed(
    bonds: &Bonds,
    particles: &Particles,
    at: usize,
    drift_s: f64,
) -> Option<(usize, Change, f64)> {
    let law = bonds.rules[bonds.rule_of(at)].law.flat_joint()?;
    let ends = bonds.ends[at].map(|end| end as usize);
    if bonds.is_broken(at) || particles.sleeps(ends[0]) {
        return None;
    }
    let before = &bonds.histories.joints[at].elements;
    let now = ends.map(|end| particles.poses[end].end());
    let change = change(
        before,
        (&bonds.joint_stiffness(at), law.friction),
        bonds.element_strengths(at).as_ref(),
        &bonds.direction(at),
        bonds.initial_length_m(at),
        &now,
    )?;
    if change.failed.is_none() && !change.slid {
        return Some((at, change, 0.0));
    }
    let motions = ends.map(|end| &particles.motions[end]);
    let start = [0, 1].map(|end| earlier(&now[end], motions[end], drift_s));
    let forces = |elements: &[Element], ends| bonds.joint_forces(at, elements, ends);
    let (first, last) = (forces(before, &start), forces(&change.elements, &now));
    let given_j = -0.5 * drift_s * (power_w(&first, motions) + power_w(&last, motions));
    let spent_j = given_j + first.energy.total() - last.energy.total();
    Some((at, change, spent_j))
}
