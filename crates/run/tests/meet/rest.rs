//! The depth of a sphere at rest on walls of every type is that of the closed form, and tunnelling
//! is detected.

use std::fmt::Write;
use std::path::Path;

use dem_engine::step::step;
use dem_plan::Plan;
use dem_plan::time_step::impact_step_s;

use super::apart::planned;

const RADIUS_M: f64 = 5e-3;
const HALF_M: f64 = 0.02;

/// A sphere on the highest point of a wall, at the origin.
fn scene(wall: &str) -> String {
    format!(
        "version = 1\nrun.end_time = 1\nrun.safety_factor = 0.2\nrun.gravity = [0, 0, -9.81]\n\
         materials.glass = {{ density = 2500, young_modulus = \"50 MPa\", poisson_ratio = 0.25 }}\n\
         contacts.glass-glass = {{ restitution = 0.05, friction = 0.5 }}\n\
         bodies.ball = {{ particles = [[0, 0, {RADIUS_M}, {RADIUS_M}]], material = \"glass\" }}\n\
         [walls.ground]\nmaterial = \"glass\"\n{wall}\n"
    )
}

/// A cube around a point as triangles of an STL file, several for each square.
fn cube_stl(folder: &Path, centre: [f64; 3]) -> String {
    let mut text = "solid cube\n".to_owned();
    let parts = 4;
    let at = |n: usize| -1.0 + 2.0 * n as f64 / f64::from(parts);
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            for i in 0..parts as usize {
                for j in 0..parts as usize {
                    let corner = |di: usize, dj: usize| {
                        let mut p = [side; 3];
                        p[(axis + 1) % 3] = at(i + di);
                        p[(axis + 2) % 3] = at(j + dj);
                        [0, 1, 2].map(|k| centre[k] + HALF_M * p[k])
                    };
                    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    for triangle in [[a, b, c], [a, c, d]] {
                        text += "facet normal 0 0 0\nouter loop\n";
                        for [x, y, z] in triangle {
                            let _ = writeln!(text, "vertex {x:e} {y:e} {z:e}");
                        }
                        text += "endloop\nendfacet\n";
                    }
                }
            }
        }
    }
    text += "endsolid cube\n";
    let path = folder.join("cube.stl");
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

/// A free-standing cube, rotated such that a face, an edge or a corner is up at the origin.
fn cube_walls(folder: &Path) -> Vec<(&'static str, String)> {
    let mut walls = Vec::new();
    let turns = [
        (1.0, ""),
        (
            2.0_f64.sqrt(),
            "rotation = { axis = [0, 1, 0], angle = \"45 deg\" }",
        ),
        (
            3.0_f64.sqrt(),
            "rotation = { axis = [1, -1, 0], angle = 0.9553166181245093 }",
        ),
    ];
    for (up, turn) in turns {
        let depth = up * HALF_M;
        let [low, high] = [-depth - HALF_M, -depth + HALF_M];
        let pivot = format!("pivot = [0, 0, {}]\n{turn}", -depth);
        let solid = format!(
            "box = {{ min = [-{HALF_M}, -{HALF_M}, {low}], max = [{HALF_M}, {HALF_M}, {high}] }}\n{pivot}"
        );
        walls.push(("box", solid));
        let sub = folder.join(format!("{up}"));
        std::fs::create_dir(&sub).unwrap();
        let stl = cube_stl(&sub, [0.0, 0.0, -depth]);
        walls.push(("mesh", format!("stl = {stl:?}\nunit = \"m\"\n{pivot}")));
    }
    walls
}

#[test]
fn a_sphere_rests_as_deep_as_hertz_says() {
    let folder = tempfile::tempdir().unwrap();
    let mut walls = cube_walls(folder.path());
    walls.push((
        "plane",
        "plane = { point = [0, 0, 0], normal = [0, 0, 1] }".to_owned(),
    ));
    let pin = format!(
        "cylinder = {{ from = [0, -0.1, -{RADIUS_M}], to = [0, 0.1, -{RADIUS_M}], radius = {RADIUS_M} }}"
    );
    walls.push(("pin", pin));
    let mass_kg = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS_M.powi(3);
    let modulus_pa = 50e6 / (1.0 - 0.25 * 0.25) / 2.0;
    let depth_m = (mass_kg * 9.81 / (4.0 / 3.0 * modulus_pa * RADIUS_M.sqrt())).powf(2.0 / 3.0);
    for (name, wall) in walls {
        let Plan { mut state, .. } = planned(&scene(&wall));
        while state.time_s < 0.05 {
            step(&mut state);
        }
        let sunk_m = RADIUS_M - state.particles.poses[0].position_m[2];
        let off = sunk_m / depth_m - 1.0;
        eprintln!("{name}: {sunk_m:e} m, off by {off:.1e}");
        assert!(off.abs() < 1e-6, "{name}: {wall}: {off:e}");
        let push_n = state.walls[0].push.force_n[2];
        assert!((push_n / (mass_kg * 9.81) - 1.0).abs() < 1e-6, "{name}");
    }
}

#[test]
fn a_servo_pushes_as_hard_as_it_is_told() {
    let text = "version = 1\nrun.end_time = 1\nrun.time_step = 4e-6\n\
         materials.glass = { density = 2500, young_modulus = \"50 MPa\" }\n\
         contacts.glass-glass = { restitution = 0.2, friction = 0.5 }\n\
         bodies.ball = { particles = [[0, 0, 5e-3, 5e-3]], material = \"glass\" }\n\
         walls.ground = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"glass\" }\n\
         walls.press = { plane = { point = [0, 0, 10.1e-3], normal = [0, 0, -1] }, material = \"glass\", \
         servo = { force = 2.5, direction = [0, 0, -1], max_velocity = 0.02 } }\n";
    let Plan { mut state, .. } = planned(text);
    while state.time_s < 0.1 {
        step(&mut state);
    }
    for (wall, sign) in state.walls.iter().zip([1.0, -1.0]) {
        let push_n = sign * wall.push.force_n[2];
        assert!((push_n / 2.5 - 1.0).abs() < 1e-6, "{push_n} N");
    }
    let p = state.walls[1].frame.position_m[2];
    assert!(p < 0.0 && p > -1e-3, "moved by {p} m from its pivot");
}

#[test]
fn a_particle_that_is_pushed_through_a_wall_is_caught() {
    let plate = "plane = { point = [0, 0, 0], normal = [0, 0, 1] }";
    let text = scene(plate).replace("50 MPa", "50 Pa");
    let Plan { mut state, .. } = planned(&text);
    for _ in 0..200_000 {
        step(&mut state);
        if state.walls[0].scratch.crossed.is_some() {
            break;
        }
    }
    assert_eq!(state.walls[0].scratch.crossed, Some(0));
}

/// A wall thinner than the particle has two sides at once: without detection the far one pushed the
/// particle out behind it, at full speed.
#[test]
fn a_particle_that_is_shot_through_a_thin_wall_is_caught() {
    for wall in [
        "box = { min = [-1, -1, -1e-3], max = [1, 1, 0] }",
        "cylinder = { from = [-1, 0, -1e-3], to = [1, 0, -1e-3], radius = 1e-3 }",
    ] {
        let text = scene(wall).replace("restitution = 0.05", "restitution = 1");
        let text = text.replace("0, 0, 0.005,", "1e-4, 2e-4, 0.006,");
        let text = text.replace(
            "bodies.ball = { ",
            "bodies.ball = { velocity = [0, 0, -200], ",
        );
        let Plan { mut state, .. } = planned(&text);
        while state.walls[0].scratch.crossed.is_none() && state.particles.poses[0].place().z > -0.1
        {
            step(&mut state);
            assert!(state.time_s < 1e-2, "{wall}: it came back");
        }
        assert_eq!(state.walls[0].scratch.crossed, Some(0), "{wall}");
    }
}

#[test]
fn impacts_of_walls_that_turn_and_ramp_are_foreseen() {
    let head = "version = 1\nrun.end_time = 0.2\n\
         materials.glass = { density = 2500, young_modulus = \"50 MPa\" }\n\
         contacts.glass-glass = { restitution = 0.5 }\n\
         bodies.ball = { particles = [[0.05, 0, 0.02, 5e-3]], material = \"glass\" }\n\
         [walls.paddle]\nbox = { min = [-0.1, -0.1, -0.01], max = [0.1, 0.1, 0] }\nmaterial = \"glass\"\n";
    let step_of = |motion: &str| {
        let Plan { state, step, .. } = planned(&format!("{head}{motion}\n"));
        (state.time_step_s, step.impact_speed_m_s)
    };
    for (motion, least_m_s) in [
        ("angular_velocity = [0, -10, 0]", 0.5),
        ("displacement = [0, 0, 0.05]\nramp = 0.1", 0.5),
        (
            "angular_displacement = { axis = [0, 1, 0], angle = \"-45 deg\" }\nramp = 0.1",
            0.39,
        ),
    ] {
        let (step_s, speed_m_s) = step_of(motion);
        assert!(
            speed_m_s >= least_m_s && speed_m_s < 2.0 * least_m_s,
            "{motion}: {speed_m_s} m/s"
        );
        assert!(step_s < 1e-4, "{motion}: {step_s} s");
    }
}

/// The step allowed by impacts is scaled by `safety` like that for stability.
#[test]
fn half_the_safety_halves_the_step_of_impacts() {
    let plate = "plane = { point = [0, 0, -1], normal = [0, 0, 1] }";
    let hertz = scene(plate).replace("run.safety_factor = 0.2\n", "");
    let linear = hertz.replace(
        "friction",
        "law = \"linear\", normal_stiffness = 1e5, friction",
    );
    for text in [hertz, linear] {
        let with = |safety: f64| {
            let safety = format!("run.end_time = 1\nrun.safety_factor = {safety}");
            planned(&text.replace("run.end_time = 1", &safety))
        };
        let usual = planned(&text);
        assert_eq!(with(0.9).step, usual.step);
        assert!(
            usual.step.step_s < 0.5 * usual.step.foreseen_s,
            "an impact decides"
        );
        let speed_m_s = usual.step.impact_speed_m_s;
        for fraction in [0.5, 0.1] {
            let found = with(0.9 * fraction);
            // The end time is reached exactly.
            let ratio = found.step.step_s / usual.step.step_s;
            assert!((ratio / fraction - 1.0).abs() < 1e-3, "{fraction}: {ratio}");
            let in_run = [0.9 * fraction, 0.9]
                .map(|safety| impact_step_s(&found.state, speed_m_s, safety, 0.01));
            assert!((in_run[0] / in_run[1] / fraction - 1.0).abs() < 1e-14);
        }
    }
}
