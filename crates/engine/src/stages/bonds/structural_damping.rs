//! Structural damping of bonds: the coefficients of the dashpots that resist as it does.
//!
//! They hold for one step: [`super::damping`] lets velocities decay with them. They are those of
//! the motions at the time of the poses, in the middle of the decay, predicted with the damping of
//! the last step: so that the error is of second order in the step. Since a decay only takes
//! energy, whatever its coefficients, the largest stable step is that without damping.

use nalgebra::Vector3;
use rayon::prelude::*;

use super::damping::predict_as_damped_before;
use super::forces::any_bond;
use crate::stages::chunks::CHUNK;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::particles::{Motion, Particles};
use crate::state::rigid_parts::is_within_part;
use dem_physics::bond::damping::{DampingCoefficients, EndMotion};

/// Structural damping of bonds.
pub(crate) const STRUCTURAL_DAMPING: Stage = Stage {
    bytes: |state| size_of_val(&state.scratch.damping_now[..]),
    ..Stage::new("structural damping", |state, _| {
        Need::of(
            any_bond(state, |rule| rule.structural_damping > 0.0),
            || "bonds resist relative motion with a fraction of their load".to_owned(),
            "not asked for",
        )
    })
};

/// Sets the coefficients of damping of this step. Returns the number of bonds with structural
/// damping that may move.
pub(crate) fn compute_structural_damping(state: &mut State) -> usize {
    if state.scratch.damping_now.is_empty() {
        return 0;
    }
    predict_as_damped_before(state);
    let mut coefficients = std::mem::take(&mut state.scratch.damping_now);
    let (bonds, particles) = (&state.bonds, &state.particles);
    let motions = &state.scratch.predicted[0];
    let part_of = &state.rigid_parts.of_particle[..];
    let chunks = coefficients.par_chunks_mut(CHUNK).enumerate();
    let computed = chunks.map(|(chunk, coefficients)| {
        let numbered = (chunk * CHUNK..).zip(coefficients);
        let resist = |(at, now): (usize, &mut [f64; 4])| {
            let structural = of_bond(bonds, at, part_of, particles, motions);
            let is_computed = structural.is_some();
            *now = bonds.damping_with(at, structural.unwrap_or_default());
            usize::from(is_computed)
        };
        numbered.map(resist).sum::<usize>()
    });
    let computed = computed.sum();
    state.scratch.damping_now = coefficients;
    computed
}

/// Coefficients of structural damping of bond `at` with these motions. None: it has none, sleeps,
/// or is within a rigid part.
fn of_bond(
    bonds: &Bonds,
    at: usize,
    part_of: &[u32],
    particles: &Particles,
    motions: &[Motion],
) -> Option<DampingCoefficients> {
    let ends = bonds.ends[at].map(|end| end as usize);
    if particles.sleeps(ends[0]) || is_within_part(part_of, bonds.ends[at]) {
        return None;
    }
    let poses = &particles.poses;
    let structural = bonds.structural_damping(at, bonds.stiffness_now(at, poses), motions)?;
    let apart = poses[ends[1]].place() - poses[ends[0]].place();
    let moving = ends.map(|end| EndMotion {
        velocity_m_s: Vector3::from(motions[end].velocity_m_s),
        spin_rad_s: Vector3::from(motions[end].spin_rad_s),
    });
    let load = bonds.forces(at, poses).load;
    Some(structural.coefficients(&load, &apart, &moving))
}
