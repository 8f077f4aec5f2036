//! A ball without gravity that a moving wall hits: it leaves with the velocity of the wall where and
//! when it was hit, twice.

use std::f64::consts::TAU;

use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::step::{advance, interact};
use nalgebra::Vector3;

use crate::helpers::started;

/// A ball of 10 mm at rest in this place, and a wall that hits it.
fn scene(ball: [f64; 3], wall: &str) -> String {
    format!(
        "version = 1
run.end_time = 1
materials.m = {{ density = 2000, young_modulus = 1e8 }}
materials.anvil.rigid = true
contacts = {{ m-m = {{ restitution = 1 }}, m-anvil = {{ restitution = 1, friction = 0 }} }}
bodies.ball = {{ particles = [[{:e}, {:e}, {:e}, 5e-3]], material = \"m\" }}
[walls.plate]
material = \"anvil\"
{wall}
",
        ball[0], ball[1], ball[2]
    )
}

#[test]
fn a_ball_leaves_with_twice_the_velocity_of_the_wall() {
    let plate = "box = { min = [-1, -1, -1], max = [1, 1, 0] }";
    let beam = "box = { min = [0, -1, -0.1], max = [1, 1, 0] }";
    // The plates go up at their full speed when they hit: at the start, but for the second.
    for (ball, wall, speed_m_s) in [
        (
            [0.0, 0.0, 5e-3 + 1e-6],
            format!(
                "{plate}\norbit = {{ axis = [0, 1, 0], towards = [-1, 0, 0], radius = 10e-3, frequency = 5 }}"
            ),
            TAU * 5.0 * 10e-3,
        ),
        // A quarter of a turn later, a radius higher than at the start.
        (
            [0.0, 0.0, 5e-3],
            format!(
                "{plate}\norbit = {{ axis = [0, 1, 0], towards = [0, 0, -1], radius = 10e-3, frequency = 5 }}"
            ),
            TAU * 5.0 * 10e-3,
        ),
        (
            [0.8, 0.0, 5e-3 + 1e-6],
            format!(
                "{beam}\nangular_displacement = {{ axis = [0, -1, 0], angle = 0.02 }}\nfrequency = 5"
            ),
            TAU * 5.0 * 0.02 * 0.8,
        ),
        // Leans along y: the side along x goes through the horizontal.
        (
            [0.8, 0.0, 5e-3 + 1e-6],
            format!(
                "{beam}\ngyration = {{ axis = [0, 0, 1], towards = [0, 1, 0], angle = 0.02, frequency = 5 }}"
            ),
            TAU * 5.0 * 0.02_f64.sin() * 0.8,
        ),
    ] {
        let mut state = started(&scene(ball, &wall));
        let mut has_touched = false;
        loop {
            interact(&mut state);
            let touches =
                !state.walls[0].touching.is_empty() && state.walls[0].push.force_n[2] > 0.0;
            if has_touched && !touches {
                break;
            }
            has_touched |= touches;
            assert!(state.time_s < 0.3, "no hit: {wall}");
            advance(&mut state);
        }
        let velocity = Vector3::from(state.particles.motions[0].velocity_m_s);
        let speed = velocity.z / (2.0 * speed_m_s);
        let balance = balance(&mut state);
        let error = balance.energy_error.abs();
        eprintln!("{velocity:?} {speed} of twice {speed_m_s} m/s, energy error {error:.1e}");
        assert!((speed - 1.0).abs() < 2e-3, "{speed}: {wall}");
        assert!(error < 1e-3, "{error:e}");
        let given_j = state.walls[0].work_j;
        let kinetic_j = balance.kinetic_j;
        assert!(
            (given_j / kinetic_j - 1.0).abs() < 1e-3,
            "{given_j:e} {kinetic_j:e}"
        );
    }
}
