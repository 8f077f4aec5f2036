//! Viscous forces of bonds, several bonds at once.

use crate::stages::bonds::blocks::{
    BondGroup, blocks_of, coming_second_ends, fetch_soon_of, for_each_partition, separations,
    vectors,
};
use crate::state::bonds::{BLOCK, BondBlock, Bonds};
use crate::state::particles::{Motion, Pose, Wrench};
use crate::state::partitions::{Batch, BondSelection, Partition};
use dem_physics::bond::damping::{DampingCoefficients, resistance};
use dem_physics::lanes::{LaneWork, Lanes, with_most_lanes};
use dem_physics::number::Vec3;

/// Sets `damping` (one for each particle) to the viscous forces of the bonds, with these
/// coefficients (one for each bond: see [`Bonds::damping`]), between ends with these motions.
pub(crate) fn damping_wrenches(
    bonds: &Bonds,
    coefficients: &[[f64; 4]],
    poses: &[Pose],
    motions: &[Motion],
    partitions: &mut [Partition],
    damping: &mut [Wrench],
) {
    for_each_partition(partitions, damping, &|partition, damping| {
        for awake in &partition.awake {
            damping[awake.clone()].fill(Wrench::default());
        }
        partition.computed.damped = 0;
        for Batch { rule, which } in &partition.batches {
            if bonds.rules[*rule].is_damped() {
                partition.computed.damped += which.count();
                with_most_lanes(BatchWork {
                    bonds,
                    coefficients,
                    poses,
                    motions,
                    partition,
                    which,
                    damping,
                });
            }
        }
    });
}

/// The work on the bonds of one batch of a partition.
struct BatchWork<'a> {
    bonds: &'a Bonds,
    coefficients: &'a [[f64; 4]],
    poses: &'a [Pose],
    motions: &'a [Motion],
    partition: &'a Partition,
    which: &'a BondSelection,
    /// Those on the particles of the partition.
    damping: &'a mut [Wrench],
}

impl LaneWork for BatchWork<'_> {
    #[inline(always)]
    fn with<T: Lanes>(mut self, proof: T::Proof) {
        match self.which {
            BondSelection::Run(range) => {
                for block in blocks_of(range) {
                    self.fetch_coming(block);
                    let eight = BondGroup::of_block(self.bonds, block, range);
                    self.add::<T>(proof, &eight, &self.bonds.blocks[block]);
                }
            }
            BondSelection::Own(list) | BondSelection::Border(list) => {
                for some in list.chunks(BLOCK) {
                    let eight = BondGroup::of_list(self.bonds, some);
                    let numbers = BondBlock::of(self.bonds, eight.numbers);
                    self.add::<T>(proof, &eight, &numbers);
                }
            }
        }
    }
}

impl BatchWork<'_> {
    /// Prefetches what the bonds that follow a block soon need.
    #[inline(always)]
    fn fetch_coming(&self, block: usize) {
        let start = self.partition.particles.start;
        for b in coming_second_ends(self.bonds, block) {
            fetch_soon_of(self.poses, b);
            fetch_soon_of(self.motions, b);
            fetch_soon_of(self.damping, b.wrapping_sub(start));
        }
    }

    /// Adds the forces of eight bonds.
    #[inline(always)]
    fn add<T: Lanes>(&mut self, proof: T::Proof, eight: &BondGroup, numbers: &BondBlock) {
        for first in (0..BLOCK).step_by(T::COUNT) {
            if !eight.any_wanted::<T>(first) {
                continue;
            }
            let apart: Vec3<T> = separations(proof, &eight.ends[first..], self.poses);
            let ends = &eight.ends[first..first + T::COUNT];
            let at = &eight.numbers[first..first + T::COUNT];
            let motion = |lane: usize, side: usize| &self.motions[ends[lane][side] as usize];
            // Spelled out: a closure around lanes may not be compiled for them.
            let moving = [
                [
                    vectors(proof, |lane| motion(lane, 0).velocity_row()),
                    vectors(proof, |lane| motion(lane, 0).spin_row()),
                ],
                [
                    vectors(proof, |lane| motion(lane, 1).velocity_row()),
                    vectors(proof, |lane| motion(lane, 1).spin_row()),
                ],
            ];
            let [normal, shear, torsion, bending] =
                T::columns(proof, |lane| self.coefficients[at[lane]]);
            let coefficients = DampingCoefficients {
                normal,
                shear,
                torsion,
                bending,
            };
            let levers_m = [
                T::load(proof, &numbers.levers_m[0], first),
                T::load(proof, &numbers.levers_m[1], first),
            ];
            let (force_on_b, torques) = resistance(&coefficients, levers_m, apart, moving);
            let start = self.partition.particles.start;
            eight.add(first, force_on_b, torques, self.damping, start);
        }
    }
}
