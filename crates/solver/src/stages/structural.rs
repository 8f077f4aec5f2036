//! Structural damping forces of bonds on the particles, from velocities predicted for the time of
//! the forces.
//!
//! The kick is split as for viscous damping ([`super::damping`]): half of it by all other forces,
//! then the resistance of the bonds over the step, then the other half. Friction that would turn a
//! motion round within the step only stops it: it is at most that of a dashpot C, with G = dt M^-1 C
//! below 2, so that the decay 1 - G stays within -1 and 1. So it only ever takes energy, the
//! largest stable step is that without damping, and a body under a steady load comes to rest. Which
//! dashpot, see [`most_resistance`]. Where a mode reverses the force jumps, so that displacements are of first
//! order in the step.

use nalgebra::Vector3;

use super::bonds::any_bond;
use super::damping::{Prediction, bytes_of_predicted, predict};
use super::stage::{NO_SAVING, Need, Stage};
use crate::physics::bond::damping::{DampingCoefficients, DampingForces, EndMotion};
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
    bytes: |state| {
        let own = size_of_val(&state.scratch.structural_resistance[..])
            + size_of_val(&state.scratch.bond_counts[..]);
        // Where bonds are damped by dashpots too, predicted motions are theirs.
        match state.bond_resistance.is_empty() && own > 0 {
            true => own + bytes_of_predicted(state),
            false => own,
        }
    },
    saving: NO_SAVING,
};

/// Sets the structural damping forces of bonds. Returns the number of bonds computed.
pub(crate) fn compute_structural_damping(state: &mut State) -> usize {
    if state.scratch.structural_resistance.is_empty() {
        return 0;
    }
    state.scratch.structural_resistance.fill(Wrench::default());
    predict(state, Prediction::Undamped);
    let kick_s = state.kick_s();
    let scratch = &mut state.scratch;
    let now = Now {
        bonds: &state.bonds,
        poses: &state.particles.poses,
        motions: &scratch.predicted[0],
        counts: &scratch.bond_counts,
        kick_s,
    };
    for_each_partition(
        &mut scratch.partitions,
        &mut scratch.structural_resistance,
        &|partition, resisting| of_partition(now, partition, resisting),
    );
    let partitions = state.scratch.partitions.iter();
    partitions
        .map(|partition| partition.computed.structural)
        .sum()
}

/// What the forces of all bonds are computed from.
#[derive(Clone, Copy)]
struct Now<'a> {
    bonds: &'a Bonds,
    poses: &'a [Pose],
    motions: &'a [Motion],
    /// The number of bonds of each free particle.
    counts: &'a [u32],
    kick_s: f64,
}

fn of_partition(now: Now<'_>, partition: &mut Partition, resisting: &mut [Wrench]) {
    let Partition {
        particles: own,
        batches,
        computed,
        ..
    } = partition;
    computed.structural = 0;
    for batch in batches.iter() {
        let gamma = now.bonds.rules[batch.rule].structural_damping;
        if gamma == 0.0 {
            continue;
        }
        computed.structural += batch.which.count();
        let mut add = |at: usize| {
            if now.bonds.is_broken(at) {
                return;
            }
            let DampingForces {
                force_on_b,
                torques,
            } = forces_of(now, at, gamma);
            let on_ends = [-force_on_b, force_on_b];
            let ends = &now.bonds.ends[at];
            for (end, (force, torque)) in ends.iter().zip(on_ends.iter().zip(&torques)) {
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

fn forces_of(now: Now<'_>, at: usize, gamma: f64) -> DampingForces {
    let ends = now.bonds.ends[at].map(|end| end as usize);
    let apart = now.poses[ends[1]].place() - now.poses[ends[0]].place();
    let length_m = apart.norm();
    let moving = ends.map(|end| EndMotion {
        velocity_m_s: Vector3::from(now.motions[end].velocity_m_s),
        spin_rad_s: Vector3::from(now.motions[end].spin_rad_s),
    });
    let load = now.bonds.forces(at, now.poses).load;
    let levers_m = now.bonds.levers_m(at);
    let longer = length_m / (levers_m[0] + levers_m[1]);
    let most = most_resistance(now, ends, levers_m.map(|lever| lever * longer));
    let c = apart / length_m;
    structural_forces(gamma, &load, &most, &levers_m, &c, length_m, &moving)
}

/// Largest G of the dashpots. The larger, the slower the motions that are resisted less than by
/// friction; those that G slows down most still lose half of their speed in a step.
const MOST: f64 = 1.5;

/// The strongest dashpots of a bond, with arms to its contact point, that leave G at most [`MOST`]
/// where every bond has them. Each of the n bonds of an end is given an n-th of its mass and
/// inertia, and dt times the power of its dashpots is at most what these hold: for a mode of the
/// relative speed u, the square of u is at most the sum of n/m times (m/n) v^2 of the ends, by Cauchy and Schwarz. Shear and bending share
/// the spin across the bond, half for each.
fn most_resistance(now: Now<'_>, ends: [usize; 2], arms_m: [f64; 2]) -> DampingCoefficients {
    let (mut along, mut across, mut turning) = (0.0, 0.0, 0.0);
    for (end, arm_m) in ends.into_iter().zip(arms_m) {
        let Motion {
            inverse_mass,
            inverse_inertia,
            ..
        } = now.motions[end];
        let count = f64::from(now.counts[end]);
        along += count * inverse_mass;
        across += count * (inverse_mass + arm_m * arm_m * inverse_inertia);
        turning += count * inverse_inertia;
    }
    let per = |share: f64, mobility: f64| MOST * share / (now.kick_s * mobility);
    DampingCoefficients {
        normal: per(1.0, along),
        shear: per(0.5, across),
        torsion: per(1.0, turning),
        bending: per(0.5, turning),
    }
}
