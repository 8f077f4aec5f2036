//! The parallel bond (Potyondy and Cundall 2004; Chen et al. 2022, table 9).

use crate::physics::bond::rod::{Rod, RodModel, Stiffness};

/// Shear stiffness is the normal stiffness divided by `kappa`; shear acts halfway between the
/// surfaces of the spheres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Parallel {
    /// Ratio of normal to shear stiffness, 2 (1 + nu) unless given.
    pub kappa: Option<f64>,
}

impl RodModel for Parallel {
    fn stiffness(&self, rod: &Rod) -> Stiffness {
        let kappa = self.kappa.unwrap_or(2.0 * (1.0 + rod.poisson_ratio));
        let shear = rod.normal_n_m() / kappa;
        let (length, radius) = (rod.shape.length_m, rod.shape.radius_m);
        let [radius_a, radius_b] = rod.shape.end_radii_m;
        // The longer lever first: the remaining length for the other is then exact, and their sum
        // is the length to the last bit.
        let longer = 0.5 * (length + (radius_a - radius_b).abs());
        let shorter = length - longer;
        Stiffness {
            torsion: 0.5 * shear * radius.powi(2),
            levers_m: if radius_a >= radius_b {
                [longer, shorter]
            } else {
                [shorter, longer]
            },
            ..rod.with_shear(shear)
        }
    }
}
