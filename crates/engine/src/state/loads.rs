//! Loads, and the course of loads and motions over time.

use dem_io::interpolation::interpolated;
use dem_scene::Factor;
use serde::{Deserialize, Serialize};

use super::renumbered::{NewNumbers, Renumbered};

/// A load on some particles, the same on each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupLoad {
    /// The particles.
    pub particles: Vec<u32>,
    /// Force on each, N. Length 3.
    pub force_n: [f64; 3],
    /// Torque on each, N m. Length 3.
    pub torque_n_m: [f64; 3],
    /// Course over time.
    pub factor: Factor,
    /// Time from which on the load is zero, s; infinite: never.
    pub end_s: f64,
}

impl GroupLoad {
    /// Factor on the load in the kick at `time_s`, which covers half of the previous step and half
    /// of the next, `steps_s`. If the load ends in between, the factor is reduced to its fraction
    /// of that time, so that its impulse does not depend on the steps.
    pub(crate) fn factor_in_kick(&self, time_s: f64, steps_s: [f64; 2]) -> f64 {
        let factor = factor_at(&self.factor, time_s);
        if self.end_s.is_infinite() {
            return factor;
        }
        let [from_s, until_s] = [time_s - 0.5 * steps_s[0], time_s + 0.5 * steps_s[1]];
        factor * ((self.end_s - from_s) / (until_s - from_s)).clamp(0.0, 1.0)
    }
}

/// Value of a factor at a time.
pub fn factor_at(factor: &Factor, time_s: f64) -> f64 {
    match factor {
        Factor::One => 1.0,
        Factor::Ramp { until_s } => (time_s / until_s).clamp(0.0, 1.0),
        Factor::Table(points) => interpolated(points, time_s).unwrap_or(1.0),
        Factor::Oscillation {
            frequency_hz,
            phase_rad,
        } => (std::f64::consts::TAU * frequency_hz * time_s + phase_rad).sin() - phase_rad.sin(),
    }
}

impl Renumbered for GroupLoad {
    fn renumber(&mut self, by: &NewNumbers<'_>) {
        by.renumber(&mut self.particles);
    }
}
