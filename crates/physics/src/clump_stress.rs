//! How contacts squeeze a clump, and whether that would break its bonds.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// The contacts of a clump at the end of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Squeeze {
    /// Largest force of a single contact, N.
    pub largest_n: f64,
    /// Sum over the contacts of their force times the way from the clump's centre to the contact
    /// point (dyadic products), N m: the mean stress (Love 1927, Weber 1966) times the volume.
    moment_n_m: Matrix3<f64>,
}

impl Squeeze {
    /// Largest principal value, by magnitude, of the mean stress in this volume, m3, in Pa. The
    /// antisymmetric part, which belongs to a torque on the clump, is left out.
    pub fn principal_stress_pa(&self, volume_m3: f64) -> f64 {
        principal(&self.moment_n_m) / volume_m3
    }

    /// Adds a contact with this force, N, at this way from the centre, m.
    pub fn add(&mut self, force_n: Vector3<f64>, arm_m: Vector3<f64>) {
        self.largest_n = self.largest_n.max(force_n.norm());
        self.moment_n_m += force_n * arm_m.transpose();
    }
}

/// Largest principal value, by magnitude, of the symmetric part of a matrix.
fn principal(moment: &Matrix3<f64>) -> f64 {
    let symmetric = 0.5 * (moment + moment.transpose());
    symmetric.symmetric_eigenvalues().amax()
}

/// Hits of a rigid clump whose mean stress (Love 1927, Weber 1966), or stress of bending if it is
/// slender, would break its bonds. A hit lasts as long as something touches the clump; its measure
/// is the stress times the volume, N m.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Hits {
    /// Largest value of the present hit, N m; 0 below that which breaks bonds.
    pub now_n_m: f64,
    /// Number of hits that are over, since they were last taken.
    pub over: u32,
    /// The largest value of these, N m.
    pub largest_n_m: f64,
    /// Stress of bending of a slender clump, Pa: in a short hit that which its modes have followed.
    pub bending_pa: f64,
}

impl Hits {
    /// Records the contacts of a step: the sum of their forces times the ways from the clump's
    /// centre to the contact points, N m, or None without a contact.
    pub fn note(&mut self, moment_n_m: Option<&Matrix3<f64>>, breaks_from_n_m: f64) {
        let Some(moment_n_m) = moment_n_m else {
            self.end();
            self.bending_pa = 0.0;
            return;
        };
        // The norm is an upper bound, and cheap.
        if moment_n_m.norm() < breaks_from_n_m.max(self.now_n_m) {
            return;
        }
        let value_n_m = principal(moment_n_m);
        if value_n_m >= breaks_from_n_m {
            self.now_n_m = self.now_n_m.max(value_n_m);
        }
    }

    /// Records the stress of bending of a slender clump that is touched, Pa, and the rate at which
    /// its modes follow it, Pa/s, over a step of `dt`, s.
    pub fn note_bending(
        &mut self,
        [stress_pa, rate_pa_s]: [f64; 2],
        dt: f64,
        volume_m3: f64,
        breaks_from_n_m: f64,
    ) {
        // A clump at rest on others follows the next knock from its static stress on.
        self.bending_pa = stress_pa.min(self.bending_pa + dt * rate_pa_s);
        let value_n_m = self.bending_pa * volume_m3;
        if value_n_m >= breaks_from_n_m {
            self.now_n_m = self.now_n_m.max(value_n_m);
        }
    }

    /// Ends the present hit.
    fn end(&mut self) {
        if self.now_n_m > 0.0 {
            self.over += 1;
            self.largest_n_m = self.largest_n_m.max(self.now_n_m);
            self.now_n_m = 0.0;
        }
    }

    /// The hits that are over, and with `at_end` the present one: their number and largest value,
    /// N m. They are not taken again.
    pub fn take(&mut self, at_end: bool) -> (u32, f64) {
        if at_end {
            self.end();
        }
        let taken = (self.over, self.largest_n_m);
        (self.over, self.largest_n_m) = (0, 0.0);
        taken
    }
}
