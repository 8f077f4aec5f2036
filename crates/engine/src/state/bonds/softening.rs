//! Bonds that soften beyond their strength: their damage, and what they were before it.

use super::{BLOCK, Bonds};
use crate::state::particles::Pose;
use dem_physics::bond::criteria::COUNT;
use dem_physics::bond::damage::{opening_ratios, screened_factor};
use dem_physics::bond::stiffness::Stiffness;
use dem_physics::bond::total::{self, BondForces, End};

impl Bonds {
    /// Softens bond `at`, whose rule has a fracture energy, to this damage, below 1.
    pub fn set_damage(&mut self, at: usize, damage: f64) {
        let known = &mut self.histories.damages[at];
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
        match self.histories.damages.get(at) {
            _ if self.is_broken(at) => 1.0,
            Some(damage) => damage.damage,
            None => 0.0,
        }
    }

    /// Whether bond `at`, broken or not, softened or failed in part before: its opening is no
    /// strain.
    pub fn was_damaged(&self, at: usize) -> bool {
        self.was_softened(at) || self.failed_fraction(at) > 0.0
    }

    /// Whether bond `at`, broken or not, softened before.
    pub(super) fn was_softened(&self, at: usize) -> bool {
        let known = self.histories.damages.get(at);
        known.is_some_and(|known| known.damage > 0.0)
    }

    /// Number of unbroken bonds that are damaged. None: no bond softens beyond its strength.
    pub fn count_damaged(&self) -> Option<usize> {
        let unbroken = |at: &&u32| !self.is_broken(**at as usize);
        let count = || self.damaged.iter().filter(unbroken).count();
        (!self.histories.damages.is_empty()).then(count)
    }

    /// Stiffnesses of bond `at` before it was damaged.
    pub(crate) fn undamaged_stiffness(&self, at: usize) -> Stiffness {
        match self.histories.damages.get(at) {
            Some(known) if known.damage > 0.0 && !self.is_broken(at) => {
                self.stiffness_from(at, known.normal, known.shear)
            }
            _ => self.stiffness(at),
        }
    }

    /// Factor on the strengths of bond `at` before it was damaged.
    pub fn undamaged_strength_factor(&self, at: usize) -> f64 {
        match self.histories.damages.get(at) {
            Some(known) => known.strength_factor,
            None => self.strength_factor(at),
        }
    }

    /// Whether strengths vary from bond to bond, apart from damage.
    pub(crate) fn strengths_scatter(&self) -> bool {
        if self.histories.damages.is_empty() {
            !self.strength_factors.is_empty()
        } else {
            self.histories
                .damages
                .iter()
                .any(|known| known.strength_factor != 1.0)
        }
    }

    /// Gives all bonds the strength of their rule, damaged ones as far as they still have it.
    pub fn forget_scatter(&mut self) {
        self.strength_factors.clear();
        for known in &mut self.histories.damages {
            known.strength_factor = 1.0;
        }
        for at in std::mem::take(&mut self.damaged) {
            let known = &mut self.histories.damages[at as usize];
            let damage = std::mem::replace(&mut known.damage, 0.0);
            self.set_damage(at as usize, damage);
        }
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

    /// Normal stiffness of bond `at` at these poses, N/m: of a damaged bond that is pressed, that
    /// which it had before.
    pub(super) fn axial_stiffness(&self, at: usize, poses: &[Pose]) -> f64 {
        match self.histories.damages.get(at) {
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
}
