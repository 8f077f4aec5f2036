//! Clumps without forces move as rigid bodies.

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::state::clumps::Template;
use dem_engine::step::{advance, interact, step};
use dem_physics::rotation::rotation;
use dem_physics::rotation::{drift, kinetic_j};
use nalgebra::Vector3;
use serde_json::Value;
use std::sync::Arc;

use super::{HEAD, MEETS, lump, planned};

fn flying(particles: &str) -> State {
    let mut plan = planned(&format!(
        "{HEAD}[bodies.one]\nmaterial = \"stuff\"\nstart_as = \"clump\"\nparticles = [{particles}]\n\
         rotation = {{ axis = [1, 2, 3], angle = 1 }}\nvelocity = [1, 2, 3]\nangular_velocity = [30, -20, 50]\n"
    ));
    plan.state.time_step_s = 1e-4;
    plan.state
}

#[test]
fn two_and_three_spheres_turn_as_free_rotation_says_to_the_last_bit() {
    for particles in [
        "[0, 0, 0, 1e-3], [3e-3, 0, 0, 2e-3]",
        "[0, 0, 0, 1e-3], [3e-3, 0, 0, 2e-3], [1e-3, 2e-3, 1e-3, 0.5e-3]",
    ] {
        let mut state = flying(particles);
        let template = state.clumps.templates[0].clone();
        let start = state.clumps.all[0];
        // The spin is that of the scene.
        let spin = start.spin_rad_s(&template);
        assert!((spin - Vector3::new(30.0, -20.0, 50.0)).norm() < 1e-13 * spin.norm());
        let mut turned = start.turned;
        for n in 1..=10_000 {
            step(&mut state);
            drift(
                &mut turned,
                start.angular_momentum,
                template.moments_kg_m2,
                1e-4,
            );
            let clump = &state.clumps.all[0];
            assert_eq!(clump.turned, turned);
            assert_eq!(clump.angular_momentum, start.angular_momentum);
            assert_eq!(clump.velocity_m_s, start.velocity_m_s);
            place_all(&state.clumps, &mut state.particles);
            for (pose, sphere) in state.particles.poses.iter().zip(template.spheres.iter()) {
                let arm = rotation(turned) * Vector3::from(sphere.place_m);
                let wanted = Vector3::from(start.place_m)
                    + Vector3::from(start.velocity_m_s) * (1e-4 * f64::from(n))
                    + arm;
                assert!((pose.place() - wanted).norm() < 1e-11);
            }
        }
    }
}

#[test]
fn a_tumbling_clump_keeps_its_energy_over_a_hundred_thousand_steps() {
    let tumbles = "start_as = \"clump\"\nvelocity = [1, 0, 0]\nangular_velocity = [100, -80, 120]";
    let other = lump("other", "position = [0, 1, 0]");
    let mut state = planned(&format!("{HEAD}{MEETS}{}{other}", lump("lump", tumbles))).state;
    let template = state.clumps.templates[0].clone();
    // 50 steps in the time of one revolution of a body with the smallest moment: see `drift`.
    let clump = state.clumps.all[0];
    let fastest = Vector3::from(clump.angular_momentum).norm() / template.moments_kg_m2[0];
    state.time_step_s = std::f64::consts::TAU / fastest / 50.0;
    let turning = |state: &State| state.clumps.all[0].kinetic_j(&template);
    let start = turning(&state);
    let [x, y, z] = clump.velocity_m_s;
    let moving = 0.5 * template.mass_kg * (x * x + y * y + z * z);
    let (mut worst, mut ledger) = (0.0_f64, 0.0_f64);
    for _ in 0..100_000 {
        interact(&mut state);
        worst = worst.max(((turning(&state) - start) / (start - moving)).abs());
        if state.steps.is_multiple_of(1000) {
            let balance = balance(&mut state);
            ledger = ledger.max(balance.energy_error.abs());
            assert!(balance.momentum_error < 1e-12 && balance.angular_momentum_error < 1e-12);
        }
        advance(&mut state);
    }
    eprintln!("energy of rotation {worst:.1e}, ledger {ledger:.1e}");
    assert!(worst < 1e-5 && ledger < 1e-5);
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|k| value[k].as_f64().unwrap())
}

/// The largest errors of the spin in body axes, relative to 5 rad/s, and of the orientation, at
/// eighths of a period; through the complete solver.
fn flip(steps_per_period: usize) -> (f64, f64) {
    let all: Value =
        serde_json::from_str(include_str!("../../../physics/tests/shape/data/clump.json")).unwrap();
    let case = &all["dzhanibekov_I_1_2_3"];
    let mut state = flying("[0, 0, 0, 1e-3], [3e-3, 0, 0, 2e-3], [1e-3, 2e-3, 1e-3, 0.5e-3]");
    let moments = numbers::<3>(&case["I_principal"]);
    let template = Template {
        moments_kg_m2: moments,
        ..(*state.clumps.templates[0]).clone()
    };
    state.clumps.templates[0] = Arc::new(template.clone());
    let clump = &mut state.clumps.all[0];
    clump.turned = [0.0, 0.0, 0.0, 1.0];
    clump.angular_momentum = numbers(&case["L_world"]);
    state.time_step_s = case["period_of_omega"].as_f64().unwrap() / steps_per_period as f64;
    let energy = |state: &State| {
        let clump = &state.clumps.all[0];
        kinetic_j(&clump.turned, clump.angular_momentum, moments)
    };
    let start = energy(&state);
    let (mut spin, mut turn) = (0.0_f64, 0.0_f64);
    let mut middle = Vec::new();
    for part in 1..=8 {
        for _ in 0..steps_per_period / 8 {
            step(&mut state);
            assert!((energy(&state) / start - 1.0).abs() < 1e-5);
        }
        let clump = &state.clumps.all[0];
        let own = rotation(clump.turned).inverse() * clump.spin_rad_s(&template);
        let wanted = Vector3::from(numbers::<3>(&case["omega_body"][part]));
        spin = spin.max((own - wanted).amax() / 5.0);
        let [w, x, y, z] = numbers::<4>(&case["q_wxyz_body_to_world"][part]);
        turn = turn.max(rotation(clump.turned).angle_to(&rotation([x, y, z, w])));
        middle.push(own[1]);
    }
    // It flips over, and back.
    assert!(
        middle.iter().any(|w| *w < -4.9) && middle.iter().any(|w| *w > 4.9),
        "{middle:?}"
    );
    (spin, turn)
}

#[test]
fn a_body_that_spins_about_its_middle_axis_flips_when_it_should() {
    let [rough, fine] = [10_000, 20_000].map(flip);
    eprintln!("spin and turn: {rough:?}, {fine:?}");
    // Equal to the error of the rotation alone, and proportional to the square of the step.
    assert!(fine.0 < 5e-7 && fine.1 < 7.5e-7);
    for (a, b) in [(rough.0, fine.0), (rough.1, fine.1)] {
        assert!(((a / b).log2() - 2.0).abs() < 0.1, "{a:e} {b:e}");
    }
}
