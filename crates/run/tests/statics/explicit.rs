//! The rest state of time-stepping runs.

use dem_engine::check::limit::limit;
use dem_engine::state::State;
use dem_engine::step::step;
use dem_physics::bond::stiffness::BondModel;
use dem_scene::Factor;
use nalgebra::Vector3;

use super::{assert_near, bar, fix, load, rest};
use crate::bars::{ELASTIC, damp_particles, random_body, with_threads};

/// Steps a state until nothing moves by more than rounding in a hundred steps.
fn step_to_rest(state: &mut State, size_m: f64) {
    damp_particles(state, 0.7);
    state.time_step_s = 0.5 * limit(state).step_s;
    let until_s = 2000.0 * state.time_step_s;
    for load in &mut state.loads {
        load.factor = Factor::Ramp { until_s };
    }
    loop {
        let before: Vec<Vector3<f64>> = state
            .particles
            .poses
            .iter()
            .map(dem_engine::state::particles::Pose::place)
            .collect();
        for _ in 0..100 {
            step(state);
        }
        let after = state
            .particles
            .poses
            .iter()
            .map(dem_engine::state::particles::Pose::place);
        let farthest = after
            .zip(before)
            .map(|(a, b)| (a - b).norm())
            .fold(0.0, f64::max);
        if state.time_s > until_s && farthest < 1e-15 * size_m {
            return;
        }
        assert!(state.steps < 1_000_000, "does not come to rest: {farthest}");
    }
}

/// Asserts that a static solution and time stepping agree in positions and reactions, to 1e-8 of
/// the largest.
fn assert_same(state: &State, size_m: f64) {
    let (mut at_once, mut stepped) = (state.clone(), state.clone());
    let found = rest(&mut at_once);
    with_threads(1, || step_to_rest(&mut stepped, size_m));
    dem_engine::step::interact(&mut stepped);
    let start = &state.particles.poses;
    let way = |of: &State, i: usize| of.particles.poses[i].place() - start[i].place();
    let all = 0..start.len();
    let farthest = all
        .clone()
        .map(|i| way(&at_once, i).norm())
        .fold(0.0, f64::max);
    let off = all
        .map(|i| (way(&at_once, i) - way(&stepped, i)).norm())
        .fold(0.0, f64::max);
    eprintln!(
        "{off:.1e} of {farthest:.3e} m after {} steps; at once {found:?}",
        stepped.steps
    );
    assert!(off < 1e-8 * farthest, "{off} m of {farthest} m");
    let sum = |of: &State, k: usize| {
        let held = &of.supports[0].held;
        held.iter().map(|held| held.reactions[0][k]).sum::<f64>()
    };
    for k in 1..3 {
        assert_near(sum(&at_once, k), sum(&stepped, k), 1e-8, "reaction");
    }
}

#[test]
fn a_cantilever() {
    for model in [BondModel::Timoshenko, BondModel::Parallel { kappa: None }] {
        let mut state = bar(model, 10, 1.0);
        fix(&mut state, &[0]);
        load(&mut state, &[10], [0.0, -1e6, 5e5], [0.0; 3]);
        assert_same(&state, 4.0);
    }
}

#[test]
fn a_random_body_with_weight_and_torque() {
    let mut state = random_body(BondModel::Timoshenko, ELASTIC, 1e-6);
    let poses = &state.particles.poses;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for pose in poses {
        low = low.min(pose.position_m[0]);
        high = high.max(pose.position_m[0]);
    }
    let among = |from: f64, to: f64| -> Vec<u32> {
        let fraction = |i: u32| (poses[i as usize].position_m[0] - low) / (high - low);
        (0..poses.len() as u32)
            .filter(|i| (from..=to).contains(&fraction(*i)))
            .collect()
    };
    let (left, right) = (among(0.0, 0.1), among(0.9, 1.0));
    fix(&mut state, &left);
    load(&mut state, &right, [0.0, 2e-3, -1e-3], [1e-7, 0.0, 2e-7]);
    state.model.gravity_m_s2 = [0.0, 3.0, -9.81];
    assert_same(&state, high - low);
}
