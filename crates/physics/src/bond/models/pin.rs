//! The pin: two springs at a point, without moments (Chen et al. 2022, section 1; the linear
//! contact bond of PFC).

use super::parallel::Parallel;
use crate::bond::rod::{Rod, RodModel, Stiffness};

/// E A/L along the bond, this divided by `kappa` across it, at the point halfway between the
/// surfaces of the spheres as for the [parallel bond](Parallel); nothing resists torsion and
/// bending. A row of such bonds is a mechanism: a body needs them in triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pin {
    /// Ratio of normal to shear stiffness, 2 (1 + nu) unless given.
    pub kappa: Option<f64>,
}

impl RodModel for Pin {
    fn stiffness(&self, rod: &Rod) -> Stiffness {
        Stiffness {
            torsion: 0.0,
            bending: 0.0,
            ..Parallel { kappa: self.kappa }.stiffness(rod)
        }
    }
}
