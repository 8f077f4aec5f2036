//! MUSEN's elastic solid bond (Dosta et al. 2013).

use crate::bond::rod::{Rod, RodModel, Stiffness};

/// Each mode as for a rod of the bond's length: k_s = G A/L.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticSolid;

impl RodModel for ElasticSolid {
    fn stiffness(&self, rod: &Rod) -> Stiffness {
        rod.with_shear(rod.shear_modulus_pa() * rod.area_m2() / rod.shape.length_m)
    }
}
