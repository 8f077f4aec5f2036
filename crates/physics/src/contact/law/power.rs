//! A force that grows with the power 1.25 of the overlap, F = K d^1.25 with K = E R^0.75, R the
//! effective radius.

use serde::Serialize;

use crate::contact::kinematics::ContactKinematics;
use crate::contact::pair_parameters::PairParameters;
use crate::contact::{ImpactLaw, NormalLaw, NormalResponse};
use crate::number::Number;

/// 2 sqrt((n + 1)/(2 n)) with n = 1.25, times the damping ratio.
const DAMPING: f64 = 1.897_366_596_101_027_6;

/// F = E R^0.75 d^1.25.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Power<T = f64> {
    /// E, Pa.
    pub modulus_pa: T,
    /// Damping and friction.
    pub parameters: PairParameters<T>,
}

impl Power {
    /// The same for several contacts at once, one for each lane.
    #[inline(always)]
    pub fn in_lanes<T>(&self, all: impl Fn(f64) -> T + Copy) -> Power<T> {
        Power {
            modulus_pa: all(self.modulus_pa),
            parameters: self.parameters.in_lanes(all),
        }
    }

    /// K, N/m^1.25.
    fn factor(&self, effective_radius_m: f64) -> f64 {
        self.modulus_pa * effective_radius_m.powf(0.75)
    }
}

impl<T: Number> NormalLaw<T> for Power<T> {
    #[inline(always)]
    fn evaluate(&self, touch: &ContactKinematics<T>, before_m: T, _dt: f64) -> NormalResponse<T> {
        let [before, now] = [before_m, touch.overlap_m].map(|overlap| overlap.if_positive(overlap));
        let root = touch.effective_radius_m.sqrt();
        let factor = self.modulus_pa * root * root.sqrt();
        let [normal_before, normal] = [before, now].map(|d| (factor * d.sqrt().sqrt()).scale(1.25));
        let elastic = (normal * now).scale(0.8);
        let damping =
            |ratio: T, k: T| (ratio * (k * touch.effective_mass_kg).sqrt()).scale(DAMPING);
        NormalResponse {
            elastic_n: elastic,
            energy_j: (elastic * now).scale(1.0 / 2.25),
            normal_n_m: [normal_before, normal],
            tangential_n_m: [normal_before, normal].map(|k| k.scale(2.0 / 7.0)),
            stiffness_ratio: now.if_positive(normal_before / normal),
            normal_damping_n_s_m: damping(self.parameters.damping_ratio, normal),
            tangential_damping_n_s_m: damping(
                self.parameters.tangential_damping_ratio,
                normal.scale(2.0 / 7.0),
            ),
        }
    }

    #[inline(always)]
    fn parameters(&self) -> &PairParameters<T> {
        &self.parameters
    }
}

impl ImpactLaw for Power {
    fn impact_fraction(&self, accuracy: f64) -> f64 {
        // Between a linear contact and one of Hertz; that of Hertz is the smaller.
        (accuracy / 0.16).sqrt().min(accuracy / 0.04)
    }

    fn landing_fraction(&self) -> f64 {
        0.1
    }

    fn normal_n_m(&self, overlap_m: f64, effective_radius_m: f64) -> f64 {
        1.25 * self.factor(effective_radius_m) * overlap_m.powf(0.25)
    }

    fn overlap_of_stiffness_m(&self, stiffness_n_m: f64, effective_radius_m: f64) -> f64 {
        (stiffness_n_m / (1.25 * self.factor(effective_radius_m))).powi(4)
    }

    fn overlap_at_impact_m(&self, effective_radius_m: f64, mass_kg: f64, speed_m_s: f64) -> f64 {
        // 1/2 m v^2 = K d^2.25/2.25
        let energy = 1.125 * mass_kg * speed_m_s.powi(2);
        (energy / self.factor(effective_radius_m)).powf(1.0 / 2.25)
    }

    fn largest_attraction_n(&self, _effective_radius_m: f64) -> f64 {
        0.0
    }
}
