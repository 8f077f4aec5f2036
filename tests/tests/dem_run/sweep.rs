//! Sweeps: studies in; tables, pages, the fastest setting out.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::{Bench, root};

/// A mass on a spring, which a force sets swinging: the end of two bonded spheres.
const SCENE: &str = r#"version = 1

[run]
end_time = "4 ms"
safety = 0.9

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

[sets.held]
particles = [0]

[sets.tip]
particles = [1]

[supports.held]
of = "held"
fixed = true

[loads.tip]
of = "tip"
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
"run.safety" = [0.2, 0.1, 0.05, 0.025]
[measures.tip]
reference = { richardson = "run.safety" }
[measures.energy]
ledger = "energy"
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

/// A table without what the clock decides.
fn timeless(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut rows = csv(path);
    for row in &mut rows {
        row.retain(|column, _| {
            !column.ends_with("_front")
                && !["time_s", "spread_s", "repeats"].contains(&column.as_str())
        });
    }
    rows
}

/// The reader of JSON may be off by the last bit.
fn assert_same_number(one: f64, other: &Value) {
    let other = other.as_f64().unwrap();
    assert!((one - other).abs() <= 1e-15 * other.abs(), "{one} {other}");
}

/// Every tag that opens is closed, in order.
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
        said.contains("front        tip: against Richardson extrapolation along run.safety"),
        "{said}"
    );
    let table = json(&bench);
    let rows = csv(&bench.path("study-sweep/sweep.csv"));
    assert_eq!(rows.len(), 8);
    for (row, run) in rows.iter().zip(table["runs"].as_array().unwrap()) {
        let number = |column: &str| row[column].parse::<f64>().unwrap();
        assert_eq!(row["run.safety"], run["settings"][1]);
        assert_same_number(number("time_s"), &run["time_s"]);
        // Until half a second has been measured, as the first two let expect.
        let times = run["times_s"].as_array().unwrap();
        let first: f64 = times[..2].iter().map(|time| time.as_f64().unwrap()).sum();
        let wanted = (0.5 / (0.5 * first)).ceil().clamp(2.0, 25.0);
        assert_eq!(number("repeats"), wanted);
        assert_eq!(times.len() as f64, wanted);
        assert_eq!(row["failed"], "");
        let tip = &run["results"][0];
        for (column, key) in [
            ("tip_value", "value"),
            ("tip_error", "error"),
            ("tip_uncertainty", "uncertainty"),
            ("tip_reference", "reference"),
        ] {
            assert_same_number(number(column), &tip[key]);
        }
        assert_eq!(
            row["tip_front"] == "1",
            tip["is_on_front"].as_bool().unwrap()
        );
        let off = number("tip_value") / number("tip_reference") - 1.0;
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
    for request in ["http:", "https:", "src=", "href=", "url(", "@import"] {
        assert!(!html.contains(request), "{request}");
    }
    assert_well_formed(&html);
    for measure in ["tip", "energy"] {
        let svg = fs::read_to_string(bench.path(&format!("study-sweep/{measure}.svg"))).unwrap();
        assert_well_formed(&svg);
        assert_eq!(svg.matches("class=\"run\"").count(), 8);
        for part in [
            "run time (s), median of 2",
            "error (share)",
            "bonds.steel.formulation",
            "on the Pareto front",
        ] {
            assert!(svg.contains(part), "{part}");
        }
    }
    // All of it for a script, and none.
    let again: Value = serde_json::from_str(&good(&bench, &["--collect", "--json"])).unwrap();
    assert_eq!(again["runs"], table["runs"]);
    assert_eq!(good(&bench, &["--collect", "--quiet"]), "");
}

#[test]
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
    assert_eq!(code, 1, "{said}");
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
    // What is there can be looked at in between.
    assert!(good(&bench, &["--collect"]).contains("it has not been run to its end"));
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
fn listed_commands_give_the_same_table() {
    let bench = bench(STEPS);
    good(&bench, &["--jobs", "2"]);
    let whole = timeless(&bench.path("study-sweep/sweep.csv"));
    let commands = good(&bench, &["--list", "--out", "apart"]);
    assert_eq!(commands.lines().count(), 16);
    assert!(!bench.path("apart/runs/0001-1").exists());
    let run = |commands: &str| {
        let list = bench.write("list.sh", commands);
        let mut sh = Command::new("sh");
        let status = sh.arg(list).current_dir(bench.folder.path()).status();
        assert!(status.unwrap().success());
    };
    run(&commands);
    // Once all are done, it is known which are short.
    let further = good(&bench, &["--list", "--resume", "--out", "apart"]);
    assert!(further.lines().all(|line| line.contains("apart/runs/000")));
    run(&further);
    assert_eq!(good(&bench, &["--list", "--resume", "--out", "apart"]), "");
    good(&bench, &["--collect", "--out", "apart"]);
    assert_eq!(timeless(&bench.path("apart/sweep.csv")), whole);
}

#[test]
fn the_fastest_setting_is_said_and_written() {
    let bench = bench(STEPS);
    good(&bench, &["--quiet"]);
    let said = good(
        &bench,
        &[
            "--collect",
            "--want",
            "tip=2%",
            "--want",
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
            "--want",
            "tip=2%",
            "--want",
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
    // The scene that was written does what the run did, and so does the command.
    let written: Value =
        serde_json::from_str(&bench.good(Path::new("fast.toml"), &["--json"])).unwrap();
    assert_eq!(written["measures"][1]["value"], run["results"][0]["value"]);
    let command = table["fastest"]["command"].as_str().unwrap();
    assert!(
        command.starts_with("dem-run spring.toml --set "),
        "{command}"
    );

    let said = bad(&bench, &["--collect", "--want", "error=1e-14"], 2);
    assert!(
        said.contains("no run is as exact: the nearest, run ") && said.contains("ask for less"),
        "{said}"
    );
    let said = bad(&bench, &["--collect", "--want", "tipp=1%"], 2);
    assert!(
        said.contains(
            "nothing that is measured is called 'tipp'; use error for all, or one of tip, energy"
        ),
        "{said}"
    );
    for wrong in ["error", "error=0", "error=1 mm"] {
        bad(&bench, &["--collect", "--want", wrong], 2);
    }
}

/// The written scene lies elsewhere than the scene and the body, whose names are relative.
#[test]
fn a_scene_with_another_body_is_written() {
    let bench = bench(
        "version = 1\nscene = \"spring.toml\"\nrepeats = 1\n[vary]\n\"body.bar\" = [\"bar.csv\"]\n\"run.safety\" = [0.1]\n[measures.energy]\nledger = \"energy\"\n",
    );
    bench.write(
        "bar.particles.csv",
        "x_m,y_m,z_m,radius_m\n0,0,0,0.2\n0.5,0,0,0.2\n",
    );
    bench.write("bar.bonds.csv", "a,b\n0,1\n");
    fs::create_dir(bench.path("there")).unwrap();
    good(&bench, &["--want", "error=1", "--write", "there/new.toml"]);
    let written = bench.good(Path::new("there/new.toml"), &["--json"]);
    let written: Value = serde_json::from_str(&written).unwrap();
    let value = &json(&bench)["runs"][0]["results"][0]["value"];
    assert_same_number(written["energy_error"].as_f64().unwrap(), value);
}

#[test]
fn runs_that_fail_are_shown_and_the_sweep_goes_on() {
    let study = r#"version = 1
scene = "spring.toml"
repeats = 1
[vary]
"run.time_step" = ["10 us", "900 us"]
[together.breaks]
"bonds.steel.failure.tension" = ["1e12 Pa", "1e12 Pa"]
"measures.pieces.of" = ["fragments", "fragments"]
names = ["a,b", "c"]
[measures.pieces]
reference = { value = 1 }
"#;
    let bench = bench(study);
    let said = good(&bench, &[]);
    assert!(
        said.contains("failed       run 3, run.time_step 900 us, breaks a,b: "),
        "{said}"
    );
    assert!(said.contains("the largest stable"), "{said}");
    let rows = csv(&bench.path("study-sweep/sweep.csv"));
    assert_eq!(rows[0]["breaks"], "a,b");
    assert_eq!(rows[0]["pieces_error"], "0e0");
    assert!(rows[0]["failed"].is_empty() && !rows[2]["failed"].is_empty());
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert!(html.contains("<h2>Failed</h2>") && html.contains("the largest stable"));

    let all = study.replace("[\"10 us\", \"900 us\"]", "[\"800 us\", \"900 us\"]");
    bench.write("study.toml", all);
    let said = bad(&bench, &["--force"], 1);
    assert!(
        said.contains("study.toml: no run came to its end; the first: "),
        "{said}"
    );
}

#[test]
fn a_measure_that_is_no_number_is_a_failure() {
    let bench = Bench::new();
    // Before the first body has come, it has no place.
    bench.write(
        "spring.toml",
        r#"version = 1
[run]
end_time = "10 ms"
[materials.steel]
density = 7850
young_modulus = "1 GPa"
[contacts]
steel-steel = { restitution = 0.5 }
[bodies.ball]
material = "steel"
particles = [[0, 0, 0, 0.01]]
start_as = "clump"
[regions.gate]
box = { min = [0, 0, 0], max = [0.1, 0.1, 0.1] }
[inlets.feed]
bodies = ["ball"]
region = "gate"
rate = "100 1/s"
velocity = ["1 m/s", 0, 0]
[measures.place]
quantity = "position_x"
"#,
    );
    bench.write(
        "study.toml",
        "version = 1\nscene = \"spring.toml\"\n[vary]\n\"inlets.feed.start\" = [\"0 s\", \"20 ms\"]\n[measures.place]\nreference = { value = \"2 cm\" }\n",
    );
    let said = good(&bench, &[]);
    assert!(
        said.contains(
            "failed       run 2, inlets.feed.start 20 ms: the measure 'place' is not a number"
        ),
        "{said}"
    );
    let rows = csv(&bench.path("study-sweep/sweep.csv"));
    assert_eq!(rows[0]["failed"], "");
    assert_eq!(rows[1]["failed"], "the measure 'place' is not a number");
    let html = fs::read_to_string(bench.path("study-sweep/sweep.html")).unwrap();
    assert!(html.contains("<h2>Failed</h2>") && html.contains("is not a number"));
}

#[test]
fn what_is_refused() {
    let paths = [
        (
            "\"run.safety\"",
            "\"run.safty\"",
            "study.toml:6: --set run.safty=0.2: unknown key run.safty; did you mean 'safety'?",
        ),
        (
            "reference = { richardson = \"run.safety\" }",
            "",
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
            "study.toml:6: run.safety has 4 values, but bonds.steel.formulation has 2; paired axes have equally many",
        ),
        (
            "{ richardson = \"run.safety\" }",
            "{ value = \"2 kg\" }",
            "measures.tip.reference: '2 kg' is not a length",
        ),
        (
            "[0.2, 0.1, 0.05, 0.025]",
            "{ from = 0.01, to = 0.9, count = 500000 }",
            "study.toml: 1000000 runs, 2 times each, are more than 10000; vary less, or say --yes",
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
    assert!(
        bad(&bench, &["--out", "."], 2).contains("this folder holds something else than a sweep")
    );
    assert!(
        bad(&bench, &["--want", "error=1", "--write", "gone/a.toml"], 2)
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

/// Those of the repository can be run as they stand, once the bodies are there that their first lines tell how to make.
#[test]
fn studies_of_data() {
    let bench = Bench::new();
    copy_folder(&root().join("data"), &bench.path("data"));
    for entry in fs::read_dir(bench.path("data/studies")).unwrap() {
        let path = entry.unwrap().path();
        let study = fs::read_to_string(&path).unwrap();
        for line in study.lines() {
            if let Some(arguments) = line.strip_prefix("#   dem-pack ") {
                let made = dem_tests::program("dem-pack")
                    .current_dir(bench.path(""))
                    .args(arguments.split(' '))
                    .arg("--quiet")
                    .status();
                assert!(made.unwrap().success(), "{line}");
            }
        }
        let output = bench
            .command(Path::new("sweep"), &["--list", "--out", "s", "--force"])
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

/// Pieces that leave, and steps above the largest stable one.
const PIECES: &str = r#"version = 1
scene = "SCENE"
repeats = 1
[set]
"run.adaptive" = false
[vary]
"run.safety" = [0.9, 0.45, 0.3]
[measures.left]
masses = "left"
reference = "finest"
[measures.rest]
masses = "at-end"
reference = "finest"
"#;

#[test]
fn distributions_of_masses_are_compared() {
    let scene = super::good("following.toml").display().to_string();
    let bench = bench(&PIECES.replace("SCENE", &scene));
    good(&bench, &["--quiet"]);
    let masses = |run: usize| -> Vec<f64> {
        let text =
            fs::read_to_string(bench.path(&format!("study-sweep/runs/000{run}-1/events.csv")));
        let mut found = Vec::new();
        for line in text.unwrap().lines().filter(|line| line.contains(",left,")) {
            found.push(line.rsplit(' ').nth(1).unwrap().parse().unwrap());
        }
        found
    };
    let (own, other) = (masses(1), masses(3));
    assert!(own.len() > 3 && other.len() > 3 && own != other);
    // At every value, and just below it, what share of each is not above.
    let share =
        |all: &[f64], x: f64| all.iter().filter(|m| **m <= x).count() as f64 / all.len() as f64;
    let apart = own
        .iter()
        .chain(&other)
        .map(|x| (share(&own, *x) - share(&other, *x)).abs());
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

/// Two spheres on a bond that is pulled until it breaks.
const PULLED: &str = r#"version = 1
[run]
[materials.clay]
density = 2000
[bonds.clay]
young_modulus = "15 MPa"
poisson_ratio = 0.3
failure = { tension = "0.2 MPa" }
[bodies.bar]
particles = [[0, 0, 0, 0.002], [0, 0, 0.004, 0.002], [0, 0, 0.008, 0.002]]
bond_list = [[0, 1], [1, 2]]
material = "clay"
bonds = "clay"
[sets.foot]
particles = [0]
[sets.head]
particles = [2]
[supports.foot]
of = "foot"
fixed = true
[test]
kind = "tension"
moves = ["head"]
direction = [0, 0, 1]
stroke = "0.3 mm"
length = "8 mm"
rate_check = false
"#;

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
    bench.write("pulled.toml", PULLED);
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
    // Both break at one force, so that the softer one goes on longer.
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
        bench.write("pulled.toml", PULLED);
        let said = bad(&bench, &[], 2);
        assert!(said.contains(wanted), "{said}");
        assert!(!bench.path("study-sweep").exists());
    }
}

/// A step above the largest stable one is refused, or taken and found unstable.
#[test]
fn steps_above_the_limit_are_for_trials() {
    let study = STEPS
        .replace("[0.2, 0.1, 0.05, 0.025]", "[0.9, 1.05]")
        .replace(
            "[measures.tip]\nreference = { richardson = \"run.safety\" }\n",
            "",
        )
        .replace(
            "repeats = 2",
            "repeats = 1\nset = { \"run.end_time\" = \"0.2 s\", \"loads.tip.torque\" = [1e3, 1e3, 1e3] }",
        );
    let forced = bench(&study.replace("repeats = 1", "repeats = 1\nforce_step = true"));
    let said = good(&forced, &[]);
    assert!(said.contains("1.05: unstable at step"), "{said}");
    let table = json(&forced);
    assert!(table["runs"][0]["failed"].is_null() && table["runs"][1]["failed"].is_string());
    let refused = bench(&study);
    let said = good(&refused, &[]);
    assert!(
        said.contains("run.safety: 1.05 is no share of the largest stable step"),
        "{said}"
    );
}
