//! Viscous forces of damped bonds on the particles, from the velocities half a step ago.

use super::bonds::any_bond;
use super::stage::{Need, Saving, Stage};
use crate::physics::bond::damping::{DampingCoefficients, resistance};
use crate::physics::number::Vec3;
use crate::stages::blocks::{
    BondGroup, blocks_of, fetch_second_ends, for_each_partition, separations, vectors,
};
use crate::stages::lanes::{LaneWork, Lanes, with_lanes};
use crate::state::State;
use crate::state::bonds::{BLOCK, Bonds};
use crate::state::particles::{Motion, Pose, Wrench};
use crate::state::partitions::{Batch, BondSelection, Partition};

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
        size_of_val(&state.bonds.damping[..]) + size_of_val(&state.scratch.bond_resistance[..])
    },
    saving: |state| {
        let of_bonds = Saving::of(state.bonds.len(), size_of::<[f64; 4]>(), BOND_DAMPING_NS)?;
        Some(Saving {
            bytes: of_bonds.bytes + state.particles.free * size_of::<Wrench>(),
            ..of_bonds
        })
    },
};

/// Sets the damping forces of bonds. Returns the number of bonds computed.
pub(crate) fn compute_bond_damping(state: &mut State) -> usize {
    if !state.scratch.bond_resistance.is_empty() {
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

/// Sets `resisting` (one for each particle) to the damping forces of the bonds.
pub(crate) fn damping_wrenches(
    bonds: &Bonds,
    poses: &[Pose],
    motions: &[Motion],
    partitions: &mut [Partition],
    resisting: &mut [Wrench],
) {
    for_each_partition(partitions, resisting, &|partition, resisting| {
        with_lanes(PartitionWork {
            bonds,
            poses,
            motions,
            partition,
            resisting,
        });
    });
}

/// The work on one partition.
struct PartitionWork<'a> {
    bonds: &'a Bonds,
    poses: &'a [Pose],
    motions: &'a [Motion],
    partition: &'a mut Partition,
    /// Those of the partition's particles.
    resisting: &'a mut [Wrench],
}

impl LaneWork for PartitionWork<'_> {
    #[inline(always)]
    fn with<T: Lanes>(self, proof: T::Proof) {
        let Self {
            bonds,
            poses,
            motions,
            partition,
            resisting,
        } = self;
        for awake in &partition.awake {
            resisting[awake.clone()].fill(Wrench::default());
        }
        let particles = &partition.particles;
        partition.computed.damped = 0;
        for Batch { rule, which } in &partition.batches {
            if !bonds.rules[*rule].damped {
                continue;
            }
            partition.computed.damped += which.count();
            match which {
                BondSelection::Run(range) => {
                    for block in blocks_of(range) {
                        fetch_second_ends(bonds, block, poses, resisting, particles);
                        let four = BondGroup::of_block(bonds, block, range);
                        for first in (0..BLOCK).step_by(T::COUNT) {
                            let (force_on_b, torques) =
                                forces::<T>(proof, bonds, &four, first, poses, motions);
                            four.add(first, force_on_b, torques, resisting, particles);
                        }
                    }
                }
                BondSelection::Own(list) | BondSelection::Border(list) => {
                    for some in list.chunks(BLOCK) {
                        let four = BondGroup::of_list(bonds, some);
                        for first in (0..BLOCK).step_by(T::COUNT) {
                            let (force_on_b, torques) =
                                forces::<T>(proof, bonds, &four, first, poses, motions);
                            four.add(first, force_on_b, torques, resisting, particles);
                        }
                    }
                }
            }
        }
    }
}

/// Damping forces of the bonds from `first` on, one for each lane: on the second ends, N, and
/// torques on both, N m.
#[inline(always)]
fn forces<T: Lanes>(
    proof: T::Proof,
    bonds: &Bonds,
    four: &BondGroup,
    first: usize,
    poses: &[Pose],
    motions: &[Motion],
) -> (Vec3<T>, [Vec3<T>; 2]) {
    let row = |[x, y, z]: [f64; 3]| [x, y, z, 0.0];
    let ends = &four.ends[first..first + T::COUNT];
    let numbers = &four.numbers[first..first + T::COUNT];
    let motion = |lane: usize, side: usize| &motions[ends[lane][side] as usize];
    let moving = [
        [
            vectors(proof, |lane| row(motion(lane, 0).velocity_m_s)),
            vectors(proof, |lane| row(motion(lane, 0).spin_rad_s)),
        ],
        [
            vectors(proof, |lane| row(motion(lane, 1).velocity_m_s)),
            vectors(proof, |lane| row(motion(lane, 1).spin_rad_s)),
        ],
    ];
    let [normal, shear, torsion, bending] = T::columns(proof, |lane| bonds.damping[numbers[lane]]);
    let coefficients = DampingCoefficients {
        normal,
        shear,
        torsion,
        bending,
    };
    let [lever_a, lever_b, _, _] = T::columns(proof, |lane| {
        let [a, b] = bonds.levers_m(numbers[lane]);
        [a, b, 0.0, 0.0]
    });
    let apart = separations::<T>(proof, ends, poses);
    let length = apart.square().sqrt();
    let c = apart * length.inverse();
    resistance(&coefficients, [lever_a, lever_b], c, length, moving)
}
