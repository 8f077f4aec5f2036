//! Walls and regions from files of triangles of every format.

use super::{Bench, dem_run, root};

/// A ball that falls onto the top of a box of 20 mm x 12 mm x 10 mm.
const SCENE: &str = r#"
version = 1
[run]
end_time = "4 ms"
gravity = [0, 0, -9.81]
[materials.ball]
density = "2500 kg/m3"
young_modulus = "5 MPa"
poisson_ratio = 0.3
[contacts]
ball-ball = { restitution = 0.5 }
[bodies.ball]
material = "ball"
particles = [["10 mm", "6 mm", "11.05 mm", "1 mm"]]
velocity = [0, 0, "-0.1 m/s"]
[walls.box]
FILE
material = "ball"
[measures.push]
of = "box"
quantity = "force"
statistic = "largest"
"#;

/// The box in quads.
const QUADS: &str = "v 0 0 0\nv 20 0 0\nv 0 12 0\nv 20 12 0\nv 0 0 10\nv 20 0 10\nv 0 12 10\nv 20 12 10\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

fn bench(file: &str) -> Bench {
    let bench = Bench::new();
    bench.write("scene.toml", SCENE.replace("FILE", file));
    bench.write("box.obj", QUADS);
    bench.write("box.step", "ISO-10303-21;\n");
    let of_packer = root().join("crates/packer/tests/shapes/box.3mf");
    std::fs::copy(of_packer, bench.path("box.3mf")).unwrap();
    bench
}

fn run(file: &str) -> std::process::Output {
    let bench = bench(file);
    let mut command = dem_run();
    let command = command.current_dir(bench.path("")).arg("scene.toml");
    command.arg("--json").output().unwrap()
}

/// The measures of the run.
fn push(file: &str) -> serde_json::Value {
    let output = run(file);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{file}: {said}");
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    summary["measures"].clone()
}

#[test]
fn walls_of_every_format_push_alike() {
    let solid = "box = { min = [0, 0, 0], max = [\"20 mm\", \"12 mm\", \"10 mm\"] }";
    let value = |measures: &serde_json::Value| {
        let text = measures.to_string();
        let numbers = text.split(|c: char| !"+-.e0123456789".contains(c));
        numbers
            .filter_map(|word| word.parse::<f64>().ok())
            .fold(0.0, |a: f64, b| a.max(b.abs()))
    };
    let wanted = value(&push(solid));
    assert!(wanted > 0.0);
    let obj = push("stl = \"box.obj\"\nunit = \"mm\"");
    assert!((value(&obj) / wanted - 1.0).abs() < 1e-9, "{obj} {wanted}");
    assert_eq!(push("stl = \"box.3mf\""), obj);
    assert_eq!(push("stl = \"box.3mf\"\nunit = \"mm\""), obj);
}

#[test]
fn files_that_are_no_wall_are_refused_in_one_message() {
    for (file, words) in [
        (
            "stl = \"box.3mf\"\nunit = \"cm\"",
            "box.3mf: a unit of the file is 0.001 m, as it says itself, not 0.01 m; leave the unit out",
        ),
        (
            "stl = \"box.step\"\nunit = \"mm\"",
            "box.step: a file of the format STEP, which has no triangles; export it as STL or 3MF",
        ),
        ("stl = \"box.obj\"", "walls.box.unit is missing"),
    ] {
        let (said, code) = super::refused(&run(file));
        assert_eq!(code, 2, "{said}");
        assert!(said.contains(words), "{said}");
    }
}
