//! `dem-run calibrate`, and scenes that include what it wrote.

use std::path::PathBuf;

use dem_io::Body;
use dem_io::body::write_body;
use serde_json::Value;

use super::{Bench, dem_run, refused, root};

/// A row of 11 spheres 4 mm apart, with bonds of this radius: rods with a closed form.
fn row(bench: &Bench, name: &str, radius_m: f64) -> PathBuf {
    let particles: Vec<[f64; 4]> = (0..11)
        .map(|i| [0.0, 0.0, 0.004 * f64::from(i), 0.002])
        .collect();
    let bonds: Vec<[u32; 2]> = (0..10).map(|i| [i, i + 1]).collect();
    let mut body = Body::from_spheres(&particles, &bonds).unwrap();
    body.bond_radii.fill(radius_m);
    let path = bench.path(name);
    write_body(&body, &path).unwrap();
    path
}

/// The bar of the tests of `[test]`, with its particles in a file.
fn scene(bench: &Bench) -> PathBuf {
    row(bench, "a.vtp", 0.002);
    let scene = super::laboratory::bar();
    let lines = scene.lines().map(|line| match line {
        line if line.starts_with("particles = [[") => "file = \"a.vtp\"",
        line if line.starts_with("bond_list") => "",
        line => line,
    });
    let text = format!("{}\n", lines.collect::<Vec<_>>().join("\n")).replace(
        "young_modulus = \"15 MPa\"\npoisson_ratio",
        "young_modulus = \"5 MPa\"\npoisson_ratio",
    );
    assert!(
        text.contains("5 MPa\"\npoisson") && text.contains("a.vtp"),
        "{text}"
    );
    bench.write("bar.toml", text)
}

fn calibrate(bench: &Bench, options: &[&str]) -> std::process::Output {
    let mut command = dem_run();
    command
        .arg("calibrate")
        .arg(bench.path("bar.toml"))
        .arg("--output")
        .arg(bench.path("clay.toml"));
    command.args(options).output().unwrap()
}

fn record(bench: &Bench) -> Value {
    let text = std::fs::read_to_string(bench.path("clay.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// The value of the first number of an unknown that a record ends with.
fn found(record: &Value, unknown: usize) -> f64 {
    let case = &record["cases"][0];
    let round = &case["rounds"][case["end"][0].as_u64().unwrap() as usize];
    let number = &record["unknowns"][unknown]["numbers"][0];
    number["value"].as_f64().unwrap() * round["factors"][unknown].as_f64().unwrap()
}

/// Rods of the radii 2 mm and 1.6 mm, tested as if both had 2 mm: their mean modulus and strength
/// are (1 + 0.64)/2 of those of their bonds.
#[test]
fn the_mean_of_two_packings_meets_modulus_and_strength() {
    let bench = Bench::new();
    scene(&bench);
    let [a, b] = [row(&bench, "a.vtp", 0.002), row(&bench, "b.vtp", 0.0016)];
    let bodies = [a.to_str().unwrap(), b.to_str().unwrap()];
    let printed = calibrate(&bench, &["--body", bodies[0], "--body", bodies[1]]);
    assert!(printed.status.success(), "{printed:?}");
    let said = String::from_utf8(printed.stdout).unwrap();
    let record = record(&bench);
    let (modulus_mpa, strength_mpa) = (found(&record, 0), found(&record, 1));
    assert!(
        (modulus_mpa * 0.82 / 15.0 - 1.0).abs() < 0.01,
        "{modulus_mpa}"
    );
    assert!(
        (strength_mpa * 0.82 / 0.2 - 1.0).abs() < 0.02,
        "{strength_mpa}"
    );
    // Standard deviation of 1 and 0.64 over their mean, and t = 12.706 for two packings.
    assert!(said.contains("scatter of packings 31.0 %"), "{said}");
    assert!(said.contains("bonds.clay.young_modulus"), "{said}");
    assert!(bench.path("clay.html").exists());
    // The scene takes the material as it stands, by an option or by its own key.
    let material = bench.path("clay.toml").display().to_string();
    let by_option = bench.good(
        &bench.path("bar.toml"),
        &["--material", &material, "--json", "--quiet"],
    );
    let summary: Value = serde_json::from_str(&by_option).unwrap();
    let results = summary["test"]["results"].as_array().unwrap();
    let modulus = results
        .iter()
        .find(|one| one["name"] == "modulus by travel")
        .unwrap();
    let wanted_pa = 15e6 / 0.82;
    assert!((modulus["value"].as_f64().unwrap() / wanted_pa - 1.0).abs() < 0.01);
    let text = std::fs::read_to_string(bench.path("bar.toml")).unwrap();
    let from = text.find("[materials.clay]").unwrap();
    let to = text.find("[bodies.bar]").unwrap();
    let text = format!(
        "{}{}{}",
        "include = [\"clay.toml\"]\n",
        &text[..from],
        &text[to..]
    );
    let own = bench.write("own.toml", text);
    let by_key: Value = serde_json::from_str(&bench.good(&own, &["--json", "--quiet"])).unwrap();
    assert_eq!(by_key["test"]["results"], summary["test"]["results"]);
}

/// A calibration of which some tests are missing goes on to the same result.
#[test]
fn an_interrupted_calibration_is_resumed() {
    let bench = Bench::new();
    scene(&bench);
    assert!(calibrate(&bench, &["--quiet"]).status.success());
    let material = std::fs::read(bench.path("clay.toml")).unwrap();
    let whole = record(&bench);
    let (said, code) = refused(&calibrate(&bench, &[]));
    assert!(
        said.contains("there is a calibration already; go on with it by --resume"),
        "{said}"
    );
    assert_eq!(code, 2);
    let mut cut = whole.clone();
    let case = &mut cut["cases"][0];
    // The test at twice the rate is done by itself.
    assert!(!case["at_twice_the_rate"].is_null());
    let rate = case["at_twice_the_rate"]["trials"][0]["results"].clone();
    case["at_twice_the_rate"] = Value::Null;
    bench.write("clay.json", cut.to_string());
    assert!(calibrate(&bench, &["--resume"]).status.success());
    let again = record(&bench);
    assert_eq!(
        again["cases"][0]["at_twice_the_rate"]["trials"][0]["results"],
        rate
    );
    let case = &mut cut["cases"][0];
    case["end"] = Value::Null;
    let rounds = case["rounds"].as_array_mut().unwrap();
    rounds.last_mut().unwrap()["trials"][0] = Value::Null;
    bench.write("clay.json", cut.to_string());
    assert!(calibrate(&bench, &["--resume"]).status.success());
    assert_eq!(std::fs::read(bench.path("clay.toml")).unwrap(), material);
    let factors = |record: &Value| -> Vec<Value> {
        let rounds = record["cases"][0]["rounds"].as_array().unwrap();
        rounds
            .iter()
            .map(|round| round["factors"].clone())
            .collect()
    };
    assert_eq!(factors(&record(&bench)), factors(&whole));
    // Another calibration is not resumed.
    let (said, code) = refused(&calibrate(
        &bench,
        &["--resume", "--set", "test.periods=30"],
    ));
    assert!(
        said.contains("it is the calibration of another scene, or with other options"),
        "{said}"
    );
    assert_eq!(code, 2);
}

/// Files that were not written by a calibration stay, and numbered ones are not overwritten either.
#[test]
fn files_of_others_stay() {
    let bench = Bench::new();
    let scene = scene(&bench);
    bench.write("clay.toml", "mine");
    let (said, code) = refused(&calibrate(&bench, &[]));
    assert!(
        said.contains("clay.toml: there is a file of this name already; replace it by --force"),
        "{said}"
    );
    assert_eq!(code, 2);
    assert_eq!(
        std::fs::read_to_string(bench.path("clay.toml")).unwrap(),
        "mine"
    );
    let text = std::fs::read_to_string(&scene).unwrap();
    let numbered = bench.write("clay-1.toml", &text);
    let shape = root().join("data/shapes/bar.stl").display().to_string();
    let mut command = dem_run();
    command
        .arg("calibrate")
        .arg(&numbered)
        .arg("--force")
        .arg("--output")
        .arg(bench.path("clay.toml"));
    command.args(["--size", "6mm", "--size", "7mm", "--", &shape]);
    let (said, code) = refused(&command.output().unwrap());
    assert!(
        said.contains("it would replace the file that it is made from"),
        "{said}"
    );
    assert_eq!(code, 2);
    assert_eq!(std::fs::read_to_string(&numbered).unwrap(), text);
    // Bad input leaves an earlier calibration as it is.
    assert!(calibrate(&bench, &["--quiet", "--force"]).status.success());
    let found = std::fs::read(bench.path("clay.toml")).unwrap();
    let (_, code) = refused(&calibrate(&bench, &["--force", "--free", "colour"]));
    assert_eq!(code, 2);
    assert_eq!(std::fs::read(bench.path("clay.toml")).unwrap(), found);
    // What it found does not stand beside one that failed.
    let failed = calibrate(
        &bench,
        &[
            "--force",
            "--set",
            "test.strength=2000 GPa",
            "--set",
            "test.stroke=10 km",
        ],
    );
    assert_ne!(failed.status.code(), Some(0));
    assert!(!bench.path("clay.toml").exists());
    let marked = std::fs::read_to_string(bench.path("clay-not-met.toml"));
    assert!(marked.is_ok_and(|text| text.starts_with("# NOT CALIBRATED: ")));
    assert!(calibrate(&bench, &["--quiet", "--force"]).status.success());
    assert!(!bench.path("clay-not-met.toml").exists());
}

/// `dem-run calibrate` of the cylinder of agglomerate, in compression, with coarse spheres.
fn of_agglomerate(bench: &Bench, options: &[&str]) -> std::process::Output {
    let cases = root().join("tests/calibrations");
    let shape = cases.join("cylinder.stl").display().to_string();
    let mut command = dem_run();
    command.arg("calibrate").arg(cases.join("agglomerate.toml"));
    command.arg("--output").arg(bench.path("clay.toml"));
    command
        .args(options)
        .args(["--packings", "2", "--", &shape]);
    command.args(["--diameter", "1.8mm..2.2mm", "--overlap", "0.25"]);
    command.args(["--bond-range", "1.1"]).output().unwrap()
}

/// Contacts at plates take a third of the deformation, and a first guess of the strength is 500
/// times too large: the static solver knows both. The file says with what the bonds were found, and
/// what other packings give.
#[test]
fn a_packed_cylinder_is_calibrated_in_few_rounds() {
    let bench = Bench::new();
    let far = [
        "--set",
        "bonds.agglomerate.failure.tensile_strength=100 MPa",
        "--set",
        "bonds.agglomerate.failure.cohesion=200 MPa",
    ];
    let printed = of_agglomerate(&bench, &far);
    assert!(printed.status.success(), "{printed:?}");
    let said = String::from_utf8(printed.stdout).unwrap();
    assert!(
        said.contains("others       mean of 2 other packings, 95 %:"),
        "{said}"
    );
    assert!(said.contains("half rate    modulus by travel "), "{said}");
    let record = record(&bench);
    let case = &record["cases"][0];
    let rounds = case["rounds"].as_array().unwrap();
    assert!(rounds.len() <= 4, "{}", rounds.len());
    // The modulus needs no correction by tests with steps.
    let first = &rounds[0]["trials"];
    let modulus = |at: usize| first[at]["results"][0].as_f64().unwrap();
    let mean = 0.5 * (modulus(0) + modulus(1));
    assert!((mean / 80e6 - 1.0).abs() < 0.02, "{mean}");
    assert!(
        !first[0]["results"][1].is_null(),
        "it did not break: {first}"
    );
    let material = std::fs::read_to_string(bench.path("clay.toml")).unwrap();
    for part in [
        "# Packings: seed 1, seed 2, of dem-pack ",
        "# Spheres: 2.001 mm in the mean, 5.97 across the body.",
        "# others: mean of 2 other packings",
        "calibrated_diameter = ",
        "calibrated_across = 5.97",
    ] {
        assert!(material.contains(part), "{part}: {material}");
    }
}

/// Contacts alone are softer than the target: the static solver says so before any test.
#[test]
fn a_modulus_out_of_reach_costs_no_test() {
    let bench = Bench::new();
    let soft = ["--set", "materials.agglomerate.young_modulus=5 MPa"];
    let printed = of_agglomerate(&bench, &soft);
    assert_eq!(printed.status.code(), Some(1), "{printed:?}");
    let said = String::from_utf8(printed.stderr).unwrap();
    assert!(
        said.contains("the modulus by travel of 80 MPa is out of reach: with bonds.agglomerate.young_modulus of"),
        "{said}"
    );
    assert!(said.contains("--modulus specimen"), "{said}");
    assert_eq!(record(&bench)["cases"][0]["rounds"], serde_json::json!([]));
    assert!(!bench.path("clay-not-met.toml").exists());
}

/// A first guess of the strength that is far too large or too small.
#[test]
fn a_first_guess_may_be_far_off() {
    for guess in ["0.002 MPa", "2 MPa"] {
        let bench = Bench::new();
        scene(&bench);
        let set = format!("bonds.clay.failure.tensile_strength={guess}");
        let said = calibrate(&bench, &["--set", "test.stroke=0.66 mm", "--set", &set]);
        assert!(said.status.success(), "{guess}: {said:?}");
        let strength_pa = found(&record(&bench), 1) * 1e6;
        assert!(
            (strength_pa / 0.2e6 - 1.0).abs() < 0.02,
            "{guess}: {strength_pa}"
        );
    }
}

/// Ten periods of a shape that is packed anew, in two sizes.
#[test]
fn sizes_of_a_shape_are_compared() {
    let bench = Bench::new();
    let text = std::fs::read_to_string(root().join("data/scenes/tension.toml")).unwrap();
    let text = text
        .replace("\"2.5 mm\"", "\"6 mm\"")
        .replace("57.5 mm", "54 mm");
    bench.write("bar.toml", text);
    let shape = root().join("data/shapes/bar.stl").display().to_string();
    let printed = calibrate(
        &bench,
        &[
            "--json",
            "--quiet",
            "--packings",
            "2",
            "--free",
            "modulus",
            "--set",
            "test.stroke=0.2 mm",
            "--set",
            "test.periods=5",
            "--set",
            "test.rate_check=false",
            "--size",
            "7mm..8mm",
            "--size",
            "8mm..10mm",
            "--max-error",
            "5%",
            "--",
            &shape,
        ],
    );
    assert!(printed.status.success(), "{printed:?}");
    let record: Value = serde_json::from_slice(&printed.stdout).unwrap();
    let names: Vec<&str> = (record["cases"].as_array().unwrap().iter())
        .map(|case| case["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["8mm..10mm", "7mm..8mm"]);
    for case in record["cases"].as_array().unwrap() {
        assert!(case["particles"].as_u64().unwrap() > 10);
        assert!(case["spheres_across"].as_f64().unwrap() > 1.0);
    }
    assert!(bench.path("clay-1.toml").exists() && bench.path("clay-2.toml").exists());
    assert!(!bench.path("clay.toml").exists());
    let page = std::fs::read_to_string(bench.path("clay.html")).unwrap();
    assert!(page.contains("curve apart") && page.contains("across the body"));
}

#[test]
fn what_cannot_be_calibrated_is_refused_with_one_message() {
    let bench = Bench::new();
    let scene = scene(&bench);
    let text = std::fs::read_to_string(&scene).unwrap();
    let shape = root().join("data/shapes/bar.stl").display().to_string();
    let body = bench.path("a.vtp").display().to_string();
    for (options, wanted) in [
        (
            vec!["--packings", "0", "--", &shape, "--diameter", "6mm"],
            "error: --packings: 0 is not between 1 and 1000; 4 is usual",
        ),
        (
            vec!["--free", "modulus", "--free", "modulus"],
            "error: --free: bonds.clay.young_modulus is named twice; name each number once",
        ),
        (
            vec!["--free", "bonds.clay.young_modulus=height:0.1"],
            "error: --free bonds.clay.young_modulus=height:0.1: the scene has no measure or test result 'height'; use one of stiffness,",
        ),
        (vec!["--free", "bodies.bar.velocity=stiffness:1"], "error: "),
        (
            vec!["--free", "colour"],
            "error: --free colour: it is not known; write modulus, strength,",
        ),
        (
            vec!["--free", "bonds.clay.young_modulus=strength:soft"],
            "error: --free bonds.clay.young_modulus=strength:soft: 'soft' is not a positive number",
        ),
        (
            vec!["--free", "bonds.mud.young_modulus=strength:1"],
            "error: --free bonds.mud.young_modulus=strength:1: the scene has no bonds.mud.young_modulus",
        ),
        (vec!["--set", "test.stroke=0.4 mm"], "error: "),
        (
            vec!["--body", "mud=x.vtp"],
            "error: --body mud=x.vtp: the scene has no body 'mud'; use one of bar",
        ),
        (
            vec!["--body", &body, "--", &shape, "--diameter", "6mm"],
            "error: --body: the body is packed anew; name either files, or a shape after --",
        ),
        (vec!["--", &shape], "error: dem-pack: "),
        (vec!["--", &shape, "--diameter", "0mm"], "error: "),
        (
            vec!["--size", "6mm", "--", &shape, "--output", "x.vtp"],
            "error: dem-pack: these are not the arguments of a shape that is packed",
        ),
        (
            vec![
                "--max-error",
                "none",
                "--size",
                "6mm",
                "--",
                &shape,
                "--diameter",
                "6mm",
            ],
            "error: --max-error: 'none' is not a positive error; write 5% or 0.05",
        ),
    ] {
        let (said, code) = refused(&calibrate(&bench, &options));
        assert!(said.starts_with(wanted), "{options:?}: {said}");
        assert!([1, 2].contains(&code), "{options:?}: {said}");
        assert!(!bench.path("clay.toml").exists(), "{options:?}: {said}");
        let _ = std::fs::remove_file(bench.path("clay.json"));
    }
    let stroke = refused(&calibrate(&bench, &["--set", "test.stroke=0.4 mm"])).0;
    // 0.2 MPa times 40 mm over 15 MPa.
    assert!(
        stroke.contains("the stroke of 0.4 mm is too short")
            && stroke.contains("0.5333 mm; write stroke = \"0.640 mm\" or more"),
        "{stroke}"
    );
    bench.write(
        "bar.toml",
        text.replace("young_modulus = \"15 MPa\"\nstrength = \"0.2 MPa\"\n", ""),
    );
    let said = refused(&calibrate(&bench, &[])).0;
    assert!(
        said.contains("bar.toml: the scene has no target; add young_modulus, strength or measured"),
        "{said}"
    );
    bench.write("bar.toml", &text);
    for output in ["bar.toml", "a.json", "page.html"] {
        let mut command = dem_run();
        command.arg("calibrate").arg(bench.path("bar.toml"));
        let (said, code) = refused(
            &command
                .arg("--output")
                .arg(bench.path(output))
                .output()
                .unwrap(),
        );
        assert!(
            said.contains("it would replace the file")
                || said.contains("or the name of the page or the record"),
            "{said}"
        );
        assert_eq!(code, 2);
    }
    assert_eq!(std::fs::read_to_string(&scene).unwrap(), text);
}

/// A damping ratio against a measure of a scene without a test: the mean kinetic energy of a
/// swinging pair.
#[test]
fn another_number_is_found_by_a_measure() {
    let bench = Bench::new();
    let text = r#"version = 1
[run]
end_time = "0.5 ms"
[materials.clay]
density = 2000
[bonds.clay]
young_modulus = "15 MPa"
poisson_ratio = 0.3
damping = { damping_ratio = 0.05 }
[bodies.pair]
particles = [[0, 0, 0, 0.002], [0.004, 0, 0, 0.002]]
bond_list = [[0, 1]]
material = "clay"
bonds = "clay"
[groups.right]
particles = [1]
[groups.left]
particles = [0]
[initial.right]
group = "right"
velocity = [0.01, 0, 0]
[initial.left]
group = "left"
velocity = [-0.01, 0, 0]
[measures.left_over]
quantity = "kinetic_energy"
statistic = "mean"
"#;
    bench.write("bar.toml", text);
    let first = bench.good(&bench.path("bar.toml"), &["--json", "--quiet"]);
    let first: Value = serde_json::from_str(&first).unwrap();
    let energy = |summary: &Value| summary["measures"]["left_over"]["value"].as_f64().unwrap();
    let wanted = 0.5 * energy(&first);
    let free = format!("bonds.clay.damping.damping_ratio=left_over:{wanted:e}");
    let printed = calibrate(&bench, &["--free", &free]);
    assert!(printed.status.success(), "{printed:?}");
    let said = String::from_utf8_lossy(&printed.stdout);
    let row = said.lines().find(|line| line.starts_with("left_over"));
    assert!(row.is_some_and(|row| row.contains(" J, target ")), "{said}");
    let material = bench.path("clay.toml").display().to_string();
    let after = bench.good(
        &bench.path("bar.toml"),
        &["--material", &material, "--json", "--quiet"],
    );
    let after: Value = serde_json::from_str(&after).unwrap();
    assert!((energy(&after) / wanted - 1.0).abs() <= 0.02);
}
