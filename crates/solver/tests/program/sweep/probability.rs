//! The probability of an outcome.

use super::{bad, bench, good};
use serde_json::Value;

const STUDY: &str = r#"version = 1
scene = "spring.toml"
[vary]
"run.seed" = [1, 2, 3]
"loads.tip.force" = [["1 kN", 0, 0], ["2 kN", 0, 0], ["3 kN", 0, 0], ["4 kN", 0, 0]]
[probability]
of = "tip"
below = "-1 m"
over = "loads.tip.force"
[measures.tip]
reference = "none"
"#;

/// The displacements of the first seed, by force, m: rising.
fn displacements(csv: &str) -> Vec<f64> {
    let rows = csv.lines().skip(1).take(4);
    let cell = |row: &str| row.split(',').nth(8).unwrap().parse().unwrap();
    rows.map(cell).collect()
}

#[test]
fn a_limit_is_chosen_after_the_runs() {
    let bench = bench(STUDY);
    let said = good(&bench, &["--quiet", "--jobs", "2"]);
    assert_eq!(said, "");
    let csv = std::fs::read_to_string(bench.path("study-sweep/sweep.csv")).unwrap();
    let heading = csv.lines().next().unwrap();
    assert_eq!(
        heading.split(',').nth(8),
        Some("tip_value (m)"),
        "{heading}"
    );
    let tip = displacements(&csv);
    assert!(tip.windows(2).all(|two| two[0] < two[1]), "{tip:?}");
    let said = good(&bench, &["--collect"]);
    let none = "probability  tip below -1 m in none of 12 runs: its mean probability in them is below 22.1 % with a confidence of 95 %; there is no curve over loads.tip.force";
    assert!(said.lines().any(|line| line == none), "{said}");

    let limit = f64::midpoint(tip[1], tip[2]);
    bench.write(
        "study.toml",
        STUDY.replace("\"-1 m\"", &format!("\"{limit:e} m\"")),
    );
    let said = good(&bench, &["--collect"]);
    let line = said
        .lines()
        .find(|line| line.starts_with("probability"))
        .unwrap();
    assert!(line.contains("50 % at 2.5 kN ("), "{line}");
    assert!(line.ends_with("; 6 of 12 runs"), "{line}");
    assert!(
        said.contains("note         one value of loads.tip.force separates the runs"),
        "{said}"
    );
    let read =
        |name: &str| std::fs::read_to_string(bench.path(&format!("study-sweep/{name}"))).unwrap();
    assert_eq!(read("probability.csv").lines().count(), 5);
    let fit = read("probability-fit.csv");
    assert!(
        fit.starts_with("runs,with_outcome,a,b,at_10 (kN),"),
        "{fit}"
    );
    assert!(read("probability.1.svg").contains("logistic curve"));
    assert!(read("sweep.html").contains("Probability"));
    let json: Value = serde_json::from_str(&read("sweep.json")).unwrap();
    let case = &json["probability"]["cases"][0];
    assert_eq!(case["fit"]["is_separated"], true);
    assert_eq!(case["points"][0]["runs"], 3);
    let at = case["fit"]["values"][1]["value"].as_f64().unwrap();
    assert!((at / 2.5 - 1.0).abs() < 1e-6, "{at}");
}

#[test]
fn a_limit_of_another_quantity_is_refused() {
    let bench = bench(&STUDY.replace("\"-1 m\"", "\"1 kg\""));
    let said = bad(&bench, &[], 2);
    assert!(
        said.contains("study.toml:6: probability.below: '1 kg' is not a length"),
        "{said}"
    );
}
