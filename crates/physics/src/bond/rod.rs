//! A bond as a round rod: the common part of the bond models.

use std::f64::consts::PI;

/// A bond before it is loaded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondShape {
    /// Distance between the centres, m.
    pub length_m: f64,
    /// Radius of the bond, m.
    pub radius_m: f64,
    /// Radii of the spheres at its two ends, m.
    pub end_radii_m: [f64; 2],
}

/// Stiffness of a bond in tension, shear, torsion and bending, and the position of its contact
/// point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness<T = f64> {
    /// Along the bond, N/m.
    pub normal: T,
    /// Across the bond at the contact point, N/m.
    pub shear: T,
    /// Torsion, N m/rad.
    pub torsion: T,
    /// Bending, N m/rad.
    pub bending: T,
    /// Distances of the contact point from the two centres, m; their sum is the bond's length.
    pub levers_m: [T; 2],
}

/// A bond as a round rod.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rod {
    /// Before it is loaded.
    pub shape: BondShape,
    /// Young's modulus, Pa.
    pub young_modulus_pa: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
}

impl Rod {
    /// A, m2.
    pub fn area_m2(&self) -> f64 {
        PI * self.shape.radius_m.powi(2)
    }

    /// I, m4.
    pub fn second_moment_m4(&self) -> f64 {
        0.25 * PI * self.shape.radius_m.powi(4)
    }

    /// G, Pa.
    pub fn shear_modulus_pa(&self) -> f64 {
        self.young_modulus_pa / (2.0 * (1.0 + self.poisson_ratio))
    }

    /// E A/L, N/m.
    pub fn normal_n_m(&self) -> f64 {
        self.young_modulus_pa * self.area_m2() / self.shape.length_m
    }

    /// Levers of which the longer one, of this length, m, is at the larger sphere. The other is
    /// what remains, so that their sum is the length to the last bit.
    pub fn levers_m(&self, longer_m: f64) -> [f64; 2] {
        let shorter_m = self.shape.length_m - longer_m;
        let [radius_a, radius_b] = self.shape.end_radii_m;
        if radius_a >= radius_b {
            [longer_m, shorter_m]
        } else {
            [shorter_m, longer_m]
        }
    }

    /// Ratio of normal to shear stiffness: 2 (1 + nu) unless given.
    pub fn kappa(&self, given: Option<f64>) -> f64 {
        given.unwrap_or(2.0 * (1.0 + self.poisson_ratio))
    }

    /// 12 E I/L^3, N/m: transverse stiffness of a slender beam whose ends do not rotate.
    pub fn beam_n_m(&self) -> f64 {
        12.0 * self.young_modulus_pa * self.second_moment_m4() / self.shape.length_m.powi(3)
    }

    /// Stiffness with this shear stiffness, N/m, and shear in the middle. The others are those of a
    /// round rod: k_n = E A/L, k_tor = G J/L and k_ben = E I/L, with J = 2 I and I = A r^2/4.
    pub fn with_shear(&self, shear_n_m: f64) -> Stiffness {
        let length = self.shape.length_m;
        let second_moment = self.second_moment_m4();
        Stiffness {
            normal: self.normal_n_m(),
            shear: shear_n_m,
            torsion: 2.0 * self.shear_modulus_pa() * second_moment / length,
            bending: self.young_modulus_pa * second_moment / length,
            levers_m: [0.5 * length; 2],
        }
    }
}

/// A bond model: the stiffness of a rod.
pub trait RodModel {
    /// Stiffness of the rod in its four modes, and the position along it where shear acts.
    fn stiffness(&self, rod: &Rod) -> Stiffness;
}
