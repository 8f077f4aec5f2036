//! Approaching objects wake sleeping bodies, which continue as they fell asleep.

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::state::State;
use dem_engine::step::{advance, interact};
use nalgebra::Vector3;

use super::{
    CLUMP, GROUND, SLEEP, apart_m, ball, depth_m, force_on_clump, go, go_until, go_until_asleep,
    head, slab, slab_kg, sleep, started,
};

/// A slab at rest, and a ball that is thrown up and falls on it.
fn thrown(start: &str) -> String {
    let lying = slab("lying", [0.0, 0.0, 0.0], start);
    let ball = ball("ball", [1e-3, 1e-3, 4e-3], "velocity = [0, 0, 0.25]");
    format!("{}{lying}{ball}{GROUND}", head(0.0))
}

#[test]
fn a_ball_that_comes_down_wakes_what_it_hits() {
    for start in [CLUMP, ""] {
        let mut state = started(&format!("{}{SLEEP}", thrown(start)));
        let mut awake = started(&thrown(start));
        go_until_asleep(&mut state, 1);
        assert!(state.time_s < 0.04);
        let mut woke_s = 0.0;
        while sleep(&state).bodies > 0 {
            go(&mut state);
            woke_s = state.time_s;
        }
        assert!((0.055..0.06).contains(&woke_s), "{woke_s}");
        // Not by contact: there was a gap left.
        let contacts = state.contacts.as_ref().unwrap();
        assert!(contacts.histories.iter().all(|m| m.overlap_m() == 0.0));
        let mut largest_m = 0.0_f64;
        go_until(&mut awake, state.time_s);
        assert_eq!(awake.steps, state.steps);
        while state.time_s < 0.065 {
            go(&mut state);
            go(&mut awake);
            for state in [&mut state, &mut awake] {
                place_all(&state.clumps, &mut state.particles);
            }
            largest_m = largest_m.max(apart_m(&state, &awake));
        }
        let moved = |state: &State| state.particles.poses[0].place().z - 1e-3;
        eprintln!(
            "{start:?}: apart {largest_m:.1e} m, woke at {woke_s} s, {:e}",
            moved(&state)
        );
        // The slab was within this distance of its rest position when it fell asleep, and the ball
        // hits it earlier or later by the same.
        assert!(largest_m < 1e-2 * depth_m(slab_kg()), "{largest_m:e}");
    }
}

#[test]
fn on_a_slope_friction_holds_as_before() {
    // A plate approaches, close enough to wake the slab, and stays above it.
    let lid = "[walls.lid]\nplane = { point = [0, 0, 2.1e-3], normal = [0, 0, -1] }\nmaterial = \"stuff\"\n\
         displacement = [0, 0, -5e-6]\ntable = [[0, 0], [0.1, 0], [0.101, 1]]\n";
    let slope_rad = 0.4;
    let lying = slab("lying", [0.0, 0.0, 0.0], CLUMP);
    let text = format!(
        "{}search.skin = 0.3\n{lying}{GROUND}{lid}{SLEEP}",
        head(slope_rad)
    );
    let mut state = started(&text);
    go_until_asleep(&mut state, 1);
    go(&mut state);
    let place = |state: &State| Vector3::from(state.clumps.all[0].place_m);
    let (start, springs) = (place(&state), sleep(&state).touches.clone());
    assert_eq!(springs.len(), 4);
    while sleep(&state).bodies > 0 {
        assert!(state.time_s < 0.11);
        interact(&mut state);
        if sleep(&state).bodies > 0 {
            advance(&mut state);
        }
    }
    assert!((state.time_s - 0.1).abs() < 2.0 * state.time_step_s);
    // In the first step after it, all forces are as when it fell asleep, equal to the weight.
    let weight_n = -slab_kg() * Vector3::from(state.model.gravity_m_s2);
    let off = (force_on_clump(&state, 0) - weight_n).norm() / weight_n.norm();
    assert!(off < 1e-3, "{off:e}");
    for (touch, kept) in state.walls[0].touching.iter().zip(&springs) {
        assert_eq!(touch.particle, kept.touch.particle);
        for k in 0..4 {
            let (now, then) = (
                touch.history.tangential[k],
                kept.touch.history.tangential[k],
            );
            assert!(
                (now - then).abs() <= 1e-12 * depth_m(slab_kg()),
                "{now:e} {then:e}"
            );
        }
    }
    let slid = springs[0].touch.history.tangential;
    let spring_m = slid[0].hypot(slid[1]);
    advance(&mut state);
    let mut moved_m = 0.0_f64;
    while state.time_s < 0.103 {
        go(&mut state);
        moved_m = moved_m.max((place(&state) - start).norm());
    }
    eprintln!("force off by {off:.1e}, moved {moved_m:.1e} m of {spring_m:.1e}");
    assert!(moved_m < 1e-2 * spring_m, "{moved_m:e} {spring_m:e}");
    // And falls asleep again.
    go_until_asleep(&mut state, 1);
    assert!((place(&state) - start).norm() < 1e-2 * spring_m);
}

#[test]
fn a_pile_wakes_as_one() {
    let piled = |n: i32| 2e-3 * f64::from(n);
    let mut text = head(0.0);
    for n in 0..3 {
        text += &slab(&format!("s{n}"), [0.0, 0.0, piled(n)], CLUMP);
    }
    // Far enough from the pile.
    text += &slab("apart", [0.02, 0.0, 0.0], CLUMP);
    let ball = ball(
        "ball",
        [1e-3, 1e-3, piled(3) + 2e-3],
        "velocity = [0, 0, 0.25]",
    );
    let mut state = started(&format!("{text}{ball}{GROUND}{SLEEP}"));
    go_until_asleep(&mut state, 4);
    while sleep(&state).bodies == 4 {
        go(&mut state);
    }
    let news = &state.scratch.events.sleep;
    assert_eq!((news.len(), news[0].kind, news[0].bodies), (1, "awake", 3));
    let asleep: Vec<bool> = state.clumps.all.iter().map(|clump| clump.asleep).collect();
    assert_eq!(asleep, [true, false, false, false]);
}
