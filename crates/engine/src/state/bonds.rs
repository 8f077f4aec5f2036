//! Bonds: one entry per bond in every array; the data for the force loop are stored in blocks.

use std::ops::Range;

use dem_scene::StrainRateMeasure;
use nalgebra::{UnitQuaternion, Vector3};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use dem_physics::bond::damping::DampingCoefficients;
use dem_physics::bond::damping_models::StructuralDamping;
use dem_physics::bond::stiffness::Stiffness;
use dem_physics::bond::strain_rate::elongation_rate;
use dem_physics::bond::tangent::{BondTangent, bond_tangent};
use dem_physics::bond::total::{BondForces, End};
use dem_physics::bond::{BondLoad, incremental, total};
use dem_physics::number::Number;

use super::particles::{Motion, Pose};

mod block;
mod elements;
pub(crate) mod histories;
mod law;
mod softening;
mod stored;
mod yielding;

pub use block::{BLOCK, BondBlock, Column};
pub use histories::Histories;
use histories::NewBond;
use law::Source;
pub use law::{BondLaw, BondRule};
use stored::frame_between;
pub(crate) use stored::{StoredBond, sign};

impl BondBlock {
    /// Copies of these bonds.
    #[inline(always)]
    pub fn of(bonds: &Bonds, some: [usize; BLOCK]) -> Self {
        let mut block = Self::EMPTY;
        for (i, at) in some.into_iter().enumerate() {
            let (from, lane) = (&bonds.blocks[at / BLOCK], at % BLOCK);
            for axis in 0..3 {
                block.direction[axis][i] = from.direction[axis][lane];
            }
            for end in 0..2 {
                block.levers_m[end][i] = from.levers_m[end][lane];
            }
            block.normal[i] = from.normal[lane];
            block.shear[i] = from.shear[lane];
            block.radii_m[i] = from.radii_m[lane];
        }
        block
    }
}

/// Ratio of the bending stiffness to the normal stiffness times the square of the radius: E I/L0 to
/// E A/L0 of a round bond.
const BENDING_OF_ROUND_BOND: f64 = 0.25;
/// Largest relative difference between ratios of stiffnesses that counts as rounding.
const SAME_RATIO: f64 = 1e-9;

/// Bending stiffness of a bond, N m/rad, from its normal stiffness, N/m, and its rule's number in
/// [`Bonds::bending_per_normal`].
#[inline(always)]
pub(crate) fn bending_stiffness<T: Number>(normal: T, radius_m: T, per_normal: f64) -> T {
    normal.scale(per_normal) * radius_m * radius_m
}

/// Ratio of torsional to bending stiffness of a bond, and of bending stiffness to normal stiffness
/// times the square of the radius: those of its rule, which all of its bonds must share. 0 without
/// moments.
pub fn moment_ratios(stiffness: &Stiffness, radius_m: f64) -> [f64; 2] {
    if stiffness.bending == 0.0 {
        return [0.0; 2];
    }
    let of_round = stiffness.normal * radius_m * radius_m * BENDING_OF_ROUND_BOND;
    let ratio = stiffness.bending / of_round;
    // That of a solid section is not to depend on rounding.
    let is_solid = (ratio - 1.0).abs() < SAME_RATIO;
    [
        stiffness.torsion / stiffness.bending,
        BENDING_OF_ROUND_BOND * if is_solid { 1.0 } else { ratio },
    ]
}

/// Whether bonds with these [`moment_ratios`] can share a rule.
pub fn share_moment_ratios(one: &[f64; 2], other: &[f64; 2]) -> bool {
    let mut pairs = one.iter().zip(other);
    pairs.all(|(a, b)| (a - b).abs() <= SAME_RATIO * a.abs().max(b.abs()))
}

/// All bonds of a scene, sorted by their first particle and then by their second.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Bonds {
    /// The two particles, the smaller index first.
    pub ends: Vec<[u32; 2]>,
    /// Data for the force loop; the last block may have room left.
    pub blocks: Vec<BondBlock>,
    /// Factor on the strengths; of a damaged bond the least of its criteria, to find those that may
    /// have reached one. Empty: 1 for all.
    pub strength_factors: Vec<f64>,
    /// Damping coefficients of normal, shear, torsion and bending: N s/m, N s/m, N m s/rad, N m
    /// s/rad. Empty: no bond is damped.
    pub damping: Vec<[f64; 4]>,
    /// What bonds of laws with a history have been through.
    pub histories: Histories,
    /// The damaged bonds, in order; broken ones may be among them.
    pub damaged: Vec<u32>,
    /// Rules of the model.
    #[serde(skip)]
    pub rules: Arc<[BondRule]>,
    /// Ratio of torsional to bending stiffness, for each rule that has bonds: it depends only on
    /// the material.
    pub torsion_per_bending: Vec<f64>,
    /// Ratio of bending stiffness to normal stiffness times the square of the radius, for each rule
    /// that has bonds: 1/4, or 0 without moments.
    pub bending_per_normal: Vec<f64>,
    /// Runs of consecutive bonds that follow the same rule: the end of each run, and the rule.
    pub rule_runs: Vec<(usize, usize)>,
}

impl Bonds {
    /// Number of bonds, broken ones included.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are no bonds.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Reserves room for exactly this many more bonds.
    pub fn reserve_exact(&mut self, count: usize) {
        self.ends.reserve_exact(count);
        let blocks = (self.len() + count).div_ceil(BLOCK);
        self.blocks.reserve_exact(blocks - self.blocks.len());
    }

    /// [`moment_ratios`] of the bonds that follow this rule. None: there are no such bonds.
    pub fn moment_ratios_of(&self, rule: usize) -> Option<[f64; 2]> {
        let mut runs = self.rule_runs.iter();
        runs.any(|(_, of)| *of == rule).then(|| {
            [
                self.torsion_per_bending[rule],
                self.bending_per_normal[rule],
            ]
        })
    }

    /// Adds a bond that follows the rule with this number, and has its moment ratios, without
    /// damping and scatter of its strengths. Bonds must be added in the order given at [`Bonds`].
    pub fn push(
        &mut self,
        ends: [u32; 2],
        direction: [f64; 3],
        radius_m: f64,
        stiffness: &Stiffness,
        rule: usize,
    ) {
        let bond = NewBond {
            law: self
                .rules
                .get(rule)
                .map_or(BondLaw::Elastic, |rule| rule.law),
            direction: direction.into(),
            radius_m,
            stiffness,
        };
        self.histories.push(self.len(), &self.rules, &bond);
        self.push_elastic(ends, direction, radius_m, stiffness, rule);
    }

    /// Adds a bond without its history.
    fn push_elastic(
        &mut self,
        ends: [u32; 2],
        direction: [f64; 3],
        radius_m: f64,
        stiffness: &Stiffness,
        rule: usize,
    ) {
        let i = self.len() % BLOCK;
        if i == 0 {
            self.blocks.push(BondBlock::EMPTY);
        }
        self.ends.push(ends);
        if let Some(block) = self.blocks.last_mut() {
            for (column, x) in block.direction.iter_mut().zip(direction) {
                column[i] = x;
            }
            for (column, lever) in block.levers_m.iter_mut().zip(stiffness.levers_m) {
                column[i] = lever;
            }
            block.normal[i] = stiffness.normal;
            block.shear[i] = stiffness.shear;
            block.radii_m[i] = radius_m;
        }
        if self.torsion_per_bending.len() <= rule {
            self.torsion_per_bending.resize(rule + 1, 1.0);
            self.bending_per_normal
                .resize(rule + 1, BENDING_OF_ROUND_BOND);
        }
        let ratios = moment_ratios(stiffness, radius_m);
        [
            self.torsion_per_bending[rule],
            self.bending_per_normal[rule],
        ] = ratios;
        let end = self.len();
        match self.rule_runs.last_mut() {
            Some((last, of)) if *of == rule => *last = end,
            _ => self.rule_runs.push((end, rule)),
        }
        if !self.damping.is_empty() {
            self.damping.resize(end, [0.0; 4]);
        }
        if !self.strength_factors.is_empty() {
            self.strength_factors.resize(end, 1.0);
        }
    }

    /// Adds a copy of bond `at` of another set with the same rules, between these ends, with its
    /// strength multiplied by a factor.
    pub(crate) fn push_copy(&mut self, other: &Self, at: usize, ends: [u32; 2], factor: f64) {
        let rule = other.rule_of(at);
        let (from, k) = (&other.blocks[at / BLOCK], at % BLOCK);
        let direction = [0, 1, 2].map(|axis| from.direction[axis][k]);
        let stiffness = other.undamaged_stiffness(at);
        self.push_elastic(ends, direction, from.radii_m[k], &stiffness, rule);
        self.torsion_per_bending[rule] = other.torsion_per_bending[rule];
        self.bending_per_normal[rule] = other.bending_per_normal[rule];
        let (copy, factor) = (self.len() - 1, factor * other.undamaged_strength_factor(at));
        if factor != 1.0 {
            self.set_strength_factor(copy, factor);
        }
        if let Some(&damping) = other.damping.get(at) {
            self.set_damping(copy, damping);
        }
        self.histories.push_copy(copy, &other.histories, at, factor);
        if other.was_softened(at) && !other.is_broken(at) {
            self.set_damage(copy, other.damage(at));
        }
    }

    /// Gives bond `at` this factor on its strengths.
    pub fn set_strength_factor(&mut self, at: usize, factor: f64) {
        self.strength_factors.resize(self.len(), 1.0);
        self.strength_factors[at] = factor;
        if let Some(known) = self.histories.damages.get_mut(at) {
            known.strength_factor = factor;
        }
    }

    /// Gives bond `at` these coefficients of damping, mode by mode.
    pub fn set_damping(&mut self, at: usize, coefficients: [f64; 4]) {
        self.damping.resize(self.len(), [0.0; 4]);
        self.damping[at] = coefficients;
    }

    /// Turns the histories of the bonds from `first` on, which are in the axes of space.
    pub(crate) fn turn_histories(&mut self, first: usize, by: &UnitQuaternion<f64>) {
        self.histories.turn(first, by);
    }

    /// Gives bond `at`, which has not yielded, this direction without load, a unit vector.
    pub(crate) fn set_direction(&mut self, at: usize, direction: &Vector3<f64>) {
        let (block, i) = (&mut self.blocks[at / BLOCK], at % BLOCK);
        for (column, x) in block.direction.iter_mut().zip(direction.iter()) {
            column[i] = *x;
        }
    }

    /// Gives bond `at` these stress-free distances of the contact point from its two ends, m.
    pub(crate) fn set_levers_m(&mut self, at: usize, levers_m: [f64; 2]) {
        let (block, i) = (&mut self.blocks[at / BLOCK], at % BLOCK);
        for (column, lever) in block.levers_m.iter_mut().zip(levers_m) {
            column[i] = lever;
        }
    }

    /// The ends of bond `at`: those of its particles, which plastic deformation has turned.
    fn ends_of(&self, at: usize, poses: &[Pose]) -> [End; 2] {
        let ends = self.ends[at].map(|end| poses[end as usize].end());
        match self.histories.plastics.get(at) {
            Some(plastic) => plastic.ends(&ends),
            None => ends,
        }
    }

    /// Rotation of the frame of bond `at`: halfway between those of its two ends.
    pub(crate) fn frame_of(&self, at: usize, poses: &[Pose]) -> UnitQuaternion<f64> {
        frame_between(&self.ends_of(at, poses))
    }

    /// Normal stiffness of bond `at`, N/m; 0 if it is broken.
    pub fn normal(&self, at: usize) -> f64 {
        self.blocks[at / BLOCK].normal[at % BLOCK]
    }

    /// Radius of bond `at`, m.
    pub fn radius_m(&self, at: usize) -> f64 {
        self.blocks[at / BLOCK].radii_m[at % BLOCK]
    }

    /// Stress-free distances of the contact point of bond `at` from its two ends, m.
    pub fn levers_m(&self, at: usize) -> [f64; 2] {
        let [a, b] = &self.blocks[at / BLOCK].levers_m;
        [a[at % BLOCK], b[at % BLOCK]]
    }

    /// Stiffnesses of bond `at`.
    pub fn stiffness(&self, at: usize) -> Stiffness {
        let shear = self.blocks[at / BLOCK].shear[at % BLOCK];
        self.stiffness_from(at, self.normal(at), shear)
    }

    /// Stiffnesses of bond `at` with these along and across it, N/m.
    fn stiffness_from(&self, at: usize, normal: f64, shear: f64) -> Stiffness {
        let rule = self.rule_of(at);
        let per_normal = self.bending_per_normal[rule];
        let bending = bending_stiffness(normal, self.radius_m(at), per_normal);
        Stiffness {
            normal,
            shear,
            torsion: bending * self.torsion_per_bending[rule],
            bending,
            levers_m: self.levers_m(at),
        }
    }

    /// Coefficients of damping of bond `at`, mode by mode, with these of structural damping.
    pub(crate) fn damping_with(&self, at: usize, structural: DampingCoefficients) -> [f64; 4] {
        let viscous = self.damping.get(at).copied().unwrap_or_default();
        let structural: [f64; 4] = structural.into();
        std::array::from_fn(|mode| viscous[mode] + structural[mode])
    }

    /// Structural damping of bond `at` with this stiffness between ends of these masses. None: it
    /// has none.
    pub(crate) fn structural_damping(
        &self,
        at: usize,
        stiffness: Stiffness,
        motions: &[Motion],
    ) -> Option<StructuralDamping> {
        let gamma = self.rules[self.rule_of(at)].structural_damping;
        if gamma == 0.0 || self.is_broken(at) {
            return None;
        }
        let [a, b] = self.ends[at].map(|end| motions[end as usize].inverse_mass);
        Some(StructuralDamping {
            gamma,
            frequency_rad_s: (stiffness.normal * (a + b)).sqrt(),
            stiffness,
        })
    }

    /// Forces of bond `at`, which must not be broken, on its ends.
    pub fn forces(&self, at: usize, poses: &[Pose]) -> BondForces {
        let stiffness = self.stiffness(at);
        match self.rules[self.rule_of(at)].law.source() {
            Source::Elements => {
                let elements = &self.histories.joints[at].elements;
                return self.joint_forces(at, elements, &self.ends_of(at, poses));
            }
            Source::Sums => {
                let [a, b] = self.ends[at].map(|end| poses[end as usize].place());
                return incremental::bond_forces(&stiffness, &self.histories.sums[at], &(b - a));
            }
            Source::Positions => {}
        }
        let stiffness = self.stiffness_now(at, poses);
        total::bond_forces(&stiffness, &self.direction(at), &self.ends_of(at, poses))
    }

    /// Deformation of bond `at`, broken or not, in place of its load: change of length and sliding,
    /// m, twist and bending, rad; the latter are 0 in a model without moments.
    pub fn deformation(&self, at: usize, poses: &[Pose]) -> BondLoad {
        let ends = self.ends_of(at, poses);
        let has_moments = self.bending_per_normal[self.rule_of(at)] > 0.0;
        let turning = if has_moments { 1.0 } else { 0.0 };
        let unit = Stiffness {
            normal: 1.0,
            shear: 1.0,
            torsion: turning,
            bending: turning,
            levers_m: self.levers_m(at),
        };
        total::bond_forces(&unit, &self.direction(at), &ends).load
    }

    /// Length of bond `at` beyond that without load, m.
    pub(crate) fn stretch_m(&self, at: usize, poses: &[Pose]) -> f64 {
        let [a, b] = self.ends[at].map(|end| poses[end as usize].place());
        (b - a).norm() - self.stress_free_length_m(at)
    }

    /// Derivatives of the forces of bond `at`, which must not be broken, with respect to
    /// displacements and rotations of its ends, by the total formulation.
    pub fn tangent(&self, at: usize, poses: &[Pose]) -> BondTangent {
        let ends = self.ends_of(at, poses);
        let stiffness = Stiffness {
            normal: self.axial_stiffness(at, poses),
            ..self.stiffness(at)
        };
        bond_tangent(&stiffness, &self.direction(at), &ends)
    }

    /// Unit vector of bond `at` from its first to its second end without load.
    pub fn direction(&self, at: usize) -> Vector3<f64> {
        let [x, y, z] = &self.blocks[at / BLOCK].direction;
        Vector3::new(x[at % BLOCK], y[at % BLOCK], z[at % BLOCK])
    }

    /// Initial length of bond `at`, m.
    pub fn initial_length_m(&self, at: usize) -> f64 {
        let plastic = self.histories.plastics.get(at);
        self.stress_free_length_m(at) - plastic.map_or(0.0, |plastic| plastic.elongation_m)
    }

    /// Length of bond `at` without load, m: the initial one until it yields.
    pub fn stress_free_length_m(&self, at: usize) -> f64 {
        let [a, b] = self.levers_m(at);
        a + b
    }

    /// Factor on the strengths of bond `at`.
    pub fn strength_factor(&self, at: usize) -> f64 {
        self.strength_factors.get(at).copied().unwrap_or(1.0)
    }

    /// Whether the strength of any bond depends on its strain rate.
    pub fn strengthen_with_rate(&self) -> bool {
        let mut rules = self.rules.iter();
        rules.any(|rule| rule.strengthening.is_some())
    }

    /// Strain rate of bond `at` by the measure of its rule, 1/s. Lengths: particles.
    pub fn strain_rate_1_s(&self, at: usize, poses: &[Pose], motions: &[Motion]) -> f64 {
        let [a, b] = self.ends[at].map(|end| end as usize);
        let velocities = [a, b].map(|end| Vector3::from(motions[end].velocity_m_s));
        let length_m = self.initial_length_m(at);
        match self.rules[self.rule_of(at)].strain_rate_measure {
            StrainRateMeasure::Elongation => {
                let c = (poses[b].place() - poses[a].place()).normalize();
                elongation_rate(&c, &velocities, length_m)
            }
            StrainRateMeasure::RelativeVelocity => {
                (velocities[1] - velocities[0]).norm() / length_m
            }
        }
    }

    /// The rate that determines the strength of bond `at` at this strain rate, 1/s: the same, or
    /// the largest so far.
    pub fn deciding_rate_1_s(&self, at: usize, rate_1_s: f64) -> f64 {
        let kept = self.histories.largest_rates.get(at);
        kept.map_or(rate_1_s, |kept| kept.0.max(rate_1_s))
    }

    /// Ratio of dynamic to static strength of bond `at` at this strain rate: 1 without rate
    /// strengthening.
    pub fn dynamic_increase_factor(&self, at: usize, rate_1_s: f64) -> f64 {
        let strengthening = self.rules[self.rule_of(at)].strengthening.as_ref();
        strengthening.map_or(1.0, |it| it.factor(self.deciding_rate_1_s(at, rate_1_s)))
    }

    /// Whether bond `at` is broken.
    pub fn is_broken(&self, at: usize) -> bool {
        self.normal(at) == 0.0
    }

    /// Removes all stiffness, damping and history of bond `at`.
    pub fn set_broken(&mut self, at: usize) {
        let block = &mut self.blocks[at / BLOCK];
        block.normal[at % BLOCK] = 0.0;
        block.shear[at % BLOCK] = 0.0;
        if let Some(damping) = self.damping.get_mut(at) {
            *damping = [0.0; 4];
        }
        self.histories.end(at);
    }

    /// Number of the rule of bond `at`.
    pub fn rule_of(&self, at: usize) -> usize {
        let stretch = self.rule_runs.partition_point(|(end, _)| *end <= at);
        self.rule_runs[stretch].1
    }

    /// The runs of bonds with the same rule in a range of bonds: rule and bonds.
    pub fn runs(&self, range: Range<usize>) -> impl Iterator<Item = (usize, Range<usize>)> {
        let starts = std::iter::once(0).chain(self.rule_runs.iter().map(|(end, _)| *end));
        starts
            .zip(&self.rule_runs)
            .map(move |(start, &(end, rule))| (rule, start.max(range.start)..end.min(range.end)))
            .filter(|(_, run)| run.start < run.end)
    }
}
