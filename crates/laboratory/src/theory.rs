//! Closed-form solutions of the tests: Euler-Bernoulli and Timoshenko beams, the disc, the bar.

/// A beam of rectangular section on two supports, loaded halfway between them by one pin or,
/// symmetrically, by two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// Support span, m. Platzer 2022 calls it the length of the sample.
    pub span_m: f64,
    /// Loading span, m; 0: one pin.
    pub loading_span_m: f64,
    /// Width of the section, across the load, m.
    pub width_m: f64,
    /// Height of the section, along the load, m.
    pub height_m: f64,
}

/// Shear coefficient of a rectangle: 5/6, from the energy of the parabolic shear stress.
pub const KAPPA: f64 = 5.0 / 6.0;

impl Beam {
    /// Second moment of area, m4.
    pub fn second_moment_m4(&self) -> f64 {
        self.width_m * self.height_m.powi(3) / 12.0
    }

    /// Distance of a support from the nearest loading pin, m.
    pub fn arm_m(&self) -> f64 {
        0.5 * (self.span_m - self.loading_span_m)
    }

    /// Bending stiffness of a body of modulus 1 Pa: force over deflection at the loading pins, m.
    /// Platzer 2022, eq. 18.
    pub fn bending_shape_m(&self) -> f64 {
        let (span, load) = (self.span_m, self.loading_span_m);
        48.0 * self.second_moment_m4() / ((span - load).powi(2) * (span + 2.0 * load))
    }

    /// Deflection at the loading pins under a total force on them, m, without shear. Platzer 2022,
    /// eq. 18; F L^3/(48 E I) for one pin.
    pub fn deflection_m(&self, force_n: f64, young_modulus_pa: f64) -> f64 {
        force_n / (young_modulus_pa * self.bending_shape_m())
    }

    /// Shear contribution to the deflection at the loading pins, m: F a/(2 kappa G A).
    pub fn shear_deflection_m(
        &self,
        force_n: f64,
        young_modulus_pa: f64,
        poisson_ratio: f64,
        kappa: f64,
    ) -> f64 {
        let shear_modulus_pa = young_modulus_pa / (2.0 * (1.0 + poisson_ratio));
        let area_m2 = self.width_m * self.height_m;
        0.5 * force_n * self.arm_m() / (kappa * shear_modulus_pa * area_m2)
    }

    /// Ratio of shear to bending in the deflection at the loading pins.
    pub fn shear_over_bending(&self, poisson_ratio: f64, kappa: f64) -> f64 {
        self.shear_deflection_m(1.0, 1.0, poisson_ratio, kappa) / self.deflection_m(1.0, 1.0)
    }

    /// Ratio of force to deflection at the loading pins with shear, N/m.
    pub fn stiffness_n_m(&self, young_modulus_pa: f64, poisson_ratio: f64, kappa: f64) -> f64 {
        let shear = self.shear_over_bending(poisson_ratio, kappa);
        young_modulus_pa * self.bending_shape_m() / (1.0 + shear)
    }

    /// Largest bending stress under a total force on the loading pins, Pa. Platzer 2022, eq. 19; 3
    /// F L/(2 b h^2) for one pin.
    pub fn stress_pa(&self, force_n: f64) -> f64 {
        1.5 * force_n * (self.span_m - self.loading_span_m)
            / (self.width_m * self.height_m * self.height_m)
    }

    /// Force at which the largest bending stress is this, N: Platzer 2022, eq. 19, inverted.
    pub fn force_n(&self, stress_pa: f64) -> f64 {
        stress_pa / self.stress_pa(1.0)
    }
}

/// Tension across the loaded diameter of a disc, Pa: 2 F/(pi D t). Brazilian test; ISRM 1978, ASTM
/// D3967.
pub fn disc_stress_pa(force_n: f64, diameter_m: f64, thickness_m: f64) -> f64 {
    2.0 * force_n / (std::f64::consts::PI * diameter_m * thickness_m)
}

/// Young's modulus of a disc from the approach of two points of its loaded diameter, Pa:
/// E = 2 k/(pi t) [2 ln((D + G)/(D - G)) - (1 - nu) G/D] for a force of k per approach, N/m, of two
/// points at G/2 on both sides of the centre, m. It is the integral of the strain under two
/// opposite point loads, in plane stress (Timoshenko and Goodier 1970, article 41).
pub fn disc_modulus_pa(
    stiffness_n_m: f64,
    diameter_m: f64,
    thickness_m: f64,
    gauge_m: f64,
    poisson_ratio: f64,
) -> f64 {
    let ends = ((diameter_m + gauge_m) / (diameter_m - gauge_m)).ln();
    let shape = 2.0 * ends - (1.0 - poisson_ratio) * gauge_m / diameter_m;
    2.0 * stiffness_n_m * shape / (std::f64::consts::PI * thickness_m)
}

/// Stress of a bar under a force along it, Pa.
pub fn bar_stress_pa(force_n: f64, area_m2: f64) -> f64 {
    force_n / area_m2
}

/// Result of a triaxial test: its largest principal stress at failure.
pub const PEAK_AXIAL_STRESS: &str = "axial stress at failure";
/// Result of a direct shear test: its largest shear stress.
pub const PEAK_SHEAR_STRESS: &str = "strength";

/// Cohesion, Pa, and friction angle, rad, of a material whose largest principal stress at failure
/// is `intercept_pa` without confining pressure and rises by `slope` with it:
/// sigma_1 = sigma_3 tan²(45° + phi/2) + 2 c tan(45° + phi/2) (Mohr and Coulomb; Jaeger, Cook and
/// Zimmerman 2007, section 4.5).
pub fn mohr_coulomb_of_peaks(slope: f64, intercept_pa: f64) -> (f64, f64) {
    let root = slope.sqrt();
    let angle_rad = 2.0 * root.atan() - std::f64::consts::FRAC_PI_2;
    (0.5 * intercept_pa / root, angle_rad)
}

/// Stress in a disc of this diameter and thickness under two opposite forces, Pa, on the loaded
/// diameter at a distance from the centre, m: across the diameter and along it, positive in
/// tension.
/// 2 F/(pi D t), and -2 F/(pi t) (2/(D - 2 y) + 2/(D + 2 y) - 1/D) (Timoshenko and Goodier 1970,
/// article 41).
pub fn disc_diameter_pa(
    force_n: f64,
    diameter_m: f64,
    thickness_m: f64,
    from_centre_m: f64,
) -> [f64; 2] {
    let scale = 2.0 * force_n / (std::f64::consts::PI * thickness_m);
    let (d, y) = (diameter_m, from_centre_m);
    let along = 2.0 / (d - 2.0 * y) + 2.0 / (d + 2.0 * y) - 1.0 / d;
    [scale / d, -scale * along]
}

/// Ratio of the first frequency of a beam supported at its ends to that of the same free beam:
/// (pi/4.7300)^2.
pub const ON_PINS: f64 = 0.441_133_4;
