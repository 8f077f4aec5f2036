//! Rotation of a rigid body.

use crate::number::{Number, Vec3};

/// Square of the half angle below which a series is used, exact to rounding.
const SMALL: f64 = 0.01;

/// The orientation `turned` (unit quaternion x, y, z, w) after the rotation vector `turn` (rad, in
/// space): the exponential of half of it, from the left.
///
/// The norm is corrected to first order, so that it does not drift.
#[inline(always)]
pub fn turn(turned: [f64; 4], turn: [f64; 3]) -> [f64; 4] {
    let half = half_angles(turn);
    let square = half.square();
    if square < SMALL {
        return after(turned, half, small_angle(square));
    }
    let angle = square.sqrt();
    after(turned, half, (angle.sin() / angle, angle.cos()))
}

/// As [`turn`], for an angle that [is small](room_to_small).
#[inline(always)]
pub fn turn_a_little<T: Number>(turned: [T; 4], turn: [T; 3]) -> [T; 4] {
    let half = half_angles(turn);
    after(turned, half, small_angle(half.square()))
}

/// Above 0 if a rotation vector, rad, is small enough for [`turn_a_little`].
#[inline(always)]
pub fn room_to_small<T: Number>(turn: [T; 3]) -> T {
    (-half_angles(turn).square()).plus(SMALL)
}

#[inline(always)]
fn half_angles<T: Number>([x, y, z]: [T; 3]) -> Vec3<T> {
    Vec3(x, y, z).scale(0.5)
}

/// Orientation after a rotation by these half angles, given their sine over angle and their cosine.
#[inline(always)]
fn after<T: Number>([x, y, z, w]: [T; 4], half: Vec3<T>, (sine_per_angle, rw): (T, T)) -> [T; 4] {
    let Vec3(rx, ry, rz) = half * sine_per_angle;
    let nx = rw * x + rx * w + ry * z - rz * y;
    let ny = rw * y - rx * z + ry * w + rz * x;
    let nz = rw * z + rx * y - ry * x + rz * w;
    let nw = rw * w - rx * x - ry * y - rz * z;
    let norm = nx * nx + ny * ny + nz * nz + nw * nw;
    let right = norm.scale(-0.5).plus(1.5);
    [nx * right, ny * right, nz * right, nw * right]
}

/// sin(a)/a and cos(a) from a^2 below [`SMALL`].
#[inline(always)]
fn small_angle<T: Number>(square: T) -> (T, T) {
    let one = square.zero().plus(1.0);
    (
        less(
            square,
            6.0,
            less(
                square,
                20.0,
                less(square, 42.0, less(square, 72.0, less(square, 110.0, one))),
            ),
        ),
        less(
            square,
            2.0,
            less(
                square,
                12.0,
                less(square, 30.0, less(square, 56.0, less(square, 90.0, one))),
            ),
        ),
    )
}

/// 1 less a quotient times the rest of a series. A product, as a division takes several times as
/// long.
#[inline(always)]
fn less<T: Number>(square: T, divisor: f64, rest: T) -> T {
    (-(square.scale(1.0 / divisor) * rest)).plus(1.0)
}

/// The rotation vector of an orientation, rad: the one with the smaller angle.
pub fn rotation_vector(turned: [f64; 4]) -> [f64; 3] {
    let [x, y, z, w] = turned;
    let sign = 1.0_f64.copysign(w);
    let sine = (x * x + y * y + z * z).sqrt();
    let angle_per_sine = if sine > 1e-12 {
        2.0 * sine.atan2(w.abs()) / sine
    } else {
        2.0
    };
    [x, y, z].map(|v| v * sign * angle_per_sine)
}
