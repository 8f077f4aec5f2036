//! Studies without references: responses, and the search for a value.

use std::f64::consts::PI;
use std::fs;
use std::process::Command;

use serde_json::Value;

use super::{assert_well_formed, bad, bench, csv, good, json, sweep};
use crate::program::Bench;

/// The bar of the scene at rest under its load.
const REST: &str = r#"version = 1
scene = "spring.toml"
average_over = "loads.tip.force"
[set]
"run.integrator" = "static"
[vary]
"loads.tip.force" = [["0.9 kN", 0, 0], ["1.1 kN", 0, 0]]
"#;

/// Elongation of the bar, m: force x length over modulus x area.
fn elongation_m(force_n: f64, modulus_pa: f64) -> f64 {
    force_n * 0.4 / (modulus_pa * PI * 0.04)
}

#[test]
fn a_study_may_keep_everything() {
    let bench = bench(&format!(
        "keep = \"all\"\n{REST}\"bonds.steel.young_modulus\" = [\"100 GPa\"]\n[measures.tip]\n"
    ));
    good(&bench, &[]);
    for name in ["series.csv", "frames.pvd"] {
        assert!(
            bench.path("study-sweep/runs/0002-1").join(name).exists(),
            "{name}"
        );
    }
}

fn study_bench(rest: &str) -> Bench {
    bench(&format!("{REST}{rest}"))
}

fn assert_near(found: &str, wanted: f64) {
    let found: f64 = found.parse().unwrap();
    assert!((found / wanted - 1.0).abs() < 1e-6, "{found} {wanted}");
}

#[test]
fn a_response_is_the_mean_with_its_scatter() {
    let bench =
        study_bench("\"bonds.steel.young_modulus\" = [\"100 GPa\", \"200 GPa\"]\n[measures.tip]\n");
    let said = good(&bench, &[]);
    assert!(said.contains("4 runs of spring.toml, once each"), "{said}");
    assert!(
        said.contains("response     tip (m), mean and standard deviation over loads.tip.force"),
        "{said}"
    );
    for absent in ["front", "error", "scatter"] {
        assert!(!said.contains(absent), "{said}");
    }
    let rows = csv(&bench.path("study-sweep/responses.csv"));
    assert_eq!(rows.len(), 2);
    for (row, modulus_gpa) in rows.iter().zip([100.0, 200.0]) {
        let ends = [900.0, 1100.0].map(|force| elongation_m(force, 1e9 * modulus_gpa));
        assert_eq!(
            (row["measure"].as_str(), row["unit"].as_str()),
            ("tip", "m")
        );
        assert_near(&row["bonds.steel.young_modulus (GPa)"], modulus_gpa);
        assert_eq!(row["runs"], "2");
        assert_near(&row["mean"], 0.5 * (ends[0] + ends[1]));
        assert_near(&row["smallest"], ends[0]);
        assert_near(&row["largest"], ends[1]);
        // Of two values their mean.
        assert_eq!(row["median"], row["mean"]);
        // Of two values: their difference over the root of two.
        assert_near(
            &row["standard_deviation"],
            (ends[1] - ends[0]) / 2.0_f64.sqrt(),
        );
    }
    let runs = csv(&bench.path("study-sweep/sweep.csv"));
    assert_eq!(runs[0]["loads.tip.force (kN)"], "0.9");
    assert!(runs[0].contains_key("tip_value (m)") && !runs[0].contains_key("tip_error"));
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert_well_formed(&html);
    assert!(html.contains("<h1>Response: spring.toml</h1>"), "{html}");
    // A run leads to its page.
    let link = "<td class=\"n\"><a href=\"runs/0001-1/report.html\">1</a></td>";
    assert!(html.contains(link), "{html}");
    for absent in ["Pareto", "error", "Times"] {
        assert!(!html.contains(absent), "{absent}");
    }
    let svg = fs::read_to_string(bench.path("study-sweep/tip.svg")).unwrap();
    assert_eq!(svg.matches("class=\"mark\"").count(), 2);
    assert!(svg.contains("s modulus of steel (GPa)"));
    assert!(
        svg.contains("bonds.steel.young_modulus 100 GPa: 3.183e-8 ±"),
        "{svg}"
    );
    let said = bad(&bench, &["--collect", "--max-error", "all=1%"], 2);
    assert!(
        said.contains("no measure of the study has a reference"),
        "{said}"
    );
}

/// With `statistic = "median"` text and page show the median, with the range of the values.
#[test]
fn a_response_may_be_the_median_with_its_range() {
    let bench = bench(&format!("statistic = \"median\"\n{REST}[measures.tip]\n"));
    let said = good(&bench, &[]);
    assert!(
        said.contains("response     tip (m), median and range over loads.tip.force"),
        "{said}"
    );
    let [low, middle, high] = [900.0, 1000.0, 1100.0].map(|force| elongation_m(force, 200e9));
    let line = format!("  {middle:.3e} ({low:.2e} to {high:.2e})");
    assert!(said.contains(&line), "{said} {line}");
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert!(html.contains("Medians over 2 values"), "{html}");
}

/// Values without numbers have names at the axis; a second parameter has a plot of its own.
#[test]
fn each_varied_parameter_has_a_plot() {
    let bench = study_bench(
        "\"bonds.steel.young_modulus\" = [\"100 GPa\", \"200 GPa\"]\n\"bonds.steel.model\" = [\"timoshenko\", \"parallel\"]\n[measures.tip]\n",
    );
    good(&bench, &[]);
    let read = |name: &str| fs::read_to_string(bench.path("study-sweep").join(name)).unwrap();
    let [over_modulus, over_model] = [read("tip.svg"), read("tip.response.2.svg")];
    for svg in [&over_modulus, &over_model] {
        assert_well_formed(svg);
        assert_eq!(svg.matches("class=\"mark\"").count(), 4);
    }
    assert_eq!(over_modulus.matches("class=\"chain\"").count(), 2);
    assert!(over_model.contains(">timoshenko</text>") && over_model.contains(">parallel</text>"));
    good(&bench, &["--force"]);
    let sweep = fs::read_dir(bench.path("study-sweep")).unwrap();
    let plots = sweep.filter(|entry| {
        let name = entry.as_ref().unwrap().file_name();
        name.to_string_lossy().ends_with(".svg")
    });
    assert_eq!(plots.count(), 2);
}

const FIND: &str = r#"[find]
parameter = "bonds.steel.young_modulus"
from = "100 GPa"
to = "300 GPa"
measure = "tip"
value = "2e-8 m"
tolerance = "1 GPa"
[measures.tip]
"#;

/// Checks the result of [`FIND`], in GPa.
fn assert_found(table: &Value) {
    // The mean elongation is that under the mean force.
    let wanted = 1e-9 * elongation_m(1000.0, 1.0) / 2e-8;
    let found = &table["find"]["cases"][0]["result"]["found"];
    let [low, high] = [0, 1].map(|end| found["between"][end].as_f64().unwrap());
    assert!(
        low <= wanted && wanted <= high && high - low <= 1.0,
        "{found}"
    );
    assert_eq!(found["at"].as_f64().unwrap(), 0.5 * (low + high));
}

/// One of three forces pulls the mean away from the median.
#[test]
fn the_median_is_found_where_that_is_looked_for() {
    let bench = bench(&format!(
        "{}{}",
        REST.replace("1.1 kN", "1 kN\", 0, 0], [\"5 kN"),
        FIND.replace("measure =", "statistic = \"median\"\nmeasure =")
    ));
    let said = good(&bench, &[]);
    assert!(
        said.contains(
            "find         the median of tip passes 2e-8 m between bonds.steel.young_modulus = 158.6 GPa and 159.4 GPa"
        ),
        "{said}"
    );
    let table = json(&bench);
    assert_eq!(table["find"]["statistic"], "median");
    assert_found(&table);
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert!(html.contains("median of tip (m)"), "{html}");
    // One of three lies on the other side: that may be chance.
    assert!(table["notes"].to_string().contains("the median of tip at"));

    // The points that were tried for the median are not those for the mean.
    let mean = FIND.to_owned();
    let forces = REST.replace("1.1 kN", "1 kN\", 0, 0], [\"5 kN");
    bench.write("study.toml", format!("{forces}{mean}"));
    let said = bad(&bench, &["--resume"], 2);
    assert!(said.contains("its runs are of another [find]"), "{said}");
}

/// An axis that changes nothing, and a value that stands twice, make scatter that is none.
#[test]
fn seeds_without_effect_and_equal_values_are_named() {
    let rest = REST
        .replace("average_over = \"loads.tip.force\"\n", "")
        .replace(
            "\"loads.tip.force\" = [[\"0.9 kN\", 0, 0], [\"1.1 kN\", 0, 0]]",
            "\"run.seed\" = [1, 2, 2]\n\"bonds.steel.young_modulus\" = [\"100 GPa\"]",
        );
    let bench = bench(&format!("{rest}[measures.tip]\n"));
    good(&bench, &[]);
    let notes = json(&bench)["notes"].to_string();
    assert!(
        notes.contains("run.seed changes no value of any measure"),
        "{notes}"
    );
    assert!(
        notes.contains("run.seed has the value 2 more than once"),
        "{notes}"
    );
    // What varies cannot be set as well.
    let both = rest.replace("[set]", "[set]\n\"run.seed\" = 7");
    bench.write("study.toml", format!("{both}[measures.tip]\n"));
    let said = bad(&bench, &["--force"], 2);
    assert!(
        said.contains("[set] gives run.seed, which varies; remove it from [set]"),
        "{said}"
    );
}

#[test]
fn a_value_is_found() {
    let bench = study_bench(FIND);
    let said = good(&bench, &["--jobs", "2"]);
    // 200 GPa in eight halves are less than 1 GPa; each point has two runs.
    assert!(said.contains("20 runs of spring.toml, once each"), "{said}");
    assert!(
        said.contains("find         tip passes 2e-8 m between bonds.steel.young_modulus = 15"),
        "{said}"
    );
    assert!(
        said.contains(" (resolution of the search; with 95 % confidence between "),
        "{said}"
    );
    let table = json(&bench);
    assert_found(&table);
    let tried = table["find"]["cases"][0]["tried"].as_array().unwrap();
    assert_eq!(tried.len(), 10);
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert_well_formed(&html);
    assert!(
        html.contains("<h2>Search</h2>") && html.contains("between bonds.steel.young_modulus = 15"),
        "{html}"
    );
    let svg = fs::read_to_string(bench.path("study-sweep/tip.svg")).unwrap();
    assert!(svg.contains("looked for: 2e-8 m"));
    assert!(
        table["notes"]
            .to_string()
            .contains("within twice its standard error")
    );

    // The runs keep their tables.
    let kept = |name: &str| bench.path("study-sweep/runs/0001-1").join(name).exists();
    assert!(kept("series.csv") && kept("report.html") && !kept("frames") && !kept("frames.pvd"));

    // Only what is missing is done again, and a smaller tolerance goes on from there.
    let summary = |run: &str| {
        bench
            .path("study-sweep/runs")
            .join(run)
            .join("summary.json")
    };
    let written = |run: &str| fs::metadata(summary(run)).unwrap().modified().unwrap();
    let before = written("0009-1");
    fs::remove_file(summary("0005-1")).unwrap();
    bench.write(
        "study.toml",
        format!("{REST}{FIND}").replace("1 GPa", "0.5 GPa"),
    );
    let said = good(&bench, &["--resume"]);
    assert!(said.contains("22 runs"), "{said}");
    assert_eq!(written("0009-1"), before);
    assert_found(&json(&bench));
    bench.write(
        "study.toml",
        format!("{REST}{FIND}").replace("2e-8", "3e-8"),
    );
    let said = bad(&bench, &["--resume"], 2);
    assert!(said.contains("its runs are of another [find]"), "{said}");
}

/// The area of the bonds is proportional to the square of their radius, the modulus that gives the
/// elongation to its inverse: 159 GPa over 1, 0.81 and 0.49. The last one is beyond the range.
#[test]
fn a_value_is_found_in_each_case() {
    let cases = "\"bonds.steel.radius_factor\" = [1, 0.7, 0.9]\n";
    let bench = study_bench(&format!("{cases}{FIND}"));
    let output = sweep(&bench, &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("2e-8 m does not lie between the values of tip at the ends for bonds.steel.radius_factor 0.7: "),
        "{said}"
    );
    let said = String::from_utf8(output.stdout).unwrap();
    // Ten points of two cases and the ends of the third, each with two forces.
    assert!(said.contains("44 runs of spring.toml"), "{said}");
    let lines = said.lines().filter(|line| line.starts_with("find  "));
    assert_eq!(lines.count(), 3);
    let found = csv(&bench.path("study-sweep/find.csv"));
    assert_eq!(found.len(), 3);
    for (row, factor) in found.iter().zip([1.0, 0.7, 0.9_f64]) {
        assert_near(&row["bonds.steel.radius_factor"], factor);
        if factor == 0.7 {
            assert_eq!(
                (row["result"].as_str(), row["from"].as_str()),
                ("not bracketed", "")
            );
            continue;
        }
        let wanted = 1e-9 * elongation_m(1000.0, factor.powi(2)) / 2e-8;
        let [low, high] = ["from", "to"].map(|end| row[end].parse::<f64>().unwrap());
        assert!(
            low <= wanted && wanted <= high && high - low <= 1.0,
            "{row:?}"
        );
        assert_near(&row["bonds.steel.young_modulus (GPa)"], 0.5 * (low + high));
        assert_eq!(row["result"], "found");
    }
    let svg = fs::read_to_string(bench.path("study-sweep/find.1.svg")).unwrap();
    assert_well_formed(&svg);
    assert_eq!(svg.matches("class=\"mark\"").count(), 2);
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert_well_formed(&html);
    assert!(html.contains("where tip is 2e-8 m"), "{html}");

    // The numbers of runs do not depend on the other cases: all are known again.
    let runs = bench.path("study-sweep/runs");
    let count = || fs::read_dir(&runs).unwrap().count();
    let before = count();
    fs::remove_file(runs.join("0002-1/summary.json")).unwrap();
    assert_eq!(
        sweep(&bench, &["--resume"]).output().unwrap().status.code(),
        Some(1)
    );
    assert_eq!(count(), before);
    assert!(csv(&bench.path("study-sweep/find.csv")) == found);
}

#[test]
fn listed_points_are_found_in_turns() {
    let bench = study_bench(FIND);
    let mut turns = 0;
    loop {
        let commands = good(&bench, &["--list", "--resume"]);
        if commands.is_empty() {
            break;
        }
        turns += 1;
        assert_eq!(commands.lines().count(), if turns == 1 { 4 } else { 2 });
        let list = bench.write("list.sh", &commands);
        let mut sh = Command::new("sh");
        assert!(
            sh.arg(list)
                .current_dir(bench.folder.path())
                .status()
                .unwrap()
                .success()
        );
        if turns == 2 {
            let said = good(&bench, &["--collect"]);
            assert!(
                said.contains("the search for tip = 2e-8 m is not finished: 3 points"),
                "{said}"
            );
        }
    }
    assert_eq!(turns, 9);
    good(&bench, &["--collect"]);
    assert_found(&json(&bench));
}

#[test]
fn ends_that_do_not_bracket_the_value() {
    let bench = study_bench(&FIND.replace("2e-8 m", "1 mm"));
    let output = sweep(&bench, &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("1 mm does not lie between the values of tip at the ends: 3.183e-8 at 100 GPa, 1.061e-8 at 300 GPa; widen from and to"),
        "{said}"
    );
    // What was found is written all the same.
    assert_eq!(csv(&bench.path("study-sweep/responses.csv")).len(), 2);
}
