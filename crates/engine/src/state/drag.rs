//! Drag of a fluid at rest on particles.

use serde::{Deserialize, Serialize};

use super::renumbered::{NewNumbers, Renumbered};

/// Drag of a fluid at rest on single particles: a force -c v.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Drag {
    /// c, N s/m.
    pub coefficient_n_s_m: f64,
    /// Force on each particle in the last step, N; 0 on those that clumps carry.
    pub forces_n: Vec<[f64; 3]>,
    /// Energy that each particle has lost, J.
    pub lost_j: Vec<f64>,
    /// The same of particles that are gone, J.
    pub gone_j: f64,
}

impl Drag {
    /// On this number of particles at rest, with c in N s/m.
    pub fn new(coefficient_n_s_m: f64, particles: usize) -> Self {
        Self {
            coefficient_n_s_m,
            forces_n: vec![[0.0; 3]; particles],
            lost_j: vec![0.0; particles],
            gone_j: 0.0,
        }
    }

    /// Energy that all particles have lost, J.
    pub fn total_j(&self) -> f64 {
        self.gone_j + self.lost_j.iter().sum::<f64>()
    }
}

impl Renumbered for Drag {
    fn renumber(&mut self, by: &NewNumbers<'_>) {
        let mut now = Self {
            gone_j: self.gone_j,
            ..Self::new(self.coefficient_n_s_m, by.poses.len())
        };
        for (old, (force_n, lost_j)) in (0..).zip(self.forces_n.iter().zip(&self.lost_j)) {
            match by.of(old) {
                Some(new) => {
                    now.forces_n[new as usize] = *force_n;
                    now.lost_j[new as usize] = *lost_j;
                }
                None => now.gone_j += lost_j,
            }
        }
        *self = now;
    }
}
