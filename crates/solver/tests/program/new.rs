//! Scenes to start from, and the reference of keys.

use std::fs;

use serde_json::Value;

use super::{Bench, dem_run, refused};

fn new(bench: &Bench, options: &[&str]) -> std::process::Output {
    let mut command = dem_run();
    command
        .arg("new")
        .args(options)
        .current_dir(bench.folder.path());
    command.output().unwrap()
}

/// The folder of a template, with the commands that are printed.
fn made(name: &str, options: &[&str]) -> (Bench, Vec<String>) {
    let bench = Bench::new();
    let output = new(&bench, &[&[name, name], options].concat());
    let said = String::from_utf8(output.stdout).unwrap();
    let wrong = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && wrong.is_empty(), "{wrong}");
    let body = match name {
        "cone" => "mantle.stl, bowl.stl, ",
        _ => "shape.stl, body.vtp with ",
    };
    let begin = format!("made {name}: scene.toml, {body}");
    assert!(said.starts_with(&begin), "{said}");
    assert!(bench.path(name).join("scene.schema.json").exists());
    let text = fs::read_to_string(bench.path(name).join("scene.toml")).unwrap();
    assert!(text.starts_with("#:schema scene.schema.json\n# "), "{name}");
    let lines = said
        .lines()
        .filter_map(|line| line.strip_prefix("  dem-run "));
    let commands: Vec<String> = lines.map(str::to_owned).collect();
    assert_eq!(commands.len(), 2, "{said}");
    (bench, commands)
}

/// Runs a printed command, with further arguments.
fn go(bench: &Bench, command: &str, more: &[&str]) -> String {
    let mut run = dem_run();
    run.args(command.split(' ')).args(more);
    let output = run.current_dir(bench.folder.path()).output().unwrap();
    let wrong = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command}: {wrong}");
    String::from_utf8(output.stdout).unwrap()
}

fn summary(bench: &Bench, name: &str) -> Value {
    let summary = bench.path(name).join("results/summary.json");
    serde_json::from_slice(&fs::read(summary).unwrap()).unwrap()
}

/// With the spheres that it has by default, a scene has no warning before it runs. With few large
/// ones it runs as it stands, by the commands that are printed; the bodies break, or the tests give
/// a modulus.
fn is_made_and_runs(name: &str, diameter: &str) {
    let (bench, commands) = made(name, &[]);
    let checked = go(&bench, &commands[0], &[]);
    let has_warning = checked.lines().any(|line| line.starts_with("warning"));
    assert!(!has_warning, "{name}: {checked}");
    let (bench, commands) = made(name, &["--diameter", diameter]);
    go(&bench, &commands[1], &[]);
    let summary = summary(&bench, name);
    let broken = summary["broken_bonds"].as_u64().unwrap();
    assert!(broken > 10, "{name}: {broken}");
    let error = summary["energy_error"].as_f64().unwrap();
    assert!(error < 0.02, "{name}: {error}");
    match &summary["test"]["results"] {
        Value::Null => assert!(bench.path(name).join("results/film.png").exists(), "{name}"),
        results => assert!(
            name == "drop-weight" || results.to_string().contains("specimen modulus"),
            "{name}"
        ),
    }
}

/// The same for rigid bodies, for this long, with the spheres that they have by default. Returns the
/// folder and the summary.
fn is_made_and_runs_for(name: &str, time: &str, bodies: u64) -> (Bench, Value) {
    let (bench, commands) = made(name, &[]);
    let checked = go(&bench, &commands[0], &[]);
    let has_warning = checked.lines().any(|line| line.starts_with("warning"));
    assert!(!has_warning, "{name}: {checked}");
    let end = format!("run.end_time={time}");
    go(&bench, &commands[1], &["--set", &end]);
    let summary = summary(&bench, name);
    assert!(summary["population"]["fed"].as_u64().unwrap() >= bodies);
    assert!(summary["energy_error"].as_f64().unwrap() < 0.01);
    (bench, summary)
}

/// The stroke and the mean power of a wall that moves, in summary and page.
fn assert_drives(name: &str, wall: &str, stroke_mm: f64, time: &str) {
    let (bench, summary) = is_made_and_runs_for(name, time, 1);
    let [stroke_m, work_j, power_w] =
        ["stroke_m", "work_j", "mean_power_w"].map(|key| summary["walls"][wall][key].as_f64());
    assert!(
        (1e3 * stroke_m.unwrap() / stroke_mm - 1.0).abs() < 0.01,
        "{stroke_m:?}"
    );
    let time_s = summary["simulated_s"].as_f64().unwrap();
    assert!((power_w.unwrap() * time_s - work_j.unwrap()).abs() <= 1e-12 * work_j.unwrap().abs());
    let page = fs::read_to_string(bench.path(name).join("results/report.html")).unwrap();
    assert!(page.contains("moving wall"), "{name}");
}

#[test]
fn drop_runs() {
    is_made_and_runs("drop", "3.6mm..4.4mm");
}

#[test]
fn drop_weight_runs() {
    is_made_and_runs("drop-weight", "5mm..6mm");
}

#[test]
fn chute_runs() {
    is_made_and_runs("chute", "7mm..9mm");
}

#[test]
fn crusher_runs() {
    is_made_and_runs("crusher", "8mm..10mm");
}

#[test]
fn mill_runs() {
    is_made_and_runs_for("mill", "0.1 s", 5);
}

#[test]
fn silo_runs() {
    is_made_and_runs_for("silo", "0.05 s", 20);
}

#[test]
fn screen_runs() {
    // Twice the radius of its circle, 0.15 times the size of the lumps.
    assert_drives("screen", "deck", 6.0, "0.2 s");
}

#[test]
fn cone_runs() {
    // Of the lower edge, 8 sizes below the pivot and 5 from the axis: twice the sine of the angle.
    assert_drives(
        "cone",
        "mantle",
        2.0 * 0.61_f64.to_radians().sin() * 30.0 * 8_f64.hypot(5.0),
        "0.12 s",
    );
}

#[test]
fn bending_runs() {
    is_made_and_runs("bending", "5mm..6mm");
}

#[test]
fn brazilian_runs() {
    is_made_and_runs("brazilian", "5mm..6mm");
}

#[test]
fn compression_runs() {
    is_made_and_runs("compression", "5mm..6mm");
}

/// A box with one corner at the origin, mm.
fn box_stl([x, y, z]: [u32; 3]) -> String {
    let corner = |k: u32| [k & 1, k >> 1 & 1, k >> 2].map(f64::from);
    let edges = [x, y, z].map(f64::from);
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let mut text = "solid box\n".to_owned();
    for [a, b, c, d] in sides {
        for facet in [[a, b, c], [a, c, d]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for k in facet {
                let at = corner(k);
                let [x, y, z] = [0, 1, 2].map(|axis| at[axis] * edges[axis]);
                text += &format!("vertex {x} {y} {z}\n");
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid box\n"
}

/// Shape, size, mass and height stand in the scene, and `check` finds them there.
#[test]
fn answers_are_in_the_scene() {
    let bench = Bench::new();
    bench.write("mine.stl", box_stl([20, 10, 10]));
    let options = [
        "drop",
        "some/where/mine",
        "--shape",
        "mine.stl",
        "--size",
        "40 mm",
        "--mass",
        "20 g",
        "--height",
        "500 mm",
        "--diameter",
        "6mm..8mm",
    ];
    let output = new(&bench, &options);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(
        said.contains("the result will be coarse; --diameter "),
        "{said}"
    );
    let folder = bench.path("some/where/mine");
    let text = fs::read_to_string(folder.join("scene.toml")).unwrap();
    for line in [
        "mass = \"20 g\"                    # over the volume of the shape: 1250 kg/m3",
        "drop = { height = \"500 mm\", onto = \"plate\" }",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    let shape = fs::read_to_string(folder.join("shape.stl")).unwrap();
    let corners = shape
        .lines()
        .filter_map(|line| line.trim().strip_prefix("vertex "));
    let xs = corners.map(|corner| corner.split(' ').next().unwrap().parse::<f64>().unwrap());
    let half = xs.fold(0.0, f64::max);
    assert!((half - 20.0).abs() < 1e-6, "{half}");
    go(&bench, "check some/where/mine/scene.toml", &[]);
    let twice = refused(&new(&bench, &options)).0;
    assert!(
        twice.contains("there is such a file or folder already"),
        "{twice}"
    );
}

#[test]
fn wrong_answers_are_refused() {
    let bench = Bench::new();
    bench.write("text.stl", "no facets");
    bench.write("cube.stl", box_stl([10, 10, 10]));
    for (options, parts) in [
        (&["drop", "--mass", "700 g"][..], "--mass: 700 g is 4"),
        (
            &["drop", "--mass", "1 mg"],
            "not between 20 and 23000 kg/m3; write a mass from ",
        ),
        (
            &["drop", "--height", "0 m"],
            "--height: '0 m' is not above 0; write a length above 0",
        ),
        (
            &["drop", "--height", "-1 m"],
            "--height: '-1 m' is not above 0",
        ),
        (
            &["drop", "--size", "large"],
            "--size: 'large' is not a length",
        ),
        (
            &["drop", "--size", "300 m"],
            "--size: 300 m is not between 10 um and 100 m",
        ),
        (
            &["drop", "--height", "3 m", "--size", "20"],
            "--size: '20' has no unit; write it with its unit, such as \"20 mm\"",
        ),
        (
            &["drop", "--height", " 3 "],
            "--height: '3' has no unit; write it with its unit, such as \"3 m\"",
        ),
        (
            &["drop", "--height", "0"],
            "--height: '0' is not above 0; write a length above 0",
        ),
        (
            &["drop", "--mass", "2e-2"],
            "--mass: '2e-2' has no unit; write it with its unit, such as \"2e-2 g\"",
        ),
        (
            &["chute", "--speed", "3"],
            "--speed: '3' has no unit; write it with its unit, such as \"3 m/s\"",
        ),
        (
            &["mill", "--speed", "6"],
            "--speed: '6' has no unit; write it with its unit, such as \"6 rpm\"",
        ),
        (
            &["crusher", "--gap", "0.02"],
            "--gap: '0.02' has no unit; write it with its unit, such as \"0.02 mm\"",
        ),
        (&["drop", "--shape", "text.stl"], "--shape: text.stl"),
        (
            &["drop", "--shape", "gone.stl"],
            "--shape: gone.stl: there is no such file",
        ),
        (
            &["bending", "--shape", "cube.stl"],
            "--shape: it is 10 mm along x, less than 3 times",
        ),
        (
            &["drop", "--speed", "1 m/s"],
            "--speed: the scene 'drop' does not use it; remove it: it uses --shape, --size, --mass, --height and --diameter",
        ),
        (
            &["bending", "--height", "1 m"],
            "it uses --shape, --size, --mass and --diameter",
        ),
        (
            &["crusher", "--gap", "61 mm"],
            "--gap: 61 mm is not between 12 mm and 54 mm",
        ),
        (
            &["silo", "--gap", "1 mm"],
            "--gap: 1 mm is not between 8 mm and 80 mm",
        ),
        (
            &["cone", "--gap", "1 mm"],
            "--gap: 1 mm is not between 6 mm and 18 mm",
        ),
        (
            &["cone", "--shape", "cube.stl"],
            "--shape: the scene 'cone' does not use it; remove it: it uses --size, --mass, --gap",
        ),
        (
            &["screen", "--size", "10 mm", "--gap", "16 mm"],
            "--gap: 16 mm is not between 3 mm and 15 mm",
        ),
        (
            &["chute", "--speed", "1e6 m/s"],
            "is not between 0.1 m/s and 20 m/s",
        ),
        (
            &["mill", "--speed", "3 m"],
            "--speed: '3 m' is not an angular velocity",
        ),
        (&["drop", "--diameter", "1 kg"], "--diameter"),
        (&["drop", "--diameter", "1 m"], "no sphere fits"),
    ] {
        let (said, code) = refused(&new(&bench, &[options, &["made/here"]].concat()));
        assert!(code == 2 && said.contains(parts), "{options:?}: {said}");
        assert!(!bench.path("made").exists(), "{options:?}");
    }
}

#[test]
fn nothing_is_overwritten() {
    let bench = Bench::new();
    bench.write("taken", "mine");
    let said = refused(&new(&bench, &["drop", "taken"]));
    assert_eq!(said.1, 2);
    assert!(
        said.0
            .contains("taken: there is such a file or folder already, and nothing is overwritten"),
        "{}",
        said.0
    );
    assert_eq!(fs::read_to_string(bench.path("taken")).unwrap(), "mine");
    fs::create_dir(bench.path("full")).unwrap();
    assert_eq!(refused(&new(&bench, &["chute", "full"])).1, 2);
    assert!(fs::read_dir(bench.path("full")).unwrap().next().is_none());
    let (said, code) = refused(&new(&bench, &["silo", "taken/here"]));
    assert!(
        code == 2 && said.contains("is a file, not a folder"),
        "{said}"
    );
    let output = new(&bench, &["milling", "mine"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(!bench.path("mine").exists());
    // A name that looks like an option.
    let output = new(&bench, &["silo", "--", "-d"]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn keys_are_those_of_the_page() {
    let keys = |options: &[&str]| {
        let mut command = dem_run();
        let output = command.arg("keys").args(options).output().unwrap();
        (
            String::from_utf8(output.stdout).unwrap(),
            String::from_utf8(output.stderr).unwrap(),
            output.status.code(),
        )
    };
    // Every key stands at the beginning of an entry, in the order of the page.
    for (words, page) in [(&[][..], "scene-keys.md"), (&["study"], "study-keys.md")] {
        let page = fs::read_to_string(super::root().join("doc").join(page)).unwrap();
        // Pairs that do not go together are no entries.
        let entries = page
            .split("\n## What does not go with what")
            .next()
            .unwrap();
        let rows = entries.lines().filter_map(|line| line.strip_prefix("| `"));
        let wanted: Vec<&str> = rows.map(|row| row.split('`').next().unwrap()).collect();
        let (text, ..) = keys(words);
        let missing: Vec<_> = wanted
            .iter()
            .filter(|key| !text.contains(&format!("\n  {key}: ")))
            .collect();
        assert!(missing.is_empty() && wanted.len() > 30, "{missing:?}");
        assert!(
            text.lines().all(|line| line.chars().count() <= 100),
            "{text}"
        );
        for markdown in ["](#", "\\[", "\\|", "`", "| "] {
            assert!(!text.contains(markdown), "{markdown}");
        }
    }
    let (bodies, ..) = keys(&["bodies"]);
    assert!(bodies.starts_with("[bodies.NAME]\n"), "{bodies}");
    assert!(bodies.contains("\n  position_of: "), "{bodies}");
    assert!(
        bodies.contains("\nDrop\n") && !bodies.contains("[walls.NAME]\n"),
        "{bodies}"
    );
    assert_eq!(keys(&["[bodies.NAME]"]).0, bodies);
    let (drop, ..) = keys(&["drop"]);
    assert!(
        drop.starts_with("Drop\n") && bodies.contains(&drop),
        "{drop}"
    );
    assert!(
        drop.contains("  height: length (m); required; more than 0 m\n      "),
        "{drop}"
    );
    let (find, ..) = keys(&["find"]);
    assert!(
        find.starts_with("[find]\n") && find.contains("\n  tolerance: "),
        "{find}"
    );
    let (run, ..) = keys(&["run"]);
    assert!(
        run.contains("  gravity: [x, y, z] (m/s2); default [0, 0, 0] m/s2\n"),
        "{run}"
    );
    let (out, said, code) = keys(&["wals"]);
    assert_eq!((out.as_str(), code), ("", Some(2)));
    assert!(
        said.contains("dem-run keys wals: a scene has no table 'wals'; use one of run, materials"),
        "{said}"
    );
}
