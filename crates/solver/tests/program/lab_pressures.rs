//! `dem-run lab` for direct shear and triaxial compression.

use std::fmt::Write;
use std::process::Output;

use serde_json::Value;

use super::{Bench, dem_run, refused};

/// Cohesion, Pa, and friction angle, degrees, of the made material.
const COHESION_PA: f64 = 20e3;
const ANGLE_DEG: f64 = 30.0;

/// A curve that rises to a peak over 2 mm and falls to 60 % of it over 6 mm: travel, mm, and the
/// fraction of the peak, from the first row on.
fn shape() -> Vec<[f64; 2]> {
    let value = |mm: f64| match mm {
        mm if mm <= 2.0 => 1.0 - (1.0 - mm / 2.0).powi(2),
        mm => 0.6 + 0.4 * (-((mm - 2.0) / 0.5).powi(2)).exp(),
    };
    (0..=300)
        .map(|n| 0.02 * f64::from(n))
        .map(|mm| [mm, value(mm)])
        .collect()
}

/// A file of that shape with this head and peak, in the unit of the head.
fn file(head: &str, peak: f64) -> String {
    let mut text = format!("{head}\n");
    for [mm, part] in shape() {
        let _ = writeln!(text, "{mm:.3},{:.6}", peak * part);
    }
    text
}

fn lab(bench: &Bench, options: &[&str]) -> Output {
    let mut command = dem_run();
    command.current_dir(bench.path("")).arg("lab").args(options);
    command.output().unwrap()
}

fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Shear stresses at three normal stresses, two specimens each, of which the file of one has a
/// force: peaks, residuals, the line with its intervals, and a file for each normal stress.
#[test]
fn a_shear_series_has_cohesion_and_friction_angle() {
    let bench = Bench::new();
    let mut table = "file,area (cm2),normal_stress (kPa)\n".to_owned();
    for (at, normal_kpa) in [50.0, 100.0, 200.0].into_iter().enumerate() {
        let peak_kpa = 1e-3 * COHESION_PA + normal_kpa * ANGLE_DEG.to_radians().tan();
        for (name, factor) in [("a", 1.02), ("b", 0.98)] {
            let (head, peak) = match (at, name) {
                // kPa over 36 cm2.
                (0, "b") => ("travel (mm),force (N)", 3.6 * peak_kpa * factor),
                _ => ("travel (mm),shear stress (kPa)", peak_kpa * factor),
            };
            let file_name = format!("{name}-{normal_kpa}.csv");
            bench.write(&file_name, file(head, peak));
            let _ = writeln!(table, "{file_name},36,{normal_kpa}");
        }
    }
    bench.write("series.csv", table);
    let options = [
        "--specimens",
        "series.csv",
        "--type",
        "direct-shear",
        "-o",
        "shear.json",
    ];
    let found = json(&lab(&bench, &[&options[..], &["--json"]].concat()));
    let line = &found["failure_line"];
    let number = |value: &Value| value.as_f64().unwrap();
    assert!(
        (number(&line["cohesion_pa"]) / COHESION_PA - 1.0).abs() < 0.01,
        "{line}"
    );
    assert!(
        (number(&line["friction_angle_deg"]) / ANGLE_DEG - 1.0).abs() < 0.01,
        "{line}"
    );
    assert_eq!(line["peaks"], 6);
    assert!(number(&line["half_widths"][0]) > 0.0, "{line}");
    for (series, normal_kpa) in found["series"]
        .as_array()
        .unwrap()
        .iter()
        .zip([50.0, 100.0, 200.0])
    {
        let material = &series["material"];
        let peak_pa = COHESION_PA + 1e3 * normal_kpa * ANGLE_DEG.to_radians().tan();
        let [strength, residual] =
            ["strength_pa", "residual_pa"].map(|name| number(&material[name]["mean"]));
        assert!((strength / peak_pa - 1.0).abs() < 2e-3, "{material}");
        assert!(
            (residual / (0.6 * peak_pa) - 1.0).abs() < 2e-3,
            "{material}"
        );
        assert!(material["young_modulus_pa"].is_null());
        let shown = if normal_kpa < 100.0 {
            "50kPa".to_owned()
        } else {
            format!("{}MPa", 1e-3 * normal_kpa)
        };
        assert!(bench.path(&format!("shear-{shown}.json")).exists());
    }
    let page = std::fs::read_to_string(bench.path("shear.html")).unwrap();
    for part in [
        "Strength over pressure",
        "normal stress 0.1 MPa",
        "residual strength",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let printed = lab(&bench, &options);
    let said = String::from_utf8(printed.stdout).unwrap();
    assert!(said.contains("failure line cohesion "), "{said}");
    assert!(said.contains("(95 %: ± "), "{said}");
    // A scene under another normal stress does not take it.
    let scene = super::root().join("data/scenes/direct-shear.toml");
    let set = format!("test.measured={:?}", bench.path("shear-0.1MPa.json"));
    let (said, code) = refused(
        &dem_run()
            .arg("check")
            .arg(scene)
            .args(["--set", &set])
            .output()
            .unwrap(),
    );
    assert!(
        said.contains("was measured under a normal stress of 0.1 MPa, not 5 MPa; name a material measured under the same"),
        "{said}"
    );
    assert_eq!(code, 2);
}

/// Triaxial tests: the force above that of the pressure, and a modulus.
#[test]
fn a_triaxial_series_has_a_modulus_as_well() {
    let bench = Bench::new();
    let (sin, cos) = ANGLE_DEG.to_radians().sin_cos();
    let mut table = "file,confining_pressure (kPa)\n".to_owned();
    for pressure_kpa in [100.0, 200.0, 400.0] {
        let of = 1e-3 * COHESION_PA * cos + pressure_kpa * sin;
        let deviator_kpa = 2.0 * of / (1.0 - sin);
        let name = format!("{pressure_kpa}.csv");
        // kPa over 10 cm2.
        bench.write(&name, file("displacement (mm),load (N)", deviator_kpa));
        let _ = writeln!(table, "{name},{pressure_kpa}");
    }
    bench.write("series.csv", table);
    let options = [
        "--specimens",
        "series.csv",
        "--type",
        "triaxial-compression",
        "--length",
        "100mm",
        "--area",
        "10cm2",
        "--json",
    ];
    let found = json(&lab(&bench, &options));
    let line = &found["failure_line"];
    let number = |value: &Value| value.as_f64().unwrap();
    assert!(
        (number(&line["cohesion_pa"]) / COHESION_PA - 1.0).abs() < 0.01,
        "{line}"
    );
    assert!(
        (number(&line["friction_angle_deg"]) / ANGLE_DEG - 1.0).abs() < 0.01,
        "{line}"
    );
    // The slope of the parabola where it has 20 % to 60 % of the peak: sqrt(0.8) to sqrt(0.4) of
    // that at its begin, 1/mm.
    let modulus = number(&found["series"][0]["material"]["young_modulus_pa"]["mean"]);
    let deviator_pa = 2.0 * (COHESION_PA * cos + 100e3 * sin) / (1.0 - sin);
    let ratio = modulus / (deviator_pa * 0.1 / 1e-3);
    assert!((0.4_f64.sqrt()..0.8_f64.sqrt()).contains(&ratio), "{ratio}");
}

/// What a simulated test has written is evaluated as it was during the run.
#[test]
fn a_simulated_curve_is_evaluated_as_a_measured_one() {
    let bench = Bench::new();
    super::calibrate_several::scenes(&bench);
    let set = "bonds.rock.young_modulus=1000 GPa";
    let said = bench.good(
        &bench.path("high.toml"),
        &["--json", "--output", "out", "--set", set],
    );
    let summary: Value = serde_json::from_str(&said).unwrap();
    let results = summary["test"]["results"].as_array().unwrap();
    let value = |name: &str| {
        let found = results.iter().find(|one| one["name"] == name).unwrap();
        found["value"].as_f64().unwrap()
    };
    let area = format!("{:.8}mm2", 9.0 * std::f64::consts::PI);
    let options = [
        "out/force-displacement.csv",
        "--type",
        "direct-shear",
        "--normal-stress",
        "1MPa",
        "--area",
        &area,
        "--travel-column",
        "2",
        "--force-column",
        "4",
        "--json",
    ];
    let found = json(&lab(&bench, &options));
    let material = &found["series"][0]["material"];
    for (name, wanted) in [
        ("strength_pa", value("strength")),
        ("residual_pa", value("residual strength")),
        ("stiffness_n_m", value("stiffness")),
    ] {
        let mean = material[name]["mean"].as_f64().unwrap();
        assert!(
            (mean / wanted - 1.0).abs() < 0.01,
            "{name}: {mean} {wanted}"
        );
    }
}

#[test]
fn tests_under_pressure_need_their_pressure() {
    let bench = Bench::new();
    bench.write("a.csv", file("travel (mm),shear stress (kPa)", 80.0));
    let rising: String = file("travel (mm),shear stress (kPa)", 80.0)
        .lines()
        .take(100)
        .map(|line| format!("{line}\n"))
        .collect();
    bench.write("rising.csv", rising);
    for (options, wanted) in [
        (
            vec!["a.csv", "--type", "direct-shear", "--area", "36cm2"],
            "error: direct-shear needs the normal stress; add --normal-stress 100kPa",
        ),
        (
            vec![
                "a.csv",
                "--type",
                "compression",
                "--area",
                "36cm2",
                "--length",
                "20mm",
                "--normal-stress",
                "1MPa",
            ],
            "error: the normal stress does not apply to compression; leave out --normal-stress",
        ),
        (
            vec![
                "rising.csv",
                "--type",
                "direct-shear",
                "--area",
                "36cm2",
                "--normal-stress",
                "1MPa",
            ],
            "error: no specimen is valid: rising.csv: it did not pass its peak: the force is still",
        ),
    ] {
        let (said, code) = refused(&lab(&bench, &options));
        assert!(said.starts_with(wanted), "{said}");
        assert_eq!(code, 2);
    }
}
