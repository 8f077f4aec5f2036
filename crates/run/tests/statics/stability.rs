//! Buckling columns, loads applied in steps, and interrupted runs.

use std::cell::Cell;
use std::f64::consts::PI;

use dem_engine::state::State;
use dem_physics::bond::stiffness::BondModel;
use dem_runner::statics::{Cause, equilibrium};

use super::{END_S, assert_near, bar, fix, load, rest};

const BONDS: u32 = 40;

/// A column clamped at one end, and its Euler load.
fn column() -> (State, f64) {
    let mut state = bar(BondModel::EulerBernoulli, BONDS, 0.5);
    fix(&mut state, &[0]);
    let length_m = 0.4 * f64::from(BONDS);
    let stiffness_n_m2 = 0.4 * state.bonds.stiffness(0).bending;
    (
        state,
        0.25 * PI * PI * stiffness_n_m2 / (length_m * length_m),
    )
}

#[test]
fn a_column_stands_below_eulers_load() {
    let (mut state, critical_n) = column();
    load(
        &mut state,
        &[BONDS],
        [-0.99 * critical_n, 0.0, 0.0],
        [0.0; 3],
    );
    assert!(rest(&mut state).stable);
}

/// Newton's method would also find the straight column above the Euler load, where it is unstable.
#[test]
fn a_column_buckles_above_eulers_load() {
    for over in [1.02, 2.5] {
        let (mut state, critical_n) = column();
        load(
            &mut state,
            &[BONDS],
            [-over * critical_n, 0.0, 0.0],
            [0.0; 3],
        );
        let problem = equilibrium(&mut state, END_S, &|_| true).unwrap_err();
        assert_eq!(problem.cause, Cause::Pivot);
        // The load steps are reduced down to a thousandth; shorter bonds would be closer by
        // (pi/2n)^2 / 12.
        assert_near(over * problem.fraction, 1.0, 5e-3, "Euler's load");
    }
}

/// A slightly inclined column bends sideways and remains stable: its end comes down beyond the
/// Euler load.
#[test]
fn a_column_with_a_force_across_bends_aside() {
    let (mut state, critical_n) = column();
    load(
        &mut state,
        &[BONDS],
        [-1.5 * critical_n, 1e-3 * critical_n, 0.0],
        [0.0; 3],
    );
    let found = rest(&mut state);
    eprintln!("{found:?}");
    assert!(found.stable);
    let [x, y, ..] = state.particles.poses[BONDS as usize].position_m;
    let length_m = 0.4 * f64::from(BONDS);
    assert!(x < 0.7 * length_m && y > 0.6 * length_m, "{x} {y}");
}

#[test]
fn it_stops_when_told() {
    let (mut state, critical_n) = column();
    load(&mut state, &[BONDS], [0.0, critical_n, 0.0], [0.0; 3]);
    let asked = Cell::new(0);
    let goes_on = |fraction: f64| {
        assert!((0.0..=1.0).contains(&fraction));
        asked.set(asked.get() + 1);
        asked.get() < 3
    };
    let before = state.particles.poses.clone();
    let problem = equilibrium(&mut state, END_S, &goes_on).unwrap_err();
    assert_eq!(problem.cause, Cause::Interrupted);
    assert_eq!(problem.fraction, 0.0);
    assert_eq!(asked.get(), 3);
    assert_eq!(state.particles.poses, before);
}
