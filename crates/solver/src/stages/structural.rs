//! Structural damping forces of bonds on the particles, from the velocities half a step ago.
//!
//! The force jumps where a mode reverses, so that displacements are of first order in the step
//! whichever velocities decide on its sign. With those of half a step ago the limit of the step is
//! exact: in the fastest mode at its limit, x, -x, x, they oppose the force, while those at the
//! time of the forces nearly vanish, and slower modes decide.

use nalgebra::Vector3;

use super::bonds::any_bond;
use super::stage::{NO_SAVING, Need, Stage};
use crate::physics::bond::damping::{DampingForces, EndMotion};
use crate::physics::bond::damping_models::structural_forces;
use crate::stages::blocks::for_each_partition;
use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::particles::{Motion, Pose, Wrench};
use crate::state::partitions::{BondSelection, Partition};

/// Structural damping of bonds.
pub(crate) const STRUCTURAL_DAMPING: Stage = Stage {
    name: "structural damping",
    within: None,
    need: |state, _| {
        Need::of(
            any_bond(state, |rule| rule.structural_damping > 0.0),
            || "bonds resist relative motion with a fraction of their load".to_owned(),
            "not asked for",
        )
    },
    bytes: |state| size_of_val(&state.scratch.structural_resistance[..]),
    saving: NO_SAVING,
};

/// Sets the structural damping forces of bonds. Returns the number of bonds computed.
pub(crate) fn compute_structural_damping(state: &mut State) -> usize {
    if state.scratch.structural_resistance.is_empty() {
        return 0;
    }
    let (bonds, p) = (&state.bonds, &state.particles);
    for_each_partition(
        &mut state.scratch.partitions,
        &mut state.scratch.structural_resistance,
        &|partition, resisting| {
            of_partition(bonds, &p.poses, &p.motions, partition, resisting);
        },
    );
    let partitions = state.scratch.partitions.iter();
    partitions
        .map(|partition| partition.computed.structural)
        .sum()
}

fn of_partition(
    bonds: &Bonds,
    poses: &[Pose],
    motions: &[Motion],
    partition: &mut Partition,
    resisting: &mut [Wrench],
) {
    let Partition {
        particles: own,
        batches,
        awake,
        computed,
        ..
    } = partition;
    computed.structural = 0;
    for awake in awake.iter() {
        resisting[awake.clone()].fill(Wrench::default());
    }
    for batch in batches.iter() {
        let gamma = bonds.rules[batch.rule].structural_damping;
        if gamma == 0.0 {
            continue;
        }
        computed.structural += batch.which.count();
        let mut add = |at: usize| {
            if bonds.is_broken(at) {
                return;
            }
            let DampingForces {
                force_on_b,
                torques,
            } = forces_of(bonds, at, gamma, poses, motions);
            let on_ends = [-force_on_b, force_on_b];
            for (end, (force, torque)) in bonds.ends[at].iter().zip(on_ends.iter().zip(&torques)) {
                let end = *end as usize;
                if own.contains(&end) {
                    resisting[end - own.start].add(force, torque);
                }
            }
        };
        match &batch.which {
            BondSelection::Own(list) | BondSelection::Border(list) => {
                list.iter().for_each(|&at| add(at as usize));
            }
            BondSelection::Run(range) => range.clone().for_each(&mut add),
        }
    }
}

fn forces_of(
    bonds: &Bonds,
    at: usize,
    gamma: f64,
    poses: &[Pose],
    motions: &[Motion],
) -> DampingForces {
    let ends = bonds.ends[at].map(|end| end as usize);
    let apart = poses[ends[1]].place() - poses[ends[0]].place();
    let length_m = apart.norm();
    let moving = ends.map(|end| EndMotion {
        velocity_m_s: Vector3::from(motions[end].velocity_m_s),
        spin_rad_s: Vector3::from(motions[end].spin_rad_s),
    });
    let load = bonds.forces(at, poses).load;
    let c = apart / length_m;
    structural_forces(gamma, &load, &bonds.levers_m(at), &c, length_m, &moving)
}
