//! Studies that compare the curves of laboratory tests.

use std::fs;

use super::{assert_same_number, assert_well_formed, bad, bench, csv, good, json};
use crate::program::laboratory::bar;

/// A bar that is pulled once until it breaks.
fn pulled() -> String {
    bar().replace("[test]\n", "[test]\nrate_check = false\n")
}

const CURVES: &str = r#"version = 1
scene = "pulled.toml"
repeats = 1
[vary]
"bonds.clay.young_modulus" = { values = ["15 MPa", "12 MPa", "14.5 MPa"], size = [1, 3, 2] }
[measures.pull]
curve = "force-displacement"
reference = "finest"
"#;

#[test]
fn curves_of_tests_are_compared() {
    let bench = bench(CURVES);
    bench.write("pulled.toml", pulled());
    let said = good(&bench, &[]);
    let curve = |run: usize| -> Vec<[f64; 2]> {
        let path = format!("study-sweep/runs/000{run}-1/force-displacement.csv");
        let rows = csv(&bench.path(&path));
        let number = |text: &str| text.parse::<f64>().unwrap();
        rows.iter()
            .map(|row| [number(&row["displacement_m"]), number(&row["load_n"])])
            .collect()
    };
    let curves = [1, 2, 3].map(curve);
    let at = |points: &[[f64; 2]], x: f64| -> f64 {
        let next = points.iter().position(|p| p[0] > x);
        match next {
            Some(0) => points[0][1],
            Some(i) => {
                let ([x0, y0], [x1, y1]) = (points[i - 1], points[i]);
                y0 + (y1 - y0) * (x - x0) / (x1 - x0)
            }
            None => points[points.len() - 1][1],
        }
    };
    let peak = |points: &[[f64; 2]]| {
        let found = points.iter().max_by(|a, b| a[1].total_cmp(&b[1]));
        *found.unwrap()
    };
    let table = json(&bench);
    for run in [1, 2] {
        let end = peak(&curves[run])[0].max(peak(&curves[0])[0]);
        let (mut between, mut under) = (0.0, 0.0);
        let fine = 20_000;
        for i in 0..fine {
            let x = end * (f64::from(i) + 0.5) / f64::from(fine);
            between += (at(&curves[run], x) - at(&curves[0], x)).abs();
            under += at(&curves[0], x);
        }
        let judged = &table["runs"][run]["results"][0];
        let (error, wanted) = (judged["error"].as_f64().unwrap(), between / under);
        assert!((error / wanted - 1.0).abs() < 1e-3, "{error} {wanted}");
        assert_same_number(peak(&curves[run])[1], &judged["value"]);
        let times = [0, run].map(|run| table["runs"][run]["time_s"].as_f64().unwrap());
        assert_same_number(times[0] / times[1], &judged["times_as_fast"]);
    }
    // Both break at the same force, so the softer one reaches a larger displacement.
    let soft = table["runs"][1]["results"][0]["error"].as_f64().unwrap();
    assert!((0.2..0.8).contains(&soft), "{soft}");
    assert!(table["runs"][0]["results"][0]["times_as_fast"].is_null());
    assert!(said.contains("times as fast as the finest"), "{said}");
    let plot = fs::read_to_string(bench.path("study-sweep/pull-curves.svg")).unwrap();
    for name in ["15 MPa", "12 MPa", "14.5 MPa"] {
        assert!(plot.contains(name));
    }
    let page = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert_well_formed(&page);
    assert!(page.contains("displacement ("));
}

#[test]
fn curves_need_a_test_and_a_finest_run() {
    for (from, to, wanted) in [
        ("pulled.toml", "spring.toml", "has no [test]"),
        (
            "\"finest\"",
            "{ value = 1 }",
            "has no run to be compared with",
        ),
        ("force-displacement", "force", "force-displacement"),
    ] {
        let bench = bench(
            &CURVES
                .replace("\"bonds.clay.", "\"bonds.KIND.")
                .replace(from, to)
                .replace("KIND", if to == "spring.toml" { "steel" } else { "clay" }),
        );
        bench.write("pulled.toml", pulled());
        let said = bad(&bench, &[], 2);
        assert!(said.contains(wanted), "{said}");
        assert!(!bench.path("study-sweep").exists());
    }
}
