//! Loads, and the course of loads and motions over time.

use dem_io::interpolation::interpolated;
use dem_scene::Factor;
use serde::{Deserialize, Serialize};

/// A load on some particles, the same on each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupLoad {
    /// The particles.
    pub particles: Vec<u32>,
    /// On each, N. Length 3.
    pub force_n: [f64; 3],
    /// On each, N m. Length 3.
    pub torque_n_m: [f64; 3],
    /// Over time.
    pub factor: Factor,
    /// From this time on it is zero, s; infinite: never.
    pub end_s: f64,
}

impl GroupLoad {
    /// What the load is multiplied by in the kick at `time_s`, which makes up for half of the step
    /// before and half of the one to come, `steps_s`. Where the load ends in between, its share of
    /// that time: so its impulse is the same whatever the steps.
    pub fn factor_in_kick(&self, time_s: f64, steps_s: [f64; 2]) -> f64 {
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
    }
}
