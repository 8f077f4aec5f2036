//! The adhesive contact law of Derjaguin, Muller and Toporov (1975), with Mindlin's tangential
//! stiffness: Hertz's contact, whose ends attract each other with 2 pi w R* while they touch, where
//! w is the work of adhesion (twice the surface energy of equal materials).
//!
//! - F_n = 4/3 E* sqrt(R*) d^(3/2) - 2 pi w R*; the pull-off force is 2 pi w R*, at d = 0;
//! - energy 8/15 E* sqrt(R*) d^(5/2) - 2 pi w R* d, which is continuous where the ends separate;
//! - the attraction begins and ends with a jump, within a step: see `jumps.rs`;
//! - friction, rolling and damping follow from Hertz's part of the force, which presses the ends.
//!
//! It holds for small, stiff particles: Tabor's parameter (R* w^2/(E*^2 z^3))^(1/3), with z the
//! distance of atoms, about 0.3 nm, is well below 1. The attraction before the touch is left out.

use super::hertz_mindlin::HertzMindlin;
use crate::contact::kinematics::ContactKinematics;
use crate::contact::normal::{ImpactLaw, NormalLaw, NormalResponse};
use crate::contact::pair_parameters::PairParameters;
use crate::number::Number;
use serde::Serialize;
use std::f64::consts::PI;

/// The law for a pair of materials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DerjaguinMullerToporov<T = f64> {
    /// The contact without adhesion.
    pub hertz_mindlin: HertzMindlin<T>,
    /// w, J/m2.
    pub work_of_adhesion_j_m2: T,
}

impl DerjaguinMullerToporov {
    /// The law of several contacts at once, one for each lane.
    #[inline(always)]
    pub fn in_lanes<T>(&self, all: impl Fn(f64) -> T + Copy) -> DerjaguinMullerToporov<T> {
        DerjaguinMullerToporov {
            hertz_mindlin: self.hertz_mindlin.in_lanes(all),
            work_of_adhesion_j_m2: all(self.work_of_adhesion_j_m2),
        }
    }
}

impl<T: Number> NormalLaw<T> for DerjaguinMullerToporov<T> {
    const ATTRACTS: bool = true;

    #[inline(always)]
    fn evaluate(
        &self,
        touch: &ContactKinematics<T>,
        overlap_before_m: T,
        dt: f64,
    ) -> NormalResponse<T> {
        let pressed = self.hertz_mindlin.evaluate(touch, overlap_before_m, dt);
        let attraction = self.attraction_n(touch);
        NormalResponse {
            elastic_n: pressed.elastic_n - attraction,
            energy_j: pressed.energy_j - attraction * touch.overlap_m,
            ..pressed
        }
    }

    #[inline(always)]
    fn attraction_n(&self, touch: &ContactKinematics<T>) -> T {
        touch
            .overlap_m
            .if_positive(self.attraction_at_touch_n(touch))
    }

    #[inline(always)]
    fn attraction_at_touch_n(&self, touch: &ContactKinematics<T>) -> T {
        let force = self.work_of_adhesion_j_m2 * touch.effective_radius_m;
        force.scale(2.0 * PI)
    }

    #[inline(always)]
    fn parameters(&self) -> &PairParameters<T> {
        &self.hertz_mindlin.parameters
    }
}

impl ImpactLaw for DerjaguinMullerToporov {
    fn impact_fraction(&self, accuracy: f64) -> f64 {
        self.hertz_mindlin.impact_fraction(accuracy)
    }

    fn landing_fraction(&self) -> f64 {
        self.hertz_mindlin.landing_fraction()
    }

    fn normal_n_m(&self, overlap_m: f64, effective_radius_m: f64) -> f64 {
        ImpactLaw::normal_n_m(&self.hertz_mindlin, overlap_m, effective_radius_m)
    }

    fn overlap_of_stiffness_m(&self, stiffness_n_m: f64, effective_radius_m: f64) -> f64 {
        let law = &self.hertz_mindlin;
        law.overlap_of_stiffness_m(stiffness_n_m, effective_radius_m)
    }

    /// At most the overlap without adhesion and that to which adhesion alone pulls from rest
    /// together, since the energy of Hertz grows faster than the overlap.
    fn overlap_at_impact_m(&self, effective_radius_m: f64, mass_kg: f64, speed_m_s: f64) -> f64 {
        let law = &self.hertz_mindlin;
        let k = 4.0 / 3.0 * law.young_modulus_pa * effective_radius_m.sqrt();
        let attraction_n = self.largest_attraction_n(effective_radius_m);
        let pulled_m = (2.5 * attraction_n / k).powf(2.0 / 3.0);
        law.overlap_at_impact_m(effective_radius_m, mass_kg, speed_m_s) + pulled_m
    }

    fn largest_attraction_n(&self, effective_radius_m: f64) -> f64 {
        2.0 * PI * self.work_of_adhesion_j_m2 * effective_radius_m
    }
}
