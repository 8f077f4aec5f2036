//! Motion of walls: planned, driven by what they push, and made.

use dem_scene::WallMotion;
use nalgebra::Vector3;

use super::driven::{bar_velocity_m_s, weight_velocity_m_s};
use crate::state::State;
use crate::state::loads::factor_at;
use crate::state::particles::Particles;
use crate::state::walls::{Wall, WallContact};
use dem_physics::rigid::turn;

/// Fraction of the deviation that a servo corrects in a step.
const SERVO: f64 = 0.1;

/// Velocity of the surface of a wall where a particle touches it, half the overlap below the
/// particle's surface, in the step just made (0) or in the next (1), m/s.
pub(crate) fn surface_velocity_m_s(
    wall: &Wall,
    particles: &Particles,
    touch: &WallContact,
    step: usize,
) -> Vector3<f64> {
    let pose = &particles.poses[touch.particle as usize];
    let normal = Vector3::from(touch.normal);
    let overlap_m = touch.history.overlap_m() + touch.history.origin_m();
    let point = pose.place() - (pose.radius_m() - 0.5 * overlap_m) * normal;
    let arm = point - Vector3::from(wall.frame.position_m);
    let belt = Vector3::from(wall.model.surface_velocity_m_s);
    let [velocity, spin] =
        [&wall.velocities_m_s, &wall.spins_rad_s].map(|of| Vector3::from(of[step]));
    velocity + spin.cross(&arm) + belt - normal * belt.dot(&normal)
}

/// Determines the motion of the walls in the second of two steps, `steps_s`, which begins at
/// `time_s`.
pub(crate) fn plan_motions(walls: &mut [Wall], time_s: f64, steps_s: [f64; 2]) {
    for wall in walls {
        let [velocity, spin] = planned(wall, time_s, steps_s);
        wall.velocities_m_s[1] = velocity;
        wall.spins_rad_s[1] = spin;
    }
}

/// Velocity, m/s, and spin, rad/s, of a wall in the second of two steps, `steps_s`, which begins at
/// `time_s`.
pub(crate) fn planned(wall: &Wall, time_s: f64, steps_s: [f64; 2]) -> [[f64; 3]; 2] {
    let dt = steps_s[1];
    match &wall.model.motion {
        WallMotion::Fixed => [[0.0; 3]; 2],
        WallMotion::Velocity {
            velocity_m_s,
            spin_rad_s,
            factor,
        } => {
            let factor = factor_at(factor, time_s + 0.5 * dt);
            [
                velocity_m_s.map(|v| factor * v),
                spin_rad_s.map(|w| factor * w),
            ]
        }
        WallMotion::Displacement {
            displacement_m,
            angular_displacement_rad: turn_rad,
            factor,
        } => {
            let gain = factor_at(factor, time_s + dt) - factor_at(factor, time_s);
            [
                displacement_m.map(|d| gain * d / dt),
                turn_rad.map(|t| gain * t / dt),
            ]
        }
        WallMotion::Orbit(orbit) => {
            let [from, to] = [time_s, time_s + dt].map(|at_s| orbit.place_m(at_s));
            [[0, 1, 2].map(|k| (to[k] - from[k]) / dt), [0.0; 3]]
        }
        WallMotion::Gyration(gyration) => {
            let turn_rad = gyration.turn_between_rad([time_s, time_s + dt]);
            [[0.0; 3], turn_rad.map(|t| t / dt)]
        }
        WallMotion::Servo {
            force_n,
            direction,
            max_velocity_m_s: largest_velocity_m_s,
            factor,
        } => {
            // Without damping, which depends on the wall's own velocity: the two would drive each
            // other.
            let elastic = |k: usize| wall.push.force_n[k] - wall.scratch.damping.force_n[k];
            let pushed: f64 = (0..3).map(|k| elastic(k) * direction[k]).sum();
            let missing = factor_at(factor, time_s) * force_n - pushed;
            // Without contact there is no stiffness to work with: the servo moves at its largest
            // speed.
            let wanted = if wall.stiffness_n_m > 0.0 {
                SERVO * missing / (wall.stiffness_n_m * dt)
            } else {
                f64::INFINITY.copysign(missing)
            };
            let speed = wanted.clamp(-largest_velocity_m_s, *largest_velocity_m_s);
            [direction.map(|d| speed * d), [0.0; 3]]
        }
        WallMotion::Bar {
            direction,
            impedance_n_s_m,
            incident_m_s,
            factor,
        } => {
            let wave_m_s = factor_at(factor, time_s + 0.5 * dt) * incident_m_s;
            let speed = bar_velocity_m_s(wall, direction, *impedance_n_s_m, wave_m_s, dt);
            [direction.map(|d| speed * d), [0.0; 3]]
        }
        WallMotion::Weight {
            direction,
            mass_kg,
            gravity_m_s2,
            ..
        } => {
            let kick_s = 0.5 * (steps_s[0] + dt);
            let speed = weight_velocity_m_s(wall, direction, *mass_kg, *gravity_m_s2, kick_s);
            [direction.map(|d| speed * d), [0.0; 3]]
        }
    }
}

/// Whether a wall moved in the previous step, or its surface moves while it is at rest.
pub(crate) fn has_moved(wall: &Wall) -> bool {
    let moving = [
        wall.velocities_m_s[0],
        wall.spins_rad_s[0],
        wall.model.surface_velocity_m_s,
    ];
    matches!(
        wall.model.motion,
        WallMotion::Servo { .. } | WallMotion::Bar { .. } | WallMotion::Weight { .. }
    ) || moving != [[0.0; 3]; 3]
}

/// Whether a wall moves in the second of two steps, `steps_s`, which begins at `time_s`.
pub(crate) fn will_move(wall: &Wall, time_s: f64, steps_s: [f64; 2]) -> bool {
    planned(wall, time_s, steps_s) != [[0.0; 3]; 2]
}

/// Whether a wall or its surface moves in the previous step or in the one of this length, s, that
/// begins at this time.
pub(crate) fn moves(wall: &Wall, [time_s, time_step_s]: [f64; 2]) -> bool {
    has_moved(wall) || will_move(wall, time_s, [time_step_s; 2])
}

/// Largest speed of a wall's point near particles, m/s, from the speed of its pivot, m/s, and its
/// spin, rad/s.
pub fn fastest_point_m_s(
    wall: &Wall,
    particles: &Particles,
    [speed_m_s, spin_rad_s]: [f64; 2],
) -> f64 {
    if spin_rad_s == 0.0 {
        return speed_m_s;
    }
    let pivot = Vector3::from(wall.frame.position_m);
    let poses = particles.poses.iter();
    let far_m = poses.map(|pose| (pose.place() - pivot).norm());
    speed_m_s + spin_rad_s * far_m.fold(0.0, f64::max)
}

/// Moves the walls. Returns the largest speed of a wall's point near particles, m/s.
pub(crate) fn move_walls(walls: &mut [Wall], particles: &Particles, dt: f64) -> f64 {
    let mut fastest = 0.0_f64;
    for wall in walls {
        let ([_, velocity], [_, spin]) = (wall.velocities_m_s, wall.spins_rad_s);
        let norms = [velocity, spin].map(|of| Vector3::from(of).norm());
        let speed_m_s = fastest_point_m_s(wall, particles, norms);
        fastest = fastest.max(speed_m_s);
        wall.moved_m = dt * speed_m_s;
        wall.skin_left_m -= wall.moved_m;
        for (place, velocity) in wall.frame.position_m.iter_mut().zip(velocity) {
            *place += dt * velocity;
        }
        wall.frame.turned = turn(wall.frame.turned, spin.map(|w| w * dt));
        wall.velocities_m_s[0] = velocity;
        wall.spins_rad_s[0] = spin;
    }
    fastest
}

/// Moves the walls.
pub(crate) fn drift_walls(state: &mut State) -> usize {
    if state.contacts.is_some() {
        state.fastest_m_s += move_walls(&mut state.walls, &state.particles, state.time_step_s);
    }
    0
}

/// Determines the motion of the walls in the coming drift.
pub(crate) fn plan_wall_motions(state: &mut State) -> usize {
    let steps_s = state.steps_s();
    plan_motions(&mut state.walls, state.time_s, steps_s);
    0
}
