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
[measures.left_kg]
discharge = "mass"
outlet = "away"
[measures.left_d50]
discharge = "d50"
[measures.left_small]
discharge = "passing"
sieve = "2.1 mm"
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
fn what_left_is_weighed_and_sieved() {
    let scene = crate::program::good("following.toml").display().to_string();
    let bench = bench(&PIECES.replace("SCENE", &scene));
    good(&bench, &["--quiet"]);
    let run = bench.path("study-sweep/runs/0001-1");
    let summary: Value =
        serde_json::from_slice(&fs::read(run.join("summary.json")).unwrap()).unwrap();
    let of_table = |name: &str| crate::program::numbers(&run.join("discharge.csv"), name);
    let pieces = of_table("sieve_m").into_iter().zip(of_table("mass_kg"));
    let small_kg: f64 = (pieces.filter(|(size_m, _)| *size_m <= 2.1e-3))
        .map(|(_, mass_kg)| mass_kg)
        .sum();
    let all_kg = summary["population"]["discharged_kg"].as_f64().unwrap();
    let wanted = [
        all_kg,
        summary["sizes"]["all"]["discharged"]["d50_m"]
            .as_f64()
            .unwrap(),
        small_kg / all_kg,
    ];
    assert!(wanted[2] > 0.0 && wanted[2] < 1.0, "{wanted:?}");
    let table = json(&bench);
    for (at, (wanted, unit)) in wanted.into_iter().zip(["kg", "m", ""]).enumerate() {
        let found = &table["runs"][0]["results"][3 + at]["value"];
        let off = found.as_f64().unwrap() / wanted - 1.0;
        assert!(off.abs() < 1e-12, "{found} {wanted}");
        assert_eq!(table["measures"][3 + at]["unit"], unit);
    }
}

#[test]
fn outlets_of_measures_are_there() {
    let study = |scene: &str| {
        bench(
            &PIECES
                .replace("SCENE", scene)
                .replace("\"away\"", "\"awa\""),
        )
    };
    let scene = crate::program::good("following.toml").display().to_string();
    let said = bad(&study(&scene), &[], 2);
    assert!(
        said.contains("has no outlet 'awa'; did you mean 'away'?"),
        "{said}"
    );
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
