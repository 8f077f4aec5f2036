//! The flat joint (Potyondy 2012) while all its elements hold: a parallel bond in the middle whose
//! moments are those of the elements.

use crate::bond::rod::{Rod, RodModel, Stiffness};

/// k_s = k_n/kappa, k_ben = m k_n r^2/4 and k_tor = m k_s r^2/2, with the ratio m of the second
/// moments. The section is in the middle of the bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatJoint {
    /// Ratio of normal to shear stiffness, 2 (1 + nu) unless given.
    pub kappa: Option<f64>,
    /// Second moment of the elements over that of the disc.
    pub moment_ratio: f64,
}

impl RodModel for FlatJoint {
    fn stiffness(&self, rod: &Rod) -> Stiffness {
        let shear = rod.normal_n_m() / rod.kappa(self.kappa);
        let disc = rod.with_shear(shear);
        Stiffness {
            torsion: self.moment_ratio * 0.5 * shear * rod.shape.radius_m.powi(2),
            bending: self.moment_ratio * disc.bending,
            ..disc
        }
    }
}
