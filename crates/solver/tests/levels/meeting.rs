//! Bodies of different limits come to one level before they touch, and part again.

use dem_run::stages::ledger::balance;
use dem_run::step::{advance, interact, step};

use super::{CONTACTS, RADIUS_M, head, levels, pair, planned};

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
        let contacts = state.contacts.as_ref().unwrap();
        for (pair, history) in contacts.pairs.iter().zip(&contacts.histories) {
            if history.overlap_m() > 0.0 {
                touched += 1;
                let [one, other] = pair.map(|i| levels(&state)[i as usize]);
                assert_eq!(one, other);
                assert_eq!(history.origin_m(), 0.0, "listed too late");
            }
        }
        let balance = balance(&mut state);
        largest = largest
            .max(balance.momentum_error)
            .max(balance.angular_momentum_error);
        assert!(
            balance.energy_error.abs() < 0.01,
            "{}",
            balance.energy_error
        );
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
