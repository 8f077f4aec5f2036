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

/// A scene to start from is made and runs as it stands, by the commands that are printed; the
/// bodies break, or the tests give a modulus.
fn is_made_and_runs(name: &str) {
    let bench = Bench::new();
    let output = new(&bench, &[name, name]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(
        said.starts_with(&format!(
            "made {name}: scene.toml, shape.stl, body.vtp with "
        )),
        "{said}"
    );
    assert!(bench.path(name).join("scene.schema.json").exists());
    let text = fs::read_to_string(bench.path(name).join("scene.toml")).unwrap();
    assert!(text.starts_with("#:schema scene.schema.json\n# "), "{name}");
    let commands: Vec<&str> = said
        .lines()
        .filter_map(|line| line.strip_prefix("  dem-run "))
        .collect();
    assert_eq!(commands.len(), 2, "{said}");
    for command in commands {
        let mut run = dem_run();
        run.args(command.split(' '))
            .current_dir(bench.folder.path());
        let output = run.output().unwrap();
        assert!(
            output.status.success(),
            "{command}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    let summary = bench.path(name).join("results/summary.json");
    let summary: Value = serde_json::from_slice(&fs::read(summary).unwrap()).unwrap();
    let broken = summary["broken_bonds"].as_u64().unwrap();
    assert!(broken > 10, "{name}: {broken}");
    assert!(
        summary["energy_error"].as_f64().unwrap() < 0.02,
        "{name}: {}",
        summary["energy_error"]
    );
    match &summary["test"]["results"] {
        Value::Null => assert!(bench.path(name).join("results/film.png").exists(), "{name}"),
        results => assert!(results.to_string().contains("specimen modulus"), "{name}"),
    }
}

#[test]
fn drop_runs() {
    is_made_and_runs("drop");
}

#[test]
fn chute_runs() {
    is_made_and_runs("chute");
}

#[test]
fn crusher_runs() {
    is_made_and_runs("crusher");
}

#[test]
fn bending_runs() {
    is_made_and_runs("bending");
}

#[test]
fn compression_runs() {
    is_made_and_runs("compression");
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
    let (said, code) = refused(&new(&bench, &["chute", "missing/here"]));
    assert!(code == 2 && said.contains("does not exist"), "{said}");
    let output = new(&bench, &["mill", "mine"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(!bench.path("mine").exists());
    // A name that looks like an option of dem-pack.
    let output = new(&bench, &["drop", "--", "-d"]);
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
