//! Resultant loads of walls.

use serde::{Deserialize, Serialize};

/// Resultant load of a wall on the particles that touch it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct WallLoad {
    /// N.
    pub force_n: [f64; 3],
    /// About the wall's pivot, N m.
    pub torque_n_m: [f64; 3],
    /// Power supplied by the surface velocity of a belt, W.
    pub belt_w: f64,
}

impl WallLoad {
    /// Adds a force, N, a torque about the pivot, N m, and a power of the belt, W.
    pub fn add(&mut self, force_n: [f64; 3], torque_n_m: [f64; 3], belt_w: f64) {
        for k in 0..3 {
            self.force_n[k] += force_n[k];
            self.torque_n_m[k] += torque_n_m[k];
        }
        self.belt_w += belt_w;
    }

    /// Power that the wall supplies to the particles while it has this motion, W.
    pub fn power_w(&self, velocity_m_s: [f64; 3], spin_rad_s: [f64; 3]) -> f64 {
        let moving: f64 = (0..3)
            .map(|k| self.force_n[k] * velocity_m_s[k] + self.torque_n_m[k] * spin_rad_s[k])
            .sum();
        moving + self.belt_w
    }
}
