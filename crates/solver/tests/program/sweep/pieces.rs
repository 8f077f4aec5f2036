//! Studies that compare the masses of pieces.

use std::fs;

use serde_json::Value;

use super::{bad, bench, good, json};

/// Pieces that are discharged.
const PIECES: &str = r#"version = 1
scene = "SCENE"
repeats = 1
[set]
"run.adaptive" = false
[vary]
"run.safety_factor" = [0.9, 0.45, 0.3]
[measures.left]
fragment_masses = "discharged"
reference = "finest"
[measures.rest]
fragment_masses = "remaining"
reference = "finest"
[measures.d50]
run_result = "d50"
"#;

#[test]
fn distributions_of_masses_are_compared() {
    let scene = crate::program::good("following.toml").display().to_string();
    let bench = bench(&PIECES.replace("SCENE", &scene));
    good(&bench, &["--quiet"]);
    let masses = |run: usize| -> Vec<f64> {
        let text =
            fs::read_to_string(bench.path(&format!("study-sweep/runs/000{run}-1/events.csv")));
        let mut found = Vec::new();
        for line in text
            .unwrap()
            .lines()
            .filter(|line| line.contains(",discharged,"))
        {
            found.push(line.rsplit(' ').nth(1).unwrap().parse().unwrap());
        }
        found
    };
    let (own, other) = (masses(1), masses(3));
    assert!(own.len() > 3 && other.len() > 3 && own != other);
    // At every value, and just below it, the fraction of each at or below it.
    let fraction =
        |all: &[f64], x: f64| all.iter().filter(|m| **m <= x).count() as f64 / all.len() as f64;
    let apart = own
        .iter()
        .chain(&other)
        .map(|x| (fraction(&own, *x) - fraction(&other, *x)).abs());
    let wanted = apart.fold(0.0, f64::max);
    let table = json(&bench);
    let of = |run: usize, measure: usize| &table["runs"][run]["results"][measure];
    assert!(
        (of(0, 0)["error"].as_f64().unwrap() - wanted).abs() < 1e-12,
        "{wanted} {table}"
    );
    assert_eq!(of(0, 0)["value"], own.len() as f64);
    assert_eq!(of(0, 0)["reference"], other.len() as f64);
    let chance = 1.358 * (1.0 / own.len() as f64 + 1.0 / other.len() as f64).sqrt();
    assert!((of(0, 0)["uncertainty"].as_f64().unwrap() - chance).abs() < 1e-12);
    assert!(of(2, 0)["is_reference"] == true && of(2, 0)["error"].is_null());
    assert!(of(0, 1)["value"].as_f64().unwrap() >= 1.0);
    let summary = fs::read(bench.path("study-sweep/runs/0001-1/summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    let d50_m = &summary["sizes"]["all"]["both"]["d50_m"];
    assert!(
        of(0, 2)["value"] == *d50_m && d50_m.as_f64().unwrap() > 0.0,
        "{d50_m}"
    );
    assert_eq!(table["measures"][2]["unit"], "m");
}

#[test]
fn masses_need_pieces_and_a_finest_run() {
    let pieces = PIECES.replace("\"run.adaptive\" = false", "\"run.seed\" = 1");
    let bench = bench(&pieces.replace("SCENE", "spring.toml"));
    let said = bad(&bench, &[], 2);
    assert!(said.contains("has no [outlets]"), "{said}");
    assert!(!bench.path("study-sweep").exists());
    let other = self::bench(
        &pieces
            .replace("SCENE", "spring.toml")
            .replace("\"finest\"", "{ value = 1 }"),
    );
    let said = bad(&other, &[], 2);
    assert!(
        said.contains("has no run to be compared with") && said.contains("finest"),
        "{said}"
    );
}
