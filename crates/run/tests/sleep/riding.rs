//! Bodies at rest on a belt or a moving wall sleep and ride with it.

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{advance, interact, number_of, stages};
use nalgebra::Vector3;

use super::{
    CLUMP, GRAVITY_M_S2, GROUND, RADIUS_M, SLEEP, SPEED_M_S, apart_m, ball, depth_m, go, go_until,
    go_until_asleep, head, slab, slab_kg, sleep, started, work,
};

/// Velocity of the belts, m/s.
const BELT_M_S: f64 = 0.1;

/// A belt along x that is 12 mm wide and ends at `end_m`, and a static table beside it that is 1 mm
/// higher.
pub(super) fn belts(speed_m_s: &str, end_m: f64) -> String {
    format!(
        "{}search.skin = 0.1\n\
         [walls.belt]\nbox = {{ min = [-10e-3, -9.8e-3, -5e-3], max = [{end_m:e}, 2.2e-3, 0] }}\n\
         material = \"stuff\"\nsurface_velocity = [{speed_m_s}, 0, 0]\n\
         [walls.table]\nbox = {{ min = [-10e-3, 3.2e-3, -5e-3], max = [{end_m:e}, 10e-3, 1e-3] }}\n\
         material = \"stuff\"\n",
        head(0.0)
    )
}

fn riding(start: &str) -> String {
    format!("{start}\nvelocity = [{BELT_M_S}, 0, 0]")
}

/// The scene with and without sleep, until this number of bodies sleep in the one.
fn both(text: &str, bodies: usize) -> [State; 2] {
    let mut state = started(&format!("{text}{SLEEP}"));
    go_until_asleep(&mut state, bodies);
    [state, started(text)]
}

/// Distance from the rest position that a body below the speed limit may have: see `settle`.
fn swing_m() -> f64 {
    SPEED_M_S / (1.5 * GRAVITY_M_S2 / depth_m(slab_kg())).sqrt()
}

fn placed_apart_m([one, other]: [&mut State; 2]) -> f64 {
    for state in [&mut *one, &mut *other] {
        place_all(&state.clumps, &mut state.particles);
    }
    apart_m(one, other)
}

/// Continues until a body wakes, and returns the cause.
fn go_until_awake(state: &mut State, bodies: usize) -> &'static str {
    loop {
        assert!(state.time_s < 0.5, "nobody wakes");
        interact(state);
        if sleep(state).bodies < bodies {
            return state.scratch.events.sleep[0].cause;
        }
        advance(state);
    }
}

/// Largest force on the first body, N, and the largest distance between the two states, m, while
/// both go on until this time.
fn follow([one, other]: [&mut State; 2], until_s: f64) -> ([f64; 2], f64) {
    let (mut largest_n, mut far_m) = ([0.0_f64; 2], 0.0_f64);
    while one.time_s < until_s {
        for (state, largest_n) in [&mut *one, &mut *other].into_iter().zip(&mut largest_n) {
            interact(state);
            *largest_n = largest_n.max(Vector3::from(state.clumps.all[0].force_n).norm());
            advance(state);
        }
        far_m = far_m.max(placed_apart_m([one, other]));
    }
    (largest_n, far_m)
}

#[test]
fn a_body_rides_to_the_end_of_a_belt_and_falls_as_if_it_had_never_slept() {
    for start in [CLUMP, ""] {
        let end_m = 12e-3;
        let text = belts("0.1", end_m) + &slab("rider", [0.0, 0.0, 0.0], &riding(start));
        let [mut state, mut awake] = both(&text, 1);
        assert_eq!(sleep(&state).riders.len(), 1);
        assert!(state.time_s < 0.03, "{}", state.time_s);
        go(&mut state);
        assert_eq!(work(&state), [0; 4]);
        let speed = |state: &State| state.particles.motions[0].velocity_m_s;
        assert_eq!(speed(&state), [BELT_M_S, 0.0, 0.0]);
        assert_eq!(go_until_awake(&mut state, 1), "edge");
        // In the last step but one in which the centres of the front spheres are above the belt.
        place_all(&state.clumps, &mut state.particles);
        let fronts = state.particles.poses.iter().map(|pose| pose.place().x);
        let left_m = end_m - fronts.fold(0.0, f64::max);
        let step_m = BELT_M_S * state.time_step_s;
        assert!(
            left_m > 0.9 * step_m && left_m < 2.1 * step_m,
            "{left_m:e} {step_m:e}"
        );
        advance(&mut state);
        go_until(&mut awake, state.time_s - 0.5 * state.time_step_s);
        assert_eq!(awake.steps, state.steps);
        let apart_m = placed_apart_m([&mut state, &mut awake]);
        let until_s = state.time_s + 0.06;
        let (_, far_m) = if start.is_empty() {
            go_until(&mut state, until_s);
            go_until(&mut awake, until_s);
            ([0.0; 2], placed_apart_m([&mut state, &mut awake]))
        } else {
            follow([&mut state, &mut awake], until_s)
        };
        let z_m = state.particles.poses[0].place().z;
        eprintln!(
            "apart {apart_m:e} m, later {far_m:e} m of {:e}, at {z_m} m",
            swing_m()
        );
        assert!(apart_m < swing_m(), "{apart_m:e}");
        assert!(z_m < -3e-3, "it has not fallen: {z_m}");
        assert!(far_m < 20.0 * swing_m(), "{far_m:e}");
    }
}

/// Errors of the balance while somebody rides, of the energy over the work against gravity.
fn ride_balance(text: &str, rise_m_s: f64) {
    let mut state = started(&format!("{text}{SLEEP}"));
    go_until_asleep(&mut state, 1);
    let look = |state: &mut State| {
        interact(state);
        let found = balance(state);
        advance(state);
        found
    };
    go(&mut state);
    let (first, start_s) = (look(&mut state), state.time_s);
    for _ in 0..2000 {
        look(&mut state);
    }
    assert_eq!(sleep(&state).riders.len(), 1);
    let last = look(&mut state);
    let work_j = slab_kg() * GRAVITY_M_S2 * rise_m_s * (state.time_s - start_s);
    let [done_j, off_j] = [
        last.wall_work_j - first.wall_work_j,
        last.energy_error_j - first.energy_error_j,
    ];
    eprintln!("{done_j:e} J of {work_j:e} J, off by {off_j:e} J; {last:?}");
    assert!((done_j / work_j - 1.0).abs() < 1e-9);
    assert!(off_j.abs() < 1e-9 * work_j.abs());
    assert!(last.momentum_error.abs() < 1e-10 && last.angular_momentum_error.abs() < 1e-10);
    // Also as it falls asleep and wakes.
    assert!(last.energy_error.abs() < 1e-5, "{}", last.energy_error);
}

#[test]
fn the_work_of_a_belt_that_lifts_or_lowers_is_booked() {
    let slope_rad: f64 = 0.3;
    for along in [0.1, -0.1] {
        let belt = format!("surface_velocity = [{along}, 0, 0]\n");
        let more = format!("{CLUMP}\nvelocity = [{along}, 0, 0]");
        let lying = slab("rider", [0.0, 0.0, 0.0], &more);
        let text = format!("{}{lying}{GROUND}{belt}", head(slope_rad));
        // Gravity pulls along x.
        ride_balance(&text, -along * slope_rad.sin());
    }
}

#[test]
fn bodies_ride_on_a_wall_that_rises() {
    for start in [CLUMP, ""] {
        let lying = slab(
            "rider",
            [0.0, 0.0, 0.0],
            &format!("{start}\nvelocity = [0.02, 0, 0.1]"),
        );
        let text = format!("{}{lying}{GROUND}velocity = [0.02, 0, 0.1]\n", head(0.0));
        ride_balance(&text, 0.1);
    }
}

#[test]
fn riders_of_many_spheres_are_at_no_wall() {
    let places = (0..20).map(|n| [n % 5, n / 5].map(|n| 2.0 * RADIUS_M * f64::from(n)));
    let spheres = places.map(|[x, y]| format!("[{x:e}, {y:e}, {RADIUS_M:e}, {RADIUS_M:e}]"));
    let spheres: Vec<String> = spheres.collect();
    let velocity = "velocity = [0.02, 0, 0.1]";
    let body = format!(
        "[bodies.rider]\nmaterial = \"stuff\"\nparticles = [{}]\n{CLUMP}\n{velocity}\n",
        spheres.join(", ")
    );
    let mut state = started(&format!("{}{body}{GROUND}{velocity}\n{SLEEP}", head(0.0)));
    go_until_asleep(&mut state, 1);
    go(&mut state);
    for _ in 0..2000 {
        go(&mut state);
        let wall = &state.walls[0];
        assert!(wall.near.is_empty() && wall.touching.is_empty());
    }
    assert_eq!(sleep(&state).riders.len(), 1);
}

#[test]
fn a_belt_that_is_slower_than_the_limit_of_sleep_carries() {
    let lying = slab("lying", [0.0, 0.0, 0.0], CLUMP);
    for motion in ["surface_velocity = [1e-4, 0, 0]", "velocity = [0, 0, 1e-4]"] {
        let text = format!("{}{lying}{GROUND}{motion}\n{SLEEP}", head(0.0));
        let mut state = started(&text);
        go_until_asleep(&mut state, 1);
        let [x, y, z] = state.clumps.all[0].velocity_m_s;
        assert_eq!([x.max(z), y], [1e-4, 0.0]);
    }
}

/// A rider that comes to a ball on the table beside the belt, or to a wall.
fn meets(more: &str, bodies: usize) {
    let text = belts("0.1", 40e-3) + &slab("rider", [0.0, 0.0, 0.0], &riding(CLUMP)) + more;
    let [mut state, mut awake] = both(&text, bodies);
    assert_eq!(go_until_awake(&mut state, bodies), "near");
    // A gap is left.
    let contacts = state.contacts.as_ref().unwrap();
    assert!(contacts.histories.iter().all(|m| m.overlap_m() == 0.0));
    advance(&mut state);
    assert_eq!(sleep(&state).bodies, 0);
    go_until(&mut awake, state.time_s - 0.5 * state.time_step_s);
    assert_eq!(awake.steps, state.steps);
    let until_s = state.time_s + 5e-3;
    let (forces_n, far_m) = follow([&mut state, &mut awake], until_s);
    eprintln!("forces {forces_n:?} N, apart {far_m:e} m");
    let weight_n = slab_kg() * GRAVITY_M_S2;
    assert!(forces_n[1] > 2.0 * weight_n, "{forces_n:?} {weight_n}");
    assert!(
        (forces_n[0] / forces_n[1] - 1.0).abs() < 0.01,
        "{forces_n:?}"
    );
    assert!(far_m < 20.0 * swing_m(), "{far_m:e}");
}

#[test]
fn a_rider_wakes_before_it_meets_a_body_at_rest() {
    meets(&ball("resting", [14e-3, 3.25e-3, 1e-3], ""), 2);
}

#[test]
fn a_rider_wakes_before_it_meets_a_slower_one() {
    let more = ball("slower", [9e-3, 3.25e-3, 1e-3], "velocity = [0.05, 0, 0]");
    let text = belts("0.1", 40e-3) + &slab("rider", [0.0, 0.0, 0.0], &riding(CLUMP)) + &more;
    let text = text.replace(
        "max = [4e-2, 10e-3, 1e-3] }",
        "max = [4e-2, 10e-3, 1e-3] }\nsurface_velocity = [0.05, 0, 0]",
    );
    let mut state = started(&format!("{text}{SLEEP}"));
    go_until_asleep(&mut state, 2);
    assert_eq!(sleep(&state).riders.len(), 2);
    assert_eq!(go_until_awake(&mut state, 2), "near");
    let contacts = state.contacts.as_ref().unwrap();
    assert!(contacts.histories.iter().all(|m| m.overlap_m() == 0.0));
    assert_eq!(sleep(&state).bodies, 0);
    // The slab has caught up with the ball.
    let x_m = |i: usize| state.particles.poses[i].place().x;
    let front_m = (1..5).map(x_m).fold(0.0, f64::max);
    assert!(
        (0.5e-3..2.5e-3).contains(&(x_m(0) - front_m)),
        "{front_m} {}",
        x_m(0)
    );
}

#[test]
fn a_rider_wakes_before_it_meets_a_plate() {
    let plate = "[walls.plate]\nbox = { min = [15e-3, -20e-3, 0.5e-3], max = [16e-3, 20e-3, 5e-3] }\n\
         material = \"stuff\"\n";
    meets(plate, 1);
}

#[test]
fn a_rider_wakes_before_it_meets_something_awake() {
    // Thrown up, and it comes down on the rider.
    let thrown = ball("thrown", [5e-3, 1e-3, 4e-3], "velocity = [0, 0, 0.25]");
    let text = belts("0.1", 40e-3) + &slab("rider", [0.0, 0.0, 0.0], &riding(CLUMP)) + &thrown;
    let [mut state, mut awake] = both(&text, 1);
    assert_eq!(go_until_awake(&mut state, 1), "near");
    assert!(
        state
            .contacts
            .as_ref()
            .unwrap()
            .histories
            .iter()
            .all(|m| m.overlap_m() == 0.0)
    );
    advance(&mut state);
    go_until(&mut awake, state.time_s - 0.5 * state.time_step_s);
    let until_s = state.time_s + 5e-3;
    let (forces_n, far_m) = follow([&mut state, &mut awake], until_s);
    eprintln!("forces {forces_n:?} N, apart {far_m:e} m");
    assert!(
        (forces_n[0] / forces_n[1] - 1.0).abs() < 0.01,
        "{forces_n:?}"
    );
    assert!(far_m < 20.0 * swing_m(), "{far_m:e}");
}

#[test]
fn a_wall_that_stops_wakes_its_riders_at_once() {
    let lying = slab(
        "rider",
        [0.0, 0.0, 0.0],
        &format!("{CLUMP}\nvelocity = [0.05, 0, 0]"),
    );
    let stops = "velocity = [0.05, 0, 0]\ntable = [[0, 1], [0.04, 1], [0.041, 0]]\n";
    let text = format!("{}{lying}{GROUND}{stops}", head(0.0));
    let [mut state, mut awake] = both(&text, 1);
    go_until_awake(&mut state, 1);
    // In the step whose middle is the first after the change.
    let wanted_s = 0.04 - 0.5 * state.time_step_s;
    assert!(
        (state.time_s - wanted_s).abs() <= state.time_step_s,
        "{}",
        state.time_s
    );
    advance(&mut state);
    go_until(&mut awake, state.time_s - 0.5 * state.time_step_s);
    let (_, far_m) = follow([&mut state, &mut awake], 0.05);
    eprintln!("apart {far_m:e} m");
    assert!(far_m < 20.0 * swing_m(), "{far_m:e}");
    assert!(state.clumps.all[0].velocity_m_s[0].abs() < SPEED_M_S);
}

/// Steps until the number of clumps is this.
fn steps_until(state: &mut State, clumps: usize) -> u64 {
    while state.clumps.all.len() != clumps {
        assert!(state.time_s < 0.3, "{} clumps", state.clumps.all.len());
        go(state);
    }
    state.steps
}

#[test]
fn outlets_and_triggers_see_riders() {
    let region = "[regions.end]\nbox = { min = [15e-3, -1, -1], max = [1, 1, 1] }\n";
    for rule in [
        "[outlets.end]\ninside = \"end\"\n",
        "[replacement.rider]\nwhen = { enters = \"end\" }\n",
    ] {
        let rider = slab("rider", [0.0, 0.0, 0.0], &riding(CLUMP));
        let text = belts("0.1", 40e-3) + &rider + region + rule;
        let [mut state, mut awake] = both(&text, 1);
        let riders_steps = steps_until(&mut state, 0);
        let steps = steps_until(&mut awake, 0);
        assert!(
            riders_steps.abs_diff(steps) <= 1 + (swing_m() / BELT_M_S / state.time_step_s) as u64,
            "{riders_steps} {steps}"
        );
        assert_eq!(sleep(&state).bodies, 0);
        assert!(sleep(&state).riders.is_empty());
    }
}

#[test]
fn riders_are_not_worked_on() {
    let mut text = format!(
        "{}{GROUND}surface_velocity = [0.1, 0, 0]\n{SLEEP}",
        head(0.0)
    );
    for n in 0..100 {
        let at_m = [n % 10, n / 10].map(|at| 6e-3 * f64::from(at));
        text += &slab(&format!("s{n}"), [at_m[0], at_m[1], 0.0], &riding(CLUMP));
    }
    let mut state = started(&text);
    go_until_asleep(&mut state, 100);
    go(&mut state);
    let done = |state: &State| -> Vec<(&str, u64)> {
        let counted = [
            "rigid clumps",
            "walls",
            "particle contacts",
            "neighbour search",
        ];
        let all = stages()
            .iter()
            .filter(|stage| counted.contains(&stage.name));
        all.map(|stage| (stage.name, state.scratch.clock.done(number_of(stage))))
            .collect()
    };
    let before = done(&state);
    let start_m = state.clumps.all[0].place_m[0];
    let start_s = state.time_s;
    for _ in 0..500 {
        go(&mut state);
    }
    assert_eq!(before.len(), 4);
    assert_eq!(done(&state), before);
    assert_eq!(work(&state), [0; 4]);
    let moved_m = state.clumps.all[0].place_m[0] - start_m;
    let wanted_m = BELT_M_S * (state.time_s - start_s);
    assert!((moved_m / wanted_m - 1.0).abs() < 1e-12);
    // What measures and files see.
    place_all(&state.clumps, &mut state.particles);
    let middle = (0..4)
        .map(|i| state.particles.poses[i].place())
        .sum::<Vector3<f64>>()
        / 4.0;
    let off_m = (middle - Vector3::from(state.clumps.all[0].place_m)).norm();
    assert!(off_m < 1e-9 * RADIUS_M, "{off_m:e}");
    // The belt feels them where they are.
    interact(&mut state);
    let [force_n, torque_n_m] = state.walls[0].total_load();
    let arm_m = state
        .clumps
        .all
        .iter()
        .map(|clump| clump.place_m[0])
        .sum::<f64>()
        / 100.0;
    assert!(
        (-torque_n_m[1] / force_n[2] / arm_m - 1.0).abs() < 1e-3,
        "{torque_n_m:?}"
    );
}
