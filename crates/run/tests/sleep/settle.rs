//! Bodies that have come to rest sleep at their position.

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::step::interact;

use super::{
    AFTER_S, CLUMP, GROUND, SLEEP, SPEED_M_S, apart_m, ball, depth_m, go, go_until,
    go_until_asleep, head, slab, slab_kg, sleep, started, work,
};

/// A clump and a cluster that fall from half a millimetre, and a single sphere.
fn falling() -> String {
    let clump = slab("clump", [0.0, 0.0, 5e-4], CLUMP);
    let cluster = slab("cluster", [0.02, 0.0, 5e-4], "");
    let single = ball("single", [0.04, 0.0, 5e-4], "");
    format!("{}{clump}{cluster}{single}{GROUND}", head(0.0))
}

#[test]
fn bodies_that_land_fall_asleep_and_lie_where_they_would_lie() {
    let mut state = started(&format!("{}{SLEEP}", falling()));
    let mut awake = started(&falling());
    go_until_asleep(&mut state, 3);
    assert!(state.time_s > AFTER_S);
    go(&mut state);
    assert_eq!(work(&state), [0; 4]);
    assert_eq!(sleep(&state).pairs.len(), 0);
    assert_eq!(sleep(&state).touches.len(), 9);
    let poses = state.particles.poses.clone();
    let clumps = state.clumps.all.clone();
    let skin_left_m = state.contacts.as_ref().unwrap().skin_left_m;
    let until_s = state.time_s + 0.02;
    go_until(&mut state, until_s);
    assert_eq!(state.particles.poses, poses);
    assert_eq!(state.clumps.all, clumps);
    assert_eq!(state.contacts.as_ref().unwrap().skin_left_m, skin_left_m);
    go_until(&mut awake, until_s);
    assert!(awake.sleep.is_none());
    for state in [&mut state, &mut awake] {
        place_all(&state.clumps, &mut state.particles);
    }
    // Contacts oscillate with sqrt(3/2 g/d): a body below the speed limit is no farther than this
    // from its rest position.
    let swing_rad_s = (1.5 * super::GRAVITY_M_S2 / depth_m(slab_kg())).sqrt();
    let apart_m = apart_m(&state, &awake);
    eprintln!("{apart_m:e} m of {:e}", SPEED_M_S / swing_rad_s);
    assert!(apart_m < SPEED_M_S / swing_rad_s);
}

#[test]
fn work_is_divided_as_long_as_it_is_there() {
    let mut state = started(&format!("{}{SLEEP}", falling()));
    (state.scratch.threads, state.scratch.worth_a_thread) = (2, 4);
    state.divide();
    assert_eq!(state.scratch.partitions.len(), 2);
    go_until_asleep(&mut state, 3);
    assert_eq!(state.scratch.partitions.len(), 1);
}

#[test]
fn the_ground_still_feels_those_who_sleep() {
    let mut state = started(&format!("{}{SLEEP}", falling()));
    go_until_asleep(&mut state, 3);
    interact(&mut state);
    let [force_n, torque_n_m] = state.walls[0].total_load();
    let weight_n = 2.25 * slab_kg() * super::GRAVITY_M_S2;
    assert_eq!(state.walls[0].push.force_n, [0.0; 3]);
    // They still oscillated a little, by at most `speed` times the frequency over gravity.
    assert!((force_n[2] / weight_n - 1.0).abs() < 1e-2, "{force_n:?}");
    // The middle of a slab is a millimetre from its beginning.
    let arm_n_m = -(1e-3 + 21e-3 + 0.25 * 40e-3) / 2.25 * weight_n;
    assert!(
        (torque_n_m[1] / arm_n_m - 1.0).abs() < 1e-2,
        "{torque_n_m:?}"
    );
}

#[test]
fn a_stack_falls_asleep_at_once_when_its_last_body_rests() {
    let mut text = head(0.0);
    for (n, name) in ["low", "middle", "high"].iter().enumerate() {
        let z_m = 2e-3 * n as f64;
        let start = if n == 1 { "" } else { CLUMP };
        text += &slab(name, [0.0, 0.0, z_m + 1e-6 * (n as f64 + 1.0)], start);
    }
    let apart = slab("apart", [0.02, 0.0, 0.0], CLUMP);
    // Lands on the stack, long after that has come to rest.
    let late = ball("late", [1e-3, 1e-3, 6e-3 + 1e-3], "velocity = [0, 0, 0.3]");
    let mut state = started(&format!("{text}{apart}{late}{GROUND}{SLEEP}"));
    let mut seen = Vec::new();
    while state.time_s < 0.3 {
        go(&mut state);
        for news in &state.scratch.events.sleep {
            seen.push((news.kind, news.bodies));
        }
    }
    // The stack and the separate body sleep; the ball wakes only the stack; all four fall asleep as
    // one.
    assert_eq!(
        seen,
        [("asleep", 1), ("asleep", 3), ("awake", 3), ("asleep", 4)]
    );
    let bottoms = sleep(&state).touches.len();
    assert_eq!(bottoms, 8);
    assert_eq!(sleep(&state).pairs.len(), 8 + 4);
    assert_eq!(work(&state), [0; 4]);
}
