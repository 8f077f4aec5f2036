//! Walls whose motion follows from the force on them: the end of a long elastic bar, and a weight.

use nalgebra::Vector3;

use crate::state::walls::Wall;

/// Velocity of the end of a bar along `direction` in the coming step of `dt`, s.
///
/// In a bar of impedance Z the incident wave moves particles at `wave_m_s` = v_I, the reflected one
/// at v - v_I, and the force at the end is F = Z v_I - Z (v - v_I) = Z (2 v_I - v). The
/// transmission bar, with v_I = 0 and `direction` away from the body, gives F = -Z v, that is Z v
/// against the body.
///
/// With the force of this moment, v = 2 v_I - F/Z would make a particle on a spring k unstable from
/// k dt = 2 Z on. So the force includes its change by the change of velocity, k dt (v - v')/2 with
/// the velocity v' of the previous step and the stiffness k of all contacts, which keeps the step
/// limit of a fixed wall for any Z, even 0.
pub(super) fn bar_velocity_m_s(
    wall: &Wall,
    direction: &[f64; 3],
    impedance_n_s_m: f64,
    wave_m_s: f64,
    dt: f64,
) -> f64 {
    let [force_n, before_m_s] = along(wall, direction);
    let half = 0.5 * wall.stiffness_n_m * dt;
    let driven = impedance_n_s_m * 2.0 * wave_m_s - force_n + half * before_m_s;
    driven / (impedance_n_s_m + half)
}

/// Velocity of a weight along `direction` after a kick of `kick_s`: the leapfrog of its mass under
/// its gravity and the force of the body.
pub(super) fn weight_velocity_m_s(
    wall: &Wall,
    direction: &[f64; 3],
    mass_kg: f64,
    gravity_m_s2: f64,
    kick_s: f64,
) -> f64 {
    let [force_n, before_m_s] = along(wall, direction);
    before_m_s + kick_s * (gravity_m_s2 - force_n / mass_kg)
}

/// Force on the particles, N, and velocity in the step just made, m/s, along a direction.
fn along(wall: &Wall, direction: &[f64; 3]) -> [f64; 2] {
    let direction = Vector3::from(*direction);
    [wall.push.force_n, wall.velocities_m_s[0]].map(|of| Vector3::from(of).dot(&direction))
}
