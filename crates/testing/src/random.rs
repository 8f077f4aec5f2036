//! Random numbers for tests.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Pseudo-random numbers (SplitMix64).
pub struct Random(pub u64);

impl Random {
    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// From 0 to 1.
    pub fn fraction(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Between two bounds.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.fraction()
    }

    /// In a cube around the origin.
    pub fn point(&mut self, half: f64) -> [f64; 3] {
        [0; 3].map(|_| self.within(-half, half))
    }

    /// On the unit sphere.
    pub fn direction(&mut self) -> Vector3<f64> {
        loop {
            let v = Vector3::from(self.point(1.0));
            if v.norm() > 0.1 && v.norm() < 1.0 {
                return v.normalize();
            }
        }
    }

    /// Any rotation.
    pub fn rotation(&mut self) -> UnitQuaternion<f64> {
        loop {
            let q = [0; 4].map(|_| self.within(-1.0, 1.0));
            let q = Quaternion::new(q[0], q[1], q[2], q[3]);
            if q.norm() > 0.1 && q.norm() < 1.0 {
                return UnitQuaternion::new_normalize(q);
            }
        }
    }
}
