//! `dem-run check`: the prediction for a scene. Nothing is run, nothing is written.

use super::{Bench, corpus, dem_run, scene_of_data, vtp_bytes};

fn check(bench: &Bench, options: &[&str]) -> String {
    let is_other = options
        .iter()
        .any(|option| ["--json", "--quiet"].contains(option));
    let whole = (!is_other).then_some("--verbose");
    let output = dem_run()
        .current_dir(bench.path(""))
        .arg("check")
        .args(options)
        .args(whole)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{said}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn says_the_step_and_why_stages_memory_and_time() {
    let bench = Bench::new();
    let path = scene_of_data("cantilever.toml");
    let scene = path.to_str().unwrap();
    let said = check(&bench, &[scene]);
    for part in [
        "11 particles, 10 bonds",
        "5.1651e-5 s chosen: 0.9 of the largest stable one",
        "stability: 5.17e-5 s; next: the end time, 0.04 s",
        "Rayleigh's estimate",
        "active         bond forces: 10 bonds",
        "inactive       gravity: no gravity",
        "memory         about ",
        "run time       about ",
        "\nloads.tip.force ",
        "[0, -100000, 0] N\n",
    ] {
        assert!(said.contains(part), "'{part}' is not in\n{said}");
    }
    let json = check(&bench, &[scene, "--json", "--set", "run.time_step=1e-5"]);
    let value: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(value["time_step_s"], 1e-5);
    assert!(value["limited_by"].is_null() && value["next_limit"].is_null());
    assert_eq!(value["steps"], 400_000.0);
    let named = |list: &str, name: &str| {
        let all = value[list].as_array().unwrap();
        all.iter()
            .find(|stage| stage["name"] == name)
            .unwrap()
            .clone()
    };
    let bonds = named("stages", "bond forces");
    assert!(
        bonds["bytes"].as_u64().unwrap() > 10 * 8 && bonds["ns_per_step"].as_f64().unwrap() > 0.0
    );
    assert!(named("inactive", "bond history")["bytes"].as_u64().unwrap() > 0);
    assert!(named("inactive", "walls")["bytes"].is_null());
    for number in [
        "limit_s",
        "memory_bytes",
        "predicted_run_time_s",
        "rayleigh_s",
    ] {
        assert!(value[number].as_f64().unwrap() > 0.0, "{number} in {json}");
    }
    assert!(bench.files().is_empty());
}

#[test]
fn says_what_limits_the_step_and_what_would_next() {
    let bench = Bench::new();
    let path = scene_of_data("chute.toml");
    let scene = path.to_str().unwrap();
    let limits = |accuracy: &str| {
        let set = format!("run.impact_accuracy={accuracy}");
        let json = check(&bench, &[scene, "--json", "--set", &set]);
        let value: serde_json::Value = serde_json::from_str(&json).unwrap();
        ["limited_by", "next_limit"].map(|key| {
            let limit = &value[key];
            let step_s = limit["step_s"].as_f64().unwrap();
            (limit["reason"].as_str().unwrap().to_owned(), step_s)
        })
    };
    let [fine, next] = limits("0.0025");
    assert_eq!([&fine.0, &next.0], ["impacts foreseen", "stability"]);
    // The usual accuracy, and twice its step.
    let [usual, coarse] = ["0.01", "0.04"].map(|accuracy| limits(accuracy)[0].clone());
    let fractions = [usual.1 / fine.1, coarse.1 / usual.1];
    assert!((fractions[0] - 4.0).abs() < 1e-12 && (fractions[1] - 2.0).abs() < 1e-12);
    let text = check(&bench, &[scene]);
    assert!(text.contains("impacts foreseen: "), "{text}");
}

#[test]
fn the_run_time_is_a_range_and_quiet_says_nothing() {
    let bench = Bench::new();
    let path = scene_of_data("cantilever.toml");
    let scene = path.to_str().unwrap();
    let value: serde_json::Value =
        serde_json::from_str(&check(&bench, &[scene, "--json", "--quiet"])).unwrap();
    let range = value["predicted_run_time_range_s"].as_array().unwrap();
    let [least, most] = [0, 1].map(|k| range[k].as_f64().unwrap());
    assert!(0.0 < least && least <= most, "{least} {most}");
    assert_eq!(value["predicted_run_time_s"], least);
    assert_eq!(check(&bench, &[scene, "--quiet"]), "");
}

#[test]
fn a_run_without_end_has_a_short_number_of_steps() {
    let bench = Bench::new();
    let path = scene_of_data("cantilever.toml");
    let said = check(
        &bench,
        &[path.to_str().unwrap(), "--set", "run.end_time=1e300"],
    );
    assert!(said.contains("\nsteps          1.9e304\n"), "{said}");
    assert!(!said.contains("0000000000"), "{said}");
}

#[test]
fn every_good_scene_can_be_checked() {
    let bench = Bench::new();
    for scene in corpus("good") {
        let scene = scene.to_str().unwrap();
        check(&bench, &[scene]);
        let json: serde_json::Value =
            serde_json::from_str(&check(&bench, &[scene, "--json", "--threads", "1"])).unwrap();
        assert!(json["time_step_s"].as_f64().unwrap() > 0.0);
    }
    assert!(bench.files().is_empty());
}

#[test]
fn only_scenes_can_be_checked() {
    let bench = Bench::new();
    let body = bench.write("row.vtp", vtp_bytes(&super::row(4)));
    for options in [
        vec![body.as_os_str()],
        vec!["--body".as_ref(), body.as_os_str()],
    ] {
        let output = dem_run().arg("check").args(options).output().unwrap();
        let (said, code) = super::refused(&output);
        assert_eq!(code, 2);
        assert!(said.contains("this is not a scene (.toml)"), "{said}");
    }
}

/// The bonds of a clump that is never replaced are not used, and need no properties.
#[test]
fn says_which_bonds_are_not_used() {
    let bench = Bench::new();
    bench.write("row.vtp", vtp_bytes(&super::row(5)));
    let text = "version = 1\nrun.end_time = 1\nmaterials.any.density = 1000\n\
                bodies.rock = { file = \"row.vtp\", material = \"any\", start_as = \"clump\" }\n";
    bench.write("rigid.toml", text);
    let said = check(&bench, &["rigid.toml"]);
    let line = "\n               'rock' as a rigid clump; its 3 bonds are not used\n";
    assert!(said.contains(line), "{said}");
}
