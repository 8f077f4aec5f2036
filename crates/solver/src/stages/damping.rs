//! Viscous forces of damped bonds on the particles.
//!
//! Velocities are known half a step before the forces (leapfrog). The kick is therefore split (Strang
//! 1968): half of it by all other forces F, then the decay of velocities by damping alone over the
//! step, then the other half by F. With the step dt, and G = dt M^-1 C at the present positions,
//!
//!   w = v_(n-1/2) + dt/2 M^-1 F_n,   v_(n+1/2) = R(G) w + dt/2 M^-1 F_n,
//!
//! where R approximates exp(-G) to second order by the stages of Runge, Kutta and Chebyshev
//! ([`Chebyshev`]), as many as keep R between 0 and 1. The error is of second order in the step in
//! any network of bonds, damping only ever takes energy, and each stage keeps momenta.
//!
//! With symmetric K and C the scheme is stable up to the same step as without damping of bonds:
//! with B = (1 + R)/2 and A = dt^2 M^-1 K, z^n u is a solution if (z - 1)^2 B^-1 u + z A u +
//! 2 (z - 1) (B^-1 - 1) u = 0. With the quadratic forms a of A and b of B^-1 in u, of norm 1,
//! b z^2 + (a - 2) z + 2 - b = 0: |z| is at most 1 if b is at least 1 and a at most 4, and z = -1
//! where A has the eigenvalue 4. Dashpots of contacts, which F contains with the velocity of half a
//! step ago, change the last condition alone: see [`crate::check::limit`].

use rayon::prelude::*;

use super::bonds::any_bond;
use super::chunks::CHUNK;
use super::damped::damping_wrenches;
use super::motion::{Forces, kick_chunk};
use super::rigid_parts::predict_rigid_parts;
use super::stage::{Need, Saving, Stage};
use super::supports::predict_held;
use crate::physics::chebyshev::Chebyshev;
use crate::state::State;
use crate::state::particles::{Motion, Wrench};
use crate::state::scratch::Scratch;

/// ns per bond of a body of 25,547 particles: see doc/leave-out.md.
const BOND_DAMPING_NS: f64 = 19.3;

/// Damping of bonds.
pub const BOND_DAMPING: Stage = Stage {
    name: "bond damping",
    within: None,
    need: |state, _| {
        Need::of(
            any_bond(state, |rule| rule.damped),
            || "bonds are damped".to_owned(),
            "no bond is damped: no relative velocities",
        )
    },
    bytes: |state| {
        let Scratch {
            bond_resistance,
            damping_stages,
            predicted,
            ..
        } = &state.scratch;
        let stages = damping_stages.iter().map(|stage| size_of_val(&stage[..]));
        size_of_val(&state.bonds.damping[..])
            + size_of_val(&bond_resistance[..])
            + stages.sum::<usize>()
            + predicted
                .iter()
                .map(|motions| size_of_val(&motions[..]))
                .sum::<usize>()
    },
    saving: |state| {
        let of_bonds = Saving::of(state.bonds.len(), size_of::<[f64; 4]>(), BOND_DAMPING_NS)?;
        let of_particle = 4 * size_of::<Wrench>() + 2 * size_of::<Motion>();
        Some(Saving {
            bytes: of_bonds.bytes + state.particles.free * of_particle,
            ..of_bonds
        })
    },
};

/// Sets the damping forces of bonds: those that, over the kick, have the impulse of its damping.
/// Returns the number of bonds computed, in one stage.
pub(crate) fn compute_bond_damping(state: &mut State) -> usize {
    if state.scratch.bond_resistance.is_empty() {
        return 0;
    }
    let kick_s = state.kick_s();
    let stages = Chebyshev::covering(kick_s * state.damping_rate_1_s);
    predict(state);
    let mut now = std::mem::take(&mut state.scratch.bond_resistance);
    let mut work = std::mem::take(&mut state.scratch.damping_stages);
    let [before, first, force] = &mut work;
    damp(state, 0, first);
    before.fill(Wrench::default());
    now.fill(Wrench::default());
    add_multiples(&mut now, 0.0, [(stages.first * kick_s, first)]);
    for stage in &stages.others {
        add_impulses(state, &now);
        damp(state, 1, force);
        let others: [(f64, &[Wrench]); 3] = [
            (stage.last, &now),
            (stage.force * kick_s, force),
            (stage.first_force * kick_s, first),
        ];
        add_multiples(before, stage.before, others);
        std::mem::swap(before, &mut now);
    }
    add_multiples(&mut now, 1.0 / kick_s, []);
    state.scratch.bond_resistance = now;
    state.scratch.damping_stages = work;
    let partitions = state.scratch.partitions.iter();
    partitions.map(|partition| partition.computed.damped).sum()
}

/// Predicts the motions of the free particles at the time of their poses, without damping of bonds.
fn predict(state: &mut State) {
    let half_s = 0.5 * state.previous_time_step_s;
    let mut predicted = std::mem::take(&mut state.scratch.predicted[0]);
    let p = &state.particles;
    let [_, structural, on_particles] = state.resistances();
    let resisting = [&[], structural, on_particles];
    let forces = Forces::of(p, resisting, state.model.gravity_m_s2, half_s);
    predict_from(&p.motions[..p.free], &forces, &mut predicted);
    predict_held(state, &mut predicted);
    predict_rigid_parts(state, &[], &mut predicted);
    state.scratch.predicted[0] = predicted;
}

/// Sets the motions of a stage: those predicted, with these impulses of damping.
fn add_impulses(state: &mut State, impulses: &[Wrench]) {
    let mut predicted = std::mem::take(&mut state.scratch.predicted[1]);
    let forces = Forces::impulses(impulses, &state.particles.asleep);
    predict_from(&state.scratch.predicted[0], &forces, &mut predicted);
    predict_held(state, &mut predicted);
    predict_rigid_parts(state, impulses, &mut predicted);
    state.scratch.predicted[1] = predicted;
}

/// Sets motions to others, changed by forces.
fn predict_from(motions: &[Motion], forces: &Forces<'_>, predicted: &mut Vec<Motion>) {
    predicted.resize(motions.len(), Motion::default());
    let chunks = motions
        .par_chunks(CHUNK)
        .zip(predicted.par_chunks_mut(CHUNK));
    chunks
        .enumerate()
        .for_each(|(chunk, (motions, predicted))| {
            predicted.copy_from_slice(motions);
            kick_chunk(chunk * CHUNK, predicted, forces);
        });
}

/// Sets `forces` to the damping of bonds between ends with the motions of this stage.
fn damp(state: &mut State, stage: usize, forces: &mut [Wrench]) {
    let scratch = &mut state.scratch;
    damping_wrenches(
        &state.bonds,
        &state.particles.poses,
        &scratch.predicted[stage],
        &mut scratch.partitions,
        forces,
    );
}

/// Multiplies wrenches by a factor and adds multiples of others.
fn add_multiples<const N: usize>(
    wrenches: &mut [Wrench],
    factor: f64,
    others: [(f64, &[Wrench]); N],
) {
    wrenches
        .par_chunks_mut(CHUNK)
        .enumerate()
        .for_each(|(chunk, wrenches)| {
            for wrench in wrenches.iter_mut() {
                wrench.force_n = wrench.force_n.map(|force| factor * force);
                wrench.torque_n_m = wrench.torque_n_m.map(|torque| factor * torque);
            }
            for (factor, list) in others {
                for (wrench, other) in wrenches.iter_mut().zip(&list[chunk * CHUNK..]) {
                    for k in 0..4 {
                        wrench.force_n[k] += factor * other.force_n[k];
                        wrench.torque_n_m[k] += factor * other.torque_n_m[k];
                    }
                }
            }
        });
}
