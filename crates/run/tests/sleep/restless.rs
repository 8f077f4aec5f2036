//! Bodies that never sleep, and bodies that are woken by distant events.

use super::{
    CLUMP, GROUND, SLEEP, ball, go, go_until, go_until_asleep, head, slab, sleep, started,
};

fn never_sleeps(text: &str, until_s: f64) {
    let mut state = started(&format!("{text}{SLEEP}"));
    while state.time_s < until_s {
        go(&mut state);
        assert_eq!(sleep(&state).bodies, 0, "at {} s", state.time_s);
    }
}

/// A slab on the ground, and the ground.
fn lying(start: &str, ground: &str) -> String {
    format!(
        "{}{}{GROUND}{ground}\n",
        head(0.0),
        slab("lying", [0.0, 0.0, 0.0], start)
    )
}

#[test]
fn nobody_sleeps_on_what_turns_or_changes_its_motion() {
    // All motions are slower than the speed limit for sleep.
    for motion in [
        "velocity = [0, 0, 1e-4]\ntable = [[0, 1], [1, 2]]",
        "angular_velocity = [0, 0, 1e-2]",
        "displacement = [0, 0, 1e-5]\nramp = \"1 s\"",
        "servo = { force = 1e-3, direction = [0, 0, 1], max_velocity = 1e-5 }",
    ] {
        for start in [CLUMP, ""] {
            never_sleeps(&lying(start, motion), 0.03);
        }
    }
}

#[test]
fn nobody_sleeps_who_is_held_or_loaded_or_lies_on_such() {
    let loads = "[loads.push]\ngroup = \"lying\"\nforce = [0, 0, -1e-5]\n";
    let supports = "[supports.hold]\ngroup = \"lying\"\nfixed = [\"ry\"]\n";
    for more in [loads, supports] {
        never_sleeps(&lying("", more), 0.03);
        let on_it = slab("rider", [0.0, 0.0, 2e-3], CLUMP);
        never_sleeps(&lying("", &format!("{on_it}{more}")), 0.03);
    }
}

#[test]
fn who_touches_somebody_restless_does_not_sleep() {
    // A rolling ball, slower than the limit for sleep, is quiet; one that spins faster is not, and
    // rests on the slab.
    let spinner = ball(
        "spinner",
        [1e-3, 1e-3, 2e-3 * 0.5_f64.sqrt()],
        "angular_velocity = [0, 0, 400]",
    );
    let text = lying(CLUMP, &spinner).replace("friction = 0.8", "friction = 0.0");
    let mut state = started(&format!("{text}{SLEEP}"));
    go_until(&mut state, 0.05);
    assert_eq!(sleep(&state).bodies, 0);
    assert!(state.particles.motions[0].spin_rad_s[2] > 300.0);
}

#[test]
fn a_wall_that_begins_to_move_wakes_at_once() {
    let text = lying(
        CLUMP,
        "velocity = [0, 0, 0.01]\ntable = [[0, 0], [0.04, 0], [0.05, 1]]",
    );
    let mut state = started(&format!("{text}{SLEEP}"));
    let mut awake = started(&text);
    go_until_asleep(&mut state, 1);
    assert!(state.time_s < 0.03);
    let mut woke_s = 0.0;
    while state.time_s < 0.05 {
        let before = sleep(&state).bodies;
        go(&mut state);
        if sleep(&state).bodies < before {
            assert_eq!((before, woke_s), (1, 0.0));
            // In the step in which the wall begins to move.
            woke_s = state.time_s - state.time_step_s;
            // Times are sums of steps.
            let wanted = (0.04 / state.time_step_s).floor() as u64;
            assert!((state.steps - 1).abs_diff(wanted) <= 1);
        }
    }
    assert!(woke_s > 0.0);
    go_until(&mut awake, 0.05);
    let z_m = |state: &dem_engine::state::State| state.clumps.all[0].place_m[2];
    // Carried along: 10 mm/s over half of 10 ms.
    assert!((z_m(&state) - 1e-3 - 5e-5).abs() < 2e-6, "{}", z_m(&state));
    assert!((z_m(&state) - z_m(&awake)).abs() < 1e-9);
}

#[test]
fn a_clump_that_is_replaced_wakes_and_its_island_with_it() {
    let top = slab("top", [0.0, 0.0, 2e-3], CLUMP);
    let text = lying(
        CLUMP,
        &format!("{top}[replacement.top]\nwhen = {{ time = 0.05 }}\n"),
    );
    let mut state = started(&format!("{text}{SLEEP}"));
    go_until_asleep(&mut state, 2);
    assert!(state.time_s < 0.05);
    go_until(&mut state, 0.049);
    assert_eq!(sleep(&state).bodies, 2);
    while state.population.replaced == 0 {
        go(&mut state);
    }
    assert_eq!((sleep(&state).bodies, state.particles.free), (0, 4));
    go(&mut state);
    // The lower one's history of its contact with the upper one is kept.
    let contacts = state.contacts.as_ref().unwrap();
    let pressed = contacts.histories.iter().filter(|m| m.overlap_m() > 0.0);
    assert_eq!(pressed.count(), 4);
    go_until_asleep(&mut state, 2);
    assert_eq!(sleep(&state).bonds, 4);
}

#[test]
fn sleepers_leave_and_keep_their_place_against_those_who_come() {
    let floor = lying(CLUMP, "");
    let text = format!(
        "{floor}[regions.gate]\nbox = {{ min = [-1e-3, -1e-3, 0], max = [3e-3, 3e-3, 2e-3] }}\n\
         [regions.all]\nbox = {{ min = [-1, -1, -1], max = [1, 1, 1] }}\n{}\
         [inlets.feed]\nbodies = [\"grain\"]\nregion = \"gate\"\nrate = 1000\nstart = 0.04\nend = 0.06\n",
        ball("grain", [0.0, 0.0, -RADIUS], CLUMP)
    );
    let mut state = started(&format!("{text}{SLEEP}"));
    go_until_asleep(&mut state, 1);
    go_until(&mut state, 0.05);
    // No position is free within the slab.
    assert_eq!((state.clumps.all.len(), sleep(&state).bodies), (1, 1));
    assert_eq!(state.population.inlets[0].bodies, 0);
}

#[test]
fn what_lies_on_a_sleeper_that_leaves_falls() {
    let top = slab("top", [0.0, 0.0, 2e-3], CLUMP);
    let text = lying(
        CLUMP,
        &format!(
            "{top}[regions.low]\nbox = {{ min = [-1, -1, -1], max = [1, 1, 1.5e-3] }}\n[outlets.hole]\ninside = \"low\"\n"
        ),
    );
    let mut state = started(&format!("{text}{SLEEP}"));
    // As if the hole were opened when both sleep.
    let outlets = std::mem::take(&mut state.model.rules.outlets);
    go_until_asleep(&mut state, 2);
    state.model.rules.outlets = outlets;
    while state.clumps.all.len() == 2 {
        go(&mut state);
    }
    assert_eq!(sleep(&state).bodies, 0);
    assert!(sleep(&state).touches.is_empty() && sleep(&state).pairs.is_empty());
    let start_s = state.time_s;
    go_until(&mut state, start_s + 5e-3);
    let fallen_m = 3e-3 - state.clumps.all[0].place_m[2];
    let wanted_m = 0.5 * super::GRAVITY_M_S2 * 25e-6;
    assert!(
        (fallen_m / wanted_m - 1.0).abs() < 0.03,
        "{fallen_m:e} {wanted_m:e}"
    );
}

const RADIUS: f64 = super::RADIUS_M;
