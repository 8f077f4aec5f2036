//! Viscous forces of damped bonds on the particles, from the velocities half a step ago.

use nalgebra::Vector3;

use crate::physics::bond::damping::{DampingCoefficients, EndMotion, damping_forces};
use crate::stages::blocks::{BLOCK, Column, Effects, Rows, for_each_share, full_lanes};
use crate::state::bonds::Bonds;
use crate::state::particles::{Motion, Pose, Wrench};
use crate::state::shares::{Batch, Share, Which};

/// Sets `resisting` (one for each particle) to the damping forces of the bonds.
pub fn damping_wrenches(
    bonds: &Bonds,
    poses: &[Pose],
    motions: &[Motion],
    shares: &mut [Share],
    resisting: &mut [Wrench],
) {
    for_each_share(shares, resisting, &|share, resisting| {
        pulp::Arch::new().dispatch(ShareWork {
            bonds,
            poses,
            motions,
            share,
            resisting,
        });
    });
}

/// The work on one share: a call that is compiled for AVX2 as well.
struct ShareWork<'a> {
    bonds: &'a Bonds,
    poses: &'a [Pose],
    motions: &'a [Motion],
    share: &'a Share,
    /// Of the share's particles only.
    resisting: &'a mut [Wrench],
}

impl pulp::NullaryFnOnce for ShareWork<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            bonds,
            poses,
            motions,
            share,
            resisting,
        } = self;
        resisting.fill(Wrench::default());
        let own = &share.particles;
        let mut block = Block::new();
        for Batch { rule, which } in &share.batches {
            if !bonds.rules[*rule].damped {
                continue;
            }
            match which {
                Which::Border(list) => {
                    for some in list.chunks(BLOCK) {
                        let numbers = some.iter().map(|&at| at as usize);
                        block.gather(bonds, numbers.clone(), poses, motions);
                        block.compute(some.len());
                        let ends = numbers.map(|at| bonds.ends[at]);
                        block.effects.add_to_second(ends, resisting, own.start);
                    }
                }
                Which::Own(list) => {
                    for some in list.chunks(BLOCK) {
                        let numbers = some.iter().map(|&at| at as usize);
                        block.gather(bonds, numbers.clone(), poses, motions);
                        block.compute(some.len());
                        let ends = numbers.map(|at| bonds.ends[at]);
                        block.effects.add_to_both(ends, resisting, own);
                    }
                }
                Which::Run(range) => {
                    let mut first = range.start;
                    while first < range.end {
                        let run = first..(first + BLOCK).min(range.end);
                        block.gather(bonds, run.clone(), poses, motions);
                        block.compute(run.len());
                        let ends = bonds.ends[run].iter().copied();
                        block.effects.add_to_both(ends, resisting, own);
                        first += BLOCK;
                    }
                }
            }
        }
    }
}

/// What a block of bonds needs, and what comes of it.
struct Block {
    apart: Rows,
    velocities: [Rows; 2],
    spins: [Rows; 2],
    levers: [Column; 2],
    coefficients: Rows,
    effects: Effects,
}

impl Block {
    fn new() -> Self {
        let rows = [[1.0; 4]; BLOCK];
        Self {
            apart: rows,
            velocities: [rows; 2],
            spins: [rows; 2],
            levers: [[1.0; BLOCK]; 2],
            coefficients: rows,
            effects: Effects::new(),
        }
    }

    #[inline(always)]
    fn gather(
        &mut self,
        bonds: &Bonds,
        numbers: impl Iterator<Item = usize>,
        poses: &[Pose],
        motions: &[Motion],
    ) {
        let row = |[x, y, z]: [f64; 3]| [x, y, z, 0.0];
        for (i, at) in (0..BLOCK).zip(numbers) {
            let [a, b] = bonds.ends[at].map(|end| end as usize);
            let places = [poses[a].position_m, poses[b].position_m];
            self.apart[i] = [0, 1, 2, 3].map(|k| places[1][k] - places[0][k]);
            for (side, end) in [a, b].into_iter().enumerate() {
                self.velocities[side][i] = row(motions[end].velocity_m_s);
                self.spins[side][i] = row(motions[end].spin_rad_s);
                self.levers[side][i] = bonds.levers_m[side][at];
            }
            self.coefficients[i] = bonds.damping[at];
        }
    }

    /// Damping forces of the first `count` bonds.
    #[inline(always)]
    fn compute(&mut self, count: usize) {
        for i in full_lanes(count) {
            let vector = |rows: &Rows| Vector3::new(rows[i][0], rows[i][1], rows[i][2]);
            let [normal, shear, torsion, bending] = self.coefficients[i];
            let coefficients = DampingCoefficients {
                normal,
                shear,
                torsion,
                bending,
            };
            let apart = vector(&self.apart);
            let length = apart.norm();
            let ends = [0, 1].map(|side| EndMotion {
                velocity_m_s: vector(&self.velocities[side]),
                spin_rad_s: vector(&self.spins[side]),
            });
            let levers = [self.levers[0][i], self.levers[1][i]];
            let c = apart * (1.0 / length);
            let forces = damping_forces(&coefficients, &levers, &c, length, &ends);
            self.effects.set(i, &forces.force_on_b, &forces.torques);
        }
    }
}
