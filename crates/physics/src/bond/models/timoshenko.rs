//! The beam with shear deformation (Chen et al. 2022, table 9; Brown et al. 2014).

use crate::bond::rod::{Rod, RodModel, Stiffness};

/// Beam with shear deformation, shear form factor 10/9:
///
/// k_s = 12 E I/(L^3 (1 + Phi)), Phi = 20 r^2 (1 + nu)/(3 L^2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timoshenko;

impl RodModel for Timoshenko {
    fn stiffness(&self, rod: &Rod) -> Stiffness {
        let (length, radius) = (rod.shape.length_m, rod.shape.radius_m);
        let phi = 20.0 * radius.powi(2) * (1.0 + rod.poisson_ratio) / (3.0 * length.powi(2));
        rod.with_shear(rod.beam_n_m() / (1.0 + phi))
    }
}
