//! The stored results of tests/bonded-round-robin are those of the solver: the first break of its
//! cheap cases.

use std::fs;

use dem_run::step;
use serde_json::Value;

use super::page::on_one_thread;
use super::scene::started;
use crate::root;

/// A case, and the factor from its first stored number to the time of its first break, s.
const CASES: [(&str, f64); 4] = [
    ("weak-bond-pulled", 1e-2),
    ("weak-bond-sheared", 1e-2),
    ("weak-bond-bent", 0.25),
    ("drop", 1e-6),
];

#[test]
fn stored_breaks_are_those_of_the_solver() {
    let folder = root().join("tests/bonded-round-robin");
    let stored = fs::read(folder.join("results.json")).unwrap();
    let stored: Value = serde_json::from_slice(&stored).unwrap();
    for (name, seconds) in CASES {
        let first = &stored["cases"][name]["quantities"][0]["values"]["dem-run"];
        let stored_s = seconds * first.as_f64().unwrap();
        let scene = fs::read_to_string(folder.join(format!("cases/{name}/scene.toml"))).unwrap();
        on_one_thread(|| {
            let mut state = started(&scene);
            while state.broken_count == 0 {
                assert!(state.time_s < 2.0 * stored_s, "{name}: nothing breaks");
                step(&mut state);
            }
            // To the step: a break is booked at its beginning or its end.
            let late_s = state.time_s - stored_s;
            assert!(late_s.abs() < 1.5 * state.time_step_s, "{name}: {late_s} s");
        });
    }
}
