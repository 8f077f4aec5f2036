//! What touches the spheres of clumps in a step.

use nalgebra::{Matrix3, Vector3};

/// Sums over the contacts that touch a sphere of a clump. Valid for one step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ClumpTouch {
    /// Number of contacts.
    pub count: u32,
    /// Stiffness k times n n^T, with the unit normal n, N/m: xx, yy, zz, xy, xz, yz.
    pub stiffness_n_m: [f64; 6],
    /// k s n, with the speed s of the other end along n relative to the sphere, N/s.
    pub rate_n_s: [f64; 3],
    /// k s^2, W/s.
    pub rate_w_s: f64,
}

impl ClumpTouch {
    /// Adds a contact with this normal and stiffness, N/m, at whose other end the sphere moves with
    /// `velocity_m_s`.
    #[inline]
    pub fn add(&mut self, normal: &Vector3<f64>, stiffness_n_m: f64, velocity_m_s: &Vector3<f64>) {
        let n = stiffness_n_m * normal;
        let along_m_s = normal.dot(velocity_m_s);
        self.count += 1;
        let products = [
            n.x * normal.x,
            n.y * normal.y,
            n.z * normal.z,
            n.x * normal.y,
            n.x * normal.z,
            n.y * normal.z,
        ];
        for (sum, product) in self.stiffness_n_m.iter_mut().zip(products) {
            *sum += product;
        }
        for (sum, n) in self.rate_n_s.iter_mut().zip(n.iter()) {
            *sum += along_m_s * n;
        }
        self.rate_w_s += stiffness_n_m * along_m_s * along_m_s;
    }

    /// Sum of the stiffness, N/m.
    pub fn sum_n_m(&self) -> f64 {
        self.stiffness_n_m[..3].iter().sum()
    }

    /// Sum of k n n^T, N/m.
    pub fn matrix_n_m(&self) -> Matrix3<f64> {
        let [xx, yy, zz, xy, xz, yz] = self.stiffness_n_m;
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }
}
