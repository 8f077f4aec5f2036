//! The slender beam without shear deformation (Chen et al. 2022, table 9; Andre
//! et al. 2012).

use crate::physics::bond::rod::{Rod, RodModel, Stiffness};

/// Slender beam: no shear deformation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EulerBernoulli;

impl RodModel for EulerBernoulli {
    fn stiffness(&self, rod: &Rod) -> Stiffness {
        rod.with_shear(rod.beam_n_m())
    }
}
