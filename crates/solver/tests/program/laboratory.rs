//! Laboratory tests from end to end.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::program::{Bench, dem_pack, dem_run, root, row, scene_of_data, vtp_bytes};

/// A row of 11 spheres of radius 2 mm, gripped at the first and last one and pulled. The bonds are
/// rods of 4 mm, for which there is a closed form.
pub(crate) fn bar() -> String {
    let particles: Vec<String> = (0..11)
        .map(|i| format!("[0, 0, {}, 0.002]", 0.004 * f64::from(i)))
        .collect();
    let bonds: Vec<String> = (0..10).map(|i| format!("[{i}, {}]", i + 1)).collect();
    format!(
        r#"version = 1
[run]
[materials.clay]
density = 2000
[bonds.clay]
young_modulus = "15 MPa"
poisson_ratio = 0.3
failure = {{ tensile_strength = "0.2 MPa" }}
[bodies.bar]
particles = [{}]
bond_list = [{}]
material = "clay"
bonds = "clay"
[groups.foot]
particles = [0]
[groups.head]
particles = [10]
[supports.foot]
group = "foot"
fixed = true
[test]
type = "tension"
crosshead = ["head"]
direction = [0, 0, 1]
stroke = "1 mm"
length = "40 mm"
area = {}
young_modulus = "15 MPa"
strength = "0.2 MPa"
"#,
        particles.join(", "),
        bonds.join(", "),
        PI * 4e-6,
    )
}

fn figure<'a>(test: &'a Value, name: &str) -> &'a Value {
    [
        "results",
        "calibration",
        "dimensions",
        "changes_at_half_the_rate",
    ]
    .iter()
    .flat_map(|part| test[part].as_array().unwrap())
    .find(|figure| figure["name"] == name)
    .unwrap_or_else(|| panic!("no {name} in {test}"))
}

fn value(test: &Value, name: &str) -> f64 {
    figure(test, name)["value"].as_f64().unwrap()
}

fn summary(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_bar_that_is_pulled_has_the_modulus_and_the_strength_of_its_bonds() {
    let bench = Bench::new();
    let scene = bench.write("bar.toml", bar());
    let said = summary(&bench.good(&scene, &["--json", "--output", "out"]));
    assert_eq!(said["ended_by"], "breakage");
    let test = &said["test"];
    assert_eq!(test["broken"], true);
    for (name, wanted, tolerance) in [
        ("specimen modulus", 15e6, 2e-3),
        ("stiffness", 15e6 * PI * 4e-6 / 0.04, 2e-3),
        ("failure force", 0.2e6 * PI * 4e-6, 5e-3),
        ("strength", 0.2e6, 5e-3),
        ("crosshead travel at failure", 0.2 / 15.0 * 0.04, 1e-2),
        ("specimen strength over bond strength", 1.0, 5e-3),
    ] {
        let off = value(test, name) / wanted - 1.0;
        assert!(off.abs() < tolerance, "{name}: {off}");
    }
    assert_eq!(test["first_broken"]["cause"], "tension");
    let changes = test["changes_at_half_the_rate"].as_array().unwrap();
    assert!(changes.len() >= 4, "{changes:?}");
    assert!(
        value_of_change(changes, "failure force").abs() < 0.01,
        "{changes:?}"
    );
    // The test is also on the page.
    let page = fs::read_to_string(bench.path("out/report.html")).unwrap();
    for part in [
        ": tension</h1>",
        "<td>failure force</td>",
        "<svg ",
        "half the rate</h2>",
        "</html>",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(page.matches("<svg ").count() >= 2);
    assert!(!page.contains("src="), "the page needs other files");
    for name in ["force-displacement.svg", "crack.svg"] {
        assert!(bench.path("out/plots").join(name).is_file(), "{name}");
    }
    // All of it can be replaced.
    bench.good(
        &scene,
        &[
            "--output",
            "out",
            "--force",
            "--set",
            "test.rate_check=false",
        ],
    );
}

fn value_of_change(changes: &[Value], name: &str) -> f64 {
    let found = changes.iter().find(|change| change["name"] == name);
    found.unwrap()["value"].as_f64().unwrap()
}

#[test]
fn a_test_that_goes_on_says_the_same() {
    let bench = Bench::new();
    let scene = bench.write("bar.toml", bar());
    let once = ["--set", "test.rate_check=false", "--json", "--output"];
    let whole = summary(&bench.good(&scene, &[&once[..], &["whole"]].concat()));
    let end_s = whole["simulated_s"].as_f64().unwrap();
    let half = format!("run.end_time={}", 0.7 * end_s);
    let first = summary(&bench.good(&scene, &[&once[..], &["parts", "--set", &half]].concat()));
    assert_eq!(first["test"]["broken"], false);
    assert_eq!(first["test"]["target_strength_pa"], 0.2e6);
    let parts = summary(&bench.good(&scene, &[&once[..], &["parts", "--resume"]].concat()));
    // The step fits the end of the run, which was initially a different one.
    for name in [
        "stiffness",
        "specimen modulus",
        "failure force",
        "crosshead travel at failure",
    ] {
        let off = value(&parts["test"], name) / value(&whole["test"], name) - 1.0;
        assert!(off.abs() < 2e-3, "{name}: {off}");
    }
    for part in ["bonds", "is_within"] {
        assert_eq!(parts["test"]["crack"][part], whole["test"]["crack"][part]);
    }
    let said = bench.bad(&scene, &[&once[..], &["parts", "--resume"]].concat(), 2);
    assert!(said.contains("the body of this test has broken"), "{said}");
}

#[test]
fn a_sample_is_bent_by_four_pins() {
    let bench = Bench::new();
    let sizes = ["--diameter", "5mm..7mm", "--overlap", "0.296"];
    dem_pack(
        &root().join("data/shapes/bending-sample.stl"),
        &[&sizes[..], &["--bond-range", "1.0"]].concat(),
        &bench.path("sample.vtp"),
    );
    let scene = scene_of_data("four-point-bending.toml");
    // Quiet: dem-pack warned of the large spheres, and dem-run repeats it.
    let mut options = vec![
        "--body",
        "sample=sample.vtp",
        "--json",
        "--output",
        "out",
        "--quiet",
    ];
    for set in ["test.periods=8", "test.rate_check=false"] {
        options.extend(["--set", set]);
    }
    let said = summary(&bench.good(&scene, &options));
    assert_eq!(said["ended_by"], "breakage");
    let test = &said["test"];
    for (name, wanted) in [
        ("support span", 0.17),
        ("loading span", 0.08),
        ("width", 0.03),
        ("height", 0.035),
    ] {
        let off = value(test, name) / wanted - 1.0;
        // The spheres do not quite touch the surface everywhere.
        assert!(off.abs() < 2e-3, "{name}: {off}");
    }
    // The supports carry the load of the pins, averaged over the sample's oscillation, until bonds
    // break.
    let series = std::fs::read_to_string(bench.path("out/series.csv")).unwrap();
    let head: Vec<&str> = series.lines().next().unwrap().split(',').collect();
    let column = |name: &str| head.iter().position(|h| *h == name).unwrap();
    let of = |names: [&str; 2]| {
        let columns = names.map(|name| column(&format!("wall_{name}_force_z_n")));
        let rows = series.lines().skip(1).map(|line| {
            let row: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
            (row[column("broken_bonds")] == 0.0).then(|| columns.map(|c| row[c]).iter().sum())
        });
        rows.map_while(|force: Option<f64>| force)
            .sum::<f64>()
            .abs()
    };
    let pressed = of(["pin-left", "pin-right"]);
    let carried = of(["support-left", "support-right"]);
    assert!(
        (carried / pressed - 1.0).abs() < 0.05,
        "{carried} {pressed}"
    );
    let force = value(test, "failure force");
    // The body by itself is stiffer than with the compliance at the pins.
    assert!(value(test, "specimen stiffness") > value(test, "stiffness"));
    let figure = figure(test, "failure force");
    let off = force / figure["theory"].as_f64().unwrap() - 1.0;
    assert!((figure["error"].as_f64().unwrap() - off).abs() < 1e-12);
    assert!(said["energy_error"].as_f64().unwrap() < 0.02);
    let crack = &test["crack"];
    assert!(crack["bonds"].as_u64().unwrap() > 50);
    assert_eq!(crack["bonds"], said["broken_bonds"]);
}

#[test]
fn what_a_test_cannot_be_made_of() {
    let bench = Bench::new();
    let text = bar();
    let loose = text.replace("bond_list = ", "# ");
    let scene = bench.write("loose.toml", loose);
    let said = bench.bad(&scene, &[], 2);
    assert!(
        said.contains("[test]: the body 'bar' has no bonds"),
        "{said}"
    );

    let bent = text
        .replace("type = \"tension\"", "type = \"three-point-bending\"")
        .replace("crosshead = [\"head\"]", "crosshead = [\"plate\"]")
        .replace("length = \"40 mm\"", "rate_check = false")
        .replace("area = ", "periods = 9 # ")
        .replace(
            "[test]",
            "[materials.steel]\nyoung_modulus = 1e9\n[contacts]\nclay-steel = { law = \"linear\", normal_stiffness = 1e4, restitution = 0.5 }\nclay-clay = { law = \"linear\", normal_stiffness = 1e4, restitution = 0.5 }\n[walls.plate]\nplane = { point = [0, 0, 1], normal = [0, 0, -1] }\nmaterial = \"steel\"\n[test]",
        );
    let scene = bench.write("bent.toml", bent);
    let said = bench.bad(&scene, &[], 2);
    assert!(
        said.contains(
            "a three-point-bending test has 1 moving and 2 fixed pins, but here are 1 and 0"
        ),
        "{said}"
    );

    // In the opposite direction, a pin and a plate move away from the body.
    for (name, body, wall) in [
        ("four-point-bending.toml", "sample", "pin-left"),
        ("compression.toml", "bar", "plate-above"),
    ] {
        let file = root().join("data/bodies/sample.vtp");
        let body_of = format!("{body}={}", file.display());
        let round = ["--body", &body_of, "--set", "test.direction=[0,0,1]"];
        let said = bench.bad(&scene_of_data(name), &round, 2);
        assert!(
            said.contains(&format!(
                "moves away from the body '{body}', whose middle lies"
            )),
            "{wall}: {said}"
        );
        // Nothing has been written, and a plan is refused in the same way.
        let out = format!("{}-out", name.trim_end_matches(".toml"));
        assert!(!bench.path(&out).exists());
        let output = bench
            .command(Path::new("check"), &round)
            .arg(scene_of_data(name))
            .output()
            .unwrap();
        assert_eq!(crate::program::refused(&output), (said, 2));
    }

    // A bar is not a disc: 180 mm by 35 mm perpendicular to the load and along it.
    let body = format!("sample={}", root().join("data/bodies/sample.vtp").display());
    let disc = "test.type='brazilian-disc'";
    let options = ["--body", &body, "--set", disc, "--output", "disc-out"];
    let said = bench.bad(&scene_of_data("four-point-bending.toml"), &options, 2);
    let wanted = "the body 'sample' is no disc: 35 mm along the load, 180 mm across it";
    assert!(said.contains(wanted), "{said}");
    assert!(!bench.path("disc-out").exists());

    // Speeds and times that do not allow a time step.
    for key in ["rate", "stroke"] {
        let set = format!("test.{key}=1e300");
        let options = ["--body", &body, "--set", &set, "--output", "fast-out"];
        let said = bench.bad(&scene_of_data("four-point-bending.toml"), &options, 2);
        assert!(
            said.contains("check the units of speeds, rates and times"),
            "{said}"
        );
        assert!(!bench.path("fast-out").exists());
    }
}

/// A test measures what its bonds and spheres make: five across are enough, and a note says for
/// which spheres its bonds hold. Without the test the same body is coarse.
#[test]
fn a_specimen_of_five_spheres_across_is_not_coarse() {
    let bench = Bench::new();
    let mut body = row(11);
    body.positions = (0..11).map(|i| [0.0, 0.0, 4e-3 * f64::from(i)]).collect();
    body.radii = vec![2e-3; 11];
    body.bonds = (1..11).map(|b| [b - 1, b]).collect();
    body.bond_radii = vec![2e-3; 10];
    body.bond_lengths = vec![4e-3; 10];
    body.about.program = Some("dem-pack 0.1.0".to_owned());
    body.about.thinnest_part_m = Some(9.8e-3);
    let mut said_of = |across: f64, has_test: bool| {
        body.about.particles_across = Some(across);
        bench.write("row.vtp", vtp_bytes(&body));
        let whole = bar();
        let place = |of: &str| whole.find(of).unwrap();
        let before = &whole[..place("particles = [[")];
        let mut text = format!(
            "{before}file = \"row.vtp\"\n{}",
            &whole[place("material = ")..]
        );
        if !has_test {
            text.truncate(text.find("[test]").unwrap());
            text = text.replace("[run]\n", "[run]\nend_time = \"1 ms\"\n");
        }
        let scene = bench.write("scene.toml", text);
        let mut check = dem_run();
        let output = check
            .arg("check")
            .arg(scene)
            .arg("--json")
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        let checked: Value = serde_json::from_slice(&output.stdout).unwrap();
        ["coarse", "notes"].map(|key| {
            let all = checked[key].as_array().unwrap().iter();
            let about = all.filter(|one| one.as_str().unwrap().contains("particles across"));
            about.count()
        })
    };
    assert_eq!(said_of(4.9, true), [0, 1]);
    assert_eq!(said_of(4.2, true), [1, 0]);
    assert_eq!(said_of(4.9, false), [1, 0]);
    assert_eq!(said_of(10.2, true), [0, 0]);
}

/// Answers of a test of strength are those at its largest load: what exceeds the laws among the
/// pieces later is a note, and a doubt only before.
#[test]
fn what_exceeds_the_laws_after_the_largest_load_is_a_note() {
    let body = format!("disc={}", root().join("data/bodies/disc.vtp").display());
    let of = |modulus_mpa: u32| {
        let bench = Bench::new();
        let set = format!("materials.cake.shear_modulus=\"{modulus_mpa} MPa\"");
        let once = ["--set", "test.rate_check=false", "--set", "test.periods=10"];
        let mut options = vec!["--body", &body, "--set", &set, "--json", "--quiet"];
        options.extend(once);
        let summary = summary(&bench.good(&scene_of_data("brazilian-disc.toml"), &options));
        let said = |of: &Value| {
            of.as_array()
                .unwrap()
                .iter()
                .map(Value::to_string)
                .collect()
        };
        let warnings: Vec<String> = said(&summary["verdict"]["warnings"]);
        let notes: Vec<String> = said(&summary["notes"]);
        (warnings, notes)
    };
    let is_pressed = |said: &String| said.contains("a contact pressed a sphere in");
    let (warnings, notes) = of(30);
    assert!(!warnings.iter().any(is_pressed), "{warnings:?}");
    let later = "after the largest load, so that the results of the test do not depend on it";
    assert!(notes.iter().any(|note| note.contains(later)), "{notes:?}");
    let (warnings, _) = of(2);
    assert!(warnings.iter().any(is_pressed), "{warnings:?}");
}
