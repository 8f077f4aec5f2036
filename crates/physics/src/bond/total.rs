//! The total formulation: force and torques are the exact gradient of an energy that depends on the
//! present positions and orientations. There is no history, so nothing needs to be rotated or
//! stored, and nothing can drift.
//!
//! With c the unit vector from a to b, a_a and a_b the bond's initial direction carried by each
//! particle, levers l_a + l_b = L0, s = l_a a_a + l_b a_b, w = c x s, e the direction of a_a + a_b,
//! and phi the rotation of b relative to a:
//!
//! U = 1/2 k_n (L - L0)^2 + 1/2 k_s |w|^2 + 1/2 k_ben |phi|^2 + 1/2 (k_tor - k_ben) (phi . e)^2
//!
//! phi is twice the vector part of the relative quaternion: 2 sin(angle/2) along the axis. It needs
//! no trigonometry and differs from the rotation vector only in third order.

use super::BondLoad;
use super::stiffness::Stiffness;
use crate::number::{Number, Rotation, Vec3};
use nalgebra::{UnitQuaternion, Vector3};

/// An end of a bond: position and rotation of its particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Centre, m.
    pub position_m: Vector3<f64>,
    /// Rotation since the bond was created.
    pub turned: UnitQuaternion<f64>,
}

/// Energy of a bond by mode, J.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BondEnergy<T = f64> {
    /// Stretch.
    pub normal: T,
    /// Shear.
    pub shear: T,
    /// Torsion.
    pub torsion: T,
    /// Bending.
    pub bending: T,
}

impl BondEnergy {
    /// All modes together, J.
    pub fn total(&self) -> f64 {
        self.normal + self.shear + self.torsion + self.bending
    }
}

/// Forces of a bond on its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondForces {
    /// Force on the second end, N. The first end feels the opposite.
    pub force_on_b: Vector3<f64>,
    /// Torques on the two ends, N m.
    pub torques: [Vector3<f64>; 2],
    /// Energy stored, J.
    pub energy: BondEnergy,
    /// Its load, mode by mode: each stiffness times its deformation, so half of load times
    /// deformation is the energy of the mode.
    pub load: BondLoad,
}

impl BondForces {
    /// Of no bond.
    pub const NONE: Self = Self {
        force_on_b: Vector3::new(0.0, 0.0, 0.0),
        torques: [Vector3::new(0.0, 0.0, 0.0); 2],
        energy: BondEnergy {
            normal: 0.0,
            shear: 0.0,
            torsion: 0.0,
            bending: 0.0,
        },
        load: BondLoad {
            normal_n: 0.0,
            shear_n: 0.0,
            torsion_n_m: 0.0,
            bending_n_m: 0.0,
        },
    };
}

/// The direction of a bond, a unit vector, from the vector `apart` between its ends: by the same
/// operations as in [`bond_forces`], so that the force of a bond at rest is 0 to the last bit.
pub fn direction(apart: &Vector3<f64>) -> Vector3<f64> {
    let apart = Vec3(apart.x, apart.y, apart.z);
    let Vec3(x, y, z) = apart * apart.square().sqrt().inverse();
    Vector3::new(x, y, z)
}

/// Forces of a bond with this stiffness and this initial direction from a to b (a unit vector).
pub fn bond_forces(stiffness: &Stiffness, direction: &Vector3<f64>, ends: &[End; 2]) -> BondForces {
    let triple = |v: &Vector3<f64>| Vec3(v.x, v.y, v.z);
    let vector = |t: Vec3<f64>| Vector3::new(t.0, t.1, t.2);
    let apart = ends[1].position_m - ends[0].position_m;
    let turned = ends.map(|end| Rotation(triple(&end.turned.imag()), end.turned.w));
    let bond_response = bond_response(stiffness, triple(direction), triple(&apart), turned);
    BondForces {
        force_on_b: vector(bond_response.force_on_b),
        torques: bond_response.torques.map(vector),
        energy: bond_response.energy,
        load: bond_response.load,
    }
}

/// Forces of one bond or several at once on their ends: as [`BondForces`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondResponse<T> {
    /// Force on the second end, N.
    pub force_on_b: Vec3<T>,
    /// Torques on the two ends, N m.
    pub torques: [Vec3<T>; 2],
    /// Energy stored, J.
    pub energy: BondEnergy<T>,
    /// Its load.
    pub load: BondLoad<T>,
}

/// Forces of bonds with these initial directions; `apart` is the vector from the first to the
/// second ends, m, and `turned` the rotations of the ends since the start.
///
/// Meant for the inside of a loop over bonds: it has no branches, and energies and loads that the
/// caller does not use are not computed.
#[inline(always)]
pub fn bond_response<T: Number>(
    stiffness: &Stiffness<T>,
    direction: Vec3<T>,
    apart: Vec3<T>,
    turned: [Rotation<T>; 2],
) -> BondResponse<T> {
    let [lever_a, lever_b] = stiffness.levers_m;
    let length = apart.square().sqrt();
    let per_length = length.inverse();
    let c = apart * per_length;
    let initial = lever_a + lever_b;
    let elongation = length - initial;

    // s = L0 c + offset: nothing cancels in a small offset, and at rest it is 0 to the last bit.
    let [turned_a, turned_b] = turned;
    let (direction_a, direction_b) = (turned_a.of(direction), turned_b.of(direction));
    let offset = (direction_a - c) * lever_a + (direction_b - c) * lever_b;
    let offset_along = c.dot(offset);
    let along = initial + offset_along;
    let shear_displacement = offset - c * offset_along;

    // A quaternion and its negative are the same rotation: the one of less than half a revolution
    // is used.
    let Rotation(half_phi, cosine) = turned_b.relative_to(turned_a);
    let sign = cosine.sign();
    let (half_phi, cosine) = (half_phi * sign, cosine * sign);
    let phi = half_phi + half_phi;
    let sum = direction_a + direction_b;
    let per_sum_squared = sum.square().inverse();
    let twist_per_sum = phi.dot(sum) * per_sum_squared;
    let twist = sum * twist_per_sum;
    let bend = phi - twist;
    let excess = stiffness.torsion - stiffness.bending;

    // Gradients of the energy with respect to phi and e; a change of e is a change of the sum,
    // across it.
    let by_phi = phi * stiffness.bending + twist * excess;
    let by_sum = bend * (excess * twist_per_sum);
    let relative_torque = by_phi * cosine;
    let shared_torque = half_phi.cross(by_phi);

    let shear_force = shear_displacement * stiffness.shear;
    let normal_force = stiffness.normal * elongation;
    BondResponse {
        force_on_b: shear_force * (along * per_length) - c * normal_force,
        torques: [
            relative_torque - shared_torque - direction_a.cross(shear_force * lever_a + by_sum),
            -relative_torque - shared_torque - direction_b.cross(shear_force * lever_b + by_sum),
        ],
        energy: BondEnergy {
            normal: (normal_force * elongation).scale(0.5),
            shear: (stiffness.shear * shear_displacement.square()).scale(0.5),
            torsion: (stiffness.torsion * twist.square()).scale(0.5),
            bending: (stiffness.bending * bend.square()).scale(0.5),
        },
        load: BondLoad {
            normal_n: normal_force,
            shear_n: stiffness.shear * shear_displacement.square().sqrt(),
            torsion_n_m: stiffness.torsion * twist.square().sqrt(),
            bending_n_m: stiffness.bending * bend.square().sqrt(),
        },
    }
}
