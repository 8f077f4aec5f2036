//! Surfaces as files of triangles, and as planes for a LAMMPS without surfaces.

use std::f64::consts::PI;

use super::{Bench, Export, exported, refused_export, stl};

/// Two spheres in a surface.
fn scene(more: &str) -> String {
    format!(
        "version = 1\nrun.end_time = \"1 ms\"\nrun.gravity = [0, 0, -9.81]\n\
         materials.grain = {{ density = 2500, young_modulus = 1e7, poisson_ratio = 0.3 }}\n\
         contacts.grain-grain = {{ restitution = 0.5, friction = 0.3 }}\n\
         [bodies.grains]\nmaterial = \"grain\"\nparticles = [[0, 0, 0.02, 0.004], [0.01, 0, 0.02, 0.004]]\n\
         [walls.bin]\nstl = \"bin.stl\"\nunit = \"m\"\nmaterial = \"grain\"\n{more}\n"
    )
}

/// A ring of corners of this radius at this height, m.
fn ring(corners: usize, radius_m: f64, height_m: f64) -> Vec<[f64; 3]> {
    let angle = |k: usize| 2.0 * PI * k as f64 / corners as f64;
    let corner = |k| {
        [
            radius_m * angle(k).cos(),
            radius_m * angle(k).sin(),
            height_m,
        ]
    };
    (0..corners).map(corner).collect()
}

/// The sides between two rings, from corner `low` and corner `high` on.
fn sides(corners: usize, low: usize, high: usize) -> Vec<[usize; 3]> {
    let side = |k: usize| {
        let next = (k + 1) % corners;
        [
            [low + k, low + next, high + next],
            [low + k, high + next, high + k],
        ]
    };
    (0..corners).flat_map(side).collect()
}

/// A floor of triangles about a corner.
fn floor(corners: usize, low: usize, middle: usize) -> Vec<[usize; 3]> {
    let part = |k: usize| [low + k, (low + (k + 1) % corners), middle];
    (0..corners).map(part).collect()
}

/// Corners and triangles of a vessel of `n` sides, 60 mm wide below and as wide or wider above. Its
/// floor, if there are `rings`, has as many in it.
fn vessel(n: usize, above_m: f64, rings: Option<usize>) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let mut corners = ring(n, 0.03, 0.0);
    corners.extend(ring(n, above_m, 0.06));
    let mut triangles = sides(n, 0, n);
    if let Some(rings) = rings {
        let mut around = 0;
        for k in 1..=rings {
            let inner = corners.len();
            corners.extend(ring(n, 0.03 * (1.0 - k as f64 / (rings + 1) as f64), 0.0));
            triangles.extend(sides(n, around, inner));
            around = inner;
        }
        corners.push([0.0; 3]);
        triangles.extend(floor(n, around, corners.len() - 1));
    }
    (corners, triangles)
}

/// An open bin of six sides.
fn bin(above_m: f64) -> String {
    let (corners, triangles) = vessel(6, above_m, Some(0));
    stl(&corners, &triangles)
}

/// The same, closed by a lid.
fn drum(n: usize, rings: usize) -> String {
    let (mut corners, mut triangles) = vessel(n, 0.03, Some(rings));
    corners.push([0.0, 0.0, 0.06]);
    triangles.extend(floor(n, n, corners.len() - 1));
    stl(&corners, &triangles)
}

/// Points and normals of the planes of the only wall.
fn planes(export: &Export) -> Vec<[[f64; 3]; 2]> {
    let parts = export.script.iter().filter(|words| {
        words.len() > 2 && words[0] == "region" && words[1].starts_with("wall_1_part_")
    });
    let plane = |words: &Vec<String>| {
        assert_eq!([&words[2], &words[9], &words[10]], ["plane", "side", "in"]);
        let number = |at: usize| words[at].parse::<f64>().unwrap();
        [
            [number(3), number(4), number(5)],
            [number(6), number(7), number(8)],
        ]
    };
    parts.map(plane).collect()
}

#[test]
fn a_bin_becomes_one_plane_for_each_face() {
    for above_m in [0.03, 0.05] {
        let bench = Bench::new();
        bench.write("bin.stl", bin(above_m));
        bench.write("scene.toml", scene(""));
        let export = exported(&bench, "scene.toml");
        let planes = planes(&export);
        assert_eq!(planes.len(), 7);
        // LAMMPS without surfaces goes on.
        assert!(!export.script.iter().flatten().any(|word| word == "\"quit"));
        let whole = export.said("region wall_1 intersect");
        assert!(
            whole.starts_with("7 wall_1_part_1 wall_1_part_2 "),
            "{whole}"
        );
        // The height of a point in the middle above each face, by the geometry of the bin.
        let apothem = (PI / 6.0).cos();
        let out = (above_m - 0.03) * apothem / 0.06;
        let wanted_m = (0.03 * apothem + out * 0.02) / out.hypot(1.0);
        let point = [0.0, 0.0, 0.02];
        let mut floors = 0;
        for [place, normal] in planes {
            let height_m: f64 = (0..3).map(|k| normal[k] * (point[k] - place[k])).sum();
            let length: f64 = normal.iter().map(|n| n * n).sum();
            assert!((length - 1.0).abs() < 1e-12);
            let is_floor = normal[2] > 0.99;
            floors += usize::from(is_floor);
            let wanted_m = if is_floor { 0.02 } else { wanted_m };
            assert!((height_m - wanted_m).abs() < 1e-8, "{height_m} {wanted_m}");
        }
        assert_eq!(floors, 1);
        let page = std::fs::read_to_string(bench.path("out/README.md")).unwrap();
        for said in [
            "`fix surface/global` of 18 triangles (`wall-1.stl`); in LAMMPS before 4 July 2026",
            "`region intersect` of 7 planes",
            "go on upwards beyond its rim",
            "Needs LAMMPS of 22 July 2025 or later",
        ] {
            assert!(page.contains(said), "{said}");
        }
    }
}

#[test]
fn a_closed_drum_becomes_planes_however_its_floor_is_meshed() {
    // Gravity does not matter for what is closed; the wall may be turned.
    let turned = "rotation = { axis = [0, 1, 0], angle = \"90 deg\" }\npivot = [0, 0, 0.03]";
    for (rings, more, floor) in [(0, "", [0.0, 0.0, 1.0]), (100, turned, [1.0, 0.0, 0.0])] {
        let bench = Bench::new();
        bench.write("bin.stl", drum(24, rings));
        bench.write("scene.toml", scene(more));
        let planes = planes(&exported(&bench, "scene.toml"));
        assert_eq!(planes.len(), 26);
        let is_floor = |normal: &[f64; 3]| (0..3).all(|k| (normal[k] - floor[k]).abs() < 1e-9);
        assert_eq!(
            planes.iter().filter(|[_, normal]| is_floor(normal)).count(),
            1
        );
    }
}

#[test]
fn a_surface_that_planes_cannot_be_needs_surfaces_and_the_reason_is_said() {
    let (mut corners, triangles) = vessel(6, 0.03, Some(0));
    // A floor with a peak: its parts look away from each other.
    corners[12][2] = 0.01;
    let peaked = stl(&corners, &triangles);
    let (corners, triangles) = vessel(6, 0.05, None);
    let hopper = stl(&corners, &triangles);
    let (corners, triangles) = vessel(6, 0.03, None);
    let pipe = stl(&corners, &triangles);
    let (mut corners, triangles) = vessel(6, 0.03, Some(0));
    let whole: Vec<[usize; 3]> = triangles[..12].to_vec();
    // One of its sides has a notch down to half of the height.
    corners.push([
        0.75 * corners[6][0] + 0.25 * corners[7][0],
        0.75 * corners[6][1] + 0.25 * corners[7][1],
        0.03,
    ]);
    let notch = corners.len() - 1;
    let mut notched = vec![[0, 1, notch], [0, notch, 6], [1, 7, notch]];
    notched.extend(&whole[2..]);
    notched.extend(&triangles[12..]);
    let notched = stl(&corners, &notched);
    // Two pipes in line with a gap between them.
    let (mut corners, mut gap) = vessel(6, 0.03, Some(0));
    let above: Vec<[f64; 3]> = corners[..12]
        .iter()
        .map(|[x, y, z]| [*x, *y, z + 0.1])
        .collect();
    corners.extend(above);
    gap.extend(sides(6, 13, 19));
    let gap = stl(&corners, &gap);
    let plate = stl(
        &[
            [-1.0, -1.0, 0.0],
            [1.0, -1.0, 0.0],
            [1.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0],
        ],
        &[[0, 1, 2], [0, 2, 3]],
    );
    let feed = "[regions.above]\nbox = { min = [0, 0, 0.03], max = [0.04, 0.01, 0.05] }\n\
                [inlets.feed]\nbodies = [\"grain\"]\nregion = \"above\"\nrate = 10\ncount = 1\n\
                [bodies.grain]\nmaterial = \"grain\"\nparticles = [[0, 0, 0, 0.004]]\n\
                start_as = \"clump\"\n";
    let cases = [
        (peaked, "", "its faces do not all look at each other"),
        (hopper, "", "it has a hole, a notch or a narrower outlet"),
        (notched, "", "it has a hole, a notch or a narrower outlet"),
        (gap, "", "it has a hole, a notch or a narrower outlet"),
        (pipe, "", "it is open, not upwards"),
        (
            drum(100, 0),
            "",
            "some of its faces meet at less than 8 degrees",
        ),
        (drum(250, 0), "", "it has more than 200 faces"),
        (plate, "", "it does not surround a room"),
        (bin(0.03), "velocity = [1, 0, 0]", "it moves"),
        (bin(0.03), "scale = 0.2", "there are particles outside"),
        (bin(0.03), feed, "there is an inlet outside"),
    ];
    for (surface, more, expected) in cases {
        let bench = Bench::new();
        bench.write("bin.stl", &surface);
        bench.write("scene.toml", scene(more));
        let export = exported(&bench, "scene.toml");
        assert!(planes(&export).is_empty(), "{expected}");
        let page = std::fs::read_to_string(bench.path("out/README.md")).unwrap();
        let why = page.split_once("planes cannot stand for it: ").unwrap().1;
        assert!(
            why.lines().next().unwrap().contains(expected),
            "{expected}: {why}"
        );
        assert!(page.contains("Needs LAMMPS of 4 July 2026 or later"));
        assert!(page.contains("GRANSURF"));
        let stop = export.said("if \"${surfaces} == 0\" then");
        assert!(
            stop.contains("the walls bin are surfaces") && stop.ends_with("\"quit 1\""),
            "{stop}"
        );
        let fix = export.said("fix wall_1_1 material_1 surface/global");
        let begin = "input stl 1 1 wall-1.stl model * 1 granular hertz ";
        assert!(fix.starts_with(begin), "{fix}");
        assert!(
            fix.ends_with("limit_damping flat 8.10961 neighbor nsq"),
            "{fix}"
        );
    }
}

/// The corners of a text STL, in their order.
fn corners_of(text: &str) -> Vec<[f64; 3]> {
    let corner = |line: &str| {
        let words: Vec<f64> = (line.strip_prefix("vertex ")?.split(' '))
            .map(|word| word.parse().unwrap())
            .collect();
        Some([words[0], words[1], words[2]])
    };
    text.lines().filter_map(corner).collect()
}

#[test]
fn the_triangles_are_those_of_the_wall_where_it_stands() {
    let bench = Bench::new();
    let text = bin(0.05);
    bench.write("bin.stl", &text);
    let more =
        "unit = \"mm\"\nrotation = { axis = [0, 1, 0], angle = \"90 deg\" }\npivot = [0, 0, 0]";
    bench.write("scene.toml", scene(more).replace("unit = \"m\"\n", ""));
    exported(&bench, "scene.toml");
    let written = std::fs::read_to_string(bench.path("out/wall-1.stl")).unwrap();
    let (read, found) = (corners_of(&text), corners_of(&written));
    assert_eq!(found.len(), 18 * 3);
    // Turned by a quarter about y. Each corner is one of them, whichever the order of the triangles.
    let wanted: Vec<[f64; 3]> = (read.iter())
        .map(|[x, y, z]| [1e-3 * z, 1e-3 * y, -1e-3 * x])
        .collect();
    for [x, y, z] in &found {
        let is_near = |w: &[f64; 3]| {
            (x - w[0]).abs() < 1e-9 && (y - w[1]).abs() < 1e-9 && (z - w[2]).abs() < 1e-9
        };
        assert!(wanted.iter().any(is_near), "{x} {y} {z}");
    }
    // LAMMPS joins triangles at corners that are the same to the last digit.
    let mut different = found.clone();
    different.sort_by(|a, b| a.partial_cmp(b).unwrap());
    different.dedup();
    assert_eq!(different.len(), 13);
}

#[test]
fn surfaces_travel_and_turn() {
    let ramp = "velocity = [\"2 m/s\", 0, 0]\nramp = \"1 ms\"";
    let swing = "displacement = [0, \"3 mm\", 0]\nfrequency = \"50 Hz\"";
    let table = "displacement = [\"3 mm\", 0, 0]\ntable = [[0, 0], [\"1 ms\", 1], [\"3 ms\", 0.5]]";
    let rate = 100.0 * PI;
    for (more, axis, path, speed) in [
        (
            ramp,
            "x",
            "2e0*((time<1e-3)*time*time/2e-3+(time>=1e-3)*(time-5e-4))".to_owned(),
            "2e0*((time<1e-3)*time/1e-3+(time>=1e-3))".to_owned(),
        ),
        (
            swing,
            "y",
            format!("3e-3*(sin({rate:e}*time+(0e0))-(0e0))"),
            format!("3e-3*({rate:e}*cos({rate:e}*time+(0e0)))"),
        ),
        (
            table,
            "x",
            "3e-3*((time<0e0)*(0e0)+(time>=0e0)*(time<1e-3)*((0e0)+(1e3)*(time-(0e0)))+(time>=1e-3)*(time<3e-3)*((1e0)+(-2.5e2)*(time-(1e-3)))+(time>=3e-3)*(5e-1))".to_owned(),
            "3e-3*((time>=0e0)*(time<1e-3)*(1e3)+(time>=1e-3)*(time<3e-3)*(-2.5e2))".to_owned(),
        ),
    ] {
        let bench = Bench::new();
        bench.write("bin.stl", bin(0.05));
        bench.write("scene.toml", scene(more));
        let export = exported(&bench, "scene.toml");
        assert_eq!(
            export.said("fix_modify wall_1_1"),
            "move 1 variable v_wall_1_x v_wall_1_y v_wall_1_z v_wall_1_vx v_wall_1_vy v_wall_1_vz"
        );
        let formula = |name: &str| export.said(&format!("variable wall_1_{name} equal"));
        assert_eq!(formula(axis), format!("\"{path}\""));
        assert_eq!(formula(&format!("v{axis}")), format!("\"{speed}\""));
    }
    let bench = Bench::new();
    bench.write("bin.stl", bin(0.05));
    let turn = "pivot = [0, 0, 0.03]\nangular_velocity = [0, \"-10 rad/s\", 0]";
    bench.write("scene.toml", scene(turn));
    let export = exported(&bench, "scene.toml");
    let period = 0.2 * PI;
    assert_eq!(
        export.said("fix_modify wall_1_1"),
        format!("move 1 rotate 0e0 0e0 3e-2 0e0 -1e0 0e0 {period:e}")
    );
    for (more, expected) in [
        (
            "angular_velocity = [0, \"1 rad/s\", 0]\nramp = \"1 ms\"",
            "surfaces turn steadily about a point that stands",
        ),
        (
            "angular_velocity = [0, \"1 rad/s\", 0]\nvelocity = [1, 0, 0]",
            "surfaces turn steadily about a point that stands",
        ),
        (
            "surface_velocity = [\"1 m/s\", 0, 0]",
            "its walls have no belt",
        ),
        (
            "servo = { force = \"1 N\", direction = [0, 0, 1], max_velocity = \"1 m/s\" }",
            "takes no force as a target",
        ),
    ] {
        let bench = Bench::new();
        bench.write("bin.stl", bin(0.05));
        bench.write("scene.toml", scene(more));
        let said = refused_export(&bench, &["scene.toml"]);
        assert!(
            said.contains("walls.bin") && said.contains(expected),
            "{said}"
        );
        assert!(!bench.path("out").exists());
    }
}
