//! Bonds: one entry per bond in every array.

use std::ops::Range;

use nalgebra::Vector3;

use crate::physics::bond::failure::Criteria;
use crate::physics::bond::incremental::History;
use crate::physics::bond::stiffness::Stiffness;
use crate::physics::bond::total::{BondForces, End};
use crate::physics::bond::{incremental, total};

use super::particles::Pose;

/// What the bonds of a kind have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondRule {
    /// Forces are summed step by step instead of following from the present place.
    pub incremental: bool,
    /// Bonds have damping coefficients.
    pub damped: bool,
    /// Strengths. None: never breaks.
    pub criteria: Option<Criteria>,
    /// Strain rate from which strengths rise with the rate, 1/s. None: never.
    pub strengthening_from_1_s: Option<f64>,
}

/// Stiffness in bending of a round bond, N m/rad, from that along it, N/m: E I/L0 from E A/L0.
#[inline(always)]
pub fn bending_stiffness(normal: f64, radius_m: f64) -> f64 {
    0.25 * normal * radius_m * radius_m
}

/// All bonds of a scene, sorted by their first particle and then by their second.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bonds {
    /// The two particles, the smaller index first.
    pub ends: Vec<[u32; 2]>,
    /// Unit vector from the first to the second end at the start, x, y, z.
    pub direction: [Vec<f64>; 3],
    /// Distances of the contact point from the two ends at the start, m.
    pub levers_m: [Vec<f64>; 2],
    /// Along the bond, N/m. A broken bond has no stiffness.
    pub normal: Vec<f64>,
    /// Across the bond, N/m.
    pub shear: Vec<f64>,
    /// Bond radii, m. They give the stiffness in bending, which is the normal one times r^2/4 in every model.
    pub radii_m: Vec<f64>,
    /// Factor on the strengths. Empty: 1 for all.
    pub strength_factors: Vec<f64>,
    /// Damping along, across, torsion, bending: N s/m, N s/m, N m s/rad, N m s/rad. Empty: none is damped.
    pub damping: Vec<[f64; 4]>,
    /// What incremental bonds carry. Empty: none is incremental.
    pub histories: Vec<History>,
    /// Kinds of bonds.
    pub rules: Vec<BondRule>,
    /// Stiffness in torsion over that in bending, for each rule that has bonds: it depends on the material only.
    pub torsion_per_bending: Vec<f64>,
    /// Ends of stretches of bonds that follow the same rule, and the rule.
    pub stretches: Vec<(usize, usize)>,
}

impl Bonds {
    /// Number of bonds, broken ones included.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Makes room for so many bonds more, and no more than that.
    pub fn reserve_exact(&mut self, count: usize) {
        self.ends.reserve_exact(count);
        let columns = [&mut self.normal, &mut self.shear, &mut self.radii_m];
        let vectors = self.direction.iter_mut().chain(&mut self.levers_m);
        for column in vectors.chain(columns) {
            column.reserve_exact(count);
        }
    }

    /// Adds a bond that follows the rule of this number. Bonds are to be added in the order that [`Bonds`] names.
    pub fn push(
        &mut self,
        ends: [u32; 2],
        direction: [f64; 3],
        radius_m: f64,
        stiffness: &Stiffness,
        rule: usize,
    ) {
        self.ends.push(ends);
        for (all, one) in self.direction.iter_mut().zip(direction) {
            all.push(one);
        }
        for (all, one) in self.levers_m.iter_mut().zip(stiffness.levers_m) {
            all.push(one);
        }
        self.normal.push(stiffness.normal);
        self.shear.push(stiffness.shear);
        if self.torsion_per_bending.len() <= rule {
            self.torsion_per_bending.resize(rule + 1, 1.0);
        }
        self.torsion_per_bending[rule] = stiffness.torsion / stiffness.bending;
        self.radii_m.push(radius_m);
        let end = self.len();
        match self.stretches.last_mut() {
            Some((last, of)) if *of == rule => *last = end,
            _ => self.stretches.push((end, rule)),
        }
    }

    /// What bond `at` answers.
    pub fn stiffness(&self, at: usize) -> Stiffness {
        let bending = bending_stiffness(self.normal[at], self.radii_m[at]);
        Stiffness {
            normal: self.normal[at],
            shear: self.shear[at],
            torsion: bending * self.torsion_per_bending[self.rule_of(at)],
            bending,
            levers_m: [self.levers_m[0][at], self.levers_m[1][at]],
        }
    }

    /// What bond `at`, which is not broken, does to its ends.
    pub fn forces(&self, at: usize, poses: &[Pose]) -> BondForces {
        let [a, b] = self.ends[at].map(|end| &poses[end as usize]);
        let stiffness = self.stiffness(at);
        if self.rules[self.rule_of(at)].incremental {
            let apart = b.place() - a.place();
            return incremental::bond_forces(&stiffness, &self.histories[at], &apart);
        }
        let [x, y, z] = &self.direction;
        let direction = Vector3::new(x[at], y[at], z[at]);
        let ends = [a, b].map(|pose| End {
            position_m: pose.place(),
            turned: pose.rotation(),
        });
        total::bond_forces(&stiffness, &direction, &ends)
    }

    /// Initial length of bond `at`, m.
    pub fn initial_length_m(&self, at: usize) -> f64 {
        self.levers_m[0][at] + self.levers_m[1][at]
    }

    /// Factor on the strengths of bond `at`.
    pub fn strength_factor(&self, at: usize) -> f64 {
        self.strength_factors.get(at).copied().unwrap_or(1.0)
    }

    /// Whether bond `at` is broken.
    pub fn is_broken(&self, at: usize) -> bool {
        self.normal[at] == 0.0
    }

    /// Takes all stiffness, damping and history from bond `at`.
    pub fn set_broken(&mut self, at: usize) {
        self.normal[at] = 0.0;
        self.shear[at] = 0.0;
        if let Some(damping) = self.damping.get_mut(at) {
            *damping = [0.0; 4];
        }
        if let Some(history) = self.histories.get_mut(at) {
            *history = History::default();
        }
    }

    /// Number of the rule that bond `at` follows.
    pub fn rule_of(&self, at: usize) -> usize {
        let stretch = self.stretches.partition_point(|(end, _)| *end <= at);
        self.stretches[stretch].1
    }

    /// The stretches of bonds of one rule that a range of bonds consists of: rule and bonds.
    pub fn runs(&self, range: Range<usize>) -> impl Iterator<Item = (usize, Range<usize>)> {
        let starts = std::iter::once(0).chain(self.stretches.iter().map(|(end, _)| *end));
        starts
            .zip(&self.stretches)
            .map(move |(start, &(end, rule))| (rule, start.max(range.start)..end.min(range.end)))
            .filter(|(_, run)| run.start < run.end)
    }
}
