//! Damping by four ratios, one for each mode.

use crate::bond::damping::{DampingCoefficients, DampingModel, ReducedInertia};
use crate::bond::stiffness::Stiffness;

/// 2 eta sqrt(k m_red) along and across the bond, 2 eta sqrt(k I_red) about it and across it, each
/// with the eta and the stiffness k of its own mode (Chen et al. 2022, section 2.1, names the four
/// coefficients). Each eta is the damping ratio of its mode where the modes are uncoupled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeRatios {
    /// Along the bond.
    pub normal: f64,
    /// Across it.
    pub shear: f64,
    /// About its axis.
    pub torsion: f64,
    /// About the axes across it.
    pub bending: f64,
}

impl DampingModel for ModeRatios {
    #[inline(always)]
    fn coefficients(&self, stiffness: &Stiffness, reduced: &ReducedInertia) -> DampingCoefficients {
        let critical = |stiffness: f64, inert: f64| 2.0 * (stiffness * inert).sqrt();
        let (mass_kg, inertia_kg_m2) = (reduced.mass_kg, reduced.inertia_kg_m2);
        DampingCoefficients {
            normal: self.normal * critical(stiffness.normal, mass_kg),
            shear: self.shear * critical(stiffness.shear, mass_kg),
            torsion: self.torsion * critical(stiffness.torsion, inertia_kg_m2),
            bending: self.bending * critical(stiffness.bending, inertia_kg_m2),
        }
    }
}
