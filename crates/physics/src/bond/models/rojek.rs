//! The bond of two segments, each as thick as its sphere (Rojek et al. 2012, as described by Chen
//! et al. 2022, section 2.1).

use std::f64::consts::PI;

use crate::bond::rod::{Rod, RodModel, Stiffness};

/// Two rods in series whose radii and lengths are in proportion to those of their spheres. f is the
/// radius of the bond over that of the smaller sphere: the segments have the areas pi (f R_a)^2 and
/// pi (f R_b)^2. The bond of equal spheres is the
/// [parallel bond](super::parallel::Parallel); touching spheres have
/// k_n = E pi f^2 R_a R_b/(R_a + R_b).
///
/// The source gives the normal stiffness. As for the parallel bond, shear is this divided by
/// `kappa`, and bending and torsion are those of springs spread over the section, whose radius is
/// that of the bond, which also counts in its stresses. Shear acts where the segments meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rojek {
    /// Ratio of normal to shear stiffness, 2 (1 + nu) unless given.
    pub kappa: Option<f64>,
}

impl RodModel for Rojek {
    fn stiffness(&self, rod: &Rod) -> Stiffness {
        let (length, radius) = (rod.shape.length_m, rod.shape.radius_m);
        let radii = rod.shape.end_radii_m;
        let factor = radius / radii[0].min(radii[1]);
        let per_radius = length / (radii[0] + radii[1]);
        let levers_m = rod.levers_m(per_radius * radii[0].max(radii[1]));
        let soft = |end: usize| {
            let area = PI * (factor * radii[end]).powi(2);
            levers_m[end] / (rod.young_modulus_pa * area)
        };
        let normal = 1.0 / (soft(0) + soft(1));
        let kappa = rod.kappa(self.kappa);
        Stiffness {
            normal,
            shear: normal / kappa,
            bending: 0.25 * normal * radius.powi(2),
            torsion: 0.5 * normal / kappa * radius.powi(2),
            levers_m,
        }
    }
}
