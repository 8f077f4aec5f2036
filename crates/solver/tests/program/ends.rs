//! A measure that ends a run.

use super::{Bench, results};
use dem_io::body::read_particles;
use serde_json::Value;

/// A ball falls: its speed is g t.
const FALLING: &str = r#"version = 1
[run]
end_time = "1 s"
time_step = "1 ms"
gravity = [0, 0, -10]
[materials.m]
density = 2000
[bodies.ball]
particles = [[0, 0, 0, "1 cm"]]
material = "m"
[measures.speed]
of = "ball"
quantity = "velocity"
end_run_above = "2.1 m/s"
[output]
series = "50 ms"
frames = "0.4 s"
"#;

fn summary(bench: &Bench) -> Value {
    serde_json::from_slice(&std::fs::read(bench.path("out/summary.json")).unwrap()).unwrap()
}

#[test]
fn a_run_ends_at_the_first_row_above_the_value() {
    let bench = Bench::new();
    let scene = bench.write("falling.toml", FALLING);
    let said = bench.good(&scene, &["--output", "out"]);
    assert!(said.contains("\nended by     measure\n"), "{said}");
    let ended = summary(&bench);
    assert_eq!(ended["ended_by"], "measure");
    // 2.1 m/s are exceeded at the row of 0.25 s.
    let [time_s, speed] = [&ended["simulated_s"], &ended["measures"]["speed"]["value"]];
    let [time_s, speed] = [time_s, speed].map(|value| value.as_f64().unwrap());
    assert!(
        (time_s - 0.25).abs() < 2e-3 && (speed - 10.0 * time_s).abs() < 1e-6,
        "{ended}"
    );
    // The frame at the end is written.
    let last = read_particles(&bench.path("out/frames/frame_000001.vtp")).unwrap();
    assert!((last.time_s - time_s).abs() < 1e-12);

    let said = bench.bad(&scene, &["--output", "out", "--resume"], 2);
    assert!(
        said.contains("measures.speed has ended this run at") && said.contains("end_run_above"),
        "{said}"
    );
    // Continued to a larger value, it is the run that had this value from the start.
    let larger = ["--output", "out", "--set", "measures.speed.end_run_above=3"];
    bench.good(&scene, &[&larger[..], &["--resume"]].concat());
    let continued = summary(&bench);
    assert_eq!(continued["ended_by"], "measure");
    let other = Bench::new();
    let scene = other.write("falling.toml", FALLING);
    other.good(&scene, &larger);
    let series = |bench: &Bench| results(&bench.path("out"))["series.csv"].clone();
    assert!(series(&bench) == series(&other));
}

#[test]
fn a_value_that_is_not_exceeded_ends_nothing_and_is_a_doubt() {
    let bench = Bench::new();
    let scene = bench.write("falling.toml", FALLING);
    bench.good(
        &scene,
        &[
            "--output",
            "out",
            "--set",
            "measures.speed.end_run_above=20",
        ],
    );
    let summary = summary(&bench);
    assert_eq!(summary["ended_by"], "end time");
    // The speed at the end, g t, is the largest.
    let warnings = summary["verdict"]["warnings"].as_array().unwrap();
    assert_eq!(
        *warnings,
        [
            "speed did not end the run, which its end_run_above of 20 m/s was to do: its largest value is 10 m/s; set a later run.end_time, or let what changes it, such as a plunger, move faster"
        ]
    );
}
