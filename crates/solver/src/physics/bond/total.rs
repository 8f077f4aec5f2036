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
use crate::physics::number::{Number, Triple, Turn};
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
    let apart = Triple(apart.x, apart.y, apart.z);
    let Triple(x, y, z) = apart * apart.square().root().inverse();
    Vector3::new(x, y, z)
}

/// Forces of a bond of this stiffness whose initial direction from a to b was `direction` (a unit vector).
pub fn bond_forces(stiffness: &Stiffness, direction: &Vector3<f64>, ends: &[End; 2]) -> BondForces {
    let triple = |v: &Vector3<f64>| Triple(v.x, v.y, v.z);
    let vector = |t: Triple<f64>| Vector3::new(t.0, t.1, t.2);
    let apart = ends[1].position_m - ends[0].position_m;
    let turned = ends.map(|end| Turn(triple(&end.turned.imag()), end.turned.w));
    let answer = answer(stiffness, triple(direction), triple(&apart), turned);
    BondForces {
        force_on_b: vector(answer.force_on_b),
        torques: answer.torques.map(vector),
        energy: answer.energy,
        load: answer.load,
    }
}

/// What one bond or several at once do to their ends: as [`BondForces`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer<T> {
    /// Force on the second end, N.
    pub force_on_b: Triple<T>,
    /// Torques on the two ends, N m.
    pub torques: [Triple<T>; 2],
    /// Energy stored, J.
    pub energy: BondEnergy<T>,
    /// What it carries.
    pub load: BondLoad<T>,
}

/// Forces of bonds whose initial directions were `direction`, whose second ends now stand `apart` from the first, m, and whose ends are `turned`
/// since the start.
///
/// Meant for the inside of a loop over bonds: there is no branch in it, and whatever of energy and load the caller does not read is not computed.
#[inline(always)]
pub fn answer<T: Number>(
    stiffness: &Stiffness<T>,
    direction: Triple<T>,
    apart: Triple<T>,
    turned: [Turn<T>; 2],
) -> Answer<T> {
    let [lever_a, lever_b] = stiffness.levers_m;
    let length = apart.square().root();
    let per_length = length.inverse();
    let c = apart * per_length;
    let initial = lever_a + lever_b;
    let stretch = length - initial;

    // s = L0 c + lean: nothing cancels in a lean that is small, and at rest it is 0 to the last bit.
    let [turned_a, turned_b] = turned;
    let (direction_a, direction_b) = (turned_a.of(direction), turned_b.of(direction));
    let lean = (direction_a - c) * lever_a + (direction_b - c) * lever_b;
    let lean_along = c.dot(lean);
    let along = initial + lean_along;
    let across = lean - c * lean_along;

    // A quaternion and its negative are the same rotation: the one of less than half a turn is meant.
    let Turn(half_phi, cosine) = turned_b.since(turned_a);
    let sign = cosine.sign();
    let (half_phi, cosine) = (half_phi * sign, cosine * sign);
    let phi = half_phi + half_phi;
    let sum = direction_a + direction_b;
    let per_sum_squared = sum.square().inverse();
    let twist_per_sum = phi.dot(sum) * per_sum_squared;
    let twist = sum * twist_per_sum;
    let bend = phi - twist;
    let excess = stiffness.torsion - stiffness.bending;

    // Gradients of the energy with respect to phi and e; a change of e is a change of the sum, across it.
    let by_phi = phi * stiffness.bending + twist * excess;
    let by_sum = bend * (excess * twist_per_sum);
    let turn = by_phi * cosine;
    let swing = half_phi.cross(by_phi);

    let shear_force = across * stiffness.shear;
    let normal_force = stiffness.normal * stretch;
    Answer {
        force_on_b: shear_force * (along * per_length) - c * normal_force,
        torques: [
            turn - swing - direction_a.cross(shear_force * lever_a + by_sum),
            -turn - swing - direction_b.cross(shear_force * lever_b + by_sum),
        ],
        energy: BondEnergy {
            normal: (normal_force * stretch).times(0.5),
            shear: (stiffness.shear * across.square()).times(0.5),
            torsion: (stiffness.torsion * twist.square()).times(0.5),
            bending: (stiffness.bending * bend.square()).times(0.5),
        },
        load: BondLoad {
            normal_n: normal_force,
            shear_n: stiffness.shear * across.square().root(),
            torsion_n_m: stiffness.torsion * twist.square().root(),
            bending_n_m: stiffness.bending * bend.square().root(),
        },
    }
}
