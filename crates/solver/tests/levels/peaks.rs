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
