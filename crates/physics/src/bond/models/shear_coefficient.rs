//! The beam with a shear coefficient (Platzer 2022, eqs. 6 and 8; Obermayr et al. 2013).

use crate::bond::rod::{Rod, RodModel, Stiffness};

/// Like the elastic solid bond, with the shear stiffness multiplied by a coefficient:
/// k_s = alpha G A/L.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearCoefficient {
    /// Shear coefficient, 0.9 for a circular section.
    pub alpha: f64,
}

impl RodModel for ShearCoefficient {
    fn stiffness(&self, rod: &Rod) -> Stiffness {
        let shear = self.alpha * rod.shear_modulus_pa() * rod.area_m2() / rod.shape.length_m;
        rod.with_shear(shear)
    }
}
