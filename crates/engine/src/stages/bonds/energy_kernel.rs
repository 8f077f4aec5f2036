//! Elastic energy of bonds, at the speed of the loop of bond forces.

use std::ops::Range;

use super::forces::Kind;
use crate::stages::bonds::blocks::{BondGroup, blocks_of, coming_second_ends, fetch_soon_of};
use crate::stages::chunks::{add, sums_of_chunks};
use crate::state::State;
use crate::state::bonds::{BLOCK, Bonds};
use crate::state::particles::Pose;
use dem_physics::bond::total::BondEnergy;
use dem_physics::lanes::{LaneWork, Lanes, with_most_lanes};

/// Elastic energy of all bonds by mode.
pub fn elastic_energy(state: &State) -> BondEnergy {
    elastic_energy_of(state, 0..state.bonds.len())
}

/// Elastic energy of some consecutive bonds by mode.
pub(crate) fn elastic_energy_of(state: &State, some: Range<usize>) -> BondEnergy {
    let (bonds, poses) = (&state.bonds, &state.particles.poses[..]);
    let first = some.start;
    let [normal, shear, torsion, bending] = sums_of_chunks(some.len(), |range| {
        let mut sums = [0.0; 4];
        for (rule, run) in bonds.runs(first + range.start..first + range.end) {
            if bonds.rules[rule].law.is_single() {
                sums = run.fold(sums, |sums, at| add(sums, energy(bonds, poses, at)));
            } else {
                with_most_lanes(Energies {
                    bonds,
                    poses,
                    kind: &Kind::of(bonds, rule),
                    range: run,
                    sums: &mut sums,
                });
            }
        }
        sums
    });
    BondEnergy {
        normal,
        shear,
        torsion,
        bending,
    }
}

/// Energy of a bond by mode, J.
fn energy(bonds: &Bonds, poses: &[Pose], at: usize) -> [f64; 4] {
    if bonds.is_broken(at) {
        return [0.0; 4];
    }
    let energy = bonds.forces(at, poses).energy;
    [energy.normal, energy.shear, energy.torsion, energy.bending]
}

/// Sums over a range of bonds that share a rule without history, in their order.
struct Energies<'a> {
    bonds: &'a Bonds,
    poses: &'a [Pose],
    kind: &'a Kind,
    range: Range<usize>,
    sums: &'a mut [f64; 4],
}

impl LaneWork for Energies<'_> {
    #[inline(always)]
    fn with<T: Lanes>(self, proof: T::Proof) {
        let (bonds, poses) = (self.bonds, self.poses);
        for block in blocks_of(&self.range) {
            for b in coming_second_ends(bonds, block) {
                fetch_soon_of(poses, b);
            }
            let eight = BondGroup::of_block(bonds, block, &self.range);
            let numbers = &bonds.blocks[block];
            for first in (0..BLOCK).step_by(T::COUNT) {
                if !eight.any_wanted::<T>(first) {
                    continue;
                }
                let response = self
                    .kind
                    .response::<T>(proof, &eight, numbers, first, poses);
                let modes = response.energy;
                let modes = [modes.normal, modes.shear, modes.torsion, modes.bending];
                let rows = T::rows(modes);
                for (i, row) in (first..).zip(&rows[..T::COUNT]) {
                    let at = block * BLOCK + i;
                    if !eight.wanted.contains(&i) || bonds.is_broken(at) {
                        continue;
                    }
                    // One that is pressed is as stiff as before the damage.
                    let terms = if bonds.was_damaged(at) {
                        energy(bonds, poses, at)
                    } else {
                        *row
                    };
                    *self.sums = add(*self.sums, terms);
                }
            }
        }
    }
}
