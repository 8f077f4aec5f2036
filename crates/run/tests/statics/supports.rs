//! Supports that move, by displacements and by velocities, with factors over time; and individually
//! fixed degrees of freedom.

use dem_physics::bond::stiffness::BondModel;
use dem_physics::rigid::rotation_vector;
use dem_scene::{Factor, Hold};

use super::{END_S, assert_near, bar, fix, hold, load, moved, rest};

const BONDS: u32 = 10;

/// Force for a given axial displacement of the end of a bar: all bonds stretch equally.
fn pulled(hold_x: Hold, factor: Factor) -> [f64; 2] {
    let mut state = bar(BondModel::Timoshenko, BONDS, 1.0);
    fix(&mut state, &[0]);
    hold(
        &mut state,
        &[BONDS],
        [Some(hold_x), None, None, None, None, None],
        factor,
    );
    let found = rest(&mut state);
    assert_eq!(found.held, 7);
    let reaction = state.supports[1].held[0].reactions[0];
    assert_eq!(reaction[1..], [0.0; 5]);
    let k = state.bonds.stiffness(0).normal / f64::from(BONDS);
    [moved(&state, BONDS as usize).x, reaction[0] / k]
}

#[test]
fn supports_move_as_their_factors_say() {
    let table = Factor::Table(vec![[0.2, 0.5], [0.4, 1.5], [2.0, 1.5]]);
    let ramp = Factor::Ramp { until_s: 0.5 };
    for (hold, factor, way) in [
        (Hold::Displacement(1e-3), ramp.clone(), 1e-3),
        (
            Hold::Displacement(1e-3),
            Factor::Ramp { until_s: 4.0 },
            0.25e-3,
        ),
        // From 0.5 at the start to 1.5.
        (Hold::Displacement(1e-3), table.clone(), 1e-3),
        (Hold::Velocity(1e-3), Factor::One, 1e-3),
        (Hold::Velocity(1e-3), ramp, 0.75e-3),
        // 0.5 for 0.2 s, increasing for 0.2 s, 1.5 for 0.6 s.
        (Hold::Velocity(1e-3), table, (0.1 + 0.2 + 0.9) * 1e-3),
    ] {
        let [moved, stretched] = pulled(hold, factor);
        // A position is accurate to 4e-16 m.
        assert_near(moved, way, 1e-11, "way");
        assert_near(stretched, way, 1e-9, "force over stiffness");
    }
    assert_eq!(END_S, 1.0);
}

/// A support that displaces the end transversely reacts with the force that gives the same
/// displacement.
#[test]
fn a_moved_end_and_a_loaded_end_are_the_same() {
    let mut loaded = bar(BondModel::Timoshenko, BONDS, 0.5);
    fix(&mut loaded, &[0]);
    load(&mut loaded, &[BONDS], [0.0, 1e6, 0.0], [0.0; 3]);
    rest(&mut loaded);
    let way = moved(&loaded, BONDS as usize);
    assert!(way.y > 1.0, "{way}");

    let mut held = bar(BondModel::Timoshenko, BONDS, 0.5);
    fix(&mut held, &[0]);
    let mut holds = [None; 6];
    holds[1] = Some(Hold::Displacement(way.y));
    hold(&mut held, &[BONDS], holds, Factor::Ramp { until_s: END_S });
    let found = rest(&mut held);
    eprintln!("{found:?}");
    assert_near(
        held.supports[1].held[0].reactions[0][1],
        1e6,
        1e-9,
        "reaction",
    );
    for (a, b) in loaded.particles.poses.iter().zip(&held.particles.poses) {
        assert!((a.place() - b.place()).norm() < 1e-9 * way.norm());
    }
}

/// A bar on two hinges, each of which fixes the position and the rotation about the bar, so that
/// torques act where it is free to rotate: it deflects as a beam on two supports.
#[test]
fn hinges_hold_places_only() {
    let mut state = bar(BondModel::EulerBernoulli, BONDS, 1.0);
    let fixed = Some(Hold::Fixed);
    hold(
        &mut state,
        &[0],
        [fixed, fixed, fixed, fixed, None, None],
        Factor::One,
    );
    hold(
        &mut state,
        &[BONDS],
        [None, fixed, fixed, None, None, None],
        Factor::One,
    );
    load(&mut state, &[BONDS / 2], [0.0, 0.0, -1e3], [0.0; 3]);
    let found = rest(&mut state);
    assert!(found.stable);
    let stiffness_n_m2 = 0.4 * state.bonds.stiffness(0).bending;
    let length_m = 0.4 * f64::from(BONDS);
    let sag_m = 1e3 * length_m.powi(3) / (48.0 * stiffness_n_m2);
    // Bonds bend in their middles; a moment that varies linearly over them is represented to
    // (1/n)^2 of half of it.
    let turn = rotation_vector(state.particles.poses[0].turned);
    assert_near(
        turn[1],
        1e3 * length_m.powi(2) / (16.0 * stiffness_n_m2),
        1e-6,
        "turn",
    );
    assert_near(-moved(&state, BONDS as usize / 2).z, sag_m, 1e-6, "sag");
    for support in &state.supports {
        assert_near(support.held[0].reactions[0][2], 500.0, 1e-9, "reaction");
    }
}

/// Both ends of a bond are moved: nothing is unknown, and the supports carry the entire load.
#[test]
fn nothing_is_left_to_find_where_all_is_held() {
    let mut state = bar(BondModel::Timoshenko, 1, 1.0);
    fix(&mut state, &[0]);
    let mut holds = [Some(Hold::Fixed); 6];
    holds[0] = Some(Hold::Displacement(1e-3));
    hold(&mut state, &[1], holds, Factor::Ramp { until_s: END_S });
    let found = rest(&mut state);
    assert_eq!((found.unknowns, found.held), (0, 12));
    let force_n = 1e-3 * state.bonds.stiffness(0).normal;
    assert_near(
        state.supports[1].held[0].reactions[0][0],
        force_n,
        1e-9,
        "reaction",
    );
    assert_near(
        state.supports[0].held[0].reactions[0][0],
        -force_n,
        1e-9,
        "reaction",
    );
}
