//! Walls in frames: where they are, what pushes on them, and how fast they move.

use std::fs;

use dem_io::body::{StoredWalls, read_walls};

use super::{Bench, good, numbers};

/// A sphere that falls onto a plate; a box that moves, a cylinder that turns and a surface of
/// 10,082 triangles that stands still.
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
particles = [[0, 0, 1.05e-3, 1e-3]]
velocity = [0, 0, "-0.1 m/s"]
[walls.box]
box = { min = ["10 mm", 0, 0], max = ["12 mm", "1 mm", "1 mm"] }
material = "ball"
velocity = ["0.5 m/s", 0, 0]
[walls.cylinder]
cylinder = { from = ["-10 mm", "-2 mm", 0], to = ["-10 mm", "2 mm", 0], radius = "3 mm" }
material = "ball"
pivot = ["-10 mm", 0, 0]
angular_velocity = [0, "50 rad/s", 0]
[walls.floor]
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
material = "ball"
[walls.terrain]
stl = "terrain.stl"
unit = "m"
material = "ball"
[output]
frames = "1 ms"
series = "1 ms"
"#;

/// A square of 71 x 71 squares of two triangles each, 0.2 m wide at a height of -10 mm.
fn terrain() -> Vec<u8> {
    let at = |i: u32| 0.2 * (f64::from(i) / 71.0 - 0.5);
    let mut stl = vec![0; 80];
    stl.extend((2 * 71 * 71_u32).to_le_bytes());
    for (i, j) in (0..71).flat_map(|i| (0..71).map(move |j| (i, j))) {
        let [a, b, c, d] =
            [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| [at(i), at(j), -0.01]);
        for corners in [[a, b, c], [a, c, d]] {
            stl.extend([0; 12]);
            let numbers = corners.as_flattened().iter();
            stl.extend(numbers.flat_map(|x| (*x as f32).to_le_bytes()));
            stl.extend([0; 2]);
        }
    }
    stl
}

fn run() -> Bench {
    let bench = Bench::new();
    bench.write("terrain.stl", terrain());
    let scene = bench.write("walls.toml", SCENE);
    // A note says that the surface is open.
    let output = bench.run(&scene, &["--output", "out"]);
    assert!(output.status.success());
    bench
}

fn walls(bench: &Bench, number: usize) -> StoredWalls {
    read_walls(&bench.path(&format!("out/frames/walls_{number:06}.vtp"))).unwrap()
}

/// Corners of the triangles of a wall, m.
fn corners(walls: &StoredWalls, name: &str) -> Vec<[[f64; 3]; 3]> {
    let number = walls.names.iter().position(|found| found == name).unwrap();
    let of_wall = walls.triangles.iter().zip(&walls.wall_of_triangle);
    let of_wall = of_wall.filter(|(_, wall)| **wall as usize == number);
    of_wall
        .map(|(triangle, _)| triangle.map(|point| walls.points_m[point as usize]))
        .collect()
}

/// Smallest and largest coordinate along an axis, m.
fn ends(corners: &[[[f64; 3]; 3]], axis: usize) -> [f64; 2] {
    let all = corners.as_flattened().iter().map(|point| point[axis]);
    [
        all.clone().fold(f64::INFINITY, f64::min),
        all.fold(f64::NEG_INFINITY, f64::max),
    ]
}

fn area(corners: &[[[f64; 3]; 3]]) -> f64 {
    let of = |[a, b, c]: &[[f64; 3]; 3]| {
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
        let cross = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        0.5 * cross.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    corners.iter().map(of).sum()
}

#[test]
fn walls_are_where_the_scene_moves_them() {
    let bench = run();
    let times = numbers(&bench.path("out/series.csv"), "time_s");
    for (number, &time_s) in times.iter().enumerate() {
        let walls = walls(&bench, number);
        assert_eq!(walls.time_s.to_bits(), time_s.to_bits());
        assert_eq!(walls.names, ["box", "cylinder", "floor", "terrain"]);
        let solid = corners(&walls, "box");
        assert_eq!(solid.len(), 12);
        let [low, high] = ends(&solid, 0);
        assert!(
            (low - (0.01 + 0.5 * time_s)).abs() < 1e-8,
            "{low} at {time_s}"
        );
        assert!((high - low - 0.002).abs() < 1e-8);
        // Rotated about its own axis, it keeps its extent, but its corners move.
        let cylinder = corners(&walls, "cylinder");
        assert_eq!(ends(&cylinder, 1), [-0.002_f32, 0.002_f32].map(f64::from));
        let round = 2.0 * std::f64::consts::PI * 0.003 * (0.004 + 0.003);
        assert!((area(&cylinder) / round - 1.0).abs() < 1e-3);
        assert_eq!(ends(&corners(&walls, "floor"), 2), [0.0; 2]);
        let terrain = corners(&walls, "terrain");
        assert_eq!(terrain.len(), 2 * 71 * 71);
        assert!((area(&terrain) / 0.04 - 1.0).abs() < 1e-6);
    }
    let turned = |number| corners(&walls(&bench, number), "cylinder")[0];
    assert!(turned(0) != turned(4));
    // The surface that stands still is written once; all points of a wall are shared.
    let fixed = fs::metadata(bench.path("out/frames/walls_fixed.vtp"))
        .unwrap()
        .len();
    let each = fs::metadata(bench.path("out/frames/walls_000004.vtp"))
        .unwrap()
        .len();
    assert!(fixed > 200_000 && each < 30_000, "{fixed} and {each} bytes");
    assert_eq!(
        walls(&bench, 0).points_m.len(),
        8 + (2 + 2 * 96) + 4 + 72 * 72
    );
}

#[test]
fn forces_are_those_of_the_time_series() {
    for name in ["meeting.toml", "following.toml"] {
        let bench = Bench::new();
        let often = [
            "--set",
            "output.frames=0.1 ms",
            "--set",
            "output.series=0.1 ms",
        ];
        bench.good(&good(name), &[&["--output", "out"], &often[..]].concat());
        let series = bench.path("out/series.csv");
        let times = numbers(&series, "time_s");
        let mut largest_n = 0.0_f64;
        let count = fs::read_dir(bench.path("out/frames")).unwrap().count() / 2;
        for number in 0..count {
            let walls = walls(&bench, number);
            let row = times.iter().position(|time| *time == walls.time_s).unwrap();
            for (wall, force_n) in walls.names.iter().zip(&walls.forces_n) {
                for (axis, found) in ["x", "y", "z"].iter().zip(force_n) {
                    let column = numbers(&series, &format!("wall_{wall}_force_{axis}_n"));
                    assert_eq!(column[row], *found, "{wall} {axis} of {name}");
                    largest_n = largest_n.max(found.abs());
                }
            }
        }
        assert!(count > 3 && largest_n > 0.0, "{name}");
    }
}

#[test]
fn a_scene_without_walls_has_no_files_of_walls() {
    let bench = Bench::new();
    bench.good(&good("breaking.toml"), &["--output", "out"]);
    let names = dem_testing::names_in(&bench.path("out/frames"));
    assert!(
        names.iter().all(|name| name.starts_with("frame_")),
        "{names:?}"
    );
}
