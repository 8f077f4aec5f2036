//! Walls that meet act as one surface, and so do the facets of a rough one.

use std::fmt::Write;
use std::fs;

use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{advance, interact};
use nalgebra::Vector3;
use tempfile::TempDir;

use crate::helpers::started;
use dem_testing::Random;

const HEAD: &str = "version = 1
run = { end_time = 1, time_step = \"1 us\" }
materials.glass = { density = 2500, young_modulus = \"50 MPa\", poisson_ratio = 0.25 }
";
const HERTZ: &str = "contacts.glass-glass = { restitution = 1, friction = 0.3 }\n";
const LINEAR: &str = "contacts.glass-glass = { law = \"linear\", normal_stiffness = \"50 kN/m\", \
                      restitution = 0.7, friction = 0.3 }\n";
/// A plane, and half spaces as boxes: left and right of x = 0, and the right one halved at y = 0.
const PLANE: &str =
    "walls.p = { material = \"glass\", plane = { point = [0, 0, 0], normal = [0, 0, 1] } }\n";
const LEFT: &str =
    "walls.l = { material = \"glass\", box = { min = [-1, -1, -0.1], max = [0, 1, 0] } }\n";
const RIGHT: &str =
    "walls.r = { material = \"glass\", box = { min = [0, -1, -0.2], max = [1, 1, 0] } }\n";

fn of_wall(name: &str, shape: &str) -> String {
    format!("walls.{name} = {{ material = \"glass\", {shape} }}\n")
}

/// A sphere of 5 mm at a place, mm, with a velocity, m/s.
fn ball(at_mm: [f64; 3], velocity_m_s: [f64; 3]) -> String {
    let [x, y, z] = at_mm.map(|x| 1e-3 * x);
    format!(
        "bodies.ball = {{ material = \"glass\", velocity = {velocity_m_s:?}, \
         particles = [[{x}, {y}, {z}, 5e-3]] }}\n"
    )
}

/// What a run shows: the largest force of all walls together along z, N; the largest number of
/// contacts; the largest energy error; the state at its end.
struct Seen {
    peak_n: f64,
    contacts: usize,
    energy_error: f64,
    state: State,
}

fn runs(text: &str, time_s: f64) -> Seen {
    let mut state = started(text);
    let (mut peak_n, mut contacts, mut energy_error) = (0.0_f64, 0, 0.0_f64);
    while state.time_s < time_s {
        interact(&mut state);
        let pushes = state.walls.iter().map(|wall| wall.push.force_n[2]);
        let push_n: f64 = pushes.sum();
        // What acts on the particles is what the walls exert.
        let wrenches = state.particles.wrenches.iter();
        let on_particles: f64 = wrenches.map(|wrench| wrench.force_n[2]).sum();
        if state.bonds.is_empty() && state.clumps.all.is_empty() {
            assert!((push_n - on_particles).abs() <= 1e-12 * push_n.abs());
        }
        peak_n = peak_n.max(push_n);
        contacts = contacts.max(state.walls.iter().map(|wall| wall.touching.len()).sum());
        if state.steps.is_multiple_of(10) {
            energy_error = energy_error.max(balance(&mut state).energy_error.abs());
        }
        advance(&mut state);
    }
    Seen {
        peak_n,
        contacts,
        energy_error,
        state,
    }
}

/// Writes triangles as an STL file in mm.
fn stl(folder: &TempDir, name: &str, triangles: &[[[f64; 3]; 3]]) -> String {
    let mut text = "solid made\n".to_owned();
    for corners in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in corners {
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text += "endsolid made\n";
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    format!("stl = {:?}, unit = \"mm\"", path.display().to_string())
}

/// A tile between two corners, mm, of squares of this size with these heights.
fn tile(
    [x0, y0, x1, y1]: [f64; 4],
    size: f64,
    mut height: impl FnMut() -> f64,
) -> Vec<[[f64; 3]; 3]> {
    let [nx, ny] = [(x1 - x0) / size, (y1 - y0) / size].map(|n| n.round() as usize);
    let heights: Vec<Vec<f64>> = (0..=nx)
        .map(|_| (0..=ny).map(|_| height()).collect())
        .collect();
    let at = |i: usize, j: usize| [x0 + size * i as f64, y0 + size * j as f64, heights[i][j]];
    let squares = (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j)));
    let halves = squares.flat_map(|(i, j)| {
        [
            [at(i, j), at(i + 1, j), at(i + 1, j + 1)],
            [at(i, j), at(i + 1, j + 1), at(i, j + 1)],
        ]
    });
    halves.collect()
}

#[test]
fn a_joint_of_walls_pushes_like_a_plane() {
    let folder = TempDir::new().unwrap();
    let flat = |name: &str, corners: [f64; 4]| {
        of_wall(
            name,
            &stl(
                &folder,
                &format!("{name}.stl"),
                &tile(corners, 10.0, || 0.0),
            ),
        )
    };
    let [tile_l, tile_r] = [
        flat("tl", [-20.0, -20.0, 0.0, 20.0]),
        flat("tr", [0.0, -20.0, 20.0, 20.0]),
    ];
    let quarters = of_wall("ra", "box = { min = [0, 0, -0.1], max = [1, 1, 0] }")
        + &of_wall("rb", "box = { min = [0, -1, -0.3], max = [1, 0, 0] }");
    let column = of_wall(
        "c",
        "cylinder = { from = [0.02, 0, -0.1], to = [0.02, 0, 0], radius = 0.02 }",
    );
    // A hair beside and below: written with few digits, or in single precision.
    let nearly = of_wall("r", "box = { min = [2e-7, -1, -0.1], max = [1, 1, -1e-7] }");
    let turned = of_wall(
        "r",
        "box = { min = [0, -1, 0], max = [0.1, 1, 1] }, rotation = { axis = [0, 1, 0], angle = \"90 deg\" }",
    );
    let floors = [
        ("boxes", format!("{LEFT}{RIGHT}")),
        ("three boxes", format!("{LEFT}{quarters}")),
        ("box in a plane", format!("{PLANE}{LEFT}")),
        ("tile beside a box", format!("{LEFT}{tile_r}")),
        ("tile beside a tile", format!("{tile_l}{tile_r}")),
        ("column in a plane", format!("{PLANE}{column}")),
        ("column and box", format!("{LEFT}{column}")),
        ("nearly", format!("{LEFT}{nearly}")),
        ("turned", format!("{LEFT}{turned}")),
    ];
    for law in [HERTZ, LINEAR] {
        for x in [-2.5, -1.0, -0.1, 0.0, 1e-9, 0.3, 1.7] {
            let ball = ball([x, 0.0, 5.02], [0.0, 0.0, -1.0]);
            let alone = runs(&format!("{HEAD}{law}{ball}{PLANE}"), 2e-3);
            for (name, floor) in &floors {
                if *name == "column and box" && x > 0.0 {
                    // Over the round rim there is less than a plane.
                    continue;
                }
                let seen = runs(&format!("{HEAD}{law}{ball}{floor}"), 2e-3);
                let ratio = seen.peak_n / alone.peak_n;
                assert!((ratio - 1.0).abs() < 1e-3, "{name} at {x}: {ratio}");
                assert_eq!(seen.contacts, 1, "{name} at {x}");
                let errors = [seen.energy_error, alone.energy_error];
                assert!(errors[0] < errors[1] + 1e-4, "{name} at {x}: {errors:?}");
            }
        }
    }
}

/// From belt to belt, as over one: not even the spin shows where the joint is.
#[test]
fn a_sphere_rides_from_wall_to_wall_as_over_one() {
    let rides = |walls: &str| {
        let ball = ball([-3.0, 0.0, 5.0], [0.5, 0.1, 0.0]);
        let contact = "contacts.glass-glass = { restitution = 0.3, friction = 0.5, rolling_friction = 0.05 }\n";
        let text = format!("{HEAD}{contact}{ball}{walls}").replace(
            "time_step = \"1 us\" }",
            "time_step = \"1 us\", gravity = [0, 0, -9.81], initial_overlap = \"keep\" }",
        );
        runs(&text, 15e-3)
    };
    let belt = ", surface_velocity = [1, 0, 0]";
    let belts = |boxes: &[&str]| -> String {
        let all = boxes.iter().zip(["a", "b", "c"]);
        all.map(|(shape, name)| of_wall(name, &format!("box = {shape}{belt}")))
            .collect()
    };
    let one = rides(&belts(&["{ min = [-1, -1, -0.1], max = [1, 1, 0] }"]));
    let several = [
        belts(&[
            "{ min = [-1, -1, -0.1], max = [0, 1, 0] }",
            "{ min = [0, -1, -0.1], max = [1, 1, 0] }",
        ]),
        belts(&[
            "{ min = [0, -1, -0.1], max = [1, 1, 0] }",
            "{ min = [-1, -1, -0.1], max = [-0.001, 1, 0] }",
            "{ min = [-0.001, -1, -0.1], max = [0, 1, 0] }",
        ]),
    ];
    let last = |seen: &Seen| {
        let p = &seen.state.particles;
        let motion = &p.motions[0];
        [
            p.poses[0].place(),
            Vector3::from(motion.velocity_m_s),
            Vector3::from(motion.spin_rad_s),
        ]
    };
    assert!(last(&one)[0].x > 4e-3, "it has crossed the joint");
    for walls in several {
        let seen = rides(&walls);
        assert_eq!(seen.contacts, 1);
        for (now, wanted) in last(&seen).iter().zip(last(&one)) {
            assert!(
                (now - wanted).norm() < 1e-9 * (1.0 + wanted.norm()),
                "{now} {wanted}"
            );
        }
        assert!((seen.peak_n / one.peak_n - 1.0).abs() < 1e-9);
        let lost = |seen: &Seen| -> f64 {
            let walls = seen.state.walls.iter();
            walls.map(|wall| wall.friction_j + wall.damping_j).sum()
        };
        assert!((lost(&seen) / lost(&one) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn sides_of_a_corner_and_steps_push_each() {
    let high = of_wall("h", "box = { min = [-1, -1, 0], max = [0, 1, 1] }");
    let step = of_wall("h", "box = { min = [-1, -1, 0], max = [0, 1, 1e-3] }");
    let slope = of_wall("s", "plane = { point = [0, 0, 0], normal = [0.25, 0, 1] }");
    // The depth of 0.05 mm in both.
    let beside = [
        ("corner", high, 4.95),
        ("step", step, 2.9),
        ("slope", slope, 0.6),
    ];
    for (name, wall, x) in beside {
        let ball = ball([x, 0.0, 4.95], [0.0; 3]);
        let text = format!("{HEAD}{HERTZ}{ball}{wall}{PLANE}");
        let text = text.replace("\"1 us\" }", "\"1 us\", initial_overlap = \"keep\" }");
        assert_eq!(runs(&text, 2e-6).contacts, 2, "{name}");
    }
}

#[test]
fn a_convex_edge_of_two_walls_is_the_edge_of_one() {
    let slab = of_wall("a", "box = { min = [-1, -1, -0.1], max = [0, 1, 0] }");
    let side = of_wall("b", "box = { min = [-0.05, -1, -1], max = [0, 1, 0] }");
    let below = of_wall("b", "box = { min = [-0.05, -1, -1], max = [0, 1, -0.1] }");
    let one = of_wall("a", "box = { min = [-1, -1, -1], max = [0, 1, 0] }");
    for x in [-0.5, 0.5, 2.0] {
        let ball = ball([x, 0.0, 5.0], [0.0, 0.0, -1.0]);
        let alone = runs(&format!("{HEAD}{HERTZ}{ball}{one}"), 2e-3);
        assert!(alone.peak_n > 1.0);
        for more in [&side, &below] {
            let seen = runs(&format!("{HEAD}{HERTZ}{ball}{slab}{more}"), 2e-3);
            assert_eq!(seen.contacts, 1, "{x}");
            assert!((seen.peak_n / alone.peak_n - 1.0).abs() < 1e-9, "{x}");
        }
    }
}

/// Bodies of several spheres land on a joint as on a plane.
#[test]
fn clumps_and_bonded_bodies_land_on_a_joint_as_on_a_plane() {
    let spheres = "particles = [[-4e-3, 0, 0.0052, 5e-3], [4e-3, 0, 0.0051, 5e-3], \
                   [0, 6e-3, 0.0052, 5e-3]]";
    let bodies = [
        format!(
            "bodies.b = {{ material = \"glass\", velocity = [0, 0, -0.5], start_as = \"clump\", {spheres} }}\n"
        ),
        format!(
            "bonds.glass = {{ young_modulus = \"1 GPa\", poisson_ratio = 0.25 }}\n\
             bodies.b = {{ material = \"glass\", bonds = \"glass\", velocity = [0, 0, -0.5], \
             {spheres}, bond_list = [[0, 1], [1, 2], [2, 0]] }}\n"
        ),
    ];
    for body in bodies {
        let [plane, joint] = [PLANE.to_owned(), format!("{LEFT}{RIGHT}")].map(|walls| {
            let text = format!("{HEAD}{LINEAR}{body}{walls}").replace("1 us", "0.5 us");
            runs(&text, 2e-3)
        });
        assert!(plane.peak_n > 1.0);
        assert!((joint.peak_n / plane.peak_n - 1.0).abs() < 1e-6, "{body}");
        let poses = joint
            .state
            .particles
            .poses
            .iter()
            .zip(&plane.state.particles.poses);
        for (now, wanted) in poses {
            assert!((now.place() - wanted.place()).norm() < 1e-9, "{body}");
        }
    }
}

/// Noise of 0.01 mm, a twentieth of the overlap, on facets of various sizes, in one file and in
/// two: within 1 % of the plane.
#[test]
fn a_rough_scan_of_a_plane_pushes_like_a_plane() {
    let folder = TempDir::new().unwrap();
    let drop = |floor: &str, x: f64| {
        let ball = ball([x, 0.2 * x, 5.03], [0.0, 0.0, -1.0]);
        runs(&format!("{HEAD}{HERTZ}{ball}{floor}"), 2e-3)
    };
    let plane = drop(PLANE, 0.0);
    let mut random = Random(4);
    for size in [1.0, 0.5, 0.25] {
        let mut rough = |corners: [f64; 4]| tile(corners, size, || random.within(-0.01, 0.01));
        let whole = of_wall("w", &stl(&folder, "w.stl", &rough([-6.0, -6.0, 6.0, 6.0])));
        let halves = of_wall("l", &stl(&folder, "l.stl", &rough([-6.0, -6.0, 0.0, 6.0])))
            + &of_wall("r", &stl(&folder, "r.stl", &rough([0.0, -6.0, 6.0, 6.0])));
        for floor in [whole, halves] {
            for x in [0.0, 0.37, -0.61] {
                let seen = drop(&floor, x);
                let ratio = seen.peak_n / plane.peak_n;
                assert!((ratio - 1.0).abs() < 0.01, "{size} mm at {x}: {ratio}");
            }
        }
    }
}
