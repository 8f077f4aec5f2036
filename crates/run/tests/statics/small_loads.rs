//! Bars under small loads: statically determinate, so each bond deforms by its load over its
//! stiffness.

use dem_engine::state::State;
use dem_physics::rigid::rotation_vector;

use super::{assert_near, bar, fix, load, moved, rest};
use crate::bars::MODELS;

const BONDS: u32 = 10;
/// Small, so that the lever of a load is constant: its square is neglected.
const SMALL: f64 = 1e-9;

/// A bar of each model, clamped at its first particle, under a load at its last.
fn each(force_n: [f64; 3], torque_n_m: [f64; 3], look: impl Fn(&State)) {
    for (model, _) in MODELS {
        let mut state = bar(model, BONDS, 1.0);
        fix(&mut state, &[0]);
        load(&mut state, &[BONDS], force_n, torque_n_m);
        let found = rest(&mut state);
        assert_eq!((found.unknowns, found.held), (60, 6));
        assert_eq!(found.load_steps, 1);
        assert!(found.residual() < 1e-7, "{}", found.residual());
        assert!(found.stable);
        look(&state);
    }
}

#[test]
fn a_force_across_bends_and_shears() {
    let force_n = 1e3;
    each([0.0, force_n, 0.0], [0.0; 3], |state| {
        let (mut deflection, mut rotation, mut start) = (0.0, 0.0, 0.0);
        for at in 0..BONDS as usize {
            let k = state.bonds.stiffness(at);
            let [before, after] = k.levers_m;
            let moment = force_n * (4.0 - start - before);
            let turned = rotation + moment / k.bending;
            deflection += before * rotation + after * turned + force_n / k.shear;
            rotation = turned;
            start += before + after;
            assert_near(moved(state, at + 1).y, deflection, 1e-8, "deflection");
            let turned = rotation_vector(state.particles.poses[at + 1].turned);
            assert_near(turned[2], rotation, 1e-8, "rotation");
        }
    });
}

#[test]
fn a_force_along_stretches() {
    each([1e3, 0.0, 0.0], [0.0; 3], |state| {
        let k = state.bonds.stiffness(0).normal;
        for i in 1..=BONDS as usize {
            // A position is accurate to 4e-16 m of 4 m, and the displacement is about 1e-8 m.
            assert_near(moved(state, i).x, i as f64 * 1e3 / k, 1e-6, "stretch");
        }
    });
}

#[test]
fn a_torque_along_twists() {
    each([0.0; 3], [1e3, 0.0, 0.0], |state| {
        let k = state.bonds.stiffness(0).torsion;
        for i in 1..=BONDS as usize {
            let turned = rotation_vector(state.particles.poses[i].turned);
            assert_near(turned[0], i as f64 * 1e3 / k, SMALL, "twist");
        }
    });
}

#[test]
fn nothing_moves_where_nothing_acts() {
    each([0.0; 3], [0.0; 3], |state| {
        for (i, pose) in state.particles.poses.iter().enumerate() {
            assert_eq!(pose.position_m, [0.4 * i as f64, 0.0, 0.0, 0.2]);
            assert_eq!(pose.turned, [0.0, 0.0, 0.0, 1.0]);
        }
    });
}

#[test]
fn weight_hangs_on_the_support() {
    for (model, _) in MODELS {
        let mut state = bar(model, BONDS, 1.0);
        fix(&mut state, &[0]);
        state.model.gravity_m_s2 = [9.81, 0.0, 0.0];
        rest(&mut state);
        let weight_n = 9.81 / state.particles.motions[1].inverse_mass;
        // Bond n carries the weight below it.
        let carried: f64 = (1..=10).map(|n| weight_n * f64::from(n)).sum();
        let k = state.bonds.stiffness(0).normal;
        assert_near(moved(&state, 10).x, carried / k, 1e-6, "stretch");
        let reaction = state.supports[0].held[0].reactions[0];
        assert_near(reaction[0], -11.0 * weight_n, 1e-9, "reaction");
    }
}
