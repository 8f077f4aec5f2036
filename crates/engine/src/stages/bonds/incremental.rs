//! Forces of bonds of the incremental formulation.

use nalgebra::Vector3;

use super::forces::any_bond;
use crate::stages::bonds::one_by_one::add_single_wrenches;
use crate::stages::chunks::CHUNK;
use crate::stages::stage::{Need, Saving, Stage};
use crate::state::State;
use crate::state::bonds::{BondLaw, Bonds};
use crate::state::particles::Particles;
use crate::threads::for_each;
use dem_physics::bond::incremental::{Step, advance};

/// ns per bond of a body of 25,547 particles: see doc/inside/leave-out.md.
const HISTORY_NS: f64 = 37.6;

/// Histories of bonds of the incremental formulation, and their forces.
pub const HISTORIES: Stage = Stage {
    bytes: |state| size_of_val(&state.bonds.histories.sums[..]),
    saving: |state| {
        Saving::of(
            state.bonds.len(),
            size_of::<dem_physics::bond::incremental::History>(),
            HISTORY_NS,
        )
    },
    ..Stage::new("bond history", |state, _| {
        Need::of(
            any_bond(state, |rule| rule.law == BondLaw::Incremental),
            || "bonds of the incremental formulation".to_owned(),
            "every bond has the total formulation",
        )
    })
};

/// Updates the histories and adds their forces to the wrenches. Returns the number of bonds
/// computed.
pub(crate) fn compute_incremental_bonds(state: &mut State) -> usize {
    let (before_s, p) = (state.previous_time_step_s, &mut state.particles);
    if !state.bonds.histories.sums.is_empty() {
        if before_s > 0.0 {
            advance_histories(&mut state.bonds, p, before_s);
        }
        return add_single_wrenches(
            &state.bonds,
            &p.poses,
            &mut state.scratch.partitions,
            &mut p.wrenches,
            |rule| rule.law == BondLaw::Incremental,
        );
    }
    0
}

/// Updates the histories to the present positions, after a drift of `time_step_s` with these
/// motions.
pub(crate) fn advance_histories(bonds: &mut Bonds, particles: &Particles, time_step_s: f64) {
    let (poses, motions) = (&particles.poses, &particles.motions);
    let mut sums = std::mem::take(&mut bonds.histories.sums);
    let known = &*bonds;
    let chunks = sums.chunks_mut(CHUNK).enumerate();
    for_each(chunks, |(chunk, sums)| {
        for (at, history) in (chunk * CHUNK..).zip(sums) {
            let [a, b] = known.ends[at].map(|end| end as usize);
            let rests = known.is_broken(at) || particles.sleeps(a);
            if rests || known.rules[known.rule_of(at)].law != BondLaw::Incremental {
                continue;
            }
            let after = poses[b].place() - poses[a].place();
            let velocity = |end: usize| Vector3::from(motions[end].velocity_m_s);
            let step = Step {
                apart_before: after - time_step_s * (velocity(b) - velocity(a)),
                apart_after: after,
                turns: [a, b].map(|end| time_step_s * Vector3::from(motions[end].spin_rad_s)),
            };
            *history = advance(&known.stiffness(at), history, &step);
        }
    });
    bonds.histories.sums = sums;
}
