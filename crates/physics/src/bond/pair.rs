//! Two particles joined by one bond: their frequencies, in closed form, and the largest time step.
//!
//! Small undamped motion about the unloaded bond. A particle with several bonds oscillates faster
//! than any of its pairs: the critical step of a body is smaller than the smallest of its pairs
//! (down to 0.71 of it in a chain of equal spheres), and only an eigenvalue of the entire body
//! gives the limit.

use super::stiffness::Stiffness;

/// Angular frequencies of a pair, rad/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frequencies {
    /// Stretch.
    pub axial: f64,
    /// Twist.
    pub torsion: f64,
    /// Bending and shear together: the slower and the faster of their two modes, each in two
    /// planes.
    pub bending: [f64; 2],
}

impl Frequencies {
    /// The fastest of them, rad/s.
    pub fn largest(&self) -> f64 {
        self.axial.max(self.torsion).max(self.bending[1])
    }

    /// Largest stable step of leapfrog for the pair, 2 / omega, s. Infinite if both ends are held.
    pub fn critical_step_s(&self) -> f64 {
        2.0 / self.largest()
    }
}

/// Frequencies of two ends, from inverse masses and inverse moments of inertia: 0 for a held end.
///
/// Bending and shear: with the shear displacement u and the bending angle phi of the bond as
/// coordinates, the inverse masses are W_uu = 1/m + sum of l^2/I, W_phi = sum of 1/I, W_u,phi =
/// l_a/I_a - l_b/I_b, and omega^2 are the eigenvalues of diag(k_s, k_ben) W.
pub fn frequencies(
    stiffness: &Stiffness,
    inverse_masses: [f64; 2],
    inverse_inertias: [f64; 2],
) -> Frequencies {
    let [lever_a, lever_b] = stiffness.levers_m;
    let [per_inertia_a, per_inertia_b] = inverse_inertias;
    let per_mass = inverse_masses[0] + inverse_masses[1];
    let per_inertia = per_inertia_a + per_inertia_b;
    let swing = lever_a * lever_a * per_inertia_a + lever_b * lever_b * per_inertia_b;
    let coupling = lever_a * per_inertia_a - lever_b * per_inertia_b;

    let shear = stiffness.shear * (per_mass + swing);
    let bend = stiffness.bending * per_inertia;
    let product = stiffness.shear * stiffness.bending;
    let apart = (shear - bend).hypot(2.0 * product.sqrt() * coupling);
    let fast = 0.5 * (shear + bend + apart);
    // The other root from the product of both, written without a difference: close to the fast one,
    // it would be lost in rounding.
    let length = lever_a + lever_b;
    let determinant =
        product * (per_mass * per_inertia + length * length * per_inertia_a * per_inertia_b);
    let slow = if fast > 0.0 { determinant / fast } else { 0.0 };
    Frequencies {
        axial: (stiffness.normal * per_mass).sqrt(),
        torsion: (stiffness.torsion * per_inertia).sqrt(),
        bending: [slow.sqrt(), fast.sqrt()],
    }
}
