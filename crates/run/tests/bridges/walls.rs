//! A sphere and a wall.

use dem_engine::state::State;

use super::{
    RADIUS_M, WATER, assert_near, ball, bridges, head, mass_kg, started, step_and_balance,
};

const FLOOR: &str =
    "[walls.floor]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = \"glass\"\n";

/// A wet sphere on a floor that sinks at 1 mm/s while the sphere is held.
fn held() -> State {
    started(&format!(
        "{}{}{}velocity = [0, 0, -1e-3]\n[supports.a]\ngroup = \"a\"\nfixed = [\"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"]\n",
        head(1.0, 1.0, "initial_overlap = \"keep\", time_step = 5e-6"),
        ball("a", [0.0, 0.0, RADIUS_M - 1e-8], [0.0; 3]),
        FLOOR
    ))
}

/// The pull of a wall is 4 pi R gamma cos(theta), twice that of an equal sphere.
#[test]
fn a_floor_that_sinks_pulls_with_the_force_of_the_closed_form() {
    let mut state = held();
    let (mut largest_n, mut last_m) = (0.0_f64, 0.0);
    while state.time_s < 0.12 {
        let balance = step_and_balance(&mut state);
        largest_n = largest_n.max(-state.walls[0].total_load()[0][2]);
        if let Some(bridge) = bridges(&state).walls.first() {
            last_m = bridge.gap_m;
            assert_eq!(bridge.normal, [0.0, 0.0, 1.0]);
        }
        let scale_j = WATER.work_j(RADIUS_M);
        assert!(balance.energy_error_j.abs() < 1e-3 * scale_j, "{balance:?}");
    }
    assert_near(largest_n, WATER.largest_n(RADIUS_M), 1e-12);
    assert_near(last_m, WATER.rupture_m(), 1e-4);
    assert_eq!(bridges(&state).formed_and_ruptured, [1, 1]);
    let lost_j = bridges(&state).lost_j;
    assert_near(lost_j, WATER.work_j(RADIUS_M), 1e-3);
}

/// The critical speed of a sphere that hits a wall.
#[test]
fn a_slow_sphere_stays_at_a_wall_and_a_fast_one_leaves() {
    let critical_m_s = (2.0 * WATER.work_j(RADIUS_M) / mass_kg()).sqrt();
    for (share, leaves) in [(0.99, false), (1.01, true)] {
        let speed = share * critical_m_s;
        let text = |run: &str| {
            let place = [0.0, 0.0, RADIUS_M + 1e-7];
            format!(
                "{}{}{FLOOR}",
                head(1.0, 1.0, run),
                ball("a", place, [0.0, 0.0, -speed])
            )
        };
        let step_s = started(&text("safety_factor = 0.9")).time_step_s / 4.0;
        let mut state = started(&text(&format!("time_step = {step_s:e}")));
        let mut highest_m = 0.0_f64;
        while state.time_s < 4.0 * WATER.rupture_m() / (0.1 * critical_m_s) {
            step_and_balance(&mut state);
            highest_m = highest_m.max(state.particles.poses[0].place().z - RADIUS_M);
        }
        assert_eq!(
            highest_m > WATER.rupture_m(),
            leaves,
            "{share}: {highest_m:e}"
        );
        assert_eq!(bridges(&state).formed_and_ruptured[1], u64::from(leaves));
    }
}

/// A sphere hangs below a ceiling: weight, pull and the elastic force are in balance. Without
/// liquid it falls.
#[test]
fn a_sphere_hangs_from_a_ceiling() {
    let scene = |volume: &str| {
        let head = head(
            1.0,
            0.2,
            "gravity = [0, 0, -9.81], initial_overlap = \"keep\"",
        );
        format!(
            "{}{}[walls.ceiling]\nplane = {{ point = [0, 0, 0], normal = [0, 0, -1] }}\nmaterial = \"glass\"\n",
            head.replace("1e-3 mm3", volume),
            ball("a", [0.0, 0.0, 1e-8 - RADIUS_M], [0.0; 3])
        )
    };
    let mut state = started(&scene("1e-3 mm3"));
    while state.time_s < 0.05 {
        step_and_balance(&mut state);
    }
    assert!(mass_kg() * 9.81 < WATER.largest_n(RADIUS_M));
    let up_n = state.walls[0].total_load()[0][2];
    assert_near(up_n, mass_kg() * 9.81, 1e-6);
    assert!(
        state.particles.poses[0].place().z > -RADIUS_M,
        "pressed against the ceiling"
    );
}

/// A sphere that rolls over the triangles of a flat plate takes its bridge along: none forms anew.
#[test]
fn a_bridge_moves_along_a_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plate.stl");
    let mut text = "solid plate\n".to_owned();
    let corner =
        |i: i32, j: i32| format!("vertex {} {} 0\n", 1e-3 * f64::from(i), 1e-3 * f64::from(j));
    for i in -2..12 {
        for j in -2..2 {
            for [a, b, c] in [[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]] {
                text.push_str("facet normal 0 0 1\nouter loop\n");
                for (x, y) in [a, b, c] {
                    text.push_str(&corner(i + x, j + y));
                }
                text.push_str("endloop\nendfacet\n");
            }
        }
    }
    std::fs::write(&path, text + "endsolid plate\n").unwrap();
    let speed = 0.2;
    let mut state = started(&format!(
        "{}{}angular_velocity = [0, {}, 0]\n[walls.plate]\nstl = {:?}\nunit = \"m\"\nmaterial = \"glass\"\n",
        head(
            1.0,
            0.2,
            "gravity = [0, 0, -9.81], initial_overlap = \"keep\""
        ),
        ball("a", [1e-4, 2e-4, RADIUS_M - 1e-7], [speed, 0.0, 0.0]),
        speed / RADIUS_M,
        path
    ));
    while state.particles.poses[0].place().x < 8e-3 {
        step_and_balance(&mut state);
        assert_eq!(bridges(&state).walls.len(), 1);
        assert!(state.time_s < 0.1);
    }
    assert_eq!(bridges(&state).formed_and_ruptured, [1, 0]);
}

/// Where two boxes meet, a bridge goes over from one to the other: there is one all the time, none
/// is formed or lost, and the sphere moves as over one box.
#[test]
fn a_bridge_goes_over_a_joint_of_walls() {
    let run = |boxes: &[[f64; 2]]| {
        let walls = boxes.iter().zip(["a", "b", "c"]).map(|([from, to], name)| {
            format!("walls.{name} = {{ box = {{ min = [{from:?}, -1, -1], max = [{to:?}, 1, 0] }}, material = \"glass\" }}\n")
        });
        let mut state = started(&format!(
            "{}{}{}",
            head(1.0, 0.5, "initial_overlap = \"keep\", time_step = 5e-6").replace(
                "[contacts.glass-glass]\n",
                &(walls.collect::<String>() + "[contacts.glass-glass]\n")
            ),
            ball("ball", [-2e-3, 0.0, RADIUS_M - 1e-8], [0.1, 0.02, 0.0]),
            "",
        ));
        let mut count = 0;
        while state.time_s < 0.05 {
            step_and_balance(&mut state);
            count = count.max(bridges(&state).walls.len());
        }
        assert_eq!(count, 1);
        assert_eq!(bridges(&state).formed_and_ruptured, [1, 0]);
        let friction_j: f64 = state.walls.iter().map(|wall| wall.friction_j).sum();
        let (place, lost_j) = (state.particles.poses[0].place(), bridges(&state).lost_j);
        (place, friction_j, lost_j, step_and_balance(&mut state))
    };
    let (place, friction_j, lost_j, balance) = run(&[[-1.0, 1.0]]);
    assert!(place.x > 1e-3, "it has crossed the joint: {place}");
    for boxes in [
        &[[-1.0, 0.0], [0.0, 1.0]][..],
        &[[0.0, 1.0], [-1.0, 0.0]],
        &[[-1.0, -1e-3], [-1e-3, 2e-4], [2e-4, 1.0]],
    ] {
        let (other, other_friction_j, other_lost_j, other_balance) = run(boxes);
        assert!((other - place).norm() < 1e-6 * RADIUS_M, "{other} {place}");
        assert_near(other_friction_j, friction_j, 1e-6);
        assert_near(other_lost_j, lost_j, 1e-6);
        let off_j = other_balance.energy_error_j - balance.energy_error_j;
        assert!(off_j.abs() < 1e-6 * WATER.work_j(RADIUS_M), "{off_j:e}");
    }
}
