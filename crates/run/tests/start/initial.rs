//! `[initial]`: displaced particles oscillate, particles with a velocity move.

use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::step::{advance, interact};

use super::{MASS_KG, PAIR, STIFFNESS_N_M, assert_near, place, planned};

/// Stretched by u and released, the pair oscillates about its rest length as in leapfrog: after n
/// steps the elongation is u cos(n phi) with cos(phi) = 1 - (w dt)^2/2 and w^2 = 2 k/m.
#[test]
fn a_pair_pulled_apart_swings_with_the_amplitude_it_had() {
    let stretch_m = 1e-6;
    let step_s = 1e-6;
    let text = format!(
        "{PAIR}run = {{ end_time = 1e-3, time_step = {step_s} }}\n\
         initial.one = {{ group = \"first\", displacement = [-0.4e-6, 0, 0] }}\n\
         initial.other = {{ group = \"second\", displacement = [0.6e-6, 0, 0] }}\n"
    );
    let mut state = planned(&text).state;
    let omega = (2.0 * STIFFNESS_N_M / MASS_KG).sqrt();
    let phi = (1.0 - 0.5 * (omega * step_s).powi(2)).acos();
    for n in 0..1000 {
        interact(&mut state);
        let now = balance(&mut state);
        if n == 0 {
            let stored_j = 0.5 * STIFFNESS_N_M * stretch_m * stretch_m;
            assert_near(now.elastic_normal_j, stored_j, 1e-9);
            assert!(now.energy_error.abs() < 1e-12, "{:e}", now.energy_error);
        }
        assert!(
            now.energy_error.abs() < (omega * step_s).powi(2),
            "{:e}",
            now.energy_error
        );
        let apart_m = (place(&state, 1) - place(&state, 0)).x - 2e-3;
        let wanted_m = stretch_m * (f64::from(n) * phi).cos();
        assert!(
            (apart_m - wanted_m).abs() < 1e-8 * stretch_m,
            "{n}: {apart_m:e}, {wanted_m:e}"
        );
        advance(&mut state);
    }
    // The centre of mass stays at its initial position.
    let centre_m = 0.5 * (place(&state, 0) + place(&state, 1));
    assert!((centre_m.x - 1.0e-3 - 0.1e-6).abs() < 1e-15);
}

/// Two tables and the body itself add up; a rotating group rotates about its own centre of mass.
#[test]
fn velocities_of_a_set_come_on_top_of_those_of_its_body() {
    let text = PAIR.replace(
        "material = \"m\",",
        "material = \"m\", velocity = [3, 0, 0],",
    );
    let text = format!(
        "{text}run.end_time = 1e-3\n\
         initial.turning = {{ group = \"all\", angular_velocity = [0, 0, 100] }}\n\
         initial.rising = {{ group = \"second\", velocity = [0, 0, 2], displacement = [0, 0, 0] }}\n"
    );
    let state = planned(&text).state;
    let of = |i: usize| {
        let motion = &state.particles.motions[i];
        (motion.velocity_m_s, motion.spin_rad_s)
    };
    let near = |got: [f64; 3], wanted: [f64; 3]| (0..3).all(|k| (got[k] - wanted[k]).abs() < 1e-12);
    for (i, wanted) in [(0, [3.0, -0.1, 0.0]), (1, [3.0, 0.1, 2.0])] {
        let (velocity, spin) = of(i);
        assert!(near(velocity, wanted), "{i}: {velocity:?}");
        assert_eq!(spin, [0.0, 0.0, 100.0]);
    }
}

/// Groups are selected by positions without displacement, and initial displacements do not count as
/// displacement since the start.
#[test]
fn sets_are_picked_before_anything_is_displaced() {
    let text = format!(
        "{PAIR}run.end_time = 1e-3\n\
         groups.left = {{ box = {{ min = [-1e-3, -1, -1], max = [1e-3, 1, 1] }} }}\n\
         initial.one = {{ group = \"left\", displacement = [5e-3, 0, 0] }}\n\
         initial.two = {{ group = \"left\", displacement = [0, 1e-3, 0] }}\n"
    );
    let plan = planned(&text);
    assert_eq!(plan.groups["left"], [0]);
    assert!((place(&plan.state, 0).x - 5e-3).abs() < 1e-18);
    assert!((place(&plan.state, 0).y - 1e-3).abs() < 1e-18);
}

/// With zero displacement and velocity, a scene is the same as without, to the bit.
#[test]
fn a_start_of_zero_changes_nothing() {
    let text = format!("{PAIR}run = {{ end_time = 1e-3, gravity = [1, 2, 3] }}\n");
    let with = format!("{text}initial.all = {{ group = \"all\", velocity = [0, 0, 0] }}\n");
    let [with, without] = [with, text].map(|text| planned(&text).state);
    assert_eq!(with.particles.poses, without.particles.poses);
    assert_eq!(with.particles.motions, without.particles.motions);
    assert_eq!(with.time_step_s, without.time_step_s);
}

/// The search for the longest stable step uses trial motions; a balance before the first step is
/// not affected by them.
#[test]
fn a_plan_with_damped_bonds_has_the_energy_that_it_was_given() {
    let speed_m_s = 0.3;
    let text = PAIR.replace(
        "radius_factor = 1",
        "radius_factor = 1, damping = { damping_ratio = 0.2, per_mode = true }",
    );
    let text = format!(
        "{text}run.end_time = 1e-3\n\
         initial.one = {{ group = \"first\", velocity = [{speed_m_s}, 0, 0] }}\n\
         initial.other = {{ group = \"second\", velocity = [-{speed_m_s}, 0, 0] }}\n"
    );
    let mut state = planned(&text).state;
    let moving_j = MASS_KG * speed_m_s * speed_m_s;
    assert_near(balance(&mut state).kinetic_j, moving_j, 1e-12);
}
