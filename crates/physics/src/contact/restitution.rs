//! Damping that gives a required coefficient of restitution.
//!
//! The linear law, m x'' + 2 zeta sqrt(k m) x' + k x = 0, and Hertz's with the damping of Tsuji et
//! al. 1992, proportional to x^(1/4), are the same problem: with y = x^(5/4) and dtau = x^(1/4) dt
//! the second becomes y'' + 2 zeta w y' + w^2 y = 0 with w^2 = 5/4 (mass and stiffness 1), and in
//! both the force passes through 0 where y'' = 0. So restitution depends only on the damping ratio
//! zeta, not on the speed:
//!
//! - until the overlap is 0: e = exp(-pi zeta / sqrt(1 - zeta^2)) (Tsuji et al. 1992);
//! - until the force is 0, attraction cut off: e = exp(-2 zeta acos(zeta) / sqrt(1 - zeta^2)), and
//!   acosh(zeta) / sqrt(zeta^2 - 1) above 1. For the linear law this is Schwager and Poeschel 2007,
//!   whose arc tangent of the double angle is resolved here.
//!
//! Both start when the ends touch; gravity, friction and other simultaneous contacts are not
//! included.

use std::f64::consts::PI;

/// Damping ratio that gives a restitution above 0 and at most 1 when attraction is cut off. For 0
/// it is infinite.
pub fn damping_ratio(restitution: f64) -> f64 {
    if restitution <= 0.0 {
        return f64::INFINITY;
    }
    let wanted = -restitution.ln();
    if wanted <= 0.0 {
        return 0.0;
    }
    // Required loss: about pi zeta for small zeta, 2 ln(2 zeta) for large. Bisection; both brackets
    // are wide enough.
    let (mut low, mut high) = (0.0, wanted + (0.5 * wanted).exp());
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if loss(middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// Restitution for a damping ratio when attraction is cut off.
pub fn restitution(damping_ratio: f64) -> f64 {
    (-loss(damping_ratio)).exp()
}

/// Damping ratio that gives a restitution above 0 and at most 1 when damping may be attractive. For
/// 0 it is 1.
pub fn damping_ratio_with_attraction(restitution: f64) -> f64 {
    if restitution <= 0.0 {
        return 1.0;
    }
    let loss = -restitution.ln();
    loss / loss.hypot(PI)
}

/// Minus the logarithm of the restitution.
fn loss(zeta: f64) -> f64 {
    // acos(z) / sqrt(1 - z^2) through half the angle, whose tangent is exact at z = 1, where the
    // quotient is 1.
    let square = (1.0 - zeta) / (1.0 + zeta);
    let tangent = square.abs().sqrt();
    let half_angle_per_tangent = if tangent < 1e-4 {
        1.0 - square / 3.0
    } else if square > 0.0 {
        tangent.atan() / tangent
    } else {
        tangent.atanh() / tangent
    };
    2.0 * zeta * half_angle_per_tangent * (1.0 + square)
}
