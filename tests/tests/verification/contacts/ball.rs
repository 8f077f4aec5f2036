//! The ball that hits and rolls.

use std::f64::consts::PI;

pub(crate) const RADIUS_M: f64 = 0.01;
pub(crate) const DENSITY_KG_M3: f64 = 2500.0;
pub(crate) const YOUNG_PA: f64 = 70e6;
pub(crate) const POISSON: f64 = 0.25;
pub(crate) const GRAVITY_M_S2: f64 = 9.81;

pub(crate) fn mass_kg() -> f64 {
    DENSITY_KG_M3 * 4.0 / 3.0 * PI * RADIUS_M.powi(3)
}
