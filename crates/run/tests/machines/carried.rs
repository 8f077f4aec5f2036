//! Bodies that lie on moving walls: they follow them, do not sleep, and go on after an interruption.

use std::f64::consts::TAU;

use dem_engine::step::interact;
use dem_plan::Plan;
use dem_runner::Progress;
use dem_runner::snapshot::{Snapshot, fingerprint};

use super::go_until;
use crate::helpers::{planned, started};

const GRAVITY_M_S2: f64 = 9.81;
/// Of the contact with the plate, N/m.
const STIFFNESS_N_M: f64 = 1e4;

/// A slab of four spheres of 1 mm that lies on a plate with this motion.
fn on_a_plate(motion: &str, more: &str) -> String {
    format!(
        "version = 1
run = {{ end_time = 2, gravity = [0, 0, -{GRAVITY_M_S2}] }}
materials.m = {{ density = 2000 }}
contacts.m-m = {{ law = \"linear\", normal_stiffness = {STIFFNESS_N_M}, restitution = 0.1, friction = 0.8 }}
[bodies.slab]
material = \"m\"
particles = [[0, 0, 1e-3, 1e-3], [2e-3, 0, 1e-3, 1e-3], [0, 2e-3, 1e-3, 1e-3], [2e-3, 2e-3, 1e-3, 1e-3]]
start_as = \"clump\"
[walls.plate]
box = {{ min = [-1, -1, -1], max = [1, 1, 0] }}
material = \"m\"
{motion}
{more}
"
    )
}

/// Below 1 g a body follows the plate: the force on it is the weight by the acceleration of the
/// plate, and it neither leaves it nor slides.
#[test]
fn a_body_on_a_plate_that_vibrates_below_1_g_follows_it() {
    let frequency_hz = 10.0;
    let rate_rad_s = TAU * frequency_hz;
    let reach_m = 0.5 * GRAVITY_M_S2 / rate_rad_s.powi(2);
    let swing = format!("displacement = [0, 0, {reach_m:e}]\nfrequency = {frequency_hz}");
    let orbit = format!(
        "orbit = {{ axis = [0, 1, 0], towards = [-1, 0, 0], radius = {reach_m:e}, frequency = {frequency_hz} }}"
    );
    for (motion, slides) in [(swing, false), (orbit, true)] {
        let mut state = started(&on_a_plate(&motion, ""));
        // The plate starts at its full speed upwards, without acceleration; the body at rest.
        go_until(&mut state, 0.3);
        let mass_kg = state.clumps.templates[0].mass_kg;
        let weight_n = mass_kg * GRAVITY_M_S2;
        let start_x_m = state.clumps.all[0].place_m[0] - state.walls[0].frame.position_m[0];
        let mut extremes = [f64::INFINITY, 0.0];
        while state.time_s < 0.5 {
            interact(&mut state);
            let upwards = -reach_m * rate_rad_s.powi(2) * (rate_rad_s * state.time_s).sin();
            let wanted = weight_n + mass_kg * upwards;
            let push_n = state.walls[0].push.force_n[2];
            assert!(
                (push_n / wanted - 1.0).abs() < 0.01,
                "{push_n:e}, not {wanted:e} N"
            );
            extremes = [extremes[0].min(push_n), extremes[1].max(push_n)];
            let x_m = state.clumps.all[0].place_m[0] - state.walls[0].frame.position_m[0];
            // The tangential force of at most half the weight bends the contacts by this.
            let gives_m = if slides {
                mass_kg * 0.5 * GRAVITY_M_S2 / STIFFNESS_N_M
            } else {
                0.0
            };
            assert!(
                (x_m - start_x_m).abs() <= 4.0 * gives_m + 1e-12,
                "{:e}",
                x_m - start_x_m
            );
            dem_engine::step::advance(&mut state);
        }
        assert!((extremes[0] / weight_n - 0.5).abs() < 0.02, "{extremes:?}");
        assert!((extremes[1] / weight_n - 1.5).abs() < 0.02, "{extremes:?}");
    }
}

/// However slowly a plate moves, nothing falls asleep on it.
#[test]
fn nothing_sleeps_on_a_plate_that_vibrates() {
    let sleep = "[sleep]\nspeed = \"1 mm/s\"\nafter = \"5 ms\"";
    for (motion, asleep) in [
        ("", 1),
        ("displacement = [0, 0, 1e-5]\nfrequency = 2", 0),
        (
            "orbit = { axis = [0, 1, 0], towards = [1, 0, 0], radius = 1e-5, frequency = 2 }",
            0,
        ),
        (
            "gyration = { axis = [0, 0, 1], towards = [1, 0, 0], angle = 1e-4, frequency = 2 }",
            0,
        ),
        (
            "angular_displacement = { axis = [0, 1, 0], angle = 1e-4 }\nfrequency = 2",
            0,
        ),
    ] {
        let mut state = started(&on_a_plate(motion, sleep));
        let mut most = 0;
        while state.time_s < 0.3 {
            dem_engine::step::step(&mut state);
            most = most.max(state.sleep.as_ref().unwrap().bodies);
        }
        assert_eq!(most, asleep, "{motion}");
    }
}

/// A run that goes on in the middle of a motion has the same bits.
#[test]
fn an_interruption_changes_nothing() {
    let motions = [
        "angular_displacement = { axis = [0, 1, 0], angle = 1e-2 }\nfrequency = 9\nphase = \"20 deg\"",
        "orbit = { axis = [0, 1, 0], towards = [1, 0, 0], radius = 1e-3, frequency = 9 }",
        "gyration = { axis = [0, 0, 1], towards = [1, 0, 0], angle = 1e-2, frequency = 9, spin = 1 }",
    ];
    for motion in motions {
        let text = on_a_plate(motion, "").replace("1e-3, 1e-3]", "2e-3, 1e-3]");
        let Plan {
            mut state, bodies, ..
        } = planned(&text);
        let print = fingerprint(&state).unwrap();
        go_until(&mut state, 0.0317);
        let name = String::new();
        let shot = Snapshot::taken(
            &state,
            &bodies,
            name,
            print,
            Vec::new(),
            Progress::default(),
        );
        let bytes = shot.to_bytes().unwrap();
        let mut again = planned(&text);
        let snapshot = Snapshot::from_bytes(&bytes).unwrap();
        snapshot
            .restore(print, &mut again.state, &mut again.bodies)
            .unwrap();
        for state in [&mut state, &mut again.state] {
            go_until(state, 0.1);
        }
        let of = |state: &dem_engine::state::State| {
            let wall = &state.walls[0];
            let clump = &state.clumps.all[0];
            let all = [
                clump.place_m,
                clump.velocity_m_s,
                clump.angular_momentum,
                wall.frame.position_m,
            ];
            (
                state.steps,
                all,
                wall.frame.turned,
                wall.work_j,
                wall.touching.clone(),
            )
        };
        assert_eq!(of(&state), of(&again.state), "{motion}");
        assert!(state.walls[0].work_j != 0.0);
    }
}
