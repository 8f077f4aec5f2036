//! Walls with `loads`: their table, cells, summary and picture, and runs that are continued.

use std::fs;

use serde_json::Value;

use super::{Bench, dem_run, numbers, refused};
use dem_results::read_all_arrays;

/// Two balls, of which one slides over a plate with loads that swings, and one falls on a plane.
const SCENE: &str = r#"
version = 1
run = { end_time = "20 ms", gravity = [0, 0, -9.81], time_step = "5 us" }
materials.stone = { density = 2600, young_modulus = "10 MPa", poisson_ratio = 0.25 }
contacts.stone-stone = { restitution = 0.5, friction = 0.3 }
bodies.a = { particles = [[0, 0, "1 mm", "1 mm"]], material = "stone", velocity = [0.5, 0, -0.1] }
bodies.b = { particles = [["-19 mm", 0, "-1 mm", "1 mm"]], material = "stone", velocity = [0, 0.2, -0.1] }
output = { frames = "5 ms", series = "1 ms" }
[walls.plate]
box = { min = ["-3 mm", "-5 mm", "-2 mm"], max = ["20 mm", "5 mm", 0] }
material = "stone"
displacement = [0, "1 mm", 0]
frequency = "40 Hz"
loads = { patch = "2.5 mm", wear_constant = "1e-12 1/Pa" }
[walls.ground]
plane = { point = [0, 0, "-2 mm"], normal = [0, 0, 1] }
material = "stone"
loads = { patch = "2 mm" }
"#;

#[test]
fn a_continued_run_has_the_same_books() {
    let bench = Bench::new();
    let scene = bench.write("plate.toml", SCENE);
    bench.good(&scene, &["--output", "whole"]);
    let half = ["--set", "run.end_time=10 ms", "--output", "part"];
    bench.good(&scene, &half);
    let read = |name: &str| fs::read(bench.path(name)).unwrap();
    assert!(read("whole/wall_loads.csv") != read("part/wall_loads.csv"));
    bench.good(&scene, &["--output", "part", "--resume"]);
    for name in [
        "wall_loads.csv",
        "wall_loads.vtp",
        "wall_loads.pvd",
        "frames/loads_000004.vtp",
    ] {
        let [whole, part] = ["whole", "part"].map(|folder| read(&format!("{folder}/{name}")));
        assert!(whole == part, "{name}");
    }
}

#[test]
fn table_cells_and_summary_agree() {
    let bench = Bench::new();
    let scene = bench.write("plate.toml", SCENE);
    bench.good(&scene, &["--output", "out"]);
    let summary: Value =
        serde_json::from_slice(&fs::read(bench.path("out/summary.json")).unwrap()).unwrap();
    let column = |name: &str| numbers(&bench.path("out/wall_loads.csv"), name);
    for (name, of_summary) in [
        ("impact_j", "impact_j"),
        ("friction_j", "friction_j"),
        ("damping_j", "damping_j"),
        ("sliding_load_n_m", "sliding_load_n_m"),
        ("normal_impulse_n_s", "normal_impulse_n_s"),
        ("wear_volume_m3", "wear_volume_m3"),
    ] {
        let wanted: f64 = ["plate", "ground"]
            .map(|wall| summary["wall_loads"][wall][of_summary].as_f64().unwrap())
            .iter()
            .sum();
        let sum: f64 = column(name).iter().sum();
        assert!(
            wanted > 0.0 && (sum / wanted - 1.0).abs() < 1e-12,
            "{name}: {sum} {wanted}"
        );
    }
    let of_plate = &summary["wall_loads"]["plate"];
    assert_eq!(of_plate["patches"], 2 * (10 * 4 + 4 + 10));
    let deepest = column("wear_depth_m").into_iter().fold(0.0, f64::max);
    assert_eq!(of_plate["largest_wear_depth_m"].as_f64(), Some(deepest));
    assert_eq!(summary["wall_loads"]["ground"]["wear_volume_m3"], 0.0);
    // Two triangles for each patch, the same numbers on both.
    let cells = read_all_arrays(&bench.path("out/wall_loads.vtp")).unwrap();
    let of_cells = cells.get("CellData/impact_j").unwrap();
    let twice: Vec<f64> = column("impact_j")
        .into_iter()
        .flat_map(|j| [j, j])
        .collect();
    assert_eq!(of_cells, twice);
    let page = fs::read_to_string(bench.path("out/report.html")).unwrap();
    assert!(page.contains("Loads of walls") && page.contains("data:image/png;base64,"));
}

#[test]
fn frames_have_the_loads_so_far_where_the_walls_stand() {
    let bench = Bench::new();
    let scene = bench.write("plate.toml", SCENE);
    bench.good(&scene, &["--output", "out"]);
    let read = |name: &str| read_all_arrays(&bench.path("out").join(name)).unwrap();
    let sum = |name: &str, column: &str| -> f64 {
        let cells = read(name);
        cells.get(column).unwrap_or_default().iter().sum()
    };
    let frames = [0, 1, 2, 3, 4].map(|at| format!("frames/loads_00000{at}.vtp"));
    for column in ["CellData/impact_j", "CellData/wear_depth_m"] {
        let sums = frames.each_ref().map(|name| sum(name, column));
        assert!(sums[0] == 0.0 && sums.is_sorted(), "{sums:?}");
        assert_eq!(sums[4], sum("wall_loads.vtp", column));
    }
    let index = fs::read_to_string(bench.path("out/wall_loads.pvd")).unwrap();
    assert!(frames.iter().all(|name| index.contains(name)), "{index}");
    let index = fs::read_to_string(bench.path("out/frames.pvd")).unwrap();
    assert!(!index.contains("loads_"), "{index}");
    // After 20 ms at 40 Hz the plate is 1 mm sin(1.6 pi) aside.
    // The plate is the last of the walls.
    let plate_y_m = |name: &str| {
        let cells = read(name);
        let coordinates = cells.get("Points/positions_m").unwrap();
        coordinates[coordinates.len() - 2]
    };
    let aside_m = 1e-3 * (1.6 * std::f64::consts::PI).sin();
    let moved_m = plate_y_m(&frames[4]) - plate_y_m("wall_loads.vtp");
    assert!((moved_m - aside_m).abs() < 1e-8, "{moved_m} {aside_m}");
    assert_eq!(plate_y_m(&frames[0]), plate_y_m("wall_loads.vtp"));
}

#[test]
fn loads_are_measured() {
    let bench = Bench::new();
    let quantities = ["wear_volume", "impact_energy", "friction_energy"];
    let measures = quantities
        .map(|name| format!("[measures.{name}]\nof = \"plate\"\nquantity = \"{name}\"\n"))
        .concat();
    let scene = bench.write("plate.toml", format!("{SCENE}{measures}"));
    bench.good(&scene, &["--output", "out"]);
    let summary: Value =
        serde_json::from_slice(&fs::read(bench.path("out/summary.json")).unwrap()).unwrap();
    let of_plate = &summary["wall_loads"]["plate"];
    for (name, booked) in quantities
        .into_iter()
        .zip(["wear_volume_m3", "impact_j", "friction_j"])
    {
        let found = &summary["measures"][name];
        assert!(found["value"].as_f64().unwrap() > 0.0);
        assert_eq!(found["value"], of_plate[booked]);
    }
    let without = format!("{SCENE}{measures}").replace("loads = ", "# ");
    let scene = bench.write("without.toml", without);
    let mut command = dem_run();
    let (said, code) = refused(&command.arg(&scene).output().unwrap());
    assert_eq!(code, 2);
    assert!(said.contains("the wall \"plate\" has no loads"), "{said}");
}

#[test]
fn the_walls_are_drawn_in_colours() {
    let bench = Bench::new();
    let scene = bench.write("plate.toml", SCENE);
    bench.good(&scene, &["--output", "out"]);
    let draw = |by: &str, file: &str| {
        let mut command = dem_run();
        command.current_dir(bench.path(".")).args([
            "picture",
            "out",
            "-o",
            file,
            "--wall-loads",
            by,
        ]);
        command.output().unwrap()
    };
    for by in ["wear_depth", "impact", "friction", "normal_impulse"] {
        assert!(draw(by, "walls.png").status.success());
        let png = fs::read(bench.path("walls.png")).unwrap();
        assert!(png.len() > 2000, "{}", png.len());
    }
    let (said, code) = refused(&draw("depth", "walls.png"));
    assert_eq!(code, 2);
    assert!(
        said.contains("'depth' is no quantity of walls; write one of wear_depth"),
        "{said}"
    );
    let (said, _) = refused(&draw("impact", "walls.gif"));
    assert!(said.contains("write a .png"), "{said}");
    let without = SCENE.replace("loads = ", "# ");
    let scene = bench.write("without.toml", without);
    bench.good(&scene, &["--output", "out", "--force"]);
    assert!(["csv", "vtp", "pvd"].iter().all(|kind| {
        !bench
            .path("out")
            .join(format!("wall_loads.{kind}"))
            .exists()
    }));
    assert!(!bench.path("out/frames/loads_000000.vtp").exists());
    let (said, code) = refused(&draw("impact", "walls.png"));
    assert_eq!(code, 2);
    assert!(said.contains("no wall of the run has loads"), "{said}");
}
