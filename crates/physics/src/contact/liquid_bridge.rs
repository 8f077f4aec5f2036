//! Pendular liquid bridges: two wet ends that have touched are pulled together by the surface
//! tension of the liquid between them, until the bridge ruptures.
//!
//! - Willett et al. 2000, eq. 12: F = 2 pi R gamma cos(theta)/(1 + 1.05 x + 2.5 x^2), with the gap
//!   s of the surfaces and x = s sqrt(R/V) (there 2.1 and 10, for half the gap). It fits their
//!   numerical solutions for small volumes, V/R^3 up to about 0.001.
//! - R is Derjaguin's radius 2 R_a R_b/(R_a + R_b) = 2 R*; at a wall twice that of the sphere.
//! - Ends that overlap attract each other as at a gap of 0: F = 4 pi R* gamma cos(theta).
//! - Rupture at the gap (1 + theta/2) V^(1/3) (Lian et al. 1993, for theta up to 40 degrees).
//!
//! Weight of the liquid, its viscosity and its exchange between bridges are left out.

use serde::Serialize;
use std::f64::consts::PI;

/// Coefficients of x and x^2 in the force.
const LINEAR: f64 = 1.05;
const SQUARE: f64 = 2.5;
/// The largest of -d/dx of 1/(1 + 1.05 x + 2.5 x^2), which is at x = 0.1344.
const STEEPEST: f64 = 1.223_658;

/// The bridges of a pair of materials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LiquidBridge {
    /// gamma, N/m.
    pub surface_tension_n_m: f64,
    /// theta, rad, less than pi/2.
    pub contact_angle_rad: f64,
    /// V, of each bridge, m3.
    pub volume_m3: f64,
}

impl LiquidBridge {
    /// Gap at which a bridge ruptures, m.
    pub fn rupture_m(&self) -> f64 {
        (1.0 + 0.5 * self.contact_angle_rad) * self.volume_m3.cbrt()
    }

    /// Force between ends that touch, with this effective radius R*, m, in N.
    pub fn largest_n(&self, effective_radius_m: f64) -> f64 {
        4.0 * PI * effective_radius_m * self.surface_tension_n_m * self.contact_angle_rad.cos()
    }

    /// x over s, 1/m.
    fn scale_1_m(&self, effective_radius_m: f64) -> f64 {
        (2.0 * effective_radius_m / self.volume_m3).sqrt()
    }

    /// Force with which a bridge attracts its ends, N, at a gap of their surfaces, m, with this
    /// effective radius, m.
    pub fn force_n(&self, gap_m: f64, effective_radius_m: f64) -> f64 {
        let x = gap_m.max(0.0) * self.scale_1_m(effective_radius_m);
        self.largest_n(effective_radius_m) / (1.0 + (LINEAR + SQUARE * x) * x)
    }

    /// The fall of the force with the gap, -dF/ds, N/m.
    pub fn fall_n_m(&self, gap_m: f64, effective_radius_m: f64) -> f64 {
        if gap_m <= 0.0 {
            return 0.0;
        }
        let scale = self.scale_1_m(effective_radius_m);
        let x = gap_m * scale;
        let steepness = (LINEAR + 2.0 * SQUARE * x) / (1.0 + (LINEAR + SQUARE * x) * x).powi(2);
        self.largest_n(effective_radius_m) * scale * steepness
    }

    /// The largest such fall at any gap, N/m.
    pub fn steepest_n_m(&self, effective_radius_m: f64) -> f64 {
        STEEPEST * self.largest_n(effective_radius_m) * self.scale_1_m(effective_radius_m)
    }

    /// Energy of a bridge, J: the work from a gap of 0 to this one, m; below 0 for an overlap.
    pub fn energy_j(&self, gap_m: f64, effective_radius_m: f64) -> f64 {
        let largest_n = self.largest_n(effective_radius_m);
        if gap_m <= 0.0 {
            return largest_n * gap_m;
        }
        let scale = self.scale_1_m(effective_radius_m);
        let x = gap_m * scale;
        let root = (4.0 * SQUARE - LINEAR * LINEAR).sqrt();
        largest_n / scale * 2.0 / root * (root * x / (2.0 + LINEAR * x)).atan()
    }

    /// Force of a bridge, N, after a step in which its gap went from one value to another, m, and
    /// the energy that it lost in the step, J: if it formed or ruptured in it, the work of its ends
    /// against the mean of its forces, minus what it stores more.
    pub fn after_step(
        &self,
        effective_radius_m: f64,
        [before_m, now_m]: [f64; 2],
        [was_there, is_there]: [bool; 2],
    ) -> [f64; 2] {
        let at = |gap_m: f64, there: bool| {
            let force_n = if there {
                self.force_n(gap_m, effective_radius_m)
            } else {
                0.0
            };
            let energy_j = || self.energy_j(gap_m, effective_radius_m);
            (force_n, if there { energy_j() } else { 0.0 })
        };
        let (force_n, energy_j) = at(now_m, is_there);
        if was_there && is_there {
            return [force_n, 0.0];
        }
        let (before_n, before_j) = at(before_m, was_there);
        let work_j = 0.5 * (before_n + force_n) * (now_m - before_m);
        [force_n, work_j - (energy_j - before_j)]
    }

    /// Energy that a bridge takes from ends which touch and then separate, J: that at its rupture.
    pub fn work_j(&self, effective_radius_m: f64) -> f64 {
        self.energy_j(self.rupture_m(), effective_radius_m)
    }
}
