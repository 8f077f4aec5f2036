//! Walls that move: what is near them takes single time steps, and what they do is booked.

use dem_run::state::State;
use dem_run::step::{advance, interact};

use super::{CONTACTS, PLATE, errors, head, levels, pair, planned};

/// A hard pair far away, which sets the time step, and a soft one above a plate with this motion.
fn text(motion: &str, above_m: f64) -> String {
    head("run.end_time = 0.03\nrun.safety_factor = 0.2")
        + CONTACTS
        + PLATE
        + motion
        + &pair("a", "hard", [0.1, 0.0, 0.5], [0.0; 3])
        + &pair("b", "soft", [0.0, 0.0, above_m], [0.0, 0.01, 0.0])
}

/// What a run shows.
#[derive(Debug, Default)]
struct Shown {
    /// Levels of the soft pair, each once in a row.
    levels: Vec<u8>,
    /// Times of the first and the last contact with the plate, s.
    touched_s: Option<[f64; 2]>,
    /// Largest errors of energy, momentum and angular momentum.
    largest: [f64; 3],
}

/// Runs a scene and looks at each common time.
fn seen(text: &str) -> (State, Shown) {
    let mut state = planned(text).state;
    let mut shown = Shown::default();
    while state.time_s < 0.03 {
        interact(&mut state);
        if state.levels.is_some() {
            let [hard, _, soft, _] = levels(&state) else {
                panic!("four spheres")
            };
            assert_eq!(*hard, 0);
            if shown.levels.last() != Some(soft) {
                shown.levels.push(*soft);
            }
            if !state.walls[0].touching.is_empty() {
                assert_eq!(*soft, 0, "touches a moving wall at {} s", state.time_s);
                let first_s = shown.touched_s.map_or(state.time_s, |[first_s, _]| first_s);
                shown.touched_s = Some([first_s, state.time_s]);
            }
        }
        let errors = errors(&mut state);
        shown.largest = [0, 1, 2].map(|k| shown.largest[k].max(errors[k]));
        advance(&mut state);
    }
    (state, shown)
}

#[test]
fn a_body_is_at_the_step_of_a_wall_before_they_touch() {
    for motion in [
        "velocity = [0, 0, 0.5]\n",
        "angular_velocity = [0, -5, 0]\npivot = [-0.1, 0, 0]\n",
        "displacement = [0, 0, 5e-3]\ntable = [[0, 0], [0.004, 0], [0.008, 1], [0.01, 1]]\n",
    ] {
        let (_, shown) = seen(&text(motion, 3.5e-3));
        assert!(shown.touched_s.is_some(), "{motion} {shown:?}");
        let [first, .., last] = shown.levels[..] else {
            panic!("{motion} {shown:?}")
        };
        assert!(first > 0 && last == first, "{motion} {shown:?}");
        assert!(shown.levels.contains(&0), "{motion} {shown:?}");
        let [energy, momentum, angular_momentum] = shown.largest;
        assert!(energy < 2e-3, "{motion} {shown:?}");
        assert!(momentum < 1e-11 && angular_momentum < 1e-11, "{shown:?}");
    }
}

/// A hard pair at rest in the way of a plate, and a soft one at rest far away: no particle moves
/// before the plate comes, and no step changes. The hard pair moves as without steps by body.
#[test]
fn a_body_at_rest_is_not_missed() {
    let text = text("velocity = [0, 0, 0.5]\n", 0.5)
        .replace("[0.1, 0.0, 0.5]", "[0.1, 0.0, 0.005]")
        .replace("velocity = [0.0, 0.01, 0.0]", "velocity = [0.0, 0.0, 0.0]")
        .replace("run.safety", "run.time_step = 1e-6\nrun.safety");
    let off = text.replace("run.steps_by_body = true", "");
    let [on, off] = [&text, &off].map(|text| {
        let mut state = planned(text).state;
        let mut touched = 0;
        while state.steps < 20_000 {
            interact(&mut state);
            touched += usize::from(!state.walls[0].touching.is_empty());
            advance(&mut state);
        }
        assert!(touched > 10, "{touched}");
        state
    });
    assert!(levels(&on)[0] == 0 && levels(&on)[2] > 0);
    assert!(on.particles.motions[0].velocity_m_s[2] > 0.5);
    assert_eq!(on.particles.motions[..2], off.particles.motions[..2]);
    assert_eq!(on.particles.poses[..2], off.particles.poses[..2]);
}

/// The wall moves by time steps, and so the two meet at the same time, and part with the same
/// motion, as without steps by body.
#[test]
fn an_impact_is_that_without_steps_by_body() {
    let text = text("velocity = [0, 0, 0.5]\n", 3.5e-3);
    let off = text.replace("run.steps_by_body = true", "");
    let [(on, shown), (off, _)] = [&text, &off].map(|text| seen(text));
    assert!(shown.touched_s.is_some());
    let [on, off] = [on, off].map(|state| {
        assert!(state.time_s > 0.03 - 1e-9);
        let soft = [2, 3].map(|i| state.particles.poses[i].position_m[2]);
        (
            soft[0] + soft[1],
            state.particles.motions[2].velocity_m_s[2],
        )
    });
    assert!((on.0 / off.0 - 1.0).abs() < 1e-3, "{on:?} {off:?}");
    assert!((on.1 / off.1 - 1.0).abs() < 1e-3, "{on:?} {off:?}");
}

/// A plate that rests until late lets the body on it take longer steps until then.
#[test]
fn a_wall_at_rest_lets_bodies_take_longer_steps() {
    let motion = "displacement = [0, 0, 1e-4]\ntable = [[0, 0], [0.02, 0], [0.03, 1]]\n";
    let text =
        text(motion, 1e-3 - 1e-8).replace("run.end", "run.initial_overlap = \"relax\"\nrun.end");
    let mut state = planned(&text).state;
    assert_eq!(state.walls[0].touching.len(), 2);
    let mut seen: Vec<(f64, u8)> = Vec::new();
    while state.time_s < 0.025 {
        interact(&mut state);
        let level = levels(&state)[2];
        if seen.last().map(|(_, last)| *last) != Some(level) {
            seen.push((state.time_s, level));
        }
        advance(&mut state);
    }
    let [(_, before), (at_s, level), ..] = seen[..] else {
        panic!("{seen:?}")
    };
    assert!(before > 0 && level == 0, "{seen:?}");
    assert!((0.0198..0.02).contains(&at_s), "{seen:?}");
}
