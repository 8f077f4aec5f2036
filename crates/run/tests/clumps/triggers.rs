//! When clumps are replaced.

use std::f64::consts::PI;

use dem_engine::state::State;
use dem_engine::state::clumps::Clump;
use dem_engine::state::events::PopulationEvent;

use super::{HEAD, block, happens, planned};

const STEP_S: f64 = 1e-6;

/// Two spheres that fall side by side at 1 m/s onto a perfectly elastic plane, 1 mm below.
fn falling(when: &str) -> State {
    let pair = block(
        "pair",
        [2, 1, 1],
        2e-3,
        |_| Some(1e-3),
        "start_as = \"clump\"\nposition = [0, 0, 2e-3]\nvelocity = [0, 0, -1]",
    );
    let mut plan = planned(&format!(
        "{HEAD}contacts.stuff-stuff = {{ restitution = 1, friction = 0 }}\n{pair}\
         [walls.ground]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\n\
         [regions.low]\nbox = {{ min = [-1, -1, -1], max = [1, 1, 1.5e-3] }}\n\
         [replacement.pair]\n{when}\n"
    ));
    plan.state.time_step_s = STEP_S;
    plan.state
}

/// Time and cause of its replacement, and the clump in that step and in the one before.
fn replaced(when: &str) -> Option<(f64, &'static str, [Clump; 2])> {
    let mut state = falling(when);
    let mut before = state.clumps.all[0];
    while state.time_s < 3e-3 {
        let now_s = state.time_s;
        let mut acted = state.clone();
        dem_engine::step::interact(&mut acted);
        let now = acted.clumps.all[0];
        if let [PopulationEvent::Replaced { cause, .. }] = happens(&mut state)[..] {
            return Some((now_s, cause, [before, now]));
        }
        before = now;
    }
    None
}

fn mass_kg() -> f64 {
    2.0 * 2500.0 * 4.0 / 3.0 * PI * 1e-9
}

#[test]
fn a_region_a_time_a_force_and_an_energy_replace_when_they_are_reached() {
    // The centre is in the region after 0.5 mm.
    let (at_s, cause, [before, now]) = replaced("when = { enters = \"low\" }").unwrap();
    assert_eq!(cause, "enters");
    assert!(before.place_m[2] > 1.5e-3 && now.place_m[2] <= 1.5e-3);
    assert!((at_s - 0.5e-3).abs() < 1.01 * STEP_S, "{at_s}");

    let (at_s, cause, _) = replaced("when = { time = 3.3e-4 }").unwrap();
    assert_eq!(cause, "time");
    assert!((3.3e-4 - 1e-15..3.3e-4 + STEP_S).contains(&at_s), "{at_s}");

    // Two contacts of Hertz: the largest force is 2 * 4/3 E* sqrt(R) d^(3/2), with 2 * 8/15 E*
    // sqrt(R) d^(5/2) = m v^2/2.
    let stiff = 1e8 / (2.0 * (1.0 - 0.0625)) * 1e-3_f64.sqrt();
    let deep_m = (0.5 * mass_kg() * 15.0 / 16.0 / stiff).powf(0.4);
    let largest_n = 8.0 / 3.0 * stiff * deep_m.powf(1.5);
    let half = format!("when = {{ force = {} }}", 0.5 * largest_n);
    let (_, cause, [before, now]) = replaced(&half).unwrap();
    assert_eq!(cause, "force");
    assert!(before.force_n[2] <= 0.5 * largest_n && now.force_n[2] > 0.5 * largest_n);
    let wanted_m = deep_m * 0.5_f64.powf(2.0 / 3.0);
    assert!(
        (1e-3 - now.place_m[2] - wanted_m).abs() < 1.01 * STEP_S,
        "{}",
        now.place_m[2]
    );
    assert!(replaced(&format!("when = {{ force = {} }}", 1.01 * largest_n)).is_none());
    assert!(replaced(&format!("when = {{ force = {} }}", 0.99 * largest_n)).is_some());

    // Contacts absorb all of its energy and return it: the absorbed energy stays counted, once.
    let whole_j = 0.5 * mass_kg();
    let (_, cause, [before, now]) =
        replaced(&format!("when = {{ impact_energy = {} }}", 0.5 * whole_j)).unwrap();
    assert_eq!(cause, "impact_energy");
    assert!(before.impact_energy_j <= 0.5 * whole_j && now.impact_energy_j > 0.5 * whole_j);
    let left = 0.5 * mass_kg() * now.velocity_m_s[2].powi(2);
    // Forces are those at the end of the step over which their power is summed: the excess is half
    // of a step's increase of the force times the speed.
    let part = largest_n * STEP_S;
    assert!(
        (left - 0.5 * whole_j).abs() < 1.5 * part,
        "{left:e} {part:e}"
    );
    assert!(
        replaced(&format!(
            "when = {{ impact_energy = {} }}",
            whole_j + 0.5 * part
        ))
        .is_none()
    );
    assert!(
        replaced(&format!(
            "when = {{ impact_energy = {} }}",
            whole_j - 0.5 * part
        ))
        .is_some()
    );
}

#[test]
fn any_takes_the_first_and_all_waits_for_the_last() {
    let both = "when = { enters = \"low\", time = 3e-4 }";
    let (early_s, cause, _) = replaced(&format!("{both}\nrequire = \"any\"")).unwrap();
    assert_eq!(cause, "time");
    assert_eq!(replaced(both).unwrap().0, early_s);
    let (late_s, ..) = replaced(&format!("{both}\nrequire = \"all\"")).unwrap();
    assert!((early_s - 3e-4).abs() < 1.01 * STEP_S && (late_s - 5e-4).abs() < 1.01 * STEP_S);
    // All at once: it is in the region before a force acts on it, and there is none when it has
    // left.
    let force = "when = { enters = \"low\", force = 1e-3 }\nrequire = \"all\"";
    let (at_s, _, [_, now]) = replaced(force).unwrap();
    assert!((at_s - 1e-3).abs() < 10.0 * STEP_S && now.force_n[2] > 1e-3);
    assert!(replaced("when = { enters = \"low\", time = 2.5e-3 }\nrequire = \"all\"").is_none());
}
