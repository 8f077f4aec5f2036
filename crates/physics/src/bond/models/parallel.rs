//! The parallel bond (Potyondy and Cundall 2004; Chen et al. 2022, table 9).

use crate::bond::rod::{Rod, RodModel, Stiffness};

/// Springs spread over the section: k_n = E A/L, k_s = k_n/kappa, k_ben = k_n r^2/4 and
/// k_tor = k_s r^2/2. Shear acts halfway between the surfaces of the spheres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parallel {
    /// Ratio of normal to shear stiffness, 2 (1 + nu) unless given.
    pub kappa: Option<f64>,
}

impl RodModel for Parallel {
    fn stiffness(&self, rod: &Rod) -> Stiffness {
        let shear = rod.normal_n_m() / rod.kappa(self.kappa);
        let (length, radius) = (rod.shape.length_m, rod.shape.radius_m);
        let [radius_a, radius_b] = rod.shape.end_radii_m;
        let longer = 0.5 * (length + (radius_a - radius_b).abs());
        Stiffness {
            torsion: 0.5 * shear * radius.powi(2),
            levers_m: rod.levers_m(longer),
            ..rod.with_shear(shear)
        }
    }
}
