//! Bars bent into arcs: closed forms of the bonds themselves, for any angle.

use std::f64::consts::PI;

use dem_engine::state::State;
use dem_scene::{Factor, Hold};

use super::{assert_near, bar, fix, hold, load, rest};
use crate::bars::MODELS;

const BONDS: u32 = 20;

/// In pure bending all bonds are chords of their initial length, each rotated relative to the
/// previous one by the same angle.
fn assert_arc(state: &State, angle: f64) {
    let (mut x, mut y) = (0.0, 0.0);
    for (i, pose) in state.particles.poses.iter().enumerate() {
        let found = pose.position_m;
        let off = (found[0] - x).hypot(found[1] - y).hypot(found[2]);
        assert!(off < 1e-8, "particle {i} is off by {off:.1e} m");
        let middle = (i as f64 + 0.5) * angle;
        x += 0.4 * middle.cos();
        y += 0.4 * middle.sin();
    }
}

/// The energy of bending is k/2 (2 sin(angle/2))^2: a moment of k sin(angle).
#[test]
fn a_moment_at_the_end_bends_a_bar_into_an_arc() {
    for (model, name) in MODELS {
        for turn in [0.5 * PI, PI, 2.0 * PI] {
            let mut state = bar(model, BONDS, 0.3);
            let angle = turn / f64::from(BONDS);
            let moment_n_m = state.bonds.stiffness(0).bending * angle.sin();
            fix(&mut state, &[0]);
            load(&mut state, &[BONDS], [0.0; 3], [0.0, 0.0, moment_n_m]);
            let found = rest(&mut state);
            eprintln!(
                "{name} {turn}: {} steps in {} load steps, {:?}",
                found.newton_steps, found.load_steps, found.residuals
            );
            assert_arc(&state, angle);
            let reaction = state.supports[0].held[0].reactions[0];
            assert_near(-reaction[5], moment_n_m, 1e-9, "moment of the support");
        }
    }
}

/// The same arc with a prescribed rotation of the end, which gives the moment.
#[test]
fn an_end_that_is_turned_bends_a_bar_into_an_arc() {
    for (model, name) in MODELS {
        for turn in [0.5 * PI, PI] {
            let mut state = bar(model, BONDS, 0.3);
            let angle = turn / f64::from(BONDS);
            fix(&mut state, &[0]);
            let mut holds = [None; 6];
            holds[3] = Some(Hold::Fixed);
            holds[4] = Some(Hold::Fixed);
            holds[5] = Some(Hold::Displacement(turn));
            hold(&mut state, &[BONDS], holds, Factor::Ramp { until_s: 0.5 });
            let found = rest(&mut state);
            eprintln!(
                "{name} {turn}: {} steps in {} load steps, {:?}",
                found.newton_steps, found.load_steps, found.residuals
            );
            assert!(found.stable);
            assert_arc(&state, angle);
            let moment_n_m = state.bonds.stiffness(0).bending * angle.sin();
            let reaction = state.supports[1].held[0].reactions[0];
            assert_near(reaction[5], moment_n_m, 1e-9, "moment of the turned end");
        }
    }
}

/// Torsion by a rotation of the end: its energy is also k/2 (2 sin(angle/2))^2.
#[test]
fn an_end_that_is_turned_twists_a_bar() {
    for (model, _) in MODELS {
        let mut state = bar(model, BONDS, 0.3);
        fix(&mut state, &[0]);
        let mut holds = [None; 6];
        holds[3] = Some(Hold::Displacement(2.0));
        holds[4] = Some(Hold::Fixed);
        holds[5] = Some(Hold::Fixed);
        hold(&mut state, &[BONDS], holds, Factor::Ramp { until_s: 0.5 });
        rest(&mut state);
        let torque_n_m = state.bonds.stiffness(0).torsion * (2.0 / f64::from(BONDS)).sin();
        let reaction = state.supports[1].held[0].reactions[0];
        assert_near(reaction[3], torque_n_m, 1e-9, "torque");
        assert_arc(&state, 0.0);
    }
}
