//! Runs of a sweep that fail.

use std::fs;

use super::{STEPS, bad, bench, csv, good, json, partly};
use crate::program::Bench;

#[test]
fn runs_that_fail_are_shown_and_the_sweep_goes_on() {
    let study = r#"version = 1
scene = "spring.toml"
repeats = 1
[vary]
"run.time_step" = ["10 us", "900 us"]
[together.breaks]
"bonds.steel.failure.tensile_strength" = ["1e12 Pa", "1e12 Pa"]
"measures.pieces.of" = ["fragments", "fragments"]
names = ["a,b", "c"]
[measures.pieces]
reference = { value = 1 }
"#;
    let bench = bench(study);
    let (table, said) = partly(&bench, &[]);
    assert!(
        table.contains("failed       run 3, run.time_step 900 us, breaks a,b: "),
        "{table}"
    );
    assert!(table.contains("the largest stable"), "{table}");
    assert!(
        said.contains("2 of 4 runs did not come to their end; the first: run 3, run.time_step 900 us, breaks a,b: ")
            && said.contains("the largest stable")
            && said.ends_with("--resume tries them again\n"),
        "{said}"
    );
    // The same if nothing is run, and if nothing else is printed; the tables are written in any
    // case.
    let written = fs::read(bench.path("study-sweep/sweep.csv")).unwrap();
    for options in [
        &["--collect"][..],
        &["--collect", "--quiet"],
        &["--collect", "--json"],
    ] {
        fs::remove_file(bench.path("study-sweep/sweep.csv")).unwrap();
        let (table, again) = partly(&bench, options);
        assert_eq!(again, said);
        assert_eq!(table.is_empty(), options.contains(&"--quiet"), "{table}");
        assert_eq!(
            fs::read(bench.path("study-sweep/sweep.csv")).unwrap(),
            written
        );
    }
    let rows = csv(&bench.path("study-sweep/sweep.csv"));
    assert_eq!(rows[0]["breaks"], "a,b");
    assert_eq!(rows[0]["pieces_error"], "0");
    assert!(rows[0]["failed"].is_empty() && !rows[2]["failed"].is_empty());
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert!(html.contains("<h2>Failed</h2>") && html.contains("the largest stable"));

    let all = study.replace("[\"10 us\", \"900 us\"]", "[\"800 us\", \"900 us\"]");
    bench.write("study.toml", all);
    let said = bad(&bench, &["--force"], 1);
    assert!(
        said.contains("study.toml: no run came to its end; the first: run 1, run.time_step 800 us, breaks a,b: "),
        "{said}"
    );
}

#[test]
fn a_measure_that_is_no_number_is_a_failure() {
    let bench = Bench::new();
    // It has no position before the first body is fed.
    bench.write(
        "spring.toml",
        r#"version = 1
[run]
end_time = "10 ms"
[materials.steel]
density = 7850
young_modulus = "1 GPa"
[contacts]
steel-steel = { restitution = 0.5 }
[bodies.ball]
material = "steel"
particles = [[0, 0, 0, 0.01]]
start_as = "clump"
[regions.gate]
box = { min = [0, 0, 0], max = [0.1, 0.1, 0.1] }
[inlets.feed]
bodies = ["ball"]
region = "gate"
rate = "100 1/s"
velocity = ["1 m/s", 0, 0]
[measures.place]
quantity = "position_x"
"#,
    );
    bench.write(
        "study.toml",
        "version = 1\nscene = \"spring.toml\"\n[vary]\n\"inlets.feed.start\" = [\"0 s\", \"20 ms\"]\n[measures.place]\nreference = { value = \"2 cm\" }\n",
    );
    let (said, _) = partly(&bench, &[]);
    assert!(
        said.contains(
            "failed       run 2, inlets.feed.start 20 ms: the measure 'place' is not a number"
        ),
        "{said}"
    );
    let rows = csv(&bench.path("study-sweep/sweep.csv"));
    assert_eq!(rows[0]["failed"], "");
    assert_eq!(rows[1]["failed"], "the measure 'place' is not a number");
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert!(html.contains("<h2>Failed</h2>") && html.contains("is not a number"));
}

/// A step above the largest stable one is refused, or accepted and found unstable.
#[test]
fn steps_above_the_limit_are_for_trials() {
    let study = STEPS
        .replace("[0.2, 0.1, 0.05, 0.025]", "[0.9, 1.05]")
        .replace(
            "[measures.tip]\nreference = { richardson = \"run.safety_factor\" }\n",
            "",
        )
        .replace(
            "repeats = 2",
            "repeats = 1\nset = { \"run.end_time\" = \"0.2 s\", \"loads.tip.torque\" = [1e3, 1e3, 1e3] }",
        );
    let forced = bench(&study.replace("repeats = 1", "repeats = 1\nforce_step = true"));
    let (said, _) = partly(&forced, &[]);
    assert!(said.contains("1.05: unstable at step"), "{said}");
    let table = json(&forced);
    assert!(table["runs"][0]["failed"].is_null() && table["runs"][1]["failed"].is_string());
    // Failed runs are repeated.
    let failed = (table["runs"].as_array().unwrap().iter())
        .filter(|run| run["failed"].is_string())
        .count();
    let list = good(&forced, &["--list", "--resume"]);
    assert_eq!(list.lines().count(), failed, "{list}");
    let refused = bench(&study);
    let (said, _) = partly(&refused, &[]);
    assert!(
        said.contains("run.safety_factor: 1.05 of the largest stable step is not stable"),
        "{said}"
    );
}
