//! Scenes solved for their static equilibrium: `run.integrator = "static"`.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::laboratory::bar;
use super::{Bench, assert_same, dem_run, names_in, numbers, refused, scene_of_data, table};

const STATIC: [&str; 2] = ["--set", "run.integrator=static"];

/// The cantilever with these additional options.
fn cantilever(bench: &Bench, options: &[&str]) -> String {
    let options = [&STATIC[..], options].concat();
    bench.good(&scene_of_data("cantilever.toml"), &options)
}

fn summary(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn measured(summary: &Value, name: &str) -> f64 {
    summary["measures"][name]["value"].as_f64().unwrap()
}

#[test]
fn says_how_the_equilibrium_was_found() {
    let bench = Bench::new();
    let said = cantilever(&bench, &["--verbose"]);
    let mut lines = said.lines();
    assert!(
        lines
            .next()
            .unwrap()
            .contains("cantilever.toml: equilibrium at 4 s in ")
    );
    assert!(
        said.contains("tip_deflection -8.5342 mm   theory -8.53424 mm   error "),
        "{said}"
    );
    let line = said
        .lines()
        .find(|line| line.starts_with("equilibrium "))
        .unwrap();
    assert!(
        line.contains(" Newton iterations, residual ")
            && line.ends_with(" of the largest bond force"),
        "{line}"
    );
    assert!(
        said.contains("solved       60 unknowns; 6 freedoms held\n"),
        "{said}"
    );
    assert!(said.contains("\nverdict      sound\n"), "{said}");
    for absent in ["steps ", "inactive", "energy "] {
        assert!(!said.contains(absent), "{said}");
    }
    assert!(bench.files().is_empty());
}

/// When continued by time steps until only rounding is left, the tip stays at its static position.
#[test]
fn the_tip_is_where_steps_bring_it() {
    let bench = Bench::new();
    let at_once = summary(&cantilever(&bench, &["--json"]));
    let rest = [
        "--set",
        "run.rest_energy_ratio=1e-26",
        "--set",
        "run.local_damping=0.7",
        "--json",
    ];
    let stepped = bench.good(&scene_of_data("cantilever.toml"), &rest);
    let stepped = summary(&stepped);
    for name in ["tip_deflection", "clamp_force"] {
        let (found, wanted) = (measured(&at_once, name), measured(&stepped, name));
        assert!(
            (found / wanted - 1.0).abs() < 1e-8,
            "{name}: {found} and {wanted}"
        );
    }
    let found = &at_once["equilibrium"];
    assert_eq!(found["unknowns"], 60);
    assert_eq!(found["held"], 6);
    assert_eq!(found["load_steps"], 1);
    assert_eq!(found["bonds_beyond_strength"], 0);
    assert_eq!(found["stable"], true);
    assert!(found["residual"].as_f64().unwrap() < 1e-9);
    assert_eq!(at_once["ended_by"], "equilibrium");
    assert_eq!(at_once["steps"], found["newton_steps"]);
    assert_eq!(at_once["energy_error"], Value::Null);
    assert!(stepped.get("equilibrium").is_none());
    // A run of less than a millisecond also has its times.
    for time in ["wall_s", "processor_s"] {
        let [found, steps] = [&at_once, &stepped].map(|s| s[time].as_f64().unwrap());
        assert!(
            found > 0.0 && found < 0.1 * steps,
            "{time}: {found} and {steps}"
        );
    }
}

#[test]
fn writes_one_frame_and_one_row() {
    let bench = Bench::new();
    let said = cantilever(&bench, &["--json", "--output", "out"]);
    let files = [
        ".lock",
        "events.csv",
        "frames",
        "frames.pvd",
        "report.html",
        "scene.toml",
        "series.csv",
        "summary.json",
    ];
    assert_eq!(names_in(&bench.path("out")), files);
    assert_eq!(
        fs::read_to_string(bench.path("out/summary.json")).unwrap(),
        said
    );
    assert_eq!(names_in(&bench.path("out/frames")).len(), 1);
    let series = bench.path("out/series.csv");
    assert_eq!(table(&series).1.len(), 1);
    assert_eq!(numbers(&series, "time_s"), [4.0]);
    assert_eq!(numbers(&series, "kinetic_energy_j"), [0.0]);
    let tip = numbers(&series, "tip_deflection_m")[0];
    assert_eq!(tip, measured(&summary(&said), "tip_deflection"));
    // For a load that increases, half of load times displacement is stored.
    let elastic = numbers(&series, "elastic_energy_j")[0];
    assert!((elastic / (-0.5e5 * tip) - 1.0).abs() < 1e-4, "{elastic}");
    assert!(numbers(&series, "load_work_j")[0].is_nan());
    assert_eq!(table(&bench.path("out/events.csv")).1.len(), 0);
}

#[test]
fn files_are_the_same_for_any_number_of_threads() {
    let bench = Bench::new();
    for threads in ["1", "2"] {
        cantilever(&bench, &["--output", threads, "--threads", threads]);
    }
    assert_same(&bench.path("1"), &bench.path("2"));
}

#[test]
fn check_says_what_is_solved() {
    let bench = Bench::new();
    let scene = scene_of_data("cantilever.toml");
    let check = |more: &[&str]| {
        let output = dem_run()
            .current_dir(bench.path(""))
            .arg("check")
            .arg(&scene)
            .args(STATIC)
            .args(more)
            .output()
            .unwrap();
        assert!(output.status.success());
        String::from_utf8(output.stdout).unwrap()
    };
    let said = check(&["--verbose"]);
    for part in [
        "static\nrun.rest_energy_ratio",
        "holds          11 particles, 10 bonds\n",
        "solves         equilibrium under what acts at 4 s: 60 unknowns, 6 freedoms held; no time steps\n",
        "by             Newton's method; Cholesky, ",
        "not used       run.rest_energy_ratio, end_run_above of measures, run.time_step, ",
        "memory         about ",
    ] {
        assert!(said.contains(part), "'{part}' is not in\n{said}");
    }
    let torque = check(&["--verbose", "--set", "loads.tip.torque=[0, 0, 1]"]);
    assert!(
        torque.contains("by             Newton's method; L U, as torques act on"),
        "{torque}"
    );
    let json = summary(&check(&["--json"]));
    assert_eq!(json["equilibrium"]["unknowns"], 60);
    assert!(json["equilibrium"]["factor_entries"].as_u64().unwrap() >= 60 * 61 / 2 / 6);
    assert!(json["memory_bytes"].as_u64().unwrap() > 1000);
    assert!(bench.files().is_empty());
}

#[test]
fn a_body_beyond_its_strength_is_not_sound() {
    let bench = Bench::new();
    let weak = ["--set", "bonds.steel.failure.tensile_strength=50 MPa"];
    let said = cantilever(&bench, &weak);
    // The moment decreases linearly from the clamp, where it gives 64 MPa.
    let line = said
        .lines()
        .find(|line| line.starts_with("warning "))
        .unwrap();
    assert!(line.contains(" bonds are beyond their strength: the body would break; run it with run.integrator = \"leapfrog\""), "{said}");
    let json = summary(&cantilever(&bench, &[&weak[..], &["--json"]].concat()));
    let beyond = json["equilibrium"]["bonds_beyond_strength"]
        .as_u64()
        .unwrap();
    let stress = |at: u64| {
        1e5 * (4.0 - 0.4 * at as f64 - 0.2) / (0.25 * std::f64::consts::PI * 0.2_f64.powi(3))
    };
    assert_eq!(
        beyond,
        (0..10).filter(|at| stress(*at) >= 50e6).count() as u64
    );
    assert!((1..10).contains(&beyond));
}

#[test]
fn what_buckles_is_unstable() {
    let bench = Bench::new();
    let scene = scene_of_data("cantilever.toml");
    let options = [
        &STATIC[..],
        &[
            "--set",
            "loads.tip.force=[\"-200 MN\", 0, 0]",
            "--output",
            "out",
        ],
    ]
    .concat();
    let said = bench.bad(&scene, &options, 3);
    assert!(said.contains("% of the loads and displacements and no stable one for more: a pivot of the stiffness is not positive there, so the body buckles or snaps through"), "{said}");
    // Euler's load of the slender column is 38.8 MN, 19.4 %.
    let fraction = said
        .split_once("found for ")
        .unwrap()
        .1
        .split_once(" %")
        .unwrap()
        .0;
    let fraction: f64 = fraction.parse().unwrap();
    assert!((17.0..20.0).contains(&fraction), "{said}");
    let left = summary(&std::fs::read_to_string(bench.path("out/summary.json")).unwrap());
    assert_eq!(left["ended_by"], "failure");
    assert_eq!(
        format!("error: {}", left["problem"].as_str().unwrap()),
        said
    );
}

#[test]
fn there_is_nothing_to_resume() {
    let bench = Bench::new();
    let scene = scene_of_data("cantilever.toml");
    let options = [&STATIC[..], &["--output", "out"]].concat();
    let output = bench.run(&scene, &[&options[..], &["--resume"]].concat());
    let (said, code) = refused(&output);
    assert_eq!(code, 2);
    assert!(
        said.contains("--resume: run.integrator = \"static\" leaves no checkpoint to go on from"),
        "{said}"
    );
    assert!(bench.files().is_empty());
}

/// Both integrators in one sweep: the same values, at very different times.
#[test]
fn a_sweep_compares_it_with_steps() {
    let bench = Bench::new();
    let study = format!(
        "version = 1\nscene = \"{}\"\ntime = \"processor\"\n[set]\n\"run.rest_energy_ratio\" = 1e-26\n\"run.local_damping\" = 0.7\n[vary]\n\"run.integrator\" = [\"leapfrog\", \"static\"]\n[measures.tip_deflection]\nreference = \"closed-form\"\n",
        scene_of_data("cantilever.toml").display()
    );
    bench.write("study.toml", study);
    let output = dem_run()
        .current_dir(bench.path(""))
        .args(["sweep", "study.toml", "--quiet"])
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let table = bench.path("study-sweep/sweep.csv");
    let [steps, at_once] = numbers(&table, "tip_deflection_value (m)")[..] else {
        panic!("two runs")
    };
    assert!((at_once / steps - 1.0).abs() < 1e-8);
    let times = numbers(&table, "time_s");
    assert!(times[1] > 0.0 && times[1] < 0.1 * times[0], "{times:?}");
    assert_eq!(numbers(&table, "tip_deflection_front"), [0.0, 1.0]);
}

/// Grips move the ends of a rod without any other compliance, also where a wall is far away.
#[test]
fn a_row_that_is_pulled_has_the_modulus_of_its_bonds() {
    let bench = Bench::new();
    let gripped = bar().replace("[run]", "[run]\nintegrator = \"static\"");
    let scene = bench.write("bar.toml", &gripped);
    let results_of = |scene: &Path, options: &[&str]| -> Vec<Value> {
        let options = [&["--json", "--quiet"], options].concat();
        let summary = summary(&bench.good(scene, &options));
        summary["test"]["results"].as_array().unwrap().clone()
    };
    let assert_modulus = |results: &[Value], name: &str| {
        let found = results.iter().find(|one| one["name"] == name).unwrap();
        let off = found["value"].as_f64().unwrap() / 15e6 - 1.0;
        assert!(off.abs() < 1e-3, "{name}: {off}");
    };
    let results = results_of(&scene, &["--output", "out"]);
    assert_modulus(&results, "modulus by travel");
    assert_modulus(&results, "specimen modulus");
    assert!(results.iter().all(|one| one["name"] != "strength"));
    let said = bench.good(&scene, &["--verbose", "--output", "other"]);
    assert!(
        said.contains("modulus by travel") && said.contains("Newton iterations"),
        "{said}"
    );
    assert!(said.contains("verdict      sound"), "{said}");
    let beside = gripped.replace(
        "density = 2000",
        "density = 2000\nyoung_modulus = \"20 MPa\"\npoisson_ratio = 0.3",
    ) + r#"[contacts]
clay-clay = { restitution = 0.5, friction = 0.3 }
[walls.floor]
plane = { point = [0, 0, -0.5], normal = [0, 0, 1] }
material = "clay"
"#;
    let scene = bench.write("pulled.toml", beside);
    assert_modulus(&results_of(&scene, &[]), "modulus by travel");
}
