//! `dem-run lab`, and scenes that take what it wrote as their target.

use std::fmt::Write;
use std::path::PathBuf;

use dem_testing::made_test::{Made, USUAL};
use serde_json::Value;

use super::{Bench, dem_run, refused, root};

const BENDING: [&str; 10] = [
    "--type",
    "four-point-bending",
    "--support-span",
    "180mm",
    "--loading-span",
    "80mm",
    "--width",
    "30mm",
    "--height",
    "35mm",
];

/// The made-up files of the repository.
fn files() -> [PathBuf; 3] {
    ["a.csv", "b.txt", "c.csv"].map(|name| root().join("data/measured").join(name))
}

fn csv(made: &Made) -> String {
    let (travel_m, force_n) = made.rows();
    let mut text = "travel (mm),force (N)\n".to_owned();
    for (travel_m, force_n) in travel_m.iter().zip(force_n) {
        let _ = writeln!(text, "{},{force_n}", 1e3 * travel_m);
    }
    text
}

#[test]
fn three_specimens_of_three_rigs_have_a_modulus_and_a_strength() {
    let bench = Bench::new();
    let output = bench.path("cake.json");
    let mut command = dem_run();
    command.arg("lab").args(files()).args(BENDING).arg("--json");
    let printed = command.arg("--output").arg(&output).output().unwrap();
    assert!(printed.status.success(), "{printed:?}");
    let summary: Value = serde_json::from_slice(&printed.stdout).unwrap();
    let material = &summary["material"];
    assert_eq!(material["specimens"].as_array().unwrap().len(), 3);
    // Platzer 2022, eqs. 18 and 19, by hand: 660.9 1/m and 4081.6 1/m2.
    let modulus_per_stiffness =
        (0.18_f64 - 0.08).powi(2) * (0.18 + 0.16) / 48.0 / (0.03 * 0.035_f64.powi(3) / 12.0);
    let stress_per_force = 1.5 * 0.1 / (0.03 * 0.035 * 0.035);
    for (name, wanted, fraction) in [
        ("young_modulus_pa", 18_230.0 * modulus_per_stiffness, 0.003),
        ("strength_pa", 51.45 * stress_per_force, 0.003),
        ("stiffness_n_m", 18_230.0, 0.003),
        ("failure_force_n", 51.45, 0.003),
    ] {
        let mean = material[name]["mean"].as_f64().unwrap();
        assert!(
            (mean / wanted - 1.0).abs() < fraction,
            "{name}: {mean}, not {wanted}"
        );
        assert_eq!(material[name]["count"], 3);
    }
    let scatter = material["failure_force_n"]["standard_deviation"]
        .as_f64()
        .unwrap();
    assert!((scatter - 1.929).abs() < 0.06, "{scatter}");
    let written = std::fs::read(&output).unwrap();
    assert_eq!(
        serde_json::from_slice::<Value>(&written).unwrap(),
        *material
    );
    let page = std::fs::read_to_string(bench.path("cake.html")).unwrap();
    for text in ["Mean curve", "seating", "linear", "behind it", "b.txt"] {
        assert!(page.contains(text), "{text}");
    }
}

/// Specimens of the table have their own dimensions; one in doubt is named and left out.
#[test]
fn a_table_names_dimensions_and_cracks() {
    let bench = Bench::new();
    for (seed, name) in (1..).zip(["one.csv", "two.csv", "three.csv"]) {
        bench.write(name, csv(&Made { seed, ..USUAL }));
    }
    let table = bench.write(
        "specimens.csv",
        "file;width (mm);crack offset (mm)\none.csv;30;\ntwo.csv;33;5\nthree.csv;;-52,5\n",
    );
    let mut command = dem_run();
    command
        .arg("lab")
        .arg("--specimens")
        .arg(&table)
        .args(BENDING);
    let output = command
        .arg("--output")
        .arg(bench.path("m.json"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("specimens    2 of 3 valid"), "{said}");
    assert!(
        said.contains(
            "three.csv: it cracked 52.5 mm from the middle, outside the loading pins at 40.0 mm"
        ),
        "{said}"
    );
    let text = std::fs::read_to_string(bench.path("m.json")).unwrap();
    let material: Value = serde_json::from_str(&text).unwrap();
    // The wider one is scaled to a width of 30 mm.
    let force = material["failure_force_n"]["mean"].as_f64().unwrap();
    assert!(
        (force / (51.45 * (1.0 + 30.0 / 33.0) / 2.0) - 1.0).abs() < 0.005,
        "{force}"
    );
}

#[test]
fn what_cannot_be_evaluated_is_refused_with_one_message() {
    let bench = Bench::new();
    let good = bench.write("good.csv", csv(&USUAL));
    let whole = bench.write(
        "whole.csv",
        csv(&Made {
            tail: 0.95,
            ..USUAL
        }),
    );
    let torn = bench.write("torn.csv", csv(&USUAL).replacen("\n0.", "\nx.", 1));
    let lab = |file: &PathBuf, options: &[&str]| {
        let mut command = dem_run();
        command.arg("lab").arg(file).args(options);
        command.arg("--output").arg(bench.path("m.json"));
        refused(&command.output().unwrap())
    };
    let place = |file: &PathBuf| file.display().to_string();
    for (file, options, wanted) in [
        (&good, &["--type", "bending"][..], "error: --type: 'bending' is not a type of test; use one of four-point-bending, three-point-bending, brazilian-disc, compression, tension".to_owned()),
        (&good, &["--type", "brazilian-disc", "--width", "30mm"], "error: brazilian-disc needs the height; add --height 30mm".to_owned()),
        (&good, &["--type", "tension", "--length", "4 parsec"], "error: --length: '4 parsec' is not a length: unknown unit 'parsec'".to_owned()),
        (&torn, &BENDING, format!("error: {}: line 3: the travel is 'x", place(&torn))),
        (&bench.path("none.csv"), &BENDING, format!("error: {}: there is no such file; check its name and folder", place(&bench.path("none.csv")))),
    ] {
        let (said, code) = lab(file, options);
        assert!(said.starts_with(&wanted), "{said}\nnot\n{wanted}");
        assert_eq!(code, 2);
        assert!(!bench.path("m.json").exists() && !bench.path("m.html").exists());
    }
    // The page shows why nothing is valid.
    let (said, code) = lab(&whole, &BENDING);
    assert!(
        said.contains("no specimen is valid") && said.contains("it did not fail"),
        "{said}"
    );
    assert_eq!(code, 2);
    assert!(!bench.path("m.json").exists() && bench.path("m.html").exists());
    // Nothing overwrites a curve or a table of specimens, and the page is not the material.
    let list = "file,width (mm)\ngood.csv,30\n";
    let specimens = bench.write("list.csv", list);
    let page = bench.path("m.html");
    for (source, output, problem) in [
        (
            vec![&good],
            &good,
            "it would replace the file that it is made from",
        ),
        (
            vec![&PathBuf::from("--specimens"), &specimens],
            &specimens,
            "it would replace the file that it is made from",
        ),
        (vec![&good], &page, "is the name of the page"),
    ] {
        let mut command = dem_run();
        command.arg("lab").args(source).args(BENDING);
        let (said, code) = refused(&command.arg("--output").arg(output).output().unwrap());
        assert!(said.contains(problem), "{said}");
        assert_eq!(code, 2, "{said}");
    }
    assert_eq!(std::fs::read_to_string(&good).unwrap(), csv(&USUAL));
    assert_eq!(std::fs::read_to_string(&specimens).unwrap(), list);
}

/// The measured quartzite gives a file that scenes include, and a page.
#[test]
fn drop_weight_tests_give_a_law_of_breakage() {
    let bench = Bench::new();
    let sheet = root().join("data/measured/quartzite-drop-weight.csv");
    let lab = |options: &[&str], output: &str| {
        let mut command = dem_run();
        command
            .arg("lab")
            .arg(&sheet)
            .args(["--type", "drop-weight"]);
        command
            .args(options)
            .arg("--output")
            .arg(bench.path(output));
        command.output().unwrap()
    };
    let printed = lab(&["--json", "--material", "ore"], "quartzite.toml");
    assert!(printed.status.success(), "{printed:?}");
    let summary: Value = serde_json::from_slice(&printed.stdout).unwrap();
    assert_eq!(summary["material"], "ore");
    assert_eq!(summary["ore"]["tests"], 13);
    let text = std::fs::read_to_string(bench.path("quartzite.toml")).unwrap();
    for part in [
        "# Fitted on 20",
        " by dem-run ",
        "\n\n[materials.ore.breakage]\nlargest_t10 = 1.0\nb = \"1.20",
    ] {
        assert!(text.contains(part), "{part} not in {text}");
    }
    let page = std::fs::read_to_string(bench.path("quartzite.html")).unwrap();
    for part in [
        "t10 over energy",
        "Master curve",
        "Family",
        "A is at its bound",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // The name of the file is that of the material; all but the place of the file stays the same.
    let printed = lab(&[], "again.toml");
    let said = String::from_utf8(printed.stdout).unwrap();
    assert!(
        said.contains("b                1.2 t/kWh       95 %: 1.06 to 1.37"),
        "{said}"
    );
    let again = std::fs::read_to_string(bench.path("again.toml")).unwrap();
    assert_eq!(again.replace("materials.again", "materials.ore"), text);
    assert!(lab(&["--quiet"], "again.toml").stdout.is_empty());
    for (options, output, wanted) in [
        (
            &["--width", "3mm"][..],
            "no.toml",
            "error: --width: does not go with drop-weight; leave it out",
        ),
        (
            &["--material", "a b"],
            "no.toml",
            "error: --material: 'a b' is not the name of a material; use letters",
        ),
        (
            &[],
            "no.html",
            "is the name of the page; write the ore to a name that ends in .toml",
        ),
    ] {
        let (said, code) = refused(&lab(options, output));
        assert!(said.contains(wanted), "{said}");
        assert_eq!(code, 2);
        assert!(!bench.path("no.toml").exists() && !bench.path("no.html").exists());
    }
    let bad = bench.write(
        "bad.csv",
        "size (mm),Ecs (kWh/t),t10 (%)\n30,1,20\n30,2,30\n30,3,130\n",
    );
    let mut command = dem_run();
    command
        .arg("lab")
        .arg(&bad)
        .args(["--type", "drop-weight", "--output"]);
    let (said, code) = refused(&command.arg(bench.path("no.toml")).output().unwrap());
    let wanted = format!(
        "error: {}: line 4: the t10 is 130 %, above 100 %; correct",
        bad.display()
    );
    assert!(said.starts_with(&wanted), "{said}");
    assert_eq!(code, 2);
    assert!(!bench.path("no.toml").exists() && !bench.path("no.html").exists());
}

/// A file without an end is refused.
#[cfg(unix)]
#[test]
fn a_file_without_an_end_is_refused() {
    let bench = Bench::new();
    let mut command = dem_run();
    command.arg("lab").arg("/dev/zero").args(BENDING);
    command.arg("--output").arg(bench.path("m.json"));
    let (said, code) = refused(&command.output().unwrap());
    assert!(
        said.contains("/dev/zero: this is larger than 256 MB"),
        "{said}"
    );
    assert_eq!(code, 2);
}

/// A bar whose bonds have the measured modulus and strength lies on the measured curve.
#[test]
fn a_simulated_test_is_compared_with_the_measured_curve() {
    let bench = Bench::new();
    let area_m2 = std::f64::consts::PI * 4e-6;
    let made = Made {
        stiffness_n_m: 15e6 * area_m2 / 0.04,
        failure_n: 0.2e6 * area_m2,
        before_m: 0.1e-3,
        seating_m: 0.0,
        offset_n: 0.1,
        drift_n: 0.0,
        noise_n: 0.002,
        bend: 1.0,
        ..USUAL
    };
    let file = bench.write("bar.csv", csv(&made));
    let area = format!("{area_m2} m2");
    let mut command = dem_run();
    command
        .arg("lab")
        .arg(&file)
        .args(["--type", "tension", "--length", "40mm", "--area", &area]);
    let output = command
        .arg("--output")
        .arg(bench.path("bar.json"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let scene = super::laboratory::bar().replace(
        "young_modulus = \"15 MPa\"\nstrength = \"0.2 MPa\"\n",
        "measured = \"bar.json\"\n",
    );
    assert!(scene.contains("measured"), "{scene}");
    let scene = bench.write("scene.toml", scene);
    let printed = bench.good(&scene, &["--json", "--quiet", "--output", "out"]);
    let summary: Value = serde_json::from_str(&printed).unwrap();
    let results = summary["test"]["results"].as_array().unwrap();
    let value = |name: &str| {
        results
            .iter()
            .find(|one| one["name"] == name)
            .unwrap()
            .clone()
    };
    let apart = value("area between the curves")["value"].as_f64().unwrap();
    assert!(apart > 0.0 && apart < 0.03, "{apart}");
    // Modulus and strength of the measured material are what the results are compared with.
    let theory = value("strength")["theory"].as_f64().unwrap();
    assert!((theory / 0.2e6 - 1.0).abs() < 0.005, "{theory}");
    assert_eq!(value("strength")["theory_is"], "measured");
    assert_eq!(value("modulus by travel")["theory_is"], "measured");
    let page = std::fs::read_to_string(bench.path("out/report.html")).unwrap();
    for column in ["simulated", "target (measured)", "deviation"] {
        assert!(page.contains(column), "{column}");
    }
    let plot = std::fs::read_to_string(bench.path("out/plots/force-displacement.svg")).unwrap();
    assert!(plot.contains("measured"));
    let inputs = summary["inputs"].to_string();
    assert!(inputs.contains("bar.json"), "{inputs}");
    // Another type of test, and a file of something else.
    let material = std::fs::read_to_string(bench.path("bar.json")).unwrap();
    bench.write(
        "bar.json",
        material.replace("\"tension\"", "\"compression\""),
    );
    let said = bench.bad(&scene, &["--output", "other"], 2);
    assert!(
        said.contains("test.measured is of the type \"compression\", not \"tension\""),
        "{said}"
    );
    bench.write("bar.json", "{}");
    let said = bench.bad(&scene, &["--output", "other"], 2);
    assert!(said.contains("is not a measured material"), "{said}");
}
