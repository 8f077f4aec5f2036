//! Studies that pack their bodies.

use std::fs;

use super::{bad, csv, good, json};
use crate::program::{Bench, dem_pack, root};

const OPTIONS: &str = "--overlap 0.296 --bond-range 1.0";

/// The bar in tension, packed by the study, with these paths that vary.
fn bench(packed: &str, vary: &str) -> Bench {
    let bench = Bench::new();
    let [scene, shape] = ["data/scenes/tension.toml", "data/shapes/bar.stl"]
        .map(|name| root().join(name).canonicalize().unwrap());
    bench.write(
        "study.toml",
        format!(
            "version = 1
scene = {scene:?}
[set]
\"run.integrator\" = \"static\"
\"groups.lower-grip.box.max\" = [1, 1, \"10 mm\"]
\"groups.upper-grip.box.min\" = [-1, -1, \"50 mm\"]
[pack.bar]
shape = {shape:?}
{packed}
[vary]
{vary}
[measures.modulus]
test_result = \"specimen modulus\"
reference = \"none\"
"
        ),
    );
    bench
}

/// Each combination of diameter and seed is a packing, which its run uses, and responses are
/// averaged over the seeds. What is there is not packed again.
#[test]
fn diameters_and_seeds_vary() {
    let options = format!("options = {OPTIONS:?}");
    let vary = "\"pack.bar.diameter\" = [\"6mm..8mm\", \"5mm..6mm\"]\n\"pack.bar.seed\" = [1, 2]";
    let bench = bench(&options, vary);
    good(&bench, &[]);
    let packings = || {
        let files = fs::read_dir(bench.path("study-sweep/packings")).unwrap();
        let files = files.map(|file| file.unwrap().path());
        let files = files.map(|file| (file.clone(), fs::read(&file).unwrap()));
        let mut files: Vec<_> = files.collect();
        files.sort();
        files
    };
    let made = packings();
    assert_eq!(made.len(), 4);
    // The third run has the first seed of the second diameter.
    let words: Vec<&str> = OPTIONS.split(' ').collect();
    let own = [&["--diameter", "5mm..6mm", "--seed", "1"], &words[..]].concat();
    dem_pack(
        &root().join("data/shapes/bar.stl"),
        &own,
        &bench.path("own.vtp"),
    );
    let own = dem_io::body::read_body(&bench.path("own.vtp")).unwrap();
    let same = |(file, _): &&(std::path::PathBuf, Vec<u8>)| {
        let made = dem_io::body::read_body(file).unwrap();
        (made.positions, made.radii, made.bonds)
            == (own.positions.clone(), own.radii.clone(), own.bonds.clone())
    };
    assert_eq!(made.iter().filter(same).count(), 1);
    let table = json(&bench);
    let particles = |run: usize| {
        let folder = format!("study-sweep/runs/{run:04}-1/summary.json");
        let text = fs::read_to_string(bench.path(&folder)).unwrap();
        let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
        summary["particles"].as_u64().unwrap()
    };
    assert_eq!(particles(3), own.radii.len() as u64);
    assert_ne!(particles(1), particles(2));
    assert_eq!(table["runs"].as_array().unwrap().len(), 4);
    let rows = csv(&bench.path("study-sweep/responses.csv"));
    assert_eq!(rows.len(), 2, "{rows:?}");
    assert!(rows.iter().all(|row| row["runs"] == "2"), "{rows:?}");
    fs::remove_dir_all(bench.path("study-sweep/runs/0004-1")).unwrap();
    good(&bench, &["--resume"]);
    assert_eq!(packings(), made);
    // Commands of a list name the packings, which are made with it.
    let listed = good(&bench, &["--list", "--output", "apart"]);
    assert!(
        listed
            .lines()
            .all(|line| line.contains("--body bar=apart/packings/bar-")),
        "{listed}"
    );
    assert_eq!(
        fs::read_dir(bench.path("apart/packings")).unwrap().count(),
        4
    );
}

#[test]
fn what_cannot_be_packed_is_refused_before_anything_runs() {
    let seeds = "\"pack.bar.seed\" = [1, 2]";
    let refused = |options: &str, vary: &str, wanted: &str| {
        let bench = bench(options, vary);
        let said = bad(&bench, &[], 2);
        assert!(said.contains(wanted), "{wanted}: {said}");
        assert!(!bench.path("study-sweep/runs/0001-1").exists());
    };
    let size = "options = \"--diameter 6mm..8mm\"";
    refused(
        size,
        "\"pack.rod.seed\" = [1, 2]",
        "pack.rod.seed: there is no [pack.rod]",
    );
    refused(
        size,
        "\"pack.bar\" = [1, 2]",
        "pack.bar names no option of dem-pack",
    );
    refused(
        size,
        "\"pack.bar.diameter\" = [\"5mm\"]",
        "--diameter is among the options of [pack.bar] as well; remove it there",
    );
    refused(
        size,
        "\"body.bar\" = [\"a.vtp\"]",
        "body.bar is the file of a body that [pack.bar] packs; remove one of the two",
    );
    refused(
        "options = \"--diameter 6mm..8mm --colour red\"",
        seeds,
        "--colour",
    );
    refused("options = \"--diameter 90mm\"", seeds, "90 mm");
    refused("", "\"pack.bar.diameter\" = [\"5 kg\"]", "5kg");
}

/// Runs of one shape are not continued with another.
#[test]
fn a_changed_shape_is_another_study() {
    let bench = bench(
        "options = \"--diameter 6mm..8mm\"",
        "\"pack.bar.seed\" = [1, 2]",
    );
    let study = fs::read_to_string(bench.path("study.toml")).unwrap();
    let shape = root().join("data/shapes/bar.stl").canonicalize().unwrap();
    let study = study.replace(&format!("{shape:?}"), "\"bar.stl\"");
    bench.write("study.toml", &study);
    fs::copy(shape, bench.path("bar.stl")).unwrap();
    good(&bench, &[]);
    fs::copy(root().join("data/shapes/disc.stl"), bench.path("bar.stl")).unwrap();
    let said = bad(&bench, &["--resume"], 2);
    assert!(said.contains("[pack]") || said.contains("study"), "{said}");
}
