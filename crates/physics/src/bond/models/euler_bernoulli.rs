//! The slender beam without shear deformation (Chen et al. 2022, table 9; Andre
//! et al. 2012).

use crate::bond::rod::{Rod, RodModel, Stiffness};

/// Slender beam, without shear deformation: k_s = 12 E I/L^3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EulerBernoulli;

impl RodModel for EulerBernoulli {
    fn stiffness(&self, rod: &Rod) -> Stiffness {
        rod.with_shear(rod.beam_n_m())
    }
}
