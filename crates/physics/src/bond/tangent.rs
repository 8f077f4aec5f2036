//! The tangent of a bond: derivatives of its forces and torques with respect to displacements and
//! rotations of its ends, by exact differentiation of the same formulas as for the forces
//! ([`bond_response`]).

use nalgebra::Vector3;

use super::stiffness::Stiffness;
use super::total::{End, bond_response};
use crate::dual::Dual;
use crate::number::{Rotation, Vec3};

/// Number of degrees of freedom of the two ends of a bond: translations along x, y, z of the first
/// (0..3), rotations about x, y, z of the first (3..6), then those of the second.
pub const DEGREES_OF_FREEDOM: usize = 12;

/// Rows: forces, N, and torques, N m, in the order of [`DEGREES_OF_FREEDOM`]. Columns:
/// displacements, m, and rotations, rad. Its entries are the external forces for a small
/// displacement or rotation: minus the derivatives of the bond's forces.
pub type BondTangent = [[f64; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];

/// Variables: the position of the second end relative to the first, the rotations of the first and
/// those of the second.
type Number = Dual<9>;

/// The tangent of a bond of the total formulation.
///
/// Rotations are rotation vectors in space, applied after the present rotation, q <- exp(turn) q.
/// If a torque acts on an end, the tangent is not symmetric in the rotations of that end: K - K^T =
/// the cross product with the torque that the bond exerts there.
pub fn bond_tangent(
    stiffness: &Stiffness,
    direction: &Vector3<f64>,
    ends: &[End; 2],
) -> BondTangent {
    let constant = Number::constant;
    let stiffness = Stiffness {
        normal: constant(stiffness.normal),
        shear: constant(stiffness.shear),
        torsion: constant(stiffness.torsion),
        bending: constant(stiffness.bending),
        levers_m: stiffness.levers_m.map(constant),
    };
    let direction = Vec3(direction.x, direction.y, direction.z);
    let Vec3(dx, dy, dz) = direction;
    let direction = Vec3(constant(dx), constant(dy), constant(dz));
    let apart = ends[1].position_m - ends[0].position_m;
    let apart = Vec3(
        Number::variable(apart.x, 0),
        Number::variable(apart.y, 1),
        Number::variable(apart.z, 2),
    );
    let turned = [turning(&ends[0], 3), turning(&ends[1], 6)];
    let bond_response = bond_response(&stiffness, direction, apart, turned);

    let rows = |triple: Vec3<Number>| [triple.0.slopes, triple.1.slopes, triple.2.slopes];
    let (force_on_b, [torque_a, torque_b]) = (
        rows(bond_response.force_on_b),
        bond_response.torques.map(rows),
    );
    let mut tangent = [[0.0; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];
    for k in 0..3 {
        let on_b = spread(&force_on_b[k], -1.0);
        tangent[k] = on_b.map(|entry| -entry);
        tangent[3 + k] = spread(&torque_a[k], -1.0);
        tangent[6 + k] = on_b;
        tangent[9 + k] = spread(&torque_b[k], -1.0);
    }
    tangent
}

/// Rotation of an end, with the derivatives with respect to a further rotation: half of it times
/// the present rotation. Variables from `first` on.
fn turning(end: &End, first: usize) -> Rotation<Number> {
    let (v, w) = (end.turned.imag(), end.turned.w);
    let mut parts = [v.x, v.y, v.z, w].map(Number::constant);
    for k in 0..3 {
        let mut half = Vector3::zeros();
        half[k] = 0.5;
        let change = half * w + half.cross(&v);
        for (part, change) in parts.iter_mut().zip([change.x, change.y, change.z]) {
            part.slopes[first + k] = change;
        }
        parts[3].slopes[first + k] = -half.dot(&v);
    }
    let [x, y, z, w] = parts;
    Rotation(Vec3(x, y, z), w)
}

/// A row of the tangent from derivatives with respect to the nine variables, times a factor.
fn spread(slopes: &[f64; 9], factor: f64) -> [f64; DEGREES_OF_FREEDOM] {
    let mut row = [0.0; DEGREES_OF_FREEDOM];
    for k in 0..3 {
        row[k] = -factor * slopes[k];
        row[3 + k] = factor * slopes[3 + k];
        row[6 + k] = factor * slopes[k];
        row[9 + k] = factor * slopes[6 + k];
    }
    row
}
