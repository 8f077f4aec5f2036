//! Rotation of a rigid body.

/// The orientation `turned` (unit quaternion x, y, z, w) after the rotation vector `turn` (rad, in space): the exponential of half of it, from the left.
///
/// Half angles below a tenth are summed as a series, exact to rounding; the norm is set right to first order, so that it does not drift.
#[inline(always)]
pub fn turn(turned: [f64; 4], turn: [f64; 3]) -> [f64; 4] {
    let half = turn.map(|t| 0.5 * t);
    let square = half[0] * half[0] + half[1] * half[1] + half[2] * half[2];
    let (sine_per_angle, cosine) = if square < 0.01 {
        small_angle(square)
    } else {
        let angle = square.sqrt();
        (angle.sin() / angle, angle.cos())
    };
    let [rx, ry, rz] = half.map(|h| h * sine_per_angle);
    let rw = cosine;
    let [x, y, z, w] = turned;
    let new = [
        rw * x + rx * w + ry * z - rz * y,
        rw * y - rx * z + ry * w + rz * x,
        rw * z + rx * y - ry * x + rz * w,
        rw * w - rx * x - ry * y - rz * z,
    ];
    let norm = new.iter().map(|q| q * q).sum::<f64>();
    new.map(|q| q * (1.5 - 0.5 * norm))
}

/// sin(a)/a and cos(a) from a^2 below 0.01.
#[inline(always)]
fn small_angle(square: f64) -> (f64, f64) {
    // Products, as a division takes several times as long.
    let s = |divisor: f64| square * (1.0 / divisor);
    (
        1.0 - s(6.0) * (1.0 - s(20.0) * (1.0 - s(42.0) * (1.0 - s(72.0) * (1.0 - s(110.0))))),
        1.0 - s(2.0) * (1.0 - s(12.0) * (1.0 - s(30.0) * (1.0 - s(56.0) * (1.0 - s(90.0))))),
    )
}

/// The rotation vector of an orientation, rad: of the smaller of its two turns.
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
