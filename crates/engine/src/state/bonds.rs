//! Bonds: one entry per bond in every array; the data for the force loop are stored in blocks.

use std::f64::consts::PI;
use std::ops::Range;

use dem_scene::StrainRateMeasure;
use nalgebra::{UnitQuaternion, Vector3};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use dem_physics::bond::criteria::COUNT;
use dem_physics::bond::damage::{Damage, opening_ratios, screened_factor};
use dem_physics::bond::damping::DampingCoefficients;
use dem_physics::bond::damping_models::StructuralDamping;
use dem_physics::bond::flat_joint::{self, ElementStrengths, FlatJoint, JointStiffness};
use dem_physics::bond::incremental::History;
use dem_physics::bond::plasticity::{PlasticDeformation, StressFree};
use dem_physics::bond::stiffness::Stiffness;
use dem_physics::bond::strain_rate::{dynamic_increase_factor, elongation_rate};
use dem_physics::bond::tangent::{BondTangent, bond_tangent};
use dem_physics::bond::total::{BondForces, End};
use dem_physics::bond::{BondLoad, incremental, total};
use dem_physics::number::Number;

use super::particles::{Motion, Pose};

mod law;

pub use law::{BondLaw, BondRule};

/// Bonds in a block.
pub const BLOCK: usize = 8;

/// One number for each bond of a block.
pub type Column = [f64; BLOCK];

/// Consecutive bonds: the data that their forces depend on, number by number, so that the loop over
/// bonds reads complete vectors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[repr(align(64))]
pub struct BondBlock {
    /// Unit vectors from the first to the second end at the start, x, y, z; of a bond that has
    /// yielded, its stress-free direction.
    pub direction: [Column; 3],
    /// Stress-free distances of the contact point from the two ends, m: the initial ones until a
    /// bond yields.
    pub levers_m: [Column; 2],
    /// Along the bond, N/m. A broken bond has no stiffness.
    pub normal: Column,
    /// Across the bond, N/m.
    pub shear: Column,
    /// Bond radii, m. They give the bending stiffness, which is the normal stiffness times r^2/4 in
    /// every model that has one.
    pub radii_m: Column,
}

impl BondBlock {
    /// A block without bonds.
    pub const EMPTY: Self = Self {
        direction: [[0.0; BLOCK]; 3],
        levers_m: [[0.0; BLOCK]; 2],
        normal: [0.0; BLOCK],
        shear: [0.0; BLOCK],
        radii_m: [1.0; BLOCK],
    };

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
    /// Histories of incremental bonds. Empty: no bond is incremental.
    #[serde(with = "histories")]
    pub histories: Vec<History>,
    /// Damage of each bond. Empty: no bond softens beyond its strength.
    pub damages: Vec<Damage>,
    /// The damaged bonds, in order; broken ones may be among them.
    pub damaged: Vec<u32>,
    /// Plastic deformation of each bond. Empty: no bond yields.
    pub plastics: Vec<PlasticDeformation>,
    /// Elements of flat joints, none for bonds of other models. Empty: there are no flat joints.
    pub joints: Vec<FlatJoint>,
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

    /// Adds a bond that follows the rule with this number, and has its moment ratios. Bonds
    /// must be added in the order given at [`Bonds`].
    pub fn push(
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
    }

    /// Adds a copy of bond `at` of another set with the same rules, between these ends, with its
    /// strength multiplied by a factor.
    pub(crate) fn push_copy(&mut self, other: &Self, at: usize, ends: [u32; 2], factor: f64) {
        let rule = other.rule_of(at);
        let (from, k) = (&other.blocks[at / BLOCK], at % BLOCK);
        let direction = [0, 1, 2].map(|axis| from.direction[axis][k]);
        let stiffness = other.undamaged_stiffness(at);
        self.push(ends, direction, from.radii_m[k], &stiffness, rule);
        self.torsion_per_bending[rule] = other.torsion_per_bending[rule];
        self.bending_per_normal[rule] = other.bending_per_normal[rule];
        let factor = factor * other.undamaged_strength_factor(at);
        if factor != 1.0 || !self.strength_factors.is_empty() {
            self.strength_factors.resize(self.len() - 1, 1.0);
            self.strength_factors.push(factor);
        }
        if let Some(&damping) = other.damping.get(at) {
            self.damping.resize(self.len() - 1, [0.0; 4]);
            self.damping.push(damping);
        } else if !self.damping.is_empty() {
            self.damping.push([0.0; 4]);
        }
        if let Some(&history) = other.histories.get(at) {
            self.histories.resize(self.len() - 1, History::default());
            self.histories.push(history);
        } else if !self.histories.is_empty() {
            self.histories.push(History::default());
        }
        if let Some(&plastic) = other.plastics.get(at) {
            self.plastics
                .resize(self.len() - 1, PlasticDeformation::NONE);
            self.plastics.push(plastic);
        } else if !self.plastics.is_empty() {
            self.plastics.push(PlasticDeformation::NONE);
        }
        if let Some(joint) = other.joints.get(at) {
            self.joints.resize(self.len() - 1, FlatJoint::default());
            self.joints.push(joint.clone());
        } else if !self.joints.is_empty() {
            self.joints.push(FlatJoint::default());
        }
        if let Some(&damage) = other.damages.get(at) {
            self.damages.push(Damage {
                damage: 0.0,
                strength_factor: factor,
                ..damage
            });
            if damage.damage > 0.0 && !other.is_broken(at) {
                self.set_damage(self.len() - 1, damage.damage);
            }
        }
    }

    /// Turns the histories of the bonds from `first` on, which are in the axes of space.
    pub(crate) fn turn_histories(&mut self, first: usize, by: &UnitQuaternion<f64>) {
        for history in self.histories.iter_mut().skip(first) {
            history.shear_force = by * history.shear_force;
            history.moment = by * history.moment;
        }
    }

    /// Softens bond `at`, whose rule has a fracture energy, to this damage, below 1.
    pub fn set_damage(&mut self, at: usize, damage: f64) {
        let known = &mut self.damages[at];
        if known.damage == 0.0 {
            self.damaged.insert(
                self.damaged.partition_point(|other| *other < at as u32),
                at as u32,
            );
        }
        known.damage = damage;
        let (known, i) = (*known, at % BLOCK);
        let block = &mut self.blocks[at / BLOCK];
        block.normal[i] = (1.0 - damage) * known.normal;
        block.shear[i] = (1.0 - damage) * known.shear;
        let ratios = self.opening_ratios(at);
        self.strength_factors.resize(self.len(), 1.0);
        self.strength_factors[at] = known.strength_factor * screened_factor(damage, &ratios);
    }

    /// Ratios of the opening at which bond `at` breaks to that at its strength: see
    /// [`opening_ratios`]. None of any criterion without a fracture energy.
    pub fn opening_ratios(&self, at: usize) -> [Option<f64>; COUNT] {
        let rule = &self.rules[self.rule_of(at)];
        let (Some(criteria), Some(energy_j_m2)) = (&rule.criteria, rule.law.fracture_energy_j_m2())
        else {
            return [None; COUNT];
        };
        let stiffness = self.undamaged_stiffness(at);
        let factor = self.undamaged_strength_factor(at);
        opening_ratios(criteria, energy_j_m2, &stiffness, self.radius_m(at), factor)
    }

    /// Damage of bond `at`: 0 intact, 1 broken.
    pub fn damage(&self, at: usize) -> f64 {
        match self.damages.get(at) {
            _ if self.is_broken(at) => 1.0,
            Some(damage) => damage.damage,
            None => 0.0,
        }
    }

    /// Whether bond `at`, broken or not, softened or failed in part before: its opening is no
    /// strain.
    pub fn was_damaged(&self, at: usize) -> bool {
        let softened = self.damages.get(at).is_some_and(|known| known.damage > 0.0);
        softened || self.failed_fraction(at) > 0.0
    }

    /// Whether bond `at`, broken or not, has yielded.
    pub fn has_yielded(&self, at: usize) -> bool {
        let plastic = self.plastics.get(at);
        plastic.is_some_and(|plastic| *plastic != PlasticDeformation::NONE)
    }

    /// Bytes of the elements of all flat joints.
    pub(crate) fn joint_bytes(&self) -> usize {
        let of_elements = self
            .joints
            .iter()
            .map(|joint| size_of_val(&joint.elements[..]));
        size_of_val(&self.joints[..]) + of_elements.sum::<usize>()
    }

    /// Failed part of the area of bond `at`, unless it is broken: 0 if it is no flat joint.
    pub fn failed_fraction(&self, at: usize) -> f64 {
        let joint = self.joints.get(at);
        joint.map_or(0.0, FlatJoint::failed_fraction)
    }

    /// Stiffness per area of bond `at`.
    pub(crate) fn joint_stiffness(&self, at: usize) -> JointStiffness {
        let (stiffness, radius_m) = (self.stiffness(at), self.radius_m(at));
        let per_area = 1.0 / (PI * radius_m * radius_m);
        JointStiffness {
            normal_pa_m: per_area * stiffness.normal,
            shear_pa_m: per_area * stiffness.shear,
        }
    }

    /// Strengths of the elements of flat joint `at`. None: they do not fail.
    pub(crate) fn element_strengths(&self, at: usize) -> Option<ElementStrengths> {
        let criteria = self.rules[self.rule_of(at)].criteria?;
        let factor = self.strength_factor(at);
        Some(ElementStrengths {
            tensile_pa: factor * criteria.tensile_strength_pa,
            cohesion_pa: factor * criteria.cohesion_pa,
            friction_tangent: criteria.friction_tangent,
        })
    }

    /// Largest utilisation of the bonded elements of flat joint `at`, which must not be broken.
    pub fn element_utilisation(&self, at: usize, poses: &[Pose]) -> f64 {
        let Some(strengths) = self.element_strengths(at) else {
            return 0.0;
        };
        flat_joint::utilisation(
            &self.joints[at].elements,
            &self.joint_stiffness(at),
            &strengths,
            &self.direction(at),
            self.initial_length_m(at),
            &self.ends_of(at, poses),
        )
    }

    /// Forces of flat joint `at` with these elements between these ends.
    pub(crate) fn joint_forces(
        &self,
        at: usize,
        elements: &[flat_joint::Element],
        ends: &[End; 2],
    ) -> BondForces {
        let stiffness = self.joint_stiffness(at);
        let length_m = self.initial_length_m(at);
        flat_joint::forces(elements, &stiffness, &self.direction(at), length_m, ends)
    }

    /// Number of unbroken bonds that have yielded. None: no bond yields.
    pub fn count_yielded(&self) -> Option<usize> {
        let is_one = |at: &usize| self.has_yielded(*at) && !self.is_broken(*at);
        let count = || (0..self.len()).filter(is_one).count();
        (!self.plastics.is_empty()).then(count)
    }

    /// Bond `at`, whose rule has a plasticity, without load.
    pub(crate) fn stress_free(&self, at: usize) -> StressFree {
        StressFree {
            levers_m: self.levers_m(at),
            direction: self.direction(at),
            plastic: self.plastics[at],
        }
    }

    /// Gives bond `at`, whose rule has a plasticity, this form without load.
    pub(crate) fn set_stress_free(&mut self, at: usize, bond: &StressFree) {
        let (block, i) = (&mut self.blocks[at / BLOCK], at % BLOCK);
        for axis in 0..3 {
            block.direction[axis][i] = bond.direction[axis];
        }
        for end in 0..2 {
            block.levers_m[end][i] = bond.levers_m[end];
        }
        self.plastics[at] = bond.plastic;
    }

    /// Gives bond `at`, which has not yielded, this direction without load, a unit vector.
    pub(crate) fn set_direction(&mut self, at: usize, direction: &Vector3<f64>) {
        let (block, i) = (&mut self.blocks[at / BLOCK], at % BLOCK);
        for (column, x) in block.direction.iter_mut().zip(direction.iter()) {
            column[i] = *x;
        }
    }

    /// The ends of bond `at`: those of its particles, which plastic deformation has turned.
    fn ends_of(&self, at: usize, poses: &[Pose]) -> [End; 2] {
        let ends = self.ends[at].map(|end| poses[end as usize].end());
        match self.plastics.get(at) {
            Some(plastic) => plastic.ends(&ends),
            None => ends,
        }
    }

    /// Rotation of the frame of bond `at`: halfway between those of its two ends.
    pub(crate) fn frame_of(&self, at: usize, poses: &[Pose]) -> UnitQuaternion<f64> {
        let [a, b] = self.ends_of(at, poses).map(|end| end.turned.into_inner());
        let sign = a.dot(&b).signum();
        UnitQuaternion::new_normalize(a + b * sign)
    }

    /// Number of unbroken bonds that are damaged. None: no bond softens beyond its strength.
    pub fn count_damaged(&self) -> Option<usize> {
        let unbroken = |at: &&u32| !self.is_broken(**at as usize);
        let count = || self.damaged.iter().filter(unbroken).count();
        (!self.damages.is_empty()).then(count)
    }

    /// Stiffnesses of bond `at` before it was damaged.
    pub(crate) fn undamaged_stiffness(&self, at: usize) -> Stiffness {
        match self.damages.get(at) {
            Some(known) if known.damage > 0.0 && !self.is_broken(at) => {
                self.stiffness_from(at, known.normal, known.shear)
            }
            _ => self.stiffness(at),
        }
    }

    /// Factor on the strengths of bond `at` before it was damaged.
    pub fn undamaged_strength_factor(&self, at: usize) -> f64 {
        match self.damages.get(at) {
            Some(known) => known.strength_factor,
            None => self.strength_factor(at),
        }
    }

    /// Whether strengths vary from bond to bond, apart from damage.
    pub(crate) fn strengths_scatter(&self) -> bool {
        if self.damages.is_empty() {
            !self.strength_factors.is_empty()
        } else {
            self.damages
                .iter()
                .any(|known| known.strength_factor != 1.0)
        }
    }

    /// Gives all bonds the strength of their rule, damaged ones as far as they still have it.
    pub fn forget_scatter(&mut self) {
        self.strength_factors.clear();
        for known in &mut self.damages {
            known.strength_factor = 1.0;
        }
        for at in std::mem::take(&mut self.damaged) {
            let known = &mut self.damages[at as usize];
            let damage = std::mem::replace(&mut known.damage, 0.0);
            self.set_damage(at as usize, damage);
        }
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
        if let Some(joint) = self
            .joints
            .get(at)
            .filter(|joint| !joint.elements.is_empty())
        {
            return self.joint_forces(at, &joint.elements, &self.ends_of(at, poses));
        }
        if self.rules[self.rule_of(at)].law == BondLaw::Incremental {
            let [a, b] = self.ends[at].map(|end| poses[end as usize].place());
            let apart = b - a;
            return incremental::bond_forces(&stiffness, &self.histories[at], &apart);
        }
        let stiffness = self.stiffness_now(at, poses);
        total::bond_forces(&stiffness, &self.direction(at), &self.ends_of(at, poses))
    }

    /// Forces that bond `at`, which must not be broken and has the total formulation, would have
    /// between these ends with this damage.
    pub fn forces_if_damaged(&self, at: usize, ends: &[End; 2], damage: f64) -> BondForces {
        let intact = self.undamaged_stiffness(at);
        let apart_m = (ends[1].position_m - ends[0].position_m).norm();
        let left = 1.0 - damage;
        let stiffness = Stiffness {
            normal: if apart_m < self.initial_length_m(at) {
                intact.normal
            } else {
                left * intact.normal
            },
            shear: left * intact.shear,
            torsion: left * intact.torsion,
            bending: left * intact.bending,
            ..intact
        };
        total::bond_forces(&stiffness, &self.direction(at), ends)
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

    /// Normal stiffness of bond `at` at these poses, N/m: of a damaged bond that is pressed, that
    /// which it had before.
    fn axial_stiffness(&self, at: usize, poses: &[Pose]) -> f64 {
        match self.damages.get(at) {
            Some(known) if known.damage > 0.0 && self.stretch_m(at, poses) < 0.0 => known.normal,
            _ => self.normal(at),
        }
    }

    /// Stiffnesses of bond `at` at these poses: see [`Self::axial_stiffness`].
    pub(crate) fn stiffness_now(&self, at: usize, poses: &[Pose]) -> Stiffness {
        Stiffness {
            normal: self.axial_stiffness(at, poses),
            ..self.stiffness(at)
        }
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
        let plastic = self.plastics.get(at);
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
        rules.any(|rule| rule.strengthening_from_1_s.is_some())
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

    /// Ratio of dynamic to static strength of bond `at` at this strain rate: 1 without rate
    /// strengthening.
    pub fn dynamic_increase_factor(&self, at: usize, rate_1_s: f64) -> f64 {
        let from = self.rules[self.rule_of(at)].strengthening_from_1_s;
        from.map_or(1.0, |from_1_s| dynamic_increase_factor(rate_1_s, from_1_s))
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
        if let Some(history) = self.histories.get_mut(at) {
            *history = History::default();
        }
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

/// Histories as plain numbers in a file: shear force x, y, z and moment x, y, z.
mod histories {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::state::bonds::History;

    pub(super) fn serialize<S: Serializer>(
        histories: &[History],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let numbers: Vec<[[f64; 3]; 2]> = histories
            .iter()
            .map(|h| [h.shear_force.into(), h.moment.into()])
            .collect();
        numbers.serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<History>, D::Error> {
        let numbers = Vec::<[[f64; 3]; 2]>::deserialize(deserializer)?;
        let history = |[force, moment]: [[f64; 3]; 2]| History {
            shear_force: force.into(),
            moment: moment.into(),
        };
        Ok(numbers.into_iter().map(history).collect())
    }
}
