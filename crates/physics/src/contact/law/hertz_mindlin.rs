//! The contact law of Hertz and Mindlin.
//!
//! With 1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b, 1/G* = (2 - nu_a)/G_a + (2 - nu_b)/G_b, 1/R* =
//! 1/R_a + 1/R_b:
//!
//! - F_n = 4/3 E* sqrt(R*) d^(3/2), tangent stiffness S_n = 2 E* sqrt(R* d) (Hertz 1882);
//! - k_t = 8 G* sqrt(R* d) (Mindlin 1949, no slip);
//! - c = 2 sqrt(5/6) zeta sqrt(S m*) along the normal with S_n, across it with k_t (Tsuji et al.
//!   1992), and the [ratio zeta](crate::contact::restitution) that gives the required restitution.

use crate::contact::kinematics::ContactKinematics;
use crate::contact::normal::{ImpactLaw, NormalLaw, NormalResponse};
use crate::contact::pair_parameters::{Elastic, PairInput, PairParameters};
use crate::number::Number;
use serde::Serialize;

/// The law for a pair of materials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct HertzMindlin<T = f64> {
    /// E*, Pa.
    pub young_modulus_pa: T,
    /// G*, Pa.
    pub shear_modulus_pa: T,
    /// Damping and friction.
    pub parameters: PairParameters<T>,
}

impl HertzMindlin {
    /// For two materials, at most one of them rigid.
    pub fn new(materials: [Elastic; 2], pair_input: &PairInput) -> Self {
        let [a, b] = materials;
        let softness = |m: Elastic| (1.0 - m.poisson_ratio.powi(2)) / m.young_modulus_pa;
        let shear_softness = |m: Elastic| {
            2.0 * (1.0 + m.poisson_ratio) * (2.0 - m.poisson_ratio) / m.young_modulus_pa
        };
        Self {
            young_modulus_pa: 1.0 / (softness(a) + softness(b)),
            shear_modulus_pa: 1.0 / (shear_softness(a) + shear_softness(b)),
            parameters: PairParameters::new(pair_input),
        }
    }

    /// The law of several contacts at once, one for each lane.
    #[inline(always)]
    pub fn in_lanes<T>(&self, all: impl Fn(f64) -> T + Copy) -> HertzMindlin<T> {
        HertzMindlin {
            young_modulus_pa: all(self.young_modulus_pa),
            shear_modulus_pa: all(self.shear_modulus_pa),
            parameters: self.parameters.in_lanes(all),
        }
    }
}

impl<T: Number> HertzMindlin<T> {
    /// Tangent stiffness along the normal, N/m, at a radius of the contact area, m: the square root
    /// of R* times the overlap.
    #[inline(always)]
    pub fn normal_n_m(&self, contact_radius_m: T) -> T {
        self.young_modulus_pa.scale(2.0) * contact_radius_m
    }
}

/// 2 sqrt(5/6), times the damping ratio.
const TSUJI: f64 = 1.825_741_858_350_553_8;

impl<T: Number> NormalLaw<T> for HertzMindlin<T> {
    #[inline(always)]
    fn evaluate(
        &self,
        touch: &ContactKinematics<T>,
        overlap_before_m: T,
        _dt: f64,
    ) -> NormalResponse<T> {
        let overlap = touch.overlap_m.if_positive(touch.overlap_m);
        let contact_radius = (touch.effective_radius_m * overlap).sqrt();
        let contact_radius_before = (touch.effective_radius_m * overlap_before_m).sqrt();
        let g = self.shear_modulus_pa.scale(8.0);
        let (normal, tangential) = (self.normal_n_m(contact_radius), g * contact_radius);
        let elastic = (normal * overlap).scale(2.0 / 3.0);
        let ratio = self.parameters.damping_ratio.scale(TSUJI);
        let tangential_ratio = self.parameters.tangential_damping_ratio.scale(TSUJI);
        let critical = (normal * touch.effective_mass_kg).sqrt();
        NormalResponse {
            elastic_n: elastic,
            energy_j: (elastic * overlap).scale(0.4),
            normal_n_m: [self.normal_n_m(contact_radius_before), normal],
            tangential_n_m: [g * contact_radius_before, tangential],
            stiffness_ratio: overlap.if_positive(contact_radius_before / contact_radius),
            normal_damping_n_s_m: ratio * critical,
            tangential_damping_n_s_m: tangential_ratio
                * (g / self.young_modulus_pa.scale(2.0)).sqrt()
                * critical,
        }
    }

    #[inline(always)]
    fn parameters(&self) -> &PairParameters<T> {
        &self.parameters
    }
}

/// Error of the energy of an impact over the square of the fraction of its limit that a step takes.
/// Bonds vibrate for a long time and conserve their energy on average; a contact does not.
const ENERGY_ERROR: f64 = 0.16;
/// Error of restitution over that fraction: the coefficient of damping grows within a step.
const RESTITUTION_ERROR: f64 = 0.04;
const LANDING_FRACTION: f64 = 0.1;

impl ImpactLaw for HertzMindlin {
    fn impact_fraction(&self, accuracy: f64) -> f64 {
        let of_energy = (accuracy / ENERGY_ERROR).sqrt();
        of_energy.min(accuracy / RESTITUTION_ERROR)
    }

    fn landing_fraction(&self) -> f64 {
        LANDING_FRACTION
    }

    fn normal_n_m(&self, overlap_m: f64, effective_radius_m: f64) -> f64 {
        Self::normal_n_m(self, (effective_radius_m * overlap_m).sqrt())
    }

    fn overlap_of_stiffness_m(&self, stiffness_n_m: f64, effective_radius_m: f64) -> f64 {
        // It grows with the square root of the overlap.
        let root = stiffness_n_m / Self::normal_n_m(self, effective_radius_m.sqrt());
        root * root
    }

    fn overlap_at_impact_m(&self, effective_radius_m: f64, mass_kg: f64, speed_m_s: f64) -> f64 {
        let k = 4.0 / 3.0 * self.young_modulus_pa * effective_radius_m.sqrt();
        (1.25 * mass_kg * speed_m_s * speed_m_s / k).powf(0.4)
    }

    fn largest_attraction_n(&self, _effective_radius_m: f64) -> f64 {
        0.0
    }
}
