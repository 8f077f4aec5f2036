//! How contacts squeeze a clump.

use nalgebra::{Matrix3, Vector3};

/// The contacts of a clump at the end of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Squeeze {
    /// Largest force of a single contact, N.
    pub(crate) largest_n: f64,
    /// Sum over the contacts of their force times the way from the clump's centre to the contact
    /// point (dyadic products), N m: the mean stress (Love 1927, Weber 1966) times the volume.
    moment_n_m: Matrix3<f64>,
}

impl Squeeze {
    /// Largest principal value, by magnitude, of the mean stress in this volume, m3, in Pa. The
    /// antisymmetric part, which belongs to a torque on the clump, is left out.
    pub(crate) fn principal_stress_pa(&self, volume_m3: f64) -> f64 {
        let symmetric = 0.5 * (self.moment_n_m + self.moment_n_m.transpose());
        symmetric.symmetric_eigenvalues().amax() / volume_m3
    }

    pub(crate) fn add(&mut self, force_n: Vector3<f64>, arm_m: Vector3<f64>) {
        self.largest_n = self.largest_n.max(force_n.norm());
        self.moment_n_m += force_n * arm_m.transpose();
    }
}
