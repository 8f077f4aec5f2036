//! The position of a body has the second order in the step, also where its step changes and where
//! its bonds are damped.

use dem_run::state::State;
use dem_run::step::step;

use super::{
    CONTACTS, RADIUS_M, damped, elongation_m, frequency_rad_s, head, levels, pair, parting, planned,
};

const SPEED_M_S: f64 = 1e-3;
const END_S: f64 = 4.096e-3;

/// The soft pair vibrates to the end with so many time steps and this damping ratio. Returns the
/// largest distance of its elongation from the closed form, over the amplitude without damping, and
/// the levels that it had in turn.
fn error(text: &str, steps: u32, damping_ratio: f64) -> (f64, Vec<u8>) {
    let time_step = format!(
        "run.end_time = {END_S:e}\nrun.time_step = {:e}",
        END_S / f64::from(steps)
    );
    // So hard that it sets the step.
    let head = head(&time_step).replace("1e8", "1e10") + &damped("soft", damping_ratio);
    let mut state: State = planned(&(head + text)).state;
    parting(&mut state, 1, SPEED_M_S);
    let omega_rad_s = frequency_rad_s(&state, 1);
    let amplitude_m = SPEED_M_S / omega_rad_s;
    let slower = (1.0 - damping_ratio * damping_ratio).sqrt();
    let mut largest_m = 0.0_f64;
    let mut seen = Vec::new();
    while state.time_s < END_S * (1.0 - 1e-9) {
        step(&mut state);
        let turned = omega_rad_s * state.time_s;
        let decayed_m = amplitude_m / slower * (-damping_ratio * turned).exp();
        let should_m = decayed_m * (slower * turned).sin();
        largest_m = largest_m.max((elongation_m(&state, 1) - should_m).abs());
        if seen.last() != Some(&levels(&state)[2]) {
            seen.push(levels(&state)[2]);
        }
    }
    (largest_m / amplitude_m, seen)
}

/// Half the step, a quarter of the error. The hard pair has the level 0, and 1 and 2 with smaller
/// steps; so has the soft one while it is near: its steps then are the same in all runs, so that
/// where they change the error of damping may fall a little faster.
fn has_second_order(text: &str, is_near_first: bool, damping_ratio: f64) {
    let errors = [0, 1, 2].map(|halved| error(text, 5120 << halved, damping_ratio));
    for (halved, (error, seen)) in (0..).zip(&errors) {
        let levels = if is_near_first {
            &[halved, 3][..]
        } else {
            &[3]
        };
        assert_eq!(seen, levels, "{error:e}");
    }
    for two in errors.windows(2) {
        let order = (two[0].0 / two[1].0).log2();
        let most = if is_near_first && damping_ratio > 0.0 {
            2.4
        } else {
            2.1
        };
        assert!((1.9..most).contains(&order), "{order}: {errors:?}");
    }
    assert!(errors[0].0 < 0.1, "{errors:?}");
}

#[test]
fn a_body_alone_has_the_second_order_at_the_highest_level() {
    let text =
        pair("a", "hard", [0.0; 3], [0.0; 3]) + &pair("b", "soft", [1.0, 0.0, 0.0], [0.0; 3]);
    for damping_ratio in [0.0, 0.2] {
        has_second_order(&text, false, damping_ratio);
    }
}

/// The soft pair starts so close to the hard one that the two could touch, and leaves it.
#[test]
fn a_body_whose_step_changes_has_the_second_order() {
    let beside_m = [0.0, 2.0 * RADIUS_M * (1.0 + 1e-4), 0.0];
    let text = CONTACTS.to_owned()
        + &pair("a", "hard", [0.0; 3], [0.0; 3])
        + &pair("b", "soft", beside_m, [0.0, 0.02, 0.0]);
    for damping_ratio in [0.0, 0.2] {
        has_second_order(&text, true, damping_ratio);
    }
}
