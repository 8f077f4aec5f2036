//! What a plan knows of moving walls: the step that follows them, their strokes, and the walls into
//! which they go.

use std::f64::consts::TAU;

use dem_plan::stroke_m;

use crate::helpers::{planned, try_planned};

const HEAD: &str = "version = 1
run = { end_time = 1, TIME }
materials.m = { density = 2000, young_modulus = 1e7 }
contacts = { m-m = { restitution = 0.5 } }
bodies.ball = { particles = [[0, 0, 5, 5e-3]], material = \"m\" }
";

fn scene(run: &str, walls: &[&str]) -> String {
    let walls = walls
        .iter()
        .map(|wall| format!("[walls.{wall}\nmaterial = \"m\"\n"));
    HEAD.replace("TIME", run) + &walls.collect::<String>()
}

/// The same with contacts that allow for long steps.
fn soft(text: String) -> String {
    text.replace("young_modulus = 1e7", "young_modulus = 1")
}

const ORBIT: &str =
    "orbit = { axis = [0, 1, 0], towards = [1, 0, 0], radius = 0.01, frequency = 50 }";

fn deck(motion: &str) -> String {
    format!("deck]\nbox = {{ min = [-1, -0.5, 0], max = [1, 0.5, 0.1] }}\n{motion}")
}

/// A rod of 1 m that hangs from the origin.
fn rod(motion: &str) -> String {
    format!("rod]\ncylinder = {{ from = [0, 0, -1], to = [0, 0, 0], radius = 1e-6 }}\n{motion}")
}

#[test]
fn an_automatic_step_follows_the_period_and_a_longer_one_is_refused() {
    let slow = ORBIT.replace("radius = 0.01", "radius = 1e-3");
    let text = |run: &str| soft(scene(run, &[&deck(&slow)]));
    let plan = planned(&text("safety_factor = 0.5"));
    assert!(plan.step.step_s <= 1e-3 && plan.step.step_s > 0.99e-3);
    assert_eq!(
        plan.step.limited_by[0].reason,
        "the period of a wall's motion"
    );
    assert_eq!(planned(&text("time_step = 1e-3")).step.step_s, 1e-3);
    let refused = try_planned(&text("time_step = 1.25e-3")).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "test.toml: [walls.deck]: its motion takes 20 ms for a period, which is 16 steps of run.time_step, 1.25 ms; at least 20 are needed; write time_step = \"auto\" or at most 1 ms, or a frequency of at most 40 Hz"
    );
}

/// A mantle that turns faster than it gyrates needs steps for its turns.
#[test]
fn a_spin_needs_its_steps_too() {
    let spin = "gyration = { axis = [0, 0, 1], towards = [1, 0, 0], angle = 0.01, frequency = 1, spin = \"3000 rpm\" }";
    let text = soft(scene("time_step = 1.2e-3", &[&rod(spin)]));
    let refused = try_planned(&text).unwrap_err().to_string();
    assert!(refused.contains("takes 20 ms for a period"), "{refused}");
    planned(&soft(scene("time_step = 1e-3", &[&rod(spin)])));
}

#[test]
fn strokes_are_those_of_the_farthest_point() {
    let swing = |phase: &str| {
        format!(
            "angular_displacement = {{ axis = [0, 1, 0], angle = 0.1 }}\nfrequency = 2\nphase = \"{phase}\""
        )
    };
    let lean = "gyration = { axis = [0, 0, -1], towards = [1, 0, 0], angle = 0.1, frequency = 2 }";
    let way = "displacement = [3e-3, 0, 4e-3]\nfrequency = 2";
    let pull = "displacement = [0, 0, 4e-3]\ntable = [[0, 0], [1, 0.5], [2, -0.5]]";
    for (wall, wanted_m) in [
        (rod(&swing("0 deg")), 2.0 * 0.1_f64.sin()),
        (rod(&swing("-90 deg")), 2.0 * 0.1_f64.sin()),
        (rod(lean), 2.0 * 0.1_f64.sin()),
        (rod(ORBIT), 0.02),
        (deck(way), 0.01),
        (deck(pull), 4e-3),
    ] {
        let mut state = planned(&scene("", &[&wall]).replace(", }", " }")).state;
        let got_m = stroke_m(&state.walls[0], 0.0).unwrap();
        assert!(
            (got_m - wanted_m).abs() < 1e-5,
            "{wall}: {got_m}, not {wanted_m}"
        );
        // It is the same wherever the wall is.
        super::go_until(&mut state, 0.0123);
        let later_m = stroke_m(&state.walls[0], state.time_s).unwrap();
        assert!((later_m - got_m).abs() < 1e-9, "{wall}: {later_m}, {got_m}");
    }
    let spins = "gyration = { axis = [0, 0, -1], towards = [1, 0, 0], angle = 0.1, frequency = 2, spin = 1 }";
    for endless in [deck("angular_velocity = [0, 1, 0]"), rod(spins)] {
        let state = planned(&scene("", &[&endless]).replace(", }", " }")).state;
        assert_eq!(stroke_m(&state.walls[0], 0.0), None);
    }
}

#[test]
fn a_motion_through_another_wall_is_doubtful() {
    let floor =
        |z_m: f64| format!("floor]\nplane = {{ point = [0, 0, {z_m}], normal = [0, 0, 1] }}");
    let side = |x_m: f64, more: &str| {
        format!("side]\nbox = {{ min = [{x_m}, -0.1, 0.02], max = [2, 0.1, 0.04] }}\n{more}")
    };
    let other = "orbit = { axis = [0, 1, 0], towards = [-1, 0, 0], radius = 0.01, frequency = 50 }";
    let slower = ORBIT.replace("50", "30");
    let swing = "angular_displacement = { axis = [0, 1, 0], angle = 0.1 }\nfrequency = 2";
    let [spin, back] = [
        "angular_velocity = [0, 3, 0]",
        "angular_velocity = [0, -3, 0]",
    ];
    let in_the_way = |x_m: f64, more: &str| {
        let side = side(x_m, more).replace("0.02]", "-0.06]");
        side.replace("0.04]", "0.06]")
    };
    for (walls, deep) in [
        (vec![deck(ORBIT), floor(-0.009)], Some("1 mm")),
        (vec![deck(ORBIT), floor(-0.011)], None),
        // They overlap at the start, as a jaw and the sides of its chamber do.
        (vec![deck(ORBIT), floor(0.01)], None),
        (vec![deck(ORBIT), side(1.012, "")], None),
        (vec![deck(other), side(1.015, ORBIT)], Some("5 mm")),
        (vec![deck(ORBIT), side(1.015, ORBIT)], None),
        (vec![deck(ORBIT), side(1.015, &slower)], Some("5 mm")),
        (
            vec![
                rod(swing),
                side(0.05, "")
                    .replace("0.02]", "-1.1]")
                    .replace("0.04]", "-0.9]"),
            ],
            Some("49.8"),
        ),
        (
            vec![
                rod(swing),
                side(0.1, "")
                    .replace("0.02]", "-1.1]")
                    .replace("0.04]", "-0.9]"),
            ],
            None,
        ),
        (vec![rod(spin), in_the_way(0.95, "")], Some("50 mm")),
        (vec![rod(spin), in_the_way(1.01, "")], None),
        // They turn together.
        (vec![rod(spin), in_the_way(0.95, spin)], None),
        (vec![rod(spin), in_the_way(0.95, back)], Some("50")),
    ] {
        let walls: Vec<&str> = walls.iter().map(String::as_str).collect();
        let plan = planned(&scene("", &walls).replace(", }", " }"));
        let said = plan
            .warnings
            .iter()
            .find(|said| said.contains("the motion of the wall"));
        match (said, deep) {
            (None, None) => {}
            (Some(said), Some(deep)) => assert!(said.contains(&format!("up to {deep}")), "{said}"),
            _ => panic!("{walls:?}: {said:?}, not {deep:?}"),
        }
    }
}

#[test]
fn a_frequency_in_rpm_without_its_unit_is_asked_for() {
    for (unit, asks) in [("Hz", true), ("rpm", false)] {
        let orbit = format!(
            "orbit = {{ axis = [0, 1, 0], towards = [1, 0, 0], radius = 4e-3, frequency = \"900 {unit}\" }}"
        );
        let plan = planned(&scene("", &[&deck(&orbit)]).replace(", }", " }"));
        let said = plan.warnings.iter().find(|said| said.contains("rpm?"));
        assert_eq!(said.is_some(), asks, "{:?}", plan.warnings);
        // (2 pi 900/s)^2 4 mm over 9.81 m/s2.
        assert!(
            said.is_none_or(|said| said.contains("13039 times gravity, 4 mm")),
            "{said:?}"
        );
    }
}

/// Walls stand where their motion begins, and go along their paths without drift.
#[test]
fn walls_keep_to_their_paths() {
    let lean = "pivot = [0, 0, 0.5]\nrotation = { axis = [0, 1, 0], angle = 0.2 }\ngyration = { axis = [0, 0, 1], towards = [1, 0, 0], angle = 0.1, frequency = 7 }";
    let text = soft(scene("time_step = 1e-4", &[&deck(ORBIT), &rod(lean)]));
    let mut state = planned(&text).state;
    let start = state.walls[0].frame.position_m;
    assert!(
        (start[0] - 0.01).abs() < 1e-17 && start[2].abs() < 1e-17,
        "{start:?}"
    );
    // Both rotations are about y.
    let turned = state.walls[1].frame.turned;
    assert!((turned[1] - 0.15_f64.sin()).abs() < 1e-15, "{turned:?}");
    super::go_until(&mut state, 0.7302);
    let angle = TAU * 50.0 * state.time_s;
    let wanted = [0.01 * angle.cos(), 0.0, -0.01 * angle.sin()];
    let off = [0, 1, 2].map(|k| (state.walls[0].frame.position_m[k] - wanted[k]).abs());
    assert!(off.iter().all(|off| *off < 1e-14), "{off:?}");
    let lower_end = state.walls[1].frame.to_space([0.0, 0.0, -1.5]);
    let leans = nalgebra::UnitQuaternion::from_scaled_axis(
        0.1 * nalgebra::Vector3::new(
            -(TAU * 7.0 * state.time_s).sin(),
            (TAU * 7.0 * state.time_s).cos(),
            0.0,
        ),
    );
    let drawn = nalgebra::UnitQuaternion::from_scaled_axis(0.2 * nalgebra::Vector3::y());
    let wanted = leans * drawn * nalgebra::Vector3::new(0.0, 0.0, -1.5);
    let off = (nalgebra::Vector3::from(lower_end) - nalgebra::Vector3::new(0.0, 0.0, 0.5) - wanted)
        .norm();
    assert!(off < 1e-12, "{off:e}");
}
