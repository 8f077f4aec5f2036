//! Damping forces of several bonds at once.

use crate::physics::bond::damping::{DampingCoefficients, resistance};
use crate::physics::number::Vec3;
use crate::stages::blocks::{BondGroup, vectors};
use crate::stages::lanes::Lanes;
use crate::state::bonds::{BondBlock, Bonds};
use crate::state::particles::Motion;

/// Damping forces of the bonds from `first` on, one for each lane, with these vectors from the first
/// to the second ends, m: on the second ends, N, and torques on both, N m.
#[inline(always)]
pub(super) fn damping_forces<T: Lanes>(
    proof: T::Proof,
    bonds: &Bonds,
    four: &BondGroup,
    block: &BondBlock,
    first: usize,
    apart: Vec3<T>,
    motions: &[Motion],
) -> (Vec3<T>, [Vec3<T>; 2]) {
    let ends = &four.ends[first..first + T::COUNT];
    let numbers = &four.numbers[first..first + T::COUNT];
    let motion = |lane: usize, side: usize| &motions[ends[lane][side] as usize];
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
    let [normal, shear, torsion, bending] = T::columns(proof, |lane| bonds.damping[numbers[lane]]);
    let coefficients = DampingCoefficients {
        normal,
        shear,
        torsion,
        bending,
    };
    let levers_m = [0, 1].map(|end: usize| T::load(proof, &block.levers_m[end], first));
    let length = apart.square().sqrt();
    let c = apart * length.inverse();
    resistance(&coefficients, levers_m, c, length, moving)
}
