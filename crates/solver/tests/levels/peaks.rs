//! Measures and triggers see the steps between two common times.

use dem_run::measure::{place_watches, probes};
use dem_run::plan::plan;
use dem_run::state::State;
use dem_run::step::step;
use dem_scene::read_bodies;

use super::{CONTACTS, PLATE, head, levels, pair};

/// A hard sphere or pair falls onto a plate at this height, m, and a soft pair rests far away.
fn text(height_m: f64, as_clump: bool, more: &str) -> String {
    let hard = pair("a", "hard", [0.0, 0.0, height_m], [0.0, 0.0, -0.5]);
    let hard = match as_clump {
        true => hard + "start_as = \"clump\"\n",
        false => hard,
    };
    head("run.end_time = 5e-3\nrun.time_step = 6.5e-6")
        + CONTACTS
        + PLATE
        + &hard
        + &pair("b", "soft", [0.5, 0.0, 0.5], [0.0; 3])
        + more
}

/// The end of a run, with its measures of each step.
fn ended(text: &str) -> State {
    let scene = crate::helpers::scene(text);
    let plan = plan(&scene, read_bodies(&scene).unwrap(), 1, false).unwrap();
    let probes = probes(&scene, &plan);
    let mut state = plan.state;
    place_watches(&probes, &mut state);
    while state.steps < 720 {
        step(&mut state);
    }
    state
}

const MEASURES: &str = "[measures]
body = { of = \"a\", with = \"plate\", quantity = \"contact_force\", statistic = \"largest\" }
push = { of = \"plate\", quantity = \"force_z\", statistic = \"smallest\" }
while = { of = \"a\", with = \"plate\", quantity = \"contact_duration\" }
";

#[test]
fn forces_are_recorded_in_every_step() {
    let text = text(1.2e-3, false, MEASURES);
    let off = text.replace("run.steps_by_body = true", "");
    let [on, off] = [&text, &off].map(|text| ended(text));
    assert!(levels(&on)[2] > 0);
    assert_eq!(on.watches.len(), 3);
    for (on, off) in on.watches[..2].iter().zip(&off.watches) {
        let [on, off] = [&on.seen, &off.seen];
        assert_eq!(on.history.largest, off.history.largest);
        assert_eq!(on.history.smallest, off.history.smallest);
        assert!(off.history.largest > Some(0.0) || off.history.smallest < Some(0.0));
    }
    let [on_s, off_s] = [&on, &off].map(|state| state.watches[2].seen.touched_s);
    assert!(
        off_s > 5e-5 && (on_s - off_s).abs() < 1e-12,
        "{on_s:e} {off_s:e}"
    );
}

/// A soft pair presses on the plate, in longer steps, while a hard one hits it: the largest push is
/// that of both, and how long the soft one touches is right within a part of its step.
#[test]
fn a_peak_is_that_of_all_levels() {
    let measures = MEASURES.replace("while = { of = \"a\"", "while = { of = \"b\"");
    let text = text(1.2e-3, false, &measures)
        .replace(
            "position = [0.5, 0.0, 0.5]\nvelocity = [0.0, 0.0, 0.0]",
            "position = [0.5, 0.0, 1.0001e-3]\nvelocity = [0.0, 0.0, -0.5]",
        )
        .replace("run.end_time", "run.safety_factor = 0.3\nrun.end_time")
        .replace("6.5e-6", "2e-6");
    let off = text.replace("run.steps_by_body = true", "");
    let [on, off] = [&text, &off].map(|text| ended(text));
    let level = levels(&on)[2];
    assert!(level > 0);
    let [hard_n, pushed_n, off_n] = [
        on.watches[0].seen.history.largest.unwrap(),
        -on.watches[1].seen.history.smallest.unwrap(),
        -off.watches[1].seen.history.smallest.unwrap(),
    ];
    assert!(pushed_n > 1.015 * hard_n, "{pushed_n} {hard_n}");
    assert!((pushed_n / off_n - 1.0).abs() < 0.002, "{pushed_n} {off_n}");
    let [on_s, off_s] = [&on, &off].map(|state| state.watches[2].seen.touched_s);
    let own_s = 2e-6 * f64::from(1_u32 << level);
    assert!(
        off_s > 20.0 * own_s && (on_s - off_s).abs() < 0.5 * own_s,
        "{on_s:e} {off_s:e}"
    );
}

/// Only one or two steps have so large a force.
#[test]
fn a_trigger_fires_between_two_common_times() {
    for height_m in [1.2e-3, 1.205e-3, 1.21e-3, 1.215e-3, 1.22e-3] {
        let alone = text(height_m, true, MEASURES).replace("run.steps_by_body = true", "");
        let peak_n = ended(&alone).watches[0].seen.history.largest.unwrap();
        // Tables of a name come first.
        let scene = |force_n: f64| {
            let text = text(height_m, true, "");
            let (head, tables) = text.split_once("[walls").unwrap();
            format!("{head}replacement.a.when.force = {force_n:e}\n[walls{tables}")
        };
        for (factor, fires) in [(0.9999, 1), (1.0001, 0)] {
            let state = ended(&scene(factor * peak_n));
            assert_eq!(state.population.replaced, fires, "{height_m} {factor}");
        }
    }
}
