//! Closed forms of linear elastic fracture mechanics.

use std::f64::consts::PI;

use dem_laboratory::Line;

/// Shape function k of a beam with a notch of `depth` (over its height) bent at three points over a
/// span of `span` heights: `K_I = sigma sqrt(D) k`, with the stress of the beam without notch,
/// `sigma = 3 P S/(2 B D^2)`. Within 0.5 % for spans from 2.5 heights on, any depth
/// (Guinea et al. 1998).
pub(crate) fn beam_shape(depth: f64, span: f64) -> f64 {
    let left = 1.0 - depth;
    let at_4 =
        1.900 - depth * (-0.089 + 0.603 * left - 0.441 * left.powi(2) + 1.223 * left.powi(3));
    let at_infinity = 1.989 - depth * left * (0.448 - 0.458 * left + 1.226 * left.powi(2));
    let shape = at_infinity + 4.0 / span * (at_4 - at_infinity);
    depth.sqrt() / (left.powf(1.5) * (1.0 + 2.0 * depth)) * shape
}

/// Stress of a beam without notch under a load in the middle of its span, Pa.
pub(crate) fn bending_stress_pa(load_n: f64, span_m: f64, width_m: f64, height_m: f64) -> f64 {
    1.5 * load_n * span_m / (width_m * height_m * height_m)
}

/// Opening of the mouth of a notch over stress, height and modulus, `V = 4 sigma a v/E`, of a beam
/// that is bent at three points over a span of `span` heights (Guinea et al. 1998; over four
/// heights that of Tada et al. 2000, 2.17).
pub(crate) fn mouth_opening(depth: f64, span: f64) -> f64 {
    let of_span = -0.04 - 0.58 * depth + 1.47 * depth.powi(2) - 2.04 * depth.powi(3);
    let v = 0.8 - 1.7 * depth
        + 2.4 * depth.powi(2)
        + 0.66 / (1.0 - depth).powi(2)
        + 4.0 / span * of_span;
    4.0 * depth * v
}

/// A double cantilever with side grooves: arms of this height, the width, that between the grooves.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cantilevers {
    pub(crate) arm_m: f64,
    pub(crate) width_m: f64,
    pub(crate) groove_width_m: f64,
}

impl Cantilevers {
    /// K_I under a load at this distance from the front of the crack, Pa sqrt(m)
    /// (Wiederhorn et al. 1968: `12 P^2 a^2/(E B^2 h^3)` with shear and the give of the root).
    pub(crate) fn intensity(&self, load_n: f64, crack_m: f64) -> f64 {
        let width_m = (self.width_m * self.groove_width_m).sqrt();
        let root = 3.467 + 2.315 * self.arm_m / crack_m;
        load_n * crack_m / (width_m * self.arm_m.powf(1.5)) * root
    }

    /// Load over the opening where it pulls, N/m: two cantilevers, each longer by two thirds of its
    /// height, which gives that K_I.
    pub(crate) fn stiffness(&self, young_pa: f64, crack_m: f64) -> f64 {
        let length_m = crack_m + 2.315 / 3.467 * self.arm_m;
        young_pa * self.width_m * (self.arm_m / length_m).powi(3) / 8.0
    }
}

/// K_I of a disc with a crack of `half_crack` (half its length over the radius) through its middle
/// along the load, over `P/(B sqrt(R))`: `sqrt(half_crack/pi) N_I` (Atkinson et al. 1982, with N_I
/// as Fowell and Xu 1993 fit it, for 0.05 to 0.95).
pub(crate) fn disc_shape(half_crack: f64) -> f64 {
    let n = 0.991 + 0.141 * half_crack + 0.863 * half_crack.powi(2) + 0.886 * half_crack.powi(3);
    (half_crack / PI).sqrt() * n
}

/// Bazant's size effect `sigma_N = B f_t/sqrt(1 + D/D_0)`, fitted by least squares of
/// `1/sigma_N^2` over D (Bazant 1984).
#[derive(Debug, Clone, Copy)]
pub(crate) struct SizeEffect {
    /// `B f_t`: strength of a small specimen, Pa.
    pub(crate) small_pa: f64,
    /// `D_0`: size at the transition, m.
    pub(crate) transition_m: f64,
}

impl SizeEffect {
    /// The law through points of size, m, and nominal strength, Pa. None: they do not fall with the
    /// size.
    pub(crate) fn of(points: &[[f64; 2]]) -> Option<Self> {
        let sizes: Vec<f64> = points.iter().map(|point| point[0]).collect();
        let inverse: Vec<f64> = points.iter().map(|point| point[1].powi(-2)).collect();
        let line = Line::fitted(&sizes, &inverse);
        let (slope, start) = (line.slope, line.at(0.0));
        (slope > 0.0 && start > 0.0).then(|| Self {
            small_pa: start.powf(-0.5),
            transition_m: start / slope,
        })
    }

    pub(crate) fn strength_pa(&self, size_m: f64) -> f64 {
        self.small_pa / (1.0 + size_m / self.transition_m).sqrt()
    }

    /// Toughness of a specimen without end: `B f_t sqrt(D_0) k`, Pa sqrt(m).
    pub(crate) fn toughness(&self, shape: f64) -> f64 {
        self.small_pa * self.transition_m.sqrt() * shape
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// Srawley 1976, ASTM E399: K for a span of four heights, within 0.5 %.
    fn srawley(depth: f64) -> f64 {
        let left = 1.0 - depth;
        let sum = 1.99 - depth * left * (2.15 - 3.93 * depth + 2.7 * depth * depth);
        3.0 * depth.sqrt() * sum / (2.0 * (1.0 + 2.0 * depth) * left.powf(1.5)) * 4.0 / 6.0
    }

    #[test]
    fn beams_are_those_of_the_standard() {
        for depth in [0.3, 0.4, 0.5, 0.6, 0.8] {
            let off = beam_shape(depth, 4.0) / srawley(depth) - 1.0;
            assert!(off.abs() < 0.005, "{depth}: {off}");
        }
        // A deep notch in pure bending: K = 3.975 M/(B b^1.5) (Tada et al. 2000).
        let deep = beam_shape(0.999, 1e9) * 0.001_f64.powf(1.5) * 6.0;
        assert!((deep / 3.975 - 1.0).abs() < 0.005, "{deep}");
        // A shallow one: 1.1215 sigma sqrt(pi a).
        let shallow = beam_shape(1e-4, 1e9) / (PI * 1e-4).sqrt();
        assert!((shallow / 1.1215 - 1.0).abs() < 0.005, "{shallow}");
    }

    /// Tada et al. 2000, 2.17: `v = 0.76 - 2.28 x + 3.87 x^2 - 2.04 x^3 + 0.66/(1 - x)^2`.
    #[test]
    fn mouths_open_as_in_the_handbook() {
        for x in [0.2_f64, 0.5, 0.7] {
            let v =
                0.76 - 2.28 * x + 3.87 * x.powi(2) - 2.04 * x.powi(3) + 0.66 / (1.0 - x).powi(2);
            assert!((mouth_opening(x, 4.0) / (4.0 * x * v) - 1.0).abs() < 1e-12);
        }
    }

    /// The derivative of the compliance is the energy release rate: `G = P^2/(2 B) dC/da = K^2/E`.
    #[test]
    fn cantilevers_release_what_their_compliance_says() {
        let specimen = Cantilevers {
            arm_m: 0.05,
            width_m: 0.05,
            groove_width_m: 0.05,
        };
        let young_pa = 20e9;
        for crack_m in [0.1, 0.15, 0.2] {
            let compliance = |crack_m| 1.0 / specimen.stiffness(young_pa, crack_m);
            let slope = (compliance(crack_m + 1e-6) - compliance(crack_m - 1e-6)) / 2e-6;
            let released = 1e6 * slope / (2.0 * 0.05);
            let k = specimen.intensity(1e3, crack_m);
            // 3.467 is rounded: its square is 12.02.
            assert!((k * k / young_pa / released - 1.0).abs() < 2e-3);
        }
    }

    /// Values of N_I of Atkinson et al. 1982, table 1, and that of a small crack in the stress of
    /// the disc.
    #[test]
    fn discs_are_those_of_the_source() {
        for (half_crack, n) in [
            (0.2, 1.060),
            (0.3, 1.135),
            (0.4, 1.243),
            (0.5, 1.387),
            (0.6, 1.578),
        ] {
            let found = disc_shape(half_crack) / (half_crack / PI).sqrt();
            assert!((found / n - 1.0).abs() < 0.005, "{half_crack}: {found}");
        }
    }

    #[test]
    fn the_size_effect_is_found_again() {
        let law = SizeEffect {
            small_pa: 3e6,
            transition_m: 0.07,
        };
        let points = [0.05, 0.1, 0.2].map(|size_m| [size_m, law.strength_pa(size_m)]);
        let found = SizeEffect::of(&points).unwrap();
        assert!((found.small_pa / law.small_pa - 1.0).abs() < 1e-9);
        assert!((found.transition_m / law.transition_m - 1.0).abs() < 1e-9);
        assert!(SizeEffect::of(&[[0.1, 1e6], [0.2, 2e6]]).is_none());
    }
}
