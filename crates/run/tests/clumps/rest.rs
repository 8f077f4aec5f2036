//! The depth of clumps at rest on a plane is that of the closed form.

use std::f64::consts::TAU;
use std::fmt::Write;

use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::step::{advance, interact, step};
use nalgebra::Vector3;

use super::{HEAD, planned};

const RADIUS_M: f64 = 4e-3;
const GRAVITY_M_S2: f64 = 9.81;

/// Depth, m, of a sphere at rest under a force, N: F = 4/3 E* sqrt(R) d^(3/2).
fn hertz_m(force_n: f64) -> f64 {
    let reduced_pa = 1e8 / (2.0 * (1.0 - 0.25 * 0.25));
    (0.75 * force_n / (reduced_pa * RADIUS_M.sqrt())).powf(2.0 / 3.0)
}

/// This number of equal spheres, in a ring around one more if there are two heights.
fn settled(count: u32, hat: bool, turned_rad: f64) {
    let mut particles = String::new();
    for n in 0..count {
        let angle = TAU * f64::from(n) / f64::from(count);
        let (y, x) = angle.sin_cos();
        let ring_m = 1.5 * RADIUS_M;
        write!(
            particles,
            "[{:e}, {:e}, {RADIUS_M:e}, {RADIUS_M:e}],",
            ring_m * x,
            ring_m * y
        )
        .unwrap();
    }
    if hat {
        write!(particles, "[0, 0, {:e}, {RADIUS_M:e}]", 2.0 * RADIUS_M).unwrap();
    }
    let mut state = planned(&format!(
        "{HEAD}run.gravity = [0, 0, -{GRAVITY_M_S2}]\n\
         contacts.stuff-stuff = {{ restitution = 0.05, friction = 0.5 }}\n\
         [bodies.one]\nmaterial = \"stuff\"\nstart_as = \"clump\"\nparticles = [{particles}]\n\
         rotation = {{ axis = [0, 0, 1], angle = {turned_rad} }}\n\
         [walls.ground]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\n"
    ))
    .state;
    let template = state.clumps.templates[0].clone();
    let spheres = count + u32::from(hat);
    let sphere_kg = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS_M.powi(3);
    assert!((template.mass_kg / (f64::from(spheres) * sphere_kg) - 1.0).abs() < 1e-14);
    let weight_n = template.mass_kg * GRAVITY_M_S2;
    let share_n = weight_n / f64::from(count);
    let depth_m = hertz_m(share_n);
    // The contacts are springs of 3/2 F/d each: they oscillate at about sqrt(3/2 g/d), damped by
    // more than half of critical damping.
    let swing_rad_s = (1.5 * GRAVITY_M_S2 / depth_m).sqrt();
    while state.time_s < 100.0 / swing_rad_s {
        if state.steps.is_multiple_of(50) {
            // Compared with the momentum of the fall.
            interact(&mut state);
            let balance = balance(&mut state);
            assert!(balance.momentum_error < 1e-10);
            advance(&mut state);
        } else {
            step(&mut state);
        }
    }
    interact(&mut state);
    let wall = &state.walls[0];
    assert_eq!(wall.touching.len(), count as usize);
    for touch in &wall.touching {
        let overlap_m = touch.history.overlap_m();
        assert!(
            (overlap_m / depth_m - 1.0).abs() < 1e-6,
            "{overlap_m:e} {depth_m:e}"
        );
        let pose = &state.particles.poses[touch.particle as usize];
        assert!(((RADIUS_M - pose.place().z) / depth_m - 1.0).abs() < 1e-6);
        let force_n =
            4.0 / 3.0 * 1e8 / (2.0 * (1.0 - 0.0625)) * RADIUS_M.sqrt() * overlap_m.powf(1.5);
        assert!((force_n / share_n - 1.0).abs() < 1e-6);
    }
    let clump = &state.clumps.all[0];
    let pushed = Vector3::from(clump.force_n);
    assert!((pushed - Vector3::z() * weight_n).norm() < 1e-6 * weight_n);
    assert!(Vector3::from(clump.torque_n_m).norm() < 1e-6 * weight_n * RADIUS_M);
    assert!((wall.push.force_n[2] / weight_n - 1.0).abs() < 1e-6);
    let balance = balance(&mut state);
    eprintln!(
        "{count} spheres: {depth_m:.3e} m, energy error {:.1e}, {} steps",
        balance.energy_error, state.steps
    );
    assert!(balance.kinetic_j < 1e-12 * weight_n * depth_m);
    // Elastic: 2/5 F d each.
    let stored_j = 0.4 * weight_n * depth_m;
    assert!((balance.contact_elastic_j / stored_j - 1.0).abs() < 3e-6);
}

#[test]
fn each_sphere_of_a_flat_clump_carries_its_share() {
    for count in [3, 4] {
        for turned_rad in [0.0, 0.7] {
            settled(count, false, turned_rad);
        }
    }
}

#[test]
fn a_sphere_that_touches_nothing_weighs_all_the_same() {
    settled(3, true, 0.3);
    settled(4, true, 0.0);
}
