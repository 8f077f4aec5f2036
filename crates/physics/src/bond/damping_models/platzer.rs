//! Damping by a coefficient (Platzer 2022, eqs. 7 and 9).

use crate::bond::damping::{DampingCoefficients, DampingModel, ReducedInertia};
use crate::bond::stiffness::Stiffness;

/// Platzer 2022, eqs. 7 and 9: a coefficient times the full relative velocity, and a factor times
/// sqrt(k_tor I_red), sqrt(k_ben I_red).
///
/// Table 1 there gives the coefficient without a unit; eq. 7 needs N s/m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Platzer {
    /// N s/m.
    pub coefficient_n_s_m: f64,
    /// 1 as printed.
    pub moment_factor: f64,
}

impl DampingModel for Platzer {
    #[inline(always)]
    fn coefficients(&self, stiffness: &Stiffness, reduced: &ReducedInertia) -> DampingCoefficients {
        DampingCoefficients {
            normal: self.coefficient_n_s_m,
            shear: self.coefficient_n_s_m,
            torsion: self.moment_factor * (stiffness.torsion * reduced.inertia_kg_m2).sqrt(),
            bending: self.moment_factor * (stiffness.bending * reduced.inertia_kg_m2).sqrt(),
        }
    }
}
