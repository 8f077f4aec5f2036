//! Studies with a design: what matters in scenes whose answers have a closed form.

use std::f64::consts::PI;
use std::fs;

use serde_json::Value;

use super::{assert_well_formed, bad, csv, json, sweep};
use crate::program::Bench;

/// A ball hits a plate: it leaves with the restitution times its velocity, whatever its mass and
/// the stiffness of the contact.
const BALL: &str = r#"version = 1

[run]
end_time = "8 ms"
gravity = [0, 0, 0]

[materials.ball]
density = "2000 kg/m3"

[materials.plate]

[contacts]
ball-plate = { law = "linear", normal_stiffness = "20 kN/m", restitution = 0.5 }

[bodies.ball]
material = "ball"
particles = [[0, 0, "10.1 mm", "10 mm"]]
velocity = [0, 0, "-1 m/s"]

[walls.plate]
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
material = "plate"

[measures.rebound]
of = "ball"
quantity = "velocity_z"

[measures.push]
of = "plate"
quantity = "force_z"
statistic = "smallest"
"#;

const RANGES: &str = r#"[design.ranges]
"contacts.ball-plate.restitution" = [0.3, 0.9]
"contacts.ball-plate.normal_stiffness" = ["10 kN/m", "40 kN/m"]
"materials.ball.density" = ["1000 kg/m3", "4000 kg/m3"]
[measures.rebound]
[measures.push]
[measures.time]
run_time = "processor"
"#;

fn bench(design: &str) -> Bench {
    let bench = Bench::new();
    bench.write("ball.toml", BALL);
    let head = "version = 1\nscene = \"ball.toml\"\n[design]\n";
    bench.write("study.toml", format!("{head}{design}{RANGES}"));
    bench
}

/// Runs the study; returns what it prints, and what it says on standard error.
fn good(bench: &Bench, options: &[&str]) -> (String, String) {
    let output = sweep(bench, options).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    (String::from_utf8(output.stdout).unwrap(), said)
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap_or_else(|_| panic!("{cell}"))
}

#[test]
fn trajectories_find_that_only_restitution_changes_a_rebound() {
    let bench = bench("kind = \"morris\"\ntrajectories = 4\n");
    let (printed, said) = good(&bench, &["--jobs", "2"]);
    assert_eq!(
        said,
        "design Morris: 4 trajectories of 3 parameters on 4 levels (seed 1), 16 points: 16 runs\n"
    );
    assert!(
        printed.contains("effects      rebound (m/s), mean "),
        "{printed}"
    );
    let rows = csv(&bench.path("study-sweep/effects.csv"));
    assert_eq!(rows.len(), 9);
    let first = &rows[0];
    assert_eq!(first["parameter"], "contacts.ball-plate.restitution");
    // v' = e v at 1 m/s: the range is 0.6, and no effect depends on the others.
    for column in ["mu_star", "mu", "mu_star_low", "mu_star_high"] {
        assert!(
            (number(&first[column]) / 0.6 - 1.0).abs() < 0.02,
            "{first:?}"
        );
    }
    assert!(number(&first["sigma"]) < 0.01, "{first:?}");
    assert_eq!(
        (first["effects"].as_str(), first["verdict"].as_str()),
        ("4", "chance unknown")
    );
    for other in &rows[1..3] {
        assert!(number(&other["mu_star"]) < 0.01, "{other:?}");
    }
    // The force is v sqrt(k m) times a factor of the damping: both matter, and interact.
    let push = &rows[3..6];
    for row in push
        .iter()
        .filter(|row| row["parameter"] != "contacts.ball-plate.restitution")
    {
        assert!(
            number(&row["mu"]) < -1.0 && number(&row["sigma"]) > 0.1,
            "{row:?}"
        );
    }
    let table = json(&bench);
    assert_eq!(table["design"]["morris"][0]["measure"], 0);
    assert_eq!(table["design"]["parameters"][1]["unit"], "kN/m");
    let time = rows
        .iter()
        .filter(|row| row["measure"] == "time" && row["unit"] == "s");
    assert_eq!(time.count(), 3);
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert_well_formed(&html);
    assert!(
        html.contains("<h1>Which parameters matter: ball.toml</h1>"),
        "{html}"
    );
    for name in ["rebound.svg", "rebound.sigma.svg", "time.svg"] {
        assert_well_formed(&fs::read_to_string(bench.path("study-sweep").join(name)).unwrap());
    }
    assert!(!bench.path("study-sweep/rebound.response.svg").exists());
    let (again, said) = good(&bench, &["--collect", "--json"]);
    let again: Value = serde_json::from_str(&again).unwrap();
    assert_eq!((&again["design"], said.as_str()), (&table["design"], ""));
}

/// Peak force of a spring without damping: v sqrt(k m).
#[test]
fn changes_one_at_a_time_are_those_of_the_closed_form() {
    let bench = bench("kind = \"one-at-a-time\"\n");
    let scene = BALL.replace("restitution = 0.5", "restitution = 1");
    bench.write("ball.toml", scene);
    let study = fs::read_to_string(bench.path("study.toml")).unwrap();
    bench.write(
        "study.toml",
        study.replace("[0.3, 0.9]", "{ from = 0.3, to = 1 }"),
    );
    let (printed, said) = good(&bench, &[]);
    assert!(
        said.ends_with("3 parameters to the ends of their ranges, 6 points: 6 runs\n"),
        "{said}"
    );
    assert!(
        printed.contains("changes      push (N) at the base "),
        "{printed}"
    );
    let rows = csv(&bench.path("study-sweep/effects.csv"));
    let row = |measure: &str, parameter: &str| {
        let is_it = |row: &&std::collections::BTreeMap<String, String>| {
            row["measure"] == measure && row["parameter"] == parameter
        };
        rows.iter().find(is_it).unwrap()
    };
    let rebound = row("rebound", "contacts.ball-plate.restitution");
    assert!(
        (number(&rebound["low_change"]) + 0.7).abs() < 0.01,
        "{rebound:?}"
    );
    assert_eq!(
        (rebound["base"].as_str(), rebound["high_change"].as_str()),
        ("1", "")
    );
    assert!(
        (number(&rebound["elasticity"]) - 1.0).abs() < 0.02,
        "{rebound:?}"
    );
    let mass_kg = 2000.0 * 4.0 / 3.0 * PI * 0.01_f64.powi(3);
    let push_n = (20e3 * mass_kg).sqrt();
    for parameter in [
        "contacts.ball-plate.normal_stiffness",
        "materials.ball.density",
    ] {
        let row = row("push", parameter);
        // Half and twice the base.
        for (end, factor) in [("low", 0.5_f64), ("high", 2.0)] {
            let wanted = push_n * (factor.sqrt() - 1.0);
            let found = -number(&row[&format!("{end}_change")]);
            assert!((found / wanted - 1.0).abs() < 0.02, "{row:?} {wanted}");
        }
    }
}

/// More trajectories continue a design; another seed is another one.
#[test]
fn more_trajectories_continue_a_design() {
    let bench = bench("kind = \"morris\"\ntrajectories = 2\n");
    good(&bench, &["--quiet"]);
    let first = bench.path("study-sweep/runs/0001-1/summary.json");
    let before = fs::metadata(&first).unwrap().modified().unwrap();
    let study = fs::read_to_string(bench.path("study.toml")).unwrap();
    bench.write(
        "study.toml",
        study.replace("trajectories = 2", "trajectories = 3"),
    );
    let (listed, said) = good(&bench, &["--resume", "--list"]);
    assert_eq!(listed.lines().count(), 4, "{listed}");
    assert!(said.contains("12 points: 12 runs"), "{said}");
    let (printed, said) = good(&bench, &["--resume", "--quiet", "--json"]);
    assert_eq!(said, "");
    let table: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(
        table["design"]["morris"][0]["parameters"][0]["statistics"]["effects"],
        3
    );
    assert_eq!(
        fs::metadata(&first).unwrap().modified().unwrap(),
        before,
        "not run again"
    );
    bench.write(
        "study.toml",
        study.replace("trajectories = 2", "trajectories = 2\nseed = 2"),
    );
    let said = bad(&bench, &["--resume"], 2);
    assert!(
        said.contains("its runs are of another [design] than study.toml says"),
        "{said}"
    );
}

/// A parameter that makes runs fail: these are named and left out, and the exit code is 1.
#[test]
fn failed_runs_are_named_and_left_out() {
    let bench = bench("kind = \"morris\"\ntrajectories = 4\n");
    let study = fs::read_to_string(bench.path("study.toml")).unwrap();
    // Its largest level exceeds the stable step of the stiffer contacts.
    let study = study.replace(
        "[measures.rebound]",
        "\"run.time_step\" = [\"50 us\", \"1000 us\"]\n[measures.rebound]",
    );
    bench.write("study.toml", study);
    let output = sweep(&bench, &["--jobs", "2"]).output().unwrap();
    let [printed, said] =
        [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    assert_eq!(output.status.code(), Some(1), "{said}");
    let [design, error] = said.lines().collect::<Vec<_>>()[..] else {
        panic!("{said}");
    };
    assert!(design.ends_with("20 points: 20 runs"), "{said}");
    assert!(
        error.contains(" of 20 runs did not come to their end; the first: run "),
        "{said}"
    );
    assert!(
        printed.contains("without values (")
            && printed.contains("the steps that they end are left out"),
        "{printed}"
    );
    let rows = csv(&bench.path("study-sweep/effects.csv"));
    assert!(rows.iter().any(|row| number(&row["effects"]) < 4.0));
    let rebound = rows
        .iter()
        .find(|row| row["parameter"] == "contacts.ball-plate.restitution")
        .unwrap();
    assert!(
        (number(&rebound["mu_star"]) / 0.6 - 1.0).abs() < 0.1,
        "{rebound:?}"
    );
}

/// What is wrong with one of the values is said before anything runs.
#[test]
fn values_that_the_scene_refuses_are_said_before_the_runs() {
    let bench = bench("kind = \"morris\"\n");
    let study = fs::read_to_string(bench.path("study.toml")).unwrap();
    bench.write("study.toml", study.replace("[0.3, 0.9]", "[0.3, 1.2]"));
    let said = bad(&bench, &[], 2);
    assert!(
        said.contains("study.toml:6: --set contacts.ball-plate.restitution=1.2: contacts.ball-plate.restitution is 1.2, but must be"),
        "{said}"
    );
    bench.write(
        "study.toml",
        study.replace("[\"10 kN/m\", \"40 kN/m\"]", "[\"10 kN/m\", \"40 kg\"]"),
    );
    let said = bad(&bench, &[], 2);
    assert!(
        said.contains("is in 'kg', but the range begins in 'kN/m'"),
        "{said}"
    );
    assert!(!bench.path("study-sweep").exists());
}
