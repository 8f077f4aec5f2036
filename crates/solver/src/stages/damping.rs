//! Viscous forces of damped bonds on the particles.
//!
//! Velocities are known half a step before the forces (leapfrog). Damping takes those at the time of
//! the forces, predicted with all other forces of this step and the damping forces of the step
//! before:
//!
//!   v_n = v_(n-1/2) + dt/2 M^-1 (F_n - C v_(n-1)),   F_n without damping of bonds,
//!
//! with an error of second order in the step, in any network of bonds. For symmetric K and C the
//! scheme is stable if and only if dt^2 times the largest eigenvalue of M^-1 K is at most 4 and dt
//! times that of M^-1 C at most 1. To see this, insert x_n = z^n x with z = exp(i theta), s and c
//! the sine and cosine of theta/2, in the axes of an eigenvalue g of dt M^-1 C: dt^2 M^-1 K x = f x
//! with f = (4 s^2 - g (4 s^4 + 2 i s c (2 s^2 + 1)))/(1 - g s^2 - i g s c), whose imaginary part,
//! -2 g s c (1 - g s^2) over a square, has the same sign for all 0 < g <= 1. The forms x^T K x are
//! real: so no damped motion reaches |z| = 1 before z = -1, where det((1 - g) (4 - dt^2 M^-1 K)) is
//! 0. Dashpots of contacts, with the velocity of half a step ago, have the opposite sign: with them
//! the first condition is that of [`crate::check::limit`].

use rayon::prelude::*;

use super::bonds::{BONDS, any_bond};
use super::chunks::CHUNK;
use super::damped::damping_wrenches;
use super::motion::{Forces, kick_chunk};
use super::rigid_parts::predict_rigid_parts;
use super::stage::{Need, Saving, Stage};
use super::supports::predict_held;
use crate::state::State;
use crate::state::particles::{Motion, Wrench};

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
        size_of_val(&state.bonds.damping[..])
            + size_of_val(&state.particles.damping[..])
            + size_of_val(&state.scratch.predicted[..])
    },
    saving: |state| {
        let of_bonds = Saving::of(state.bonds.len(), size_of::<[f64; 4]>(), BOND_DAMPING_NS)?;
        Some(Saving {
            bytes: of_bonds.bytes
                + state.particles.free * (size_of::<Wrench>() + size_of::<Motion>()),
            ..of_bonds
        })
    },
};

/// Sets the damping forces of bonds. Returns the number of bonds computed.
pub(crate) fn compute_bond_damping(state: &mut State) -> usize {
    if state.particles.damping.is_empty() {
        return 0;
    }
    predict(state);
    let State {
        bonds,
        particles,
        scratch,
        ..
    } = state;
    damping_wrenches(
        bonds,
        &particles.poses,
        &scratch.predicted,
        &mut scratch.partitions,
        &mut particles.damping,
    );
    let partitions = scratch.partitions.iter();
    partitions.map(|partition| partition.computed.damped).sum()
}

/// Predicts the motions of the free particles at the time of their poses, from the forces of this
/// step and the damping forces that are there.
pub(super) fn predict(state: &mut State) {
    let half_s = 0.5 * state.previous_time_step_s;
    let mut predicted = std::mem::take(&mut state.scratch.predicted);
    let p = &state.particles;
    let forces = Forces::of(p, state.resistances(), state.model.gravity_m_s2, half_s);
    predicted.resize(p.free, Motion::default());
    (predicted.par_chunks_mut(CHUNK).enumerate()).for_each(|(chunk, predicted)| {
        let first = chunk * CHUNK;
        predicted.copy_from_slice(&p.motions[first..first + predicted.len()]);
        kick_chunk(first, predicted, &forces);
    });
    predict_held(state, &mut predicted);
    predict_rigid_parts(state, &mut predicted);
    state.scratch.predicted = predicted;
}
