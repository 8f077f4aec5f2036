//! The total formulation: force and torques are the exact gradient of an energy of the present positions and orientations.
//! There is no history, so nothing has to be rotated along, stored or can drift.
//!
//! With c the unit vector from a to b, a_a and a_b the bond's initial direction carried by each particle, levers l_a + l_b = L0,
//! s = l_a a_a + l_b a_b, w = c x s, e the direction of a_a + a_b, and phi the rotation of b relative to a:
//!
//! U = 1/2 k_n (L - L0)^2 + 1/2 k_s |w|^2 + 1/2 k_ben |phi|^2 + 1/2 (k_tor - k_ben) (phi . e)^2
//!
//! phi is twice the vector part of the relative quaternion: 2 sin(angle/2) along the axis. It needs no trigonometry and differs from the
//! rotation vector in third order only.

use super::BondLoad;
use super::stiffness::Stiffness;
use nalgebra::{UnitQuaternion, Vector3};

/// An end of a bond: where its particle is and how it is turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Centre, m.
    pub position_m: Vector3<f64>,
    /// Rotation since the bond was made.
    pub turned: UnitQuaternion<f64>,
}

/// Energy of a bond by mode, J.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BondEnergy {
    /// Stretch.
    pub normal: f64,
    /// Shear.
    pub shear: f64,
    /// Torsion.
    pub torsion: f64,
    /// Bending.
    pub bending: f64,
}

impl BondEnergy {
    /// All modes together, J.
    pub fn total(&self) -> f64 {
        self.normal + self.shear + self.torsion + self.bending
    }
}

/// What a bond does to its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondForces {
    /// Force on the second end, N. The first end feels the opposite.
    pub force_on_b: Vector3<f64>,
    /// Torques on the two ends, N m.
    pub torques: [Vector3<f64>; 2],
    /// Energy stored, J.
    pub energy: BondEnergy,
    /// What it carries, mode by mode: each stiffness times its deformation, so half of load times deformation is the energy of the mode.
    pub load: BondLoad,
}

/// The direction of a bond whose ends are `apart`, a unit vector: by the same operations as in [`bond_forces`], so that a bond at rest gives no force to the last bit.
pub fn direction(apart: &Vector3<f64>) -> Vector3<f64> {
    apart * (1.0 / apart.norm())
}

/// Forces of a bond of this stiffness whose initial direction from a to b was `direction` (a unit vector).
///
/// Meant for the inside of a loop over bonds: there is no branch in it, and whatever of energy and load the caller does not read is not computed.
#[inline(always)]
pub fn bond_forces(stiffness: &Stiffness, direction: &Vector3<f64>, ends: &[End; 2]) -> BondForces {
    let [a, b] = ends;
    let [lever_a, lever_b] = stiffness.levers_m;
    let apart = b.position_m - a.position_m;
    let length = apart.norm();
    let per_length = 1.0 / length;
    let c = apart * per_length;
    let initial = lever_a + lever_b;
    let stretch = length - initial;

    // s = L0 c + lean: nothing cancels in a lean that is small, and at rest it is 0 to the last bit.
    let (direction_a, direction_b) = (a.turned * direction, b.turned * direction);
    let lean = lever_a * (direction_a - c) + lever_b * (direction_b - c);
    let lean_along = c.dot(&lean);
    let along = initial + lean_along;
    let across = lean - c * lean_along;

    let relative = b.turned.quaternion() * a.turned.quaternion().conjugate();
    // A quaternion and its negative are the same rotation: the one of less than half a turn is meant.
    let relative = relative * 1.0_f64.copysign(relative.w);
    let (cosine, half_phi) = (relative.w, relative.imag());
    let phi = 2.0 * half_phi;
    let sum = direction_a + direction_b;
    let per_sum_squared = 1.0 / sum.norm_squared();
    let twist_per_sum = phi.dot(&sum) * per_sum_squared;
    let twist = sum * twist_per_sum;
    let bend = phi - twist;
    let excess = stiffness.torsion - stiffness.bending;

    // Gradients of the energy with respect to phi and e; a change of e is a change of the sum, across it.
    let by_phi = stiffness.bending * phi + excess * twist;
    let by_sum = (excess * twist_per_sum) * bend;
    let turn = cosine * by_phi;
    let swing = half_phi.cross(&by_phi);

    let shear_force = stiffness.shear * across;
    BondForces {
        force_on_b: shear_force * (along * per_length) - c * (stiffness.normal * stretch),
        torques: [
            turn - swing - direction_a.cross(&(lever_a * shear_force + by_sum)),
            -turn - swing - direction_b.cross(&(lever_b * shear_force + by_sum)),
        ],
        energy: BondEnergy {
            normal: 0.5 * stiffness.normal * stretch * stretch,
            shear: 0.5 * stiffness.shear * across.norm_squared(),
            torsion: 0.5 * stiffness.torsion * twist.norm_squared(),
            bending: 0.5 * stiffness.bending * bend.norm_squared(),
        },
        load: BondLoad {
            normal_n: stiffness.normal * stretch,
            shear_n: stiffness.shear * across.norm(),
            torsion_n_m: stiffness.torsion * twist.norm(),
            bending_n_m: stiffness.bending * bend.norm(),
        },
    }
}
