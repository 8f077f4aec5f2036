//! What a contact remembers from step to step, as it lies in memory.

use serde::{Deserialize, Serialize};

/// History of a contact. Two cache lines; contacts without rolling friction use only the first.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[repr(C, align(64))]
pub struct ContactHistory {
    /// Tangential displacement x, y, z and the overlap of the law, m.
    pub tangential: [f64; 4],
    /// Damping force on the second end x, y, z, N, and the overlap at which the law begins, m,
    /// which is 0 except for pairs that
    /// [separated while overlapping](super::relaxation).
    pub damping: [f64; 4],
    /// Rolling displacement x, y, z, rad, and an unused number.
    pub rolling: [f64; 4],
    /// Damping moment on the second end x, y, z, N m, and an unused number.
    pub rolling_damping: [f64; 4],
}

impl ContactHistory {
    /// The history of a pair whose law begins at this overlap, m.
    pub fn separated_at(overlap_m: f64) -> Self {
        Self {
            damping: [0.0, 0.0, 0.0, overlap_m.max(0.0)],
            ..Self::default()
        }
    }

    /// The history of a pair with this overlap of the law, m, and nothing else.
    pub fn pressed_by(overlap_m: f64) -> Self {
        Self {
            tangential: [0.0, 0.0, 0.0, overlap_m.max(0.0)],
            ..Self::default()
        }
    }

    /// Whether there is anything in it.
    pub fn remembers(&self) -> bool {
        *self != Self::default()
    }

    /// The history with the two particles exchanged.
    pub fn reversed(&self) -> Self {
        let back = |[x, y, z, last]: [f64; 4]| [-x, -y, -z, last];
        Self {
            tangential: back(self.tangential),
            damping: back(self.damping),
            rolling: back(self.rolling),
            rolling_damping: back(self.rolling_damping),
        }
    }

    /// Overlap of the law, m; above 0 if the two press on each other.
    #[inline(always)]
    pub fn overlap_m(&self) -> f64 {
        self.tangential[3]
    }

    /// Whether the two have parted, and a force is still to be counted back.
    #[inline(always)]
    pub fn ends_with_a_jump(&self) -> bool {
        let [x, y, z, _] = self.damping;
        self.overlap_m() == 0.0 && [x, y, z] != [0.0; 3]
    }

    /// Overlap at which the law begins, m.
    #[inline(always)]
    pub fn origin_m(&self) -> f64 {
        self.damping[3]
    }
}

/// A contact between a particle and a wall, with its history.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WallContact {
    /// Number of the particle.
    pub particle: u32,
    /// Feature of the wall: see [`crate::geometry::Touch`].
    pub feature: u32,
    /// Unit vector from the wall to the centre. Length 3.
    pub normal: [f64; 3],
    /// Displacements, overlap and origin.
    pub history: ContactHistory,
}
