//! Sweeps: studies as input; tables, pages and the fastest setting as output.

mod curves;
mod designs;
mod failed;
mod lists;
mod packings;
mod pieces;
mod probability;
mod responses;
mod safety;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::{Bench, dem_pack, root};

/// A mass on a spring, excited by a force: the end of two bonded spheres.
const SCENE: &str = r#"version = 1

[run]
end_time = "4 ms"
safety_factor = 0.9

[materials.steel]
density = "7850 kg/m3"

[bonds.steel]
young_modulus = "200 GPa"
poisson_ratio = 0.3

[bodies.bar]
material = "steel"
bonds = "steel"
particles = [[0, 0, 0, 0.2], [0.4, 0, 0, 0.2]]
bond_list = [[0, 1]]

[groups.held]
particles = [0]

[groups.tip]
particles = [1]

[supports.held]
group = "held"
fixed = true

[loads.tip]
group = "tip"
force = ["1 kN", 0, 0]

[measures.tip]
of = "tip"
quantity = "displacement_x"

[measures.pieces]
of = "fragments"
quantity = "count"
"#;

const STEPS: &str = r#"version = 1
scene = "spring.toml"
repeats = 2
[vary]
"bonds.steel.formulation" = ["total", "incremental"]
"run.safety_factor" = [0.2, 0.1, 0.05, 0.025]
[measures.tip]
reference = { richardson = "run.safety_factor" }
[measures.energy]
balance = "energy"
"#;

fn bench(study: &str) -> Bench {
    let bench = Bench::new();
    bench.write("spring.toml", SCENE);
    bench.write("study.toml", study);
    bench
}

fn sweep(bench: &Bench, options: &[&str]) -> Command {
    let mut command = bench.command(Path::new("sweep"), &["study.toml"]);
    command.args(options);
    command
}

fn good(bench: &Bench, options: &[&str]) -> String {
    let output = sweep(bench, options).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert_eq!(said, "");
    String::from_utf8(output.stdout).unwrap()
}

/// A sweep of which some runs have no values: its standard output and standard error.
fn partly(bench: &Bench, options: &[&str]) -> (String, String) {
    let output = sweep(bench, options).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.starts_with("error: study.toml: ") && said.matches('\n').count() == 1,
        "{said}"
    );
    (String::from_utf8(output.stdout).unwrap(), said)
}

fn bad(bench: &Bench, options: &[&str], code: i32) -> String {
    let (said, found) = super::refused(&sweep(bench, options).output().unwrap());
    assert_eq!(found, code, "{said}");
    said
}

fn json(bench: &Bench) -> Value {
    serde_json::from_slice(&fs::read(bench.path("study-sweep/sweep.json")).unwrap()).unwrap()
}

/// The lines of a CSV file by column, read without our own code.
fn csv(path: &Path) -> Vec<BTreeMap<String, String>> {
    let text = fs::read_to_string(path).unwrap();
    let mut rows = Vec::new();
    for line in text.lines() {
        let (mut cells, mut cell, mut quoted) = (Vec::new(), String::new(), false);
        let mut letters = line.chars().peekable();
        while let Some(letter) = letters.next() {
            match letter {
                '"' if quoted && letters.peek() == Some(&'"') => {
                    letters.next();
                    cell.push('"');
                }
                '"' => quoted = !quoted,
                ',' if !quoted => cells.push(std::mem::take(&mut cell)),
                other => cell.push(other),
            }
        }
        cells.push(cell);
        rows.push(cells);
    }
    let head = rows.remove(0);
    rows.into_iter()
        .map(|row| {
            assert_eq!(row.len(), head.len());
            head.iter().cloned().zip(row).collect()
        })
        .collect()
}

/// The JSON reader may have an error in the last bit.
fn assert_same_number(one: f64, other: &Value) {
    let other = other.as_f64().unwrap();
    assert!((one - other).abs() <= 1e-15 * other.abs(), "{one} {other}");
}

/// Checks that every opened tag is closed, in order.
fn assert_well_formed(html: &str) {
    let mut open: Vec<&str> = Vec::new();
    for tag in html.split('<').skip(1) {
        let (tag, _) = tag.split_once('>').unwrap();
        let name = tag.split_whitespace().next().unwrap();
        if let Some(closed) = name.strip_prefix('/') {
            assert_eq!(open.pop(), Some(closed));
        } else if !tag.ends_with('/') && !tag.starts_with('!') && name != "meta" {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn tables_and_pages_of_a_sweep() {
    let bench = bench(STEPS);
    let said = good(&bench, &[]);
    assert!(
        said.starts_with("study.toml: 8 runs of spring.toml, 2 ")
            && said.contains(" times each, on 1 thread"),
        "{said}"
    );
    assert!(
        said.contains("front        tip: against Richardson extrapolation along run.safety_factor"),
        "{said}"
    );
    let table = json(&bench);
    let rows = csv(&bench.path("study-sweep/sweep.csv"));
    assert_eq!(rows.len(), 8);
    for (row, run) in rows.iter().zip(table["runs"].as_array().unwrap()) {
        let number = |column: &str| row[column].parse::<f64>().unwrap();
        assert_eq!(number("run.safety_factor").to_string(), run["settings"][1]);
        assert_same_number(number("time_s"), &run["time_s"]);
        // Until half a second has been measured, extrapolated from the first two.
        let times = run["times_s"].as_array().unwrap();
        let first: f64 = times[..2].iter().map(|time| time.as_f64().unwrap()).sum();
        let wanted = (0.5 / (0.5 * first)).ceil().clamp(2.0, 25.0);
        assert_eq!(number("repeats"), wanted);
        assert_eq!(times.len() as f64, wanted);
        assert_eq!(row["failed"], "");
        let tip = &run["results"][0];
        for (column, key) in [
            ("tip_value (m)", "value"),
            ("tip_error", "error"),
            ("tip_uncertainty", "uncertainty"),
            ("tip_reference (m)", "reference"),
        ] {
            assert_same_number(number(column), &tip[key]);
        }
        assert_eq!(
            row["tip_front"] == "1",
            tip["is_on_front"].as_bool().unwrap()
        );
        let off = number("tip_value (m)") / number("tip_reference (m)") - 1.0;
        assert!((off.abs() - number("tip_error")).abs() < 1e-14);
        // The same from the folder of the run.
        let summary = bench.path(&format!(
            "study-sweep/runs/{:04}-1/summary.json",
            number("run")
        ));
        let summary: Value = serde_json::from_slice(&fs::read(summary).unwrap()).unwrap();
        assert_same_number(number("energy_value"), &summary["energy_error"]);
        assert_eq!(number("steps"), summary["steps"]);
    }
    // Leapfrog is of second order.
    let orders = table["orders"].as_array().unwrap();
    assert_eq!(orders.len(), 4);
    for order in orders {
        let value = order["order"].as_f64().unwrap();
        assert!((value - 2.0).abs() < 0.2, "{order}");
    }
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    for request in ["http:", "https:", "src=", "url(", "@import"] {
        assert!(!html.contains(request), "{request}");
    }
    // Only the pages of runs, on demand.
    let links = html.matches("href=").count();
    assert_eq!(links, html.matches("<a href=\"runs/").count());
    assert_eq!(links, 8);
    assert_well_formed(&html);
    for measure in ["tip", "energy"] {
        let svg = fs::read_to_string(bench.path(&format!("study-sweep/{measure}.svg"))).unwrap();
        assert_well_formed(&svg);
        assert_eq!(svg.matches("class=\"mark\"").count(), 8);
        for part in [
            "run time (s), median of 2",
            "error (share)",
            "bonds.steel.formulation",
            "on the Pareto front",
        ] {
            assert!(svg.contains(part), "{part}");
        }
    }
    // All of it for a script, and an empty one.
    let again: Value = serde_json::from_str(&good(&bench, &["--collect", "--json"])).unwrap();
    assert_eq!(again["runs"], table["runs"]);
    assert_eq!(good(&bench, &["--collect", "--quiet"]), "");
    // A repeat that left nothing readable is no reason to fail, but it is said.
    bench.write("study-sweep/runs/0003-2/summary.json", "{");
    good(&bench, &["--collect"]);
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert!(html.contains("run 3: of its 2 repeats 1 left results; its time is theirs"));
}

#[test]
#[cfg(unix)]
fn an_interrupted_sweep_goes_on() {
    let bench = bench(STEPS);
    let slow = STEPS.replace(
        "repeats = 2",
        "repeats = 1\n[set]\n\"run.end_time\" = \"400 ms\"",
    );
    bench.write("study.toml", &slow);
    let child = sweep(&bench, &[])
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let first = bench.path("study-sweep/runs/0001-1/summary.json");
    while !first.exists() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let said = bad(&bench, &["--resume"], 2);
    assert!(said.contains("another sweep is writing into it"), "{said}");
    Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    let (said, code) = super::refused(&child.wait_with_output().unwrap());
    assert_eq!(code, 130, "{said}");
    assert!(
        said.contains("interrupted after") && said.contains("of 8 runs; go on with --resume"),
        "{said}"
    );
    assert!(!bench.path("study-sweep/runs/0008-1/summary.json").exists());
    let before = fs::metadata(&first).unwrap().modified().unwrap();
    let said = bad(&bench, &[], 2);
    assert!(
        said.contains("a sweep is in this folder; go on with it by --resume"),
        "{said}"
    );
    // Existing results can be viewed in between.
    let (table, said) = partly(&bench, &["--collect"]);
    assert!(table.contains("it has not been run to its end"));
    assert!(
        said.contains(" of 8 runs did not come to their end; the first: run "),
        "{said}"
    );
    good(&bench, &["--resume"]);
    assert_eq!(
        fs::metadata(&first).unwrap().modified().unwrap(),
        before,
        "not run again"
    );
    let rows = csv(&bench.path("study-sweep/sweep.csv"));
    assert!(rows.iter().all(|row| row["failed"].is_empty()));

    bench.write("spring.toml", SCENE.replace("1 kN", "2 kN"));
    let said = bad(&bench, &["--resume"], 2);
    assert!(said.contains("its runs are of another text of the scene than study.toml says; replace them with --force"), "{said}");
}

#[test]
fn the_fastest_setting_is_said_and_written() {
    let bench = bench(STEPS);
    good(&bench, &["--quiet"]);
    let said = good(
        &bench,
        &[
            "--collect",
            "--max-error",
            "tip=2%",
            "--max-error",
            "energy=5%",
            "--write",
            "fast.toml",
        ],
    );
    assert!(
        said.contains("fastest      run ") && said.contains("written      fast.toml"),
        "{said}"
    );
    let table: Value = serde_json::from_str(&good(
        &bench,
        &[
            "--collect",
            "--max-error",
            "tip=2%",
            "--max-error",
            "energy=5%",
            "--json",
        ],
    ))
    .unwrap();
    let chosen = table["fastest"]["run"].as_u64().unwrap() as usize;
    let run = &table["runs"][chosen - 1];
    assert!(run["results"][0]["error"].as_f64().unwrap() <= 0.02);
    assert!(run["results"][1]["error"].as_f64().unwrap() <= 0.05);
    let time = run["time_s"].as_f64().unwrap();
    let spread = run["spread_s"].as_f64().unwrap();
    for other in table["runs"].as_array().unwrap() {
        let error = |at: usize| other["results"][at]["error"].as_f64().unwrap();
        let is_exact = error(0) <= 0.02 && error(1) <= 0.05;
        let other_time = other["time_s"].as_f64().unwrap() + other["spread_s"].as_f64().unwrap();
        assert!(!is_exact || other_time + spread >= time, "{other}");
    }
    // The written scene gives the same as the run, and so does the command.
    let written: Value =
        serde_json::from_str(&bench.good(Path::new("fast.toml"), &["--json"])).unwrap();
    assert_eq!(
        written["measures"]["tip"]["value"],
        run["results"][0]["value"]
    );
    let command = table["fastest"]["command"].as_str().unwrap();
    assert!(
        command.starts_with("dem-run spring.toml --set "),
        "{command}"
    );

    let said = bad(&bench, &["--collect", "--max-error", "all=1e-14"], 2);
    assert!(
        said.contains("no run is as exact: the nearest, run ") && said.contains("ask for less"),
        "{said}"
    );
    let said = bad(&bench, &["--collect", "--max-error", "tipp=1%"], 2);
    assert!(
        said.contains(
            "nothing that is measured is called 'tipp'; use all for all measures, or one of tip, energy"
        ),
        "{said}"
    );
    for wrong in ["all", "all=0", "all=1 mm"] {
        bad(&bench, &["--collect", "--max-error", wrong], 2);
    }
}

/// The written scene is in another folder than the scene and the body, whose names are relative.
#[test]
fn a_scene_with_another_body_is_written() {
    let bench = bench(
        "version = 1\nscene = \"spring.toml\"\nrepeats = 1\n[vary]\n\"body.bar\" = [\"bar.csv\"]\n\"run.safety_factor\" = [0.1]\n[measures.energy]\nbalance = \"energy\"\n",
    );
    bench.write(
        "bar.particles.csv",
        "x_m,y_m,z_m,radius_m\n0,0,0,0.2\n0.5,0,0,0.2\n",
    );
    bench.write("bar.bonds.csv", "particle_a,particle_b\n0,1\n");
    fs::create_dir(bench.path("there")).unwrap();
    good(
        &bench,
        &["--max-error", "all=1", "--write", "there/new.toml"],
    );
    let written = bench.good(Path::new("there/new.toml"), &["--json"]);
    let written: Value = serde_json::from_str(&written).unwrap();
    let value = &json(&bench)["runs"][0]["results"][0]["value"];
    assert_same_number(written["energy_error"].as_f64().unwrap(), value);
}

#[test]
fn what_is_refused() {
    let paths = [
        (
            "\"run.safety_factor\"",
            "\"run.safty_factor\"",
            "study.toml:6: --set run.safty_factor=0.2: unknown key run.safty_factor; did you mean 'safety_factor'?",
        ),
        (
            "{ richardson = \"run.safety_factor\" }",
            "\"closed-form\"",
            "study.toml:7: measures.tip has no reference: that of the scene says none; add reference",
        ),
        (
            "[measures.tip]",
            "[measures.tipp]",
            "the scene spring.toml has no measure 'tipp'; did you mean 'tip'?",
        ),
        (
            "scene = \"spring.toml\"",
            "scene = \"sprung.toml\"",
            "study.toml: scene: sprung.toml: there is no such file",
        ),
        (
            "repeats = 2",
            "combine = \"paired\"",
            "study.toml:6: run.safety_factor has 4 values, but bonds.steel.formulation has 2; paired axes have equally many",
        ),
        (
            "{ richardson = \"run.safety_factor\" }",
            "{ value = \"2 kg\" }",
            "measures.tip.reference: '2 kg' is not a length",
        ),
        (
            "[0.2, 0.1, 0.05, 0.025]",
            "{ from = 0.01, to = 0.9, count = 50000 }",
            "study.toml: 100000 runs, 2 times each, are more than 10000; vary less, or say --yes",
        ),
        ("version = 1", "version = 3", "version is 3"),
    ];
    for (old, new, parts) in paths {
        let bench = bench(&STEPS.replace(old, new));
        let said = bad(&bench, &[], 2);
        assert!(said.contains(parts), "{said}\n{parts}");
        assert!(!bench.path("study-sweep").exists(), "{new}");
    }
    let bench = bench(STEPS);
    assert!(bad(&bench, &["--collect"], 2).contains("no sweep is in this folder"));
    assert!(bad(&bench, &["--jobs", "0"], 2).contains("--jobs: 0 is not between 1 and 1024"));
    assert!(bad(&bench, &["--threads", "0"], 2).contains("--threads: 0 is not between 1 and 1024"));
    assert!(
        bad(&bench, &["--output", "."], 2)
            .contains("this folder holds something else than a sweep")
    );
    assert!(
        bad(
            &bench,
            &["--max-error", "all=1", "--write", "gone/a.toml"],
            2
        )
        .contains("there is no folder 'gone'")
    );
    assert!(!bench.path("study-sweep").exists());
    assert!(
        !sweep(&bench, &["--write", "a.toml"])
            .output()
            .unwrap()
            .status
            .success()
    );
}

/// The studies of the repository can be run unchanged, once the bodies have been made as described
/// in their first lines.
#[test]
fn studies_of_data() {
    let bench = Bench::new();
    copy_folder(&root().join("data"), &bench.path("data"));
    for entry in fs::read_dir(bench.path("data/studies")).unwrap() {
        let path = entry.unwrap().path();
        let study = fs::read_to_string(&path).unwrap();
        for line in study.lines() {
            if let Some(arguments) = line.strip_prefix("#   dem-pack ") {
                let words: Vec<&str> = arguments.split(' ').collect();
                let [stl, options @ .., "-o", body] = &words[..] else {
                    panic!("{line}");
                };
                dem_pack(&bench.path(stl), options, &bench.path(body));
            }
        }
        let output = bench
            .command(Path::new("sweep"), &["--list", "--output", "s", "--force"])
            .arg(&path)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        assert!(String::from_utf8(output.stdout).unwrap().lines().count() >= 3);
    }
}

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let copy = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy_folder(&entry.path(), &copy);
        } else {
            fs::copy(entry.path(), copy).unwrap();
        }
    }
}
