//! A time step that follows the limit.

use serde_json::Value;

use super::{Bench, good, table};

fn summary(bench: &Bench, scene: &std::path::Path, options: &[&str]) -> Value {
    serde_json::from_str(&bench.good(scene, &[options, &["--json"]].concat())).unwrap()
}

fn steps_of_events(bench: &Bench, out: &str) -> Vec<(String, [f64; 2])> {
    let (_, events) = table(&bench.path(&format!("{out}/events.csv")));
    let times = |detail: &str| -> [f64; 2] {
        let numbers: Vec<f64> = (detail.split(' '))
            .filter_map(|word| word.parse().ok())
            .collect();
        [numbers[0], numbers[1]]
    };
    (events.iter().filter(|row| row[2] == "time_step"))
        .map(|row| (row[9].clone(), times(&row[11])))
        .collect()
}

#[test]
fn it_falls_as_clumps_become_clusters_and_rises_when_it_may() {
    let bench = Bench::new();
    let run = |out: &str, adaptive: &str| {
        let set = format!("run.adaptive={adaptive}");
        summary(
            &bench,
            &good("following.toml"),
            &["--out", out, "--set", &set],
        )
    };
    let (following, falling) = (run("following", "true"), run("falling", "false"));
    assert!(falling["adaptive"].is_null());
    let changes = steps_of_events(&bench, "following");
    let (cause, [before_s, after_s]) = &changes[0];
    assert!(
        cause == "replacement" && *before_s > 4.0 * after_s,
        "{changes:?}"
    );
    let rises = |(cause, [before_s, after_s]): &(String, [f64; 2])| {
        cause == "adaptive" && after_s > before_s
    };
    assert!(changes[1..].iter().any(rises), "{changes:?}");
    let of_adaptive = &following["adaptive"];
    assert_eq!(of_adaptive["changes"], changes.len() as u64);
    let smallest_s = changes
        .iter()
        .map(|(_, s)| s[0].min(s[1]))
        .fold(f64::INFINITY, f64::min);
    assert!((of_adaptive["smallest_step_s"].as_f64().unwrap() / smallest_s - 1.0).abs() < 1e-4);
    // What it costs: hardly more energy missed than without, both small, for fewer steps.
    let error = |of: &Value| of["energy_error"].as_f64().unwrap();
    assert!(
        error(&following) < 2.0 * error(&falling).max(1e-4),
        "{following}"
    );
    assert!(following["steps"].as_u64() < falling["steps"].as_u64());
    assert!(following["momentum_error"].as_f64().unwrap() < 1e-11);
}

/// One of two spheres is pulled until the bond between them breaks, soon; after that nothing vibrates, and a constant force is followed exactly by any step.
const DUMBBELL: &str = "version = 1
run = { end_time = 4, ADAPTIVE }
materials.stuff = { density = 2500 }
bonds.stiff = { young_modulus = 1e9, poisson_ratio = 0.25, failure = { tension = 1e5 } }
[bodies.dumbbell]
particles = [[0, 0, 0, 0.01], [0.02, 0, 0, 0.01]]
bond_list = [[0, 1]]
material = \"stuff\"
bonds = \"stiff\"
[sets.right]
body = \"dumbbell\"
particles = [1]
[loads.pull]
of = \"right\"
force = [100, 0, 0]
[measures.right]
of = \"right\"
quantity = \"displacement_x\"
";

#[test]
fn without_anything_that_vibrates_steps_are_large_and_a_flight_is_the_same() {
    let bench = Bench::new();
    let run = |name: &str, adaptive: &str| {
        let scene = bench.write(name, DUMBBELL.replace("ADAPTIVE", adaptive));
        summary(&bench, &scene, &["--out", &format!("{name}-out")])
    };
    let (following, falling) = (
        run("a.toml", "adaptive = true"),
        run("b.toml", "adaptive = false"),
    );
    assert_eq!(following["broken_bonds"], 1);
    let steps = |of: &Value| of["steps"].as_u64().unwrap();
    assert!(
        20 * steps(&following) < steps(&falling),
        "{following} {falling}"
    );
    let place = |of: &Value| of["measures"][0]["value"].as_f64().unwrap();
    let apart = (place(&following) / place(&falling) - 1.0).abs();
    assert!(apart < 1e-9, "{apart:e}");
}
