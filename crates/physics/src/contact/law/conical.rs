//! The law of a conical tip: F = K d^2.

use crate::contact::kinematics::ContactKinematics;
use crate::contact::pair_parameters::PairParameters;
use crate::contact::{ImpactLaw, NormalLaw, NormalResponse};
use crate::number::Number;
use serde::Serialize;

/// A conical tip.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Conical<T = f64> {
    /// K, N/m2.
    pub cone_n_m2: T,
    /// Damping and friction.
    pub parameters: PairParameters<T>,
}

impl Conical {
    /// The same for several contacts at once, one for each lane.
    #[inline(always)]
    pub fn in_lanes<T>(&self, all: impl Fn(f64) -> T + Copy) -> Conical<T> {
        Conical {
            cone_n_m2: all(self.cone_n_m2),
            parameters: self.parameters.in_lanes(all),
        }
    }
}

impl<T: Number> NormalLaw<T> for Conical<T> {
    #[inline(always)]
    fn evaluate(&self, touch: &ContactKinematics<T>, before_m: T, _dt: f64) -> NormalResponse<T> {
        let [before, now] = [before_m, touch.overlap_m].map(|overlap| overlap.if_positive(overlap));
        let [normal_before, normal] = [before, now].map(|d| (self.cone_n_m2 * d).scale(2.0));
        let elastic = self.cone_n_m2 * now * now;
        let damping = |ratio: T, stiffness: T| {
            (ratio * (stiffness * touch.effective_mass_kg).sqrt()).scale(2.0)
        };
        NormalResponse {
            elastic_n: elastic,
            energy_j: (elastic * now).scale(1.0 / 3.0),
            normal_n_m: [normal_before, normal],
            // As stiff along the surface as a linear contact with 2/7 of its normal stiffness.
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

impl ImpactLaw for Conical {
    fn impact_fraction(&self) -> f64 {
        0.125
    }

    fn landing_fraction(&self) -> f64 {
        0.05
    }

    fn normal_n_m(&self, overlap_m: f64, _effective_radius_m: f64) -> f64 {
        2.0 * self.cone_n_m2 * overlap_m
    }

    fn overlap_of_stiffness_m(&self, stiffness_n_m: f64, _effective_radius_m: f64) -> f64 {
        stiffness_n_m / (2.0 * self.cone_n_m2)
    }

    fn overlap_at_impact_m(&self, _effective_radius_m: f64, mass_kg: f64, speed_m_s: f64) -> f64 {
        // 1/2 m v^2 = 1/3 K d^3
        (1.5 * mass_kg * speed_m_s.powi(2) / self.cone_n_m2).cbrt()
    }

    fn largest_attraction_n(&self, _effective_radius_m: f64) -> f64 {
        0.0
    }
}
