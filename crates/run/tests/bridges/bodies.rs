//! What else must know of bridges: clumps, sleep, outlets, and scenes that are dry.

use dem_engine::state::State;

use super::{
    RADIUS_M, WATER, assert_near, ball, bridges, head, mass_kg, started, step_and_balance,
};

const FLOOR: &str =
    "[walls.floor]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = \"glass\"\n";

#[test]
fn a_dry_scene_has_no_bridges() {
    let text = format!(
        "{}{}{FLOOR}",
        head(1.0, 0.5, ""),
        ball("a", [0.0, 0.0, 2e-3], [0.0; 3])
    );
    let dry: String = text
        .lines()
        .filter(|line| !line.starts_with("liquid"))
        .map(|line| format!("{line}\n"))
        .collect();
    assert!(started(&dry).bridges.is_none());
    assert!(started(&text).bridges.is_some());
}

/// A large volume, whose bridges reach farther than the list of near pairs.
fn far(text: &str) -> String {
    text.replace("1e-3 mm3", "0.3 mm3")
}

/// The spheres of a clump that a bridge holds move on, although nothing is near them.
#[test]
fn a_bridge_pulls_at_a_clump_beyond_the_skin() {
    let clump = format!(
        "[bodies.rod]\nmaterial = \"glass\"\nstart_as = \"clump\"\nposition = [0, 0, {:e}]\n\
         particles = [[0, 0, 0, {RADIUS_M:e}], [0, 0, {:e}, {RADIUS_M:e}]]\nvelocity = [0, 0, 0.2]\n",
        2.0 * RADIUS_M - 1e-8,
        1.9 * RADIUS_M
    );
    let mut state = started(&format!(
        "{}{}{clump}[search]\nskin = 0.02\n",
        far(&head(
            1.0,
            1.0,
            "initial_overlap = \"keep\", safety_factor = 0.3"
        )),
        ball("a", [0.0; 3], [0.0, 0.0, -0.2])
    ));
    let volume = dem_physics::contact::liquid_bridge::LiquidBridge {
        volume_m3: 3e-10,
        ..WATER
    };
    assert!(volume.rupture_m() > 0.5 * RADIUS_M);
    let mut largest_m = 0.0_f64;
    while bridges(&state).formed_and_ruptured[1] == 0 {
        let balance = step_and_balance(&mut state);
        assert!(balance.energy_error.abs() < 1e-3, "{balance:?}");
        assert!(balance.momentum_error < 1e-12);
        if let Some(bridge) = bridges(&state).pairs.first() {
            largest_m = largest_m.max(bridge.gap_m);
        }
        assert!(state.time_s < 0.1);
    }
    assert_near(largest_m, volume.rupture_m(), 1e-2);
    assert_near(bridges(&state).lost_j, volume.work_j(0.5 * RADIUS_M), 2e-2);
}

/// Two spheres on a floor, one of them held to the other by a bridge alone, fall asleep together
/// and wake together; the wall feels the pull of its bridges all the while.
#[test]
fn bridges_join_what_sleeps() {
    let apart_m = 2.0 * RADIUS_M + 2e-4;
    let mut state = started(&format!(
        "{}{}{}{FLOOR}[sleep]\nspeed = \"1 mm/s\"\nafter = \"2 ms\"\n",
        far(&head(
            1.0,
            0.1,
            "gravity = [0, 0, -9.81], initial_overlap = \"keep\""
        ))
        .replace(
            "friction = 0.3",
            "friction = 0.9\nrolling = \"spring-dashpot\"\nrolling_friction = 0.5"
        ),
        ball("a", [0.0, 0.0, RADIUS_M - 1e-8], [0.0; 3]),
        ball("b", [2.0 * RADIUS_M - 1e-8, 0.0, RADIUS_M - 1e-8], [0.0; 3]),
    ));
    step_and_balance(&mut state);
    assert_eq!(bridges(&state).pairs.len(), 1);
    state.particles.poses[1].put_at([apart_m, 0.0, RADIUS_M - 1e-8]);
    let asleep = |state: &State| state.sleep.as_ref().unwrap().bodies;
    while asleep(&state) == 0 {
        step_and_balance(&mut state);
        assert!(state.time_s < 1.0, "never asleep");
    }
    assert_eq!(
        asleep(&state),
        2,
        "one sleeps, and a bridge pulls at the other"
    );
    let before = state.clone();
    for _ in 0..300 {
        step_and_balance(&mut state);
    }
    assert_eq!(state.bridges, before.bridges);
    let down_n = state.walls[0].total_load()[0][2];
    assert_near(down_n, 2.0 * mass_kg() * 9.81, 1e-2);
}

/// A body that leaves takes its bridges along, and the books know.
#[test]
fn an_outlet_takes_bridges_along() {
    let mut state = started(&format!(
        "{}{}{}[regions.out]\nbox = {{ min = [{:e}, -1, -1], max = [1, 1, 1] }}\n[outlets.out]\ninside = \"out\"\n",
        far(&head(
            1.0,
            1.0,
            "initial_overlap = \"keep\", safety_factor = 0.3"
        )),
        ball("a", [0.0; 3], [0.0; 3]),
        ball("b", [2.0 * RADIUS_M - 1e-8, 0.0, 0.0], [0.1, 0.0, 0.0]),
        2.3 * RADIUS_M
    ));
    let mut had = 0;
    while state.particles.len() == 2 {
        had = bridges(&state).pairs.len();
        let balance = step_and_balance(&mut state);
        assert!(balance.energy_error.abs() < 1e-3);
        assert!(state.time_s < 0.1);
    }
    assert_eq!(had, 1);
    assert!(bridges(&state).pairs.is_empty());
    let balance = step_and_balance(&mut state);
    assert!(balance.energy_error.abs() < 1e-3, "{balance:?}");
    assert_eq!(balance.liquid_bridge_j, 0.0);
    assert!(balance.flow_energy_j < 0.0);
}
