//! Free rotation of a rigid body.
//!
//! The kinetic energy is split into parts, each of which rotates the body about one axis, exactly,
//! in a symmetric order (Reich 1994; Dullweber et al. 1997). The step is of second order and
//! reversible, and the energy error stays bounded. The angular momentum in space is never written,
//! so it stays the same to the last bit.
//!
//! An orientation is the unit quaternion x, y, z, w that rotates the principal axes of the body
//! into space.

use nalgebra::{Quaternion, UnitQuaternion};

use super::rigid::turn;

/// Fraction of the step at each end that minimises the second-order error (McLachlan 1995).
const EDGE: f64 = 0.193_183_327_503_783_6;

/// Rotates a body freely for a time.
///
/// `orientation` is the unit quaternion x, y, z, w from principal axes to space,
/// `angular_momentum_world` in space, kg m^2/s, `moments` the principal moments, all positive, kg
/// m^2, and `dt` the time, s, which may be negative.
///
/// The kinetic energy is |L|^2 / (2 M), with M the middle moment, and L_k^2 / 2 (1 / I_k - 1 / M)
/// for the other two axes. The first part rotates the body about its angular momentum and does not
/// affect the others, so that it can be applied at any time. The other two alternate, the axis of
/// the smallest moment first and last (five rotations, McLachlan 1995). The motion of a body with
/// two equal moments is exact, that of one with nearly equal ones nearly so.
///
/// The energy is accurate to 1e-5 with 50 steps or more in the time 2 pi I / |L|, with I the
/// smallest moment.
pub fn drift(
    orientation: &mut [f64; 4],
    angular_momentum_world: [f64; 3],
    moments: [f64; 3],
    dt: f64,
) {
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| moments[a].total_cmp(&moments[b]));
    let [least, middle, most] = order;
    let rate = |k: usize| (moments[middle] - moments[k]) / (moments[middle] * moments[k]);
    let mut q = *orientation;
    let mut l = into_body(&q, angular_momentum_world);
    for (axis, part) in [
        (least, EDGE),
        (most, 0.5),
        (least, 1.0 - 2.0 * EDGE),
        (most, 0.5),
        (least, EDGE),
    ] {
        spin_about(axis, &mut q, &mut l, part * dt * rate(axis));
    }
    let about = angular_momentum_world.map(|l| l * dt / moments[middle]);
    *orientation = turn(q, about);
}

/// The spin of a body in space, rad/s, from its orientation (unit quaternion x, y, z, w), its
/// angular momentum in space, kg m^2/s, and its principal moments, kg m^2.
pub fn spin_rad_s(
    orientation: &[f64; 4],
    angular_momentum_world: [f64; 3],
    moments: [f64; 3],
) -> [f64; 3] {
    let l = into_body(orientation, angular_momentum_world);
    rotated(orientation, [0, 1, 2].map(|k| l[k] / moments[k]))
}

/// The kinetic energy of the rotation, J, from the orientation (unit quaternion x, y, z, w), the
/// angular momentum in space, kg m^2/s, and the principal moments, kg m^2.
pub fn kinetic_j(
    orientation: &[f64; 4],
    angular_momentum_world: [f64; 3],
    moments: [f64; 3],
) -> f64 {
    let l = into_body(orientation, angular_momentum_world);
    0.5 * (l[0] * l[0] / moments[0] + l[1] * l[1] / moments[1] + l[2] * l[2] / moments[2])
}

/// Rotates a body about one of its axes for a time, s, times a rate per angular momentum, 1/(kg
/// m^2), and the angular momentum in the body the opposite way.
#[inline(always)]
fn spin_about(axis: usize, q: &mut [f64; 4], l: &mut [f64; 3], time_rate: f64) {
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let (sine, cosine) = (0.5 * time_rate * l[axis]).sin_cos();
    let [a, b, c, w] = [q[axis], q[next], q[last], q[3]];
    q[axis] = cosine * a + sine * w;
    q[next] = cosine * b + sine * c;
    q[last] = cosine * c - sine * b;
    q[3] = cosine * w - sine * a;
    let (sine, cosine) = (2.0 * sine * cosine, 1.0 - 2.0 * sine * sine);
    let [b, c] = [l[next], l[last]];
    l[next] = cosine * b + sine * c;
    l[last] = cosine * c - sine * b;
}

fn into_body(&[x, y, z, w]: &[f64; 4], vector: [f64; 3]) -> [f64; 3] {
    rotated(&[-x, -y, -z, w], vector)
}

/// A vector rotated by a unit quaternion.
#[inline(always)]
fn rotated(&[x, y, z, w]: &[f64; 4], v: [f64; 3]) -> [f64; 3] {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let u = [x, y, z];
    let twice = cross(u, v).map(|c| 2.0 * c);
    let more = cross(u, twice);
    [0, 1, 2].map(|k| v[k] + w * twice[k] + more[k])
}

/// A rotation from its components x, y, z, w.
pub fn rotation([x, y, z, w]: [f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
}

/// The components x, y, z, w of a rotation.
pub fn numbers(rotation: &UnitQuaternion<f64>) -> [f64; 4] {
    [rotation.i, rotation.j, rotation.k, rotation.w]
}
