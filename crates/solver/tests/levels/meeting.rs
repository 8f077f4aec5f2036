//! Bodies of different limits come to one level before they touch, and part again.

use dem_run::step::{advance, interact, step};

use super::{CONTACTS, RADIUS_M, errors, head, levels, pair, planned, touching_at_one_level};

const TOGETHER: &str = "run.end_time = 0.02";

/// A hard pair on its way to a soft one at rest, and a soft one far away.
fn text() -> String {
    head(TOGETHER)
        + CONTACTS
        + &pair("a", "hard", [0.0, 8.0 * RADIUS_M, 0.0], [0.0, -1.0, 0.1])
        + &pair("b", "soft", [RADIUS_M, 0.0, 0.0], [0.0; 3])
        + &pair("c", "soft", [1.0, 0.0, 0.0], [0.0; 3])
}

#[test]
fn bodies_that_touch_have_one_level_and_keep_their_momentum() {
    let mut state = planned(&text()).state;
    let mut touched = 0;
    let mut largest = 0.0_f64;
    let mut seen: Vec<[u8; 3]> = Vec::new();
    while state.time_s < 0.02 {
        interact(&mut state);
        let now = [0, 2, 4].map(|i| levels(&state)[i]);
        if seen.last() != Some(&now) {
            seen.push(now);
        }
        touched += touching_at_one_level(&state);
        let [energy, momentum, angular_momentum] = errors(&mut state);
        largest = largest.max(momentum).max(angular_momentum);
        assert!(energy < 0.01, "{energy}");
        advance(&mut state);
    }
    assert!(touched > 3);
    assert!(largest < 1e-12, "{largest}");
    let [hard, soft, far] = seen[0];
    assert!(hard == 0 && soft > 1 && far == soft, "{seen:?}");
    assert!(seen.contains(&[0, 0, far]), "{seen:?}");
    assert_eq!(seen.last(), Some(&seen[0]), "{seen:?}");
}

/// The momentum that the two exchange does not depend on the steps of the third.
#[test]
fn a_body_far_away_does_not_change_a_collision() {
    let without_c = text().split("[bodies.c]").next().unwrap().to_owned();
    let mut states = [text(), without_c].map(|text| planned(&text).state);
    for state in &mut states {
        while state.time_s < 0.02 {
            step(state);
        }
    }
    let [with, without] = &states;
    assert_eq!(with.time_step_s, without.time_step_s);
    assert_eq!(with.particles.poses[..4], without.particles.poses[..4]);
}

/// All in one heap: as without steps by body, for the same number of steps.
#[test]
fn a_group_with_the_stiffest_body_takes_its_steps() {
    let beside_m = |n: f64| [0.0, n * 2.0 * RADIUS_M * (1.0 + 1e-4), 0.0];
    let text = head(TOGETHER)
        + CONTACTS
        + &pair("a", "hard", beside_m(0.0), [0.0; 3])
        + &pair("b", "soft", beside_m(1.0), [0.0; 3])
        + &pair("c", "soft", beside_m(2.0), [0.0; 3]);
    let mut state = planned(&text).state;
    step(&mut state);
    assert_eq!(levels(&state), [0; 6]);
}
