//! Forces of the bonds on the particles, total formulation.

use std::f64::consts::PI;
use std::ops::Range;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::physics::bond::BondLoad;
use crate::physics::bond::failure::Screen;
use crate::physics::bond::stiffness::Stiffness;
use crate::physics::bond::total::{End, bond_forces};
use crate::stages::blocks::{BLOCK, Column, Effects, Rows, fetch_soon, for_each_share, full_lanes};
use crate::state::bonds::{Bonds, bending_stiffness};
use crate::state::particles::{Pose, Wrench};
use crate::state::shares::{Batch, Share, Which};

/// Bonds between those that are computed and those whose particles are fetched into the cache.
const AHEAD: usize = 2 * BLOCK;
/// Square of the utilisation from which a bond is looked at by itself: less than 1, for rounding.
const NEARLY: f64 = 1.0 - 1e-9;

/// Sets the wrenches to the forces of the bonds. `shares` cover all particles; their `failing` lists the bonds of the total formulation that have reached their strength.
pub fn bond_wrenches(bonds: &Bonds, poses: &[Pose], shares: &mut [Share], wrenches: &mut [Wrench]) {
    for_each_share(shares, wrenches, &|share, wrenches| {
        pulp::Arch::new().dispatch(ShareWork {
            bonds,
            poses,
            share,
            wrenches,
        });
    });
}

/// The work on one share: a call that is compiled for AVX2 as well.
struct ShareWork<'a> {
    bonds: &'a Bonds,
    poses: &'a [Pose],
    share: &'a mut Share,
    /// Of the share's particles only.
    wrenches: &'a mut [Wrench],
}

impl pulp::NullaryFnOnce for ShareWork<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Share {
            particles,
            batches,
            failing,
        } = self.share;
        failing.clear();
        self.wrenches.fill(Wrench::default());
        let mut block = Block::new();
        for Batch { rule, which } in batches.iter() {
            let torsion = self.bonds.torsion_per_bending[*rule];
            let rule = &self.bonds.rules[*rule];
            if rule.incremental {
                continue;
            }
            let screen = rule.criteria.as_ref().map(Screen::new);
            match which {
                Which::Border(list) => {
                    for some in list.chunks(BLOCK) {
                        block.gather_some(self.bonds, some, self.poses);
                        block.compute(some.len(), torsion);
                        let ends = some.iter().map(|&at| self.bonds.ends[at as usize]);
                        block
                            .effects
                            .add_to_second(ends, self.wrenches, particles.start);
                    }
                }
                Which::Own(list) => {
                    for some in list.chunks(BLOCK) {
                        block.gather_some(self.bonds, some, self.poses);
                        block.compute(some.len(), torsion);
                        let ends = some.iter().map(|&at| self.bonds.ends[at as usize]);
                        block.effects.add_to_both(ends, self.wrenches, particles);
                        if let Some(screen) = &screen {
                            block.check(screen, self.bonds, some.iter().copied(), failing);
                        }
                    }
                }
                Which::Run(range) => {
                    let mut first = range.start;
                    while first < range.end {
                        let run = first..(first + BLOCK).min(range.end);
                        let ahead = self.bonds.ends.get(first + AHEAD..first + AHEAD + BLOCK);
                        fetch_second_ends(
                            ahead.unwrap_or_default(),
                            self.poses,
                            self.wrenches,
                            particles,
                        );
                        block.gather_run(self.bonds, run.clone(), self.poses);
                        block.compute(run.len(), torsion);
                        let ends = self.bonds.ends[run.clone()].iter().copied();
                        block.effects.add_to_both(ends, self.wrenches, particles);
                        if let Some(screen) = &screen {
                            let numbers = run.start as u32..run.end as u32;
                            block.check(screen, self.bonds, numbers, failing);
                        }
                        first += BLOCK;
                    }
                }
            }
        }
    }
}

/// Asks for the particles at the second ends of bonds that will be computed soon: in a large body they come from far away in memory, while first
/// ends follow one another.
#[inline(always)]
fn fetch_second_ends(
    ends: &[[u32; 2]],
    poses: &[Pose],
    wrenches: &[Wrench],
    particles: &Range<usize>,
) {
    for &[_, b] in ends {
        fetch_soon(&poses[b as usize]);
        if particles.contains(&(b as usize)) {
            fetch_soon(&wrenches[b as usize - particles.start]);
        }
    }
}

/// What a block of bonds needs, and what comes of it.
struct Block {
    apart: Rows,
    turned: [Rows; 2],
    direction: [Column; 3],
    levers: [Column; 2],
    normal: Column,
    shear: Column,
    radius: Column,
    effects: Effects,
    /// Normal, shear, torsion, bending.
    load: [Column; 4],
}

impl Block {
    fn new() -> Self {
        let column = [0.0; BLOCK];
        let rows = [[0.0; 4]; BLOCK];
        Self {
            apart: rows,
            turned: [rows; 2],
            direction: [column; 3],
            levers: [column; 2],
            normal: column,
            shear: column,
            radius: [1.0; BLOCK],
            effects: Effects::new(),
            load: [column; 4],
        }
    }

    /// The columns that are copied, and where from.
    #[inline(always)]
    fn columns<'a>(&'a mut self, bonds: &'a Bonds) -> [(&'a mut Column, &'a [f64]); 8] {
        let [x, y, z] = &mut self.direction;
        let [lever_a, lever_b] = &mut self.levers;
        [
            (x, &bonds.direction[0]),
            (y, &bonds.direction[1]),
            (z, &bonds.direction[2]),
            (lever_a, &bonds.levers_m[0]),
            (lever_b, &bonds.levers_m[1]),
            (&mut self.normal, &bonds.normal),
            (&mut self.shear, &bonds.shear),
            (&mut self.radius, &bonds.radii_m),
        ]
    }

    #[inline(always)]
    fn gather_run(&mut self, bonds: &Bonds, run: Range<usize>, poses: &[Pose]) {
        for (to, from) in self.columns(bonds) {
            to[..run.len()].copy_from_slice(&from[run.clone()]);
        }
        self.gather_ends(bonds.ends[run].iter().copied(), poses);
    }

    #[inline(always)]
    fn gather_some(&mut self, bonds: &Bonds, some: &[u32], poses: &[Pose]) {
        for (to, from) in self.columns(bonds) {
            for (to, &at) in to.iter_mut().zip(some) {
                *to = from[at as usize];
            }
        }
        self.gather_ends(some.iter().map(|&at| bonds.ends[at as usize]), poses);
    }

    #[inline(always)]
    fn gather_ends(&mut self, ends: impl Iterator<Item = [u32; 2]>, poses: &[Pose]) {
        for (i, [a, b]) in (0..BLOCK).zip(ends) {
            let (a, b) = (&poses[a as usize], &poses[b as usize]);
            self.apart[i] = [0, 1, 2, 3].map(|k| b.position_m[k] - a.position_m[k]);
            self.turned[0][i] = a.turned;
            self.turned[1][i] = b.turned;
        }
    }

    /// Forces, torques and loads of the first `count` bonds.
    #[inline(always)]
    fn compute(&mut self, count: usize, torsion_per_bending: f64) {
        for i in full_lanes(count) {
            let turned = |q: &[f64; 4]| {
                UnitQuaternion::new_unchecked(Quaternion::new(q[3], q[0], q[1], q[2]))
            };
            let apart = self.apart[i];
            let ends = [
                End {
                    position_m: Vector3::zeros(),
                    turned: turned(&self.turned[0][i]),
                },
                End {
                    position_m: Vector3::new(apart[0], apart[1], apart[2]),
                    turned: turned(&self.turned[1][i]),
                },
            ];
            let bending = bending_stiffness(self.normal[i], self.radius[i]);
            let stiffness = Stiffness {
                normal: self.normal[i],
                shear: self.shear[i],
                torsion: bending * torsion_per_bending,
                bending,
                levers_m: [self.levers[0][i], self.levers[1][i]],
            };
            let [x, y, z] = &self.direction;
            let direction = Vector3::new(x[i], y[i], z[i]);
            let forces = bond_forces(&stiffness, &direction, &ends);
            self.effects.set(i, &forces.force_on_b, &forces.torques);
            self.load[0][i] = forces.load.normal_n;
            self.load[1][i] = forces.load.shear_n;
            self.load[2][i] = forces.load.torsion_n_m;
            self.load[3][i] = forces.load.bending_n_m;
        }
    }

    /// Lists the bonds that have reached their strength, before any strengthening by rate; and perhaps some that nearly have.
    #[inline(always)]
    fn check(
        &self,
        screen: &Screen,
        bonds: &Bonds,
        numbers: impl Iterator<Item = u32>,
        failing: &mut Vec<u32>,
    ) {
        let mut beyond: Column = [0.0; BLOCK];
        for (i, beyond) in beyond.iter_mut().enumerate() {
            let load = BondLoad {
                normal_n: self.load[0][i],
                shear_n: self.load[1][i],
                torsion_n_m: self.load[2][i],
                bending_n_m: self.load[3][i],
            };
            let [used, factor] = screen.used_and_factor(&load, self.radius[i]);
            *beyond = used - NEARLY * factor;
        }
        if bonds.strength_factors.is_empty() {
            for (beyond, at) in beyond.iter().zip(numbers) {
                if *beyond >= 0.0 {
                    failing.push(at);
                }
            }
        } else {
            for (i, at) in (0..BLOCK).zip(numbers) {
                let volume = PI * self.radius[i].powi(3);
                let strengthened = bonds.strength_factors[at as usize].powi(2) - 1.0;
                if beyond[i] >= NEARLY * volume * volume * strengthened {
                    failing.push(at);
                }
            }
        }
    }
}
