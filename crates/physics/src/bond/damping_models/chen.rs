//! Damping by a damping ratio (Chen et al. 2022, eqs. 9 and 10).

use crate::bond::damping::{DampingCoefficients, DampingModel, ReducedInertia};
use crate::bond::stiffness::Stiffness;

/// Chen et al. 2022, eqs. 9 and 10: 2 eta sqrt(k_n m_red) along and across the bond, 2 eta sqrt(2
/// k_tor I_red) about all axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chen {
    /// eta.
    pub damping_ratio: f64,
}

impl DampingModel for Chen {
    #[inline(always)]
    fn coefficients(&self, stiffness: &Stiffness, reduced: &ReducedInertia) -> DampingCoefficients {
        let eta = self.damping_ratio;
        let force = 2.0 * eta * (stiffness.normal * reduced.mass_kg).sqrt();
        let moment = 2.0 * eta * (2.0 * stiffness.torsion * reduced.inertia_kg_m2).sqrt();
        DampingCoefficients {
            normal: force,
            shear: force,
            torsion: moment,
            bending: moment,
        }
    }
}

/// As [`Chen`], but 2 eta sqrt(k m_red), 2 eta sqrt(k I_red) with the stiffness k of each mode, and
/// without the 2 under the root of eq. 10. eta is then the damping ratio of each uncoupled mode
/// (stretch, torsion) of two particles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChenByMode {
    /// eta.
    pub damping_ratio: f64,
}

impl DampingModel for ChenByMode {
    #[inline(always)]
    fn coefficients(&self, stiffness: &Stiffness, reduced: &ReducedInertia) -> DampingCoefficients {
        let eta = self.damping_ratio;
        DampingCoefficients {
            normal: 2.0 * eta * (stiffness.normal * reduced.mass_kg).sqrt(),
            shear: 2.0 * eta * (stiffness.shear * reduced.mass_kg).sqrt(),
            torsion: 2.0 * eta * (stiffness.torsion * reduced.inertia_kg_m2).sqrt(),
            bending: 2.0 * eta * (stiffness.bending * reduced.inertia_kg_m2).sqrt(),
        }
    }
}
