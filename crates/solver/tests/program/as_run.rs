//! The scene next to its results runs again to the same results.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::{Bench, piped, results, row, scene_of_data, vtp_bytes};

const SCENE: &str = "version = 1
include = [\"stuff.toml\"]
run.end_time = \"1 ms\"
bonds.m = { young_modulus = \"1 MPa\", poisson_ratio = 0.3 }
contacts.m-m = { restitution = 0.5 }
bodies.row = { file = \"missing.vtp\", material = \"m\", bonds = \"m\", position = [0, 0, \"5 mm\"] }
walls.floor = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"m\" }
output = { frames = \"0.1 ms\", folder = \"elsewhere\" }
";

fn bench() -> Bench {
    let bench = Bench::new();
    fs::create_dir(bench.path("scenes")).unwrap();
    fs::create_dir(bench.path("bodies")).unwrap();
    bench.write("scenes/case.toml", SCENE);
    bench.write("bodies/row.vtp", vtp_bytes(&row(4)));
    let stuff = "materials.m = { density = 1000, young_modulus = \"1 MPa\" }\n";
    bench.write("scenes/stuff.toml", stuff);
    bench.write(
        "more.toml",
        "bonds.m = { young_modulus = \"2 MPa\", poisson_ratio = 0.2 }\n",
    );
    bench
}

const OPTIONS: [&str; 6] = [
    "--body",
    "row=bodies/row.vtp",
    "--material",
    "more.toml",
    "--set",
    "bodies.row.velocity=[0, 0, \"-7 m/s\"]",
];

fn summary(bench: &Bench, folder: &str) -> Value {
    let path = bench.path(folder).join("summary.json");
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

#[test]
fn the_scene_in_the_folder_gives_the_same_results() {
    let bench = bench();
    bench.good(
        Path::new("scenes/case.toml"),
        &[&OPTIONS[..], &["--output", "first"]].concat(),
    );
    bench.good(Path::new("first/scene.toml"), &["--output", "second"]);
    // Another folder has other paths and the settings in the scene itself, but the same physics.
    let (first, second) = (
        results(&bench.path("first")),
        results(&bench.path("second")),
    );
    let numbers = |name: &str| name.ends_with(".csv") || name.ends_with(".vtp");
    let count = first.keys().filter(|name| numbers(name)).count();
    assert!(count > 20, "{count} files");
    for (name, bytes) in first.iter().filter(|(name, _)| numbers(name)) {
        assert!(*bytes == second[name], "{name}");
    }
    assert_eq!(
        summary(&bench, "first")["inputs"]["bodies"]["row"]["hash"],
        summary(&bench, "second")["inputs"]["bodies"]["row"]["hash"]
    );
    let text = fs::read_to_string(bench.path("first/scene.toml")).unwrap();
    assert!(text.contains("file = \"../bodies/row.vtp\""), "{text}");
    // Nothing in it says where on this machine it was.
    assert!(!text.contains(bench.path("").to_str().unwrap()), "{text}");
    let said = bench.bad(
        Path::new("first/scene.toml"),
        &["--output", "first", "--force"],
        2,
    );
    assert!(said.contains("this is an input of the run"), "{said}");
}

#[test]
fn a_scene_that_cannot_be_resumed_does_not_replace_that_of_the_run() {
    let bench = bench();
    let options = [&OPTIONS[..], &["--output", "out"]].concat();
    bench.good(Path::new("scenes/case.toml"), &options);
    let before = fs::read(bench.path("out/scene.toml")).unwrap();
    let longer = [&options[..], &["--resume", "--set", "run.end_time=2 ms"]].concat();
    let other = [&longer[..], &["--set", "materials.m.density=2000"]].concat();
    bench.bad(Path::new("scenes/case.toml"), &other, 2);
    assert_eq!(fs::read(bench.path("out/scene.toml")).unwrap(), before);
    bench.good(Path::new("scenes/case.toml"), &longer);
    let options = [
        &OPTIONS[..],
        &["--output", "whole", "--set", "run.end_time=2 ms"],
    ]
    .concat();
    bench.good(Path::new("scenes/case.toml"), &options);
    let [one, other] = ["out", "whole"].map(|name| fs::read(bench.path(name).join("scene.toml")));
    assert_eq!(one.unwrap(), other.unwrap());
}

#[test]
fn a_body_from_a_pipe_is_named() {
    let bench = bench();
    let out = bench.path("out").display().to_string();
    let scene = bench.path("scenes/case.toml").display().to_string();
    let arguments = [scene.as_str(), "--body", "-", "--output", &out, "--quiet"];
    let output = piped(&arguments, &vtp_bytes(&row(4)));
    assert!(output.status.success());
    let text = fs::read_to_string(bench.path("out/scene.toml")).unwrap();
    assert!(
        text.contains("# The body 'row' came from standard input"),
        "{text}"
    );
    bench.good(
        Path::new("out/scene.toml"),
        &["--body", "row=bodies/row.vtp", "--output", "again"],
    );
    let series = |folder: &str| fs::read(bench.path(folder).join("series.csv")).unwrap();
    assert!(series("out") == series("again"));
}

#[test]
fn a_scene_of_the_data_runs_again() {
    let bench = Bench::new();
    let scene = scene_of_data("cantilever.toml");
    bench.good(&scene, &["--output", "one"]);
    bench.good(Path::new("one/scene.toml"), &["--output", "two"]);
    for name in ["series.csv", "frames/frame_000000.vtp"] {
        let [one, two] = ["one", "two"].map(|at| fs::read(bench.path(at).join(name)).unwrap());
        assert!(one == two, "{name}");
    }
}
