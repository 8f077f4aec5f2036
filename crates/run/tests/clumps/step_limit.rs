//! The time step of scenes with clumps.

use dem_engine::check::limit::{limit, safe_step};
use dem_engine::check::linearised_contacts::contact_rates;
use dem_engine::check::linearised_contacts::impact::at_impact;
use dem_engine::step::{interact, step};
use dem_plan::Plan;

use super::again::same;
use super::books::{booked, feed};
use super::{HEAD, MEETS, go, planned};

/// Lumps that enter through an inlet and stay clumps while they fall on a plate.
fn unbreakable() -> String {
    let text = feed(0.5, "box = { min = [-1, -1, -1], max = [1, 1, -0.015] }");
    text.split_inclusive('\n')
        .filter(|line| !line.starts_with("[replacement") && !line.starts_with("when"))
        .collect()
}

/// The query has no effect, whether or not clumps touch something at that time.
#[test]
fn to_look_for_the_limit_changes_nothing() {
    let [mut quiet, mut asked] = [planned(&unbreakable()), planned(&unbreakable())];
    let mut touching = 0;
    while quiet.state.time_s < 0.2 {
        go(&mut quiet.state, &mut quiet.bodies);
        go(&mut asked.state, &mut asked.bodies);
        if quiet.state.steps.is_multiple_of(10) {
            limit(&mut asked.state);
            touching += u32::from(!asked.state.walls[0].touching.is_empty());
        }
    }
    assert!(touching > 10, "{touching}");
    assert!(same(&quiet.state, &asked.state));
}

fn one_sphere(more: &str) -> Plan {
    planned(&format!(
        "{HEAD}{MEETS}run.gravity = [0, 0, -9.81]\n\
         [bodies.ball]\nmaterial = \"stuff\"\nparticles = [[0, 0, 0.1, 2e-3]]\n{more}\n\
         [walls.floor]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\n"
    ))
}

#[test]
fn a_clump_of_one_sphere_takes_the_step_of_the_sphere() {
    let [sphere, clump] = ["", "start_as = \"clump\""].map(one_sphere);
    let [a, b] = [sphere.step, clump.step].map(|s| [s.step_s, s.foreseen_s, s.impact_speed_m_s]);
    assert!(a[1] < 1e-3 && a[0] < a[1], "{a:?}");
    for (a, b) in a.into_iter().zip(b) {
        assert!((a / b - 1.0).abs() < 1e-12, "{a:e} {b:e}");
    }
}

/// There is nothing at the start, and clumps never have bonds.
#[test]
fn impacts_of_clumps_that_are_to_come_are_foreseen() {
    let Plan { state, step, .. } = planned(&unbreakable());
    assert!(state.particles.is_empty() && step.impact_speed_m_s > 0.5);
    assert!(step.foreseen_s < 1e-3, "{:e}", step.foreseen_s);
    let books = booked(&unbreakable(), step.step_s, 0.25);
    let touched = books.last.contact_damping_j > 0.0;
    eprintln!("{:e} s: {:?}", step.step_s, books.worst);
    assert!(touched && books.worst[0] < 1e-2 && books.worst[1] < 1e-11);
    // The contacts are as predicted, except for several of one clump at the same time.
    let [k, c, _] = at_impact(&books.state, step.impact_speed_m_s);
    assert!((safe_step(k, c) / step.foreseen_s - 1.0).abs() < 1e-12);
}

/// A clump lies on a plate under its weight, on two spheres or on three with one above them, with
/// springs and without damping. Up to the limit small motions stay small, and beyond it they grow:
/// of all six modes together.
#[test]
fn a_clump_on_a_plate_is_stable_up_to_the_limit() {
    let two = [[0.0, 0.0, 0.0], [13e-3, 7.5e-3, 0.0]];
    let foot = |degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        [9e-3 * cosine, 9e-3 * sine, 0.0]
    };
    let pyramid = [foot(10.0), foot(130.0), foot(250.0), [0.0, 0.0, 10e-3]];
    for (places_m, feet) in [(&two[..], 2.0), (&pyramid[..], 3.0)] {
        let [below, beyond] = [0.99, 1.01].map(|share| energy_at(share, places_m, feet));
        assert!(below < 1e-16, "{below:e}");
        assert!(beyond > 1e-9, "{beyond:e}");
    }
}

/// Kinetic energy, J, of a clump of spheres at these places, m, on so many feet, after 1000 steps
/// of this fraction of the limit.
fn energy_at(share: f64, places_m: &[[f64; 3]], feet: f64) -> f64 {
    const RADIUS_M: f64 = 5e-3;
    const STIFFNESS_N_M: f64 = 1e4;
    let sphere_kg = 2000.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS_M.powi(3);
    let weight_n = places_m.len() as f64 * sphere_kg * 9.81;
    let height_m = RADIUS_M - weight_n / (feet * STIFFNESS_N_M);
    let spheres = places_m.iter();
    let spheres = spheres.map(|[x, y, z]| format!("[{x:e}, {y:e}, {z:e}, {RADIUS_M}]"));
    let spheres: Vec<String> = spheres.collect();
    let text = format!(
        "version = 1
run = {{ end_time = 1, gravity = [0, 0, -9.81], initial_overlap = \"keep\" }}
materials.m = {{ density = 2000, young_modulus = 1e7 }}
[contacts.m-m]
restitution = 1
friction = 1
law = \"linear\"
normal_stiffness = {STIFFNESS_N_M}
[walls.floor]
plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
material = \"m\"
[bodies.lump]
material = \"m\"
particles = [{}]
position = [0, 0, {height_m:e}]
velocity = [1e-9, 2e-9, 3e-9]
angular_velocity = [1e-7, 2e-7, 3e-7]
start_as = \"clump\"
",
        spheres.join(", ")
    );
    let mut state = planned(&text).state;
    interact(&mut state);
    let [k, c] = contact_rates(&state);
    assert!(k > 0.0 && c == 0.0, "{k} {c}");
    let mut state = planned(&text).state;
    state.time_step_s = share * safe_step(k, c);
    for _ in 0..1000 {
        step(&mut state);
    }
    state.clumps.kinetic_j()
}
