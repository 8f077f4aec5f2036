//! The linear contact law: springs and dashpots of constant stiffness.
//!
//! F_n = k_n d, k_t a constant fraction of k_n, c = 2 zeta sqrt(k m*) along the normal with k_n,
//! across it with k_t, and the [ratio zeta](crate::contact::restitution) that gives the required
//! restitution at any speed (Cundall and Strack 1979; Schwager and Poeschel 2007).
//!
//! The dashpot acts with its full force from the first moment, while the kick of a step covers the
//! time around its end. So that the loss does not depend on the moment within a step at which the
//! ends meet, the first kick contains only the fraction of the dashpot's force since then.

use crate::contact::kinematics::ContactKinematics;
use crate::contact::normal::{ImpactLaw, NormalLaw, NormalResponse};
use crate::contact::pair_parameters::{PairInput, PairParameters};
use crate::number::Number;
use serde::Serialize;

/// The law for a pair of materials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Linear<T = f64> {
    /// k_n, N/m.
    pub normal_n_m: T,
    /// k_t, N/m.
    pub tangential_n_m: T,
    /// Damping and friction.
    pub parameters: PairParameters<T>,
}

impl Linear {
    /// With this stiffness, N/m, and this ratio k_t / k_n.
    pub fn new(normal_n_m: f64, tangential_ratio: f64, pair_input: &PairInput) -> Self {
        Self {
            normal_n_m,
            tangential_n_m: tangential_ratio * normal_n_m,
            parameters: PairParameters::new(pair_input),
        }
    }

    /// The law of several contacts at once, one for each lane.
    #[inline(always)]
    pub fn in_lanes<T>(&self, all: impl Fn(f64) -> T + Copy) -> Linear<T> {
        Linear {
            normal_n_m: all(self.normal_n_m),
            tangential_n_m: all(self.tangential_n_m),
            parameters: self.parameters.in_lanes(all),
        }
    }
}

impl<T: Number> NormalLaw<T> for Linear<T> {
    #[inline(always)]
    fn evaluate(
        &self,
        touch: &ContactKinematics<T>,
        overlap_before_m: T,
        dt: f64,
    ) -> NormalResponse<T> {
        let overlap = touch.overlap_m.if_positive(touch.overlap_m);
        let due = due_of_kick(touch, overlap_before_m, dt);
        let normal = overlap.if_positive(self.normal_n_m);
        let tangential = overlap.if_positive(self.tangential_n_m);
        let normal_before = overlap_before_m.if_positive(self.normal_n_m);
        let elastic = normal * overlap;
        NormalResponse {
            elastic_n: elastic,
            energy_j: (elastic * overlap).scale(0.5),
            normal_n_m: [normal_before, normal],
            tangential_n_m: [
                overlap_before_m.if_positive(self.tangential_n_m),
                tangential,
            ],
            stiffness_ratio: overlap.if_positive(normal_before / normal),
            normal_damping_n_s_m: (self.parameters.damping_ratio
                * (normal * touch.effective_mass_kg).sqrt())
            .scale(2.0)
                * due,
            tangential_damping_n_s_m: (self.parameters.tangential_damping_ratio
                * (tangential * touch.effective_mass_kg).sqrt())
            .scale(2.0),
        }
    }

    #[inline(always)]
    fn parameters(&self) -> &PairParameters<T> {
        &self.parameters
    }
}

/// Fraction of a kick that is due if the ends met in the step of `dt`, s, before its middle: the
/// time since then, and half a step after it. 1 if they were already in contact, or separate.
#[inline(always)]
fn due_of_kick<T: Number>(touch: &ContactKinematics<T>, overlap_before_m: T, dt: f64) -> T {
    let one = overlap_before_m.zero().plus(1.0);
    let approached_m = touch.velocity_m_s.dot(touch.middle).scale(-dt);
    let since_met = (touch.overlap_m / approached_m).minimum(one);
    let more = approached_m.if_positive(since_met.plus(-0.5));
    one + more - overlap_before_m.if_positive(more)
}

/// Error of the energy of an impact over the square of the fraction of its limit that a step takes:
/// the force starts with a jump in slope, that of the dashpot with its full value. The error of
/// restitution is below half of it.
const ENERGY_ERROR: f64 = 0.64;
/// The error of the energy grows with the square of the step: it is 2e-3 at 0.05, at the worst
/// moment within a step at which an impact can begin.
const LANDING_FRACTION: f64 = 0.034;

impl ImpactLaw for Linear {
    fn impact_fraction(&self, accuracy: f64) -> f64 {
        (accuracy / ENERGY_ERROR).sqrt()
    }

    fn landing_fraction(&self) -> f64 {
        LANDING_FRACTION
    }

    fn normal_n_m(&self, overlap_m: f64, _effective_radius_m: f64) -> f64 {
        overlap_m.if_positive(self.normal_n_m)
    }

    fn overlap_of_stiffness_m(&self, stiffness_n_m: f64, _effective_radius_m: f64) -> f64 {
        if self.normal_n_m > stiffness_n_m {
            0.0
        } else {
            f64::INFINITY
        }
    }

    fn overlap_at_impact_m(&self, _effective_radius_m: f64, mass_kg: f64, speed_m_s: f64) -> f64 {
        speed_m_s * (mass_kg / self.normal_n_m).sqrt()
    }

    fn largest_attraction_n(&self, _effective_radius_m: f64) -> f64 {
        0.0
    }
}
