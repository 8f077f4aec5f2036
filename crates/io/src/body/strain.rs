//! How the bonds of a body are strained, for formats of files that do not hold it.

use nalgebra::{UnitQuaternion, Vector3};

use super::histories::are_loaded;
use super::parts::Body;

/// Largest strain that counts as rounding: change of length over length, or angle, rad.
const NONE: f64 = 1e-6;

impl Body {
    /// Whether any bond is longer or shorter than without load.
    pub(super) fn is_stretched(&self) -> bool {
        let mut bonds = self.bonds.iter().zip(&self.bond_lengths);
        bonds.any(|(ends, length)| (self.apart_m(ends).norm() / length - 1.0).abs() > NONE)
    }

    /// Whether any bond is bent, twisted or sheared, beyond its plastic deformation.
    pub(super) fn is_sheared(&self) -> bool {
        if are_loaded(&self.bond_histories) {
            return true;
        }
        let mut bonds = self.bonds.iter().zip(&self.bond_directions);
        bonds.any(|(ends, direction)| {
            let [a, b] = ends.map(|end| {
                let turn = self.turns_rad.get(end as usize).copied();
                UnitQuaternion::from_scaled_axis(Vector3::from(turn.unwrap_or_default()))
            });
            let direction = Vector3::from(*direction);
            let mean = 0.5 * (a * direction + b * direction);
            let sheared = (mean - self.apart_m(ends).normalize()).norm();
            sheared.max(a.angle_to(&b)) > NONE
        })
    }

    /// From the first to the second particle of a bond, m.
    fn apart_m(&self, ends: &[u32; 2]) -> Vector3<f64> {
        let [a, b] = ends.map(|end| Vector3::from(self.positions[end as usize]));
        b - a
    }
}
