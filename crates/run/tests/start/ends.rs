//! Supports and loads that end.

use std::fs;

use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::step::{advance, interact};
use dem_results::checkpoint::read_checkpoint;
use dem_results::folder::names;
use dem_results::{Existing, ResultsFolder};
use dem_runner::snapshot::Snapshot;

use super::{MASS_KG, PAIR, STIFFNESS_N_M, assert_near, place, planned, run_of, try_planned};

/// A force F that ends after T leaves a body of mass m with the velocity F T/m, for any step.
#[test]
fn a_load_that_ends_gives_its_whole_impulse_and_no_more() {
    let (force_n, end_s) = (1e-3, 0.1234e-3);
    for steps in [20.0, 100.0, 333.0] {
        let text = format!(
            "{PAIR}run = {{ end_time = 1e-3, time_step = {} }}\n\
             loads.push = {{ group = \"all\", force = [0, {force_n}, 0], end = {end_s} }}\n",
            1e-3 / steps
        );
        let mut state = planned(&text).state;
        let mut balances = Vec::new();
        while state.time_s < 0.9e-3 {
            interact(&mut state);
            balances.push(balance(&mut state));
            advance(&mut state);
        }
        let speed_m_s = force_n * end_s / (2.0 * MASS_KG);
        for motion in &state.particles.motions {
            assert_near(motion.velocity_m_s[1], speed_m_s, 1e-12);
        }
        // Leapfrog's own difference, dt^2 f^2/(8 m) for each particle while f acts on it.
        let own_j = 2.0 * (state.time_step_s * 0.5 * force_n).powi(2) / (8.0 * MASS_KG);
        let last = balances.last().unwrap();
        assert_near(last.kinetic_j, MASS_KG * speed_m_s * speed_m_s, 1e-11);
        assert_near(last.load_work_j, last.kinetic_j + own_j, 1e-9);
        for now in &balances {
            assert!(now.energy_error_j.abs() < 1.000001 * own_j, "{now:?}");
            assert!(now.momentum_error < 1e-12, "{:e}", now.momentum_error);
        }
    }
}

/// Pulls the second sphere of the pair by 1 um against the fixed first, and releases it at 0.4 ms.
fn pulled(step_s: f64, end: &str) -> String {
    format!(
        "{PAIR}run = {{ end_time = 2e-3, time_step = {step_s} }}\n\
         supports.clamp = {{ group = \"first\", fixed = true }}\n\
         supports.pull = {{ group = \"second\", displacement = {{ x = 1e-6 }}, ramp = 0.2e-3, {end} }}\n"
    )
}

/// Released from rest it oscillates about the rest length with that amplitude, w^2 = k/m, as in
/// leapfrog; the balance is as accurate as for the oscillation alone.
#[test]
fn a_pair_that_is_let_go_swings_with_the_amplitude_of_its_release() {
    let step_s = 1e-6;
    let mut state = planned(&pulled(step_s, "end = 0.4e-3")).state;
    let omega = (STIFFNESS_N_M / MASS_KG).sqrt();
    let phi = (1.0 - 0.5 * (omega * step_s).powi(2)).acos();
    let amplitude_m = 1e-6;
    let stored_j = 0.5 * STIFFNESS_N_M * amplitude_m * amplitude_m;
    for n in 0..1900 {
        interact(&mut state);
        let now = balance(&mut state);
        let pull_n = state.supports[1].held[0].reactions;
        if n < 400 {
            assert!(n < 220 || (pull_n[0][0] / (STIFFNESS_N_M * 1e-6) - 1.0).abs() < 1e-8);
        } else {
            let apart_m = (place(&state, 1) - place(&state, 0)).x - 2e-3;
            let wanted_m = amplitude_m * (f64::from(n - 400) * phi).cos();
            assert!(
                (apart_m - wanted_m).abs() < 1e-8 * amplitude_m,
                "{n}: {apart_m:e}"
            );
            assert_near(now.support_work_j, stored_j, 1e-8);
            let of_swing = (omega * step_s).powi(2);
            assert!(
                now.energy_error.abs() < of_swing,
                "{n}: {:e}",
                now.energy_error
            );
            assert!(now.momentum_error < 1e-12, "{n}: {:e}", now.momentum_error);
        }
        if n > 400 {
            assert_eq!(pull_n, [[0.0; 6]; 2]);
        }
        advance(&mut state);
    }
}

/// A body released while moving continues with the velocity of the support.
#[test]
fn a_body_that_is_let_go_in_motion_keeps_its_velocity() {
    let text = format!(
        "{PAIR}run = {{ end_time = 2e-3, time_step = 1e-6, gravity = [0, 0, -10] }}\n\
         supports.carry = {{ group = \"all\", velocity = {{ x = 2, z = 0, rx = 0, ry = 0, rz = 0 }}, ramp = 0.2e-3, end = 0.5e-3 }}\n"
    );
    let mut state = planned(&text).state;
    while state.time_s < 1.5e-3 - 0.5e-6 {
        interact(&mut state);
        let now = balance(&mut state);
        assert!(
            now.energy_error.abs() < 1e-9,
            "{}: {:e}",
            state.time_s,
            now.energy_error
        );
        assert!(now.momentum_error < 1e-12, "{:e}", now.momentum_error);
        advance(&mut state);
    }
    // In free fall since 0.5 ms, and moving along x.
    assert!((place(&state, 0).z / (-0.5 * 10.0 * 1e-6) - 1.0).abs() < 1e-9);
    assert!((state.particles.motions[1].velocity_m_s[0] - 2.0).abs() < 1e-12);
}

/// The step is right for the released body, from the start.
#[test]
fn the_limit_of_the_step_counts_on_what_is_let_go() {
    let of = |more: &str| {
        planned(&format!("{PAIR}run.end_time = 1\n{more}"))
            .step
            .limit
            .step_s
    };
    let clamp = |end: &str| {
        of(&format!(
            "supports.c = {{ group = \"first\", fixed = true{end} }}\n"
        ))
    };
    let (free, held, ending) = (of(""), clamp(""), clamp(", end = 0.5"));
    assert!(held > 1.2 * free, "{held:e} {free:e}");
    assert_near(ending, free, 1e-9);
}

/// Fixed degrees of freedom may be loaded if they are released before the load ends.
#[test]
fn a_load_may_wait_for_the_end_of_a_support() {
    let of = |end: &str| {
        let text = format!(
            "{PAIR}run.end_time = 1e-3\n\
             supports.c = {{ group = \"first\", fixed = true, end = 0.5e-3 }}\n\
             loads.push = {{ group = \"first\", force = [1, 0, 0]{end} }}\n"
        );
        try_planned(&text).map(|_| ())
    };
    assert!(of("").is_ok());
    assert!(of(", end = 0.6e-3").is_ok());
    let error = of(", end = 0.5e-3").unwrap_err();
    assert!(
        error.problem.contains("that a support holds there"),
        "{error}"
    );
}

/// Damped and at rest long before, the run continues until the last end.
#[test]
fn rest_waits_for_the_end_of_supports_and_loads() {
    let damped = PAIR.replace(
        "radius_factor = 1 }",
        "radius_factor = 1, damping = { damping_ratio = 0.5 } }",
    );
    let clamp = "supports.clamp = { group = \"first\", fixed = true }\n";
    let run = "run = { end_time = 0.1, rest_energy_ratio = 1e-6 }\n";
    let load =
        |end: &str| format!("loads.pull = {{ group = \"second\", force = [1e-3, 0, 0]{end} }}\n");
    let ended = |more: &str| {
        let text = format!("{damped}{run}{clamp}{more}");
        let summary = run_of(&text, None, None, 2.0).unwrap();
        (summary.ended_by, summary.simulated_s)
    };
    let (why, at_s) = ended(&load(""));
    assert!(why == "rest" && at_s < 0.01, "{why} {at_s}");
    let (why, at_s) = ended(&format!(
        "{}{}",
        load(""),
        "loads.last = { group = \"second\", force = [1e-3, 0, 0], end = \"30 ms\" }\n"
    ));
    assert!(why == "rest" && at_s > 0.03 && at_s < 0.06, "{why} {at_s}");
    let (why, at_s) = ended(&format!(
        "{}{}",
        load(""),
        "supports.hold = { group = \"second\", fixed = [\"y\"], end = \"20 ms\" }\n"
    ));
    assert!(why == "rest" && at_s > 0.02 && at_s < 0.04, "{why} {at_s}");
}

/// A run interrupted before, near and after the ends continues with the same bits.
#[test]
fn a_resumed_run_ends_what_the_whole_one_ends() {
    let text = format!(
        "{}loads.blow = {{ group = \"second\", force = [0, 1e-3, 0], end = 0.6501e-3 }}\n\
         output.series = 5e-6\n",
        pulled(1e-6, "end = 0.4e-3")
    );
    let parent = tempfile::tempdir().unwrap();
    let whole = ResultsFolder::create(&parent.path().join("whole"), Existing::Refuse).unwrap();
    run_of(&text, Some(&whole), None, 2.0).unwrap();
    let of_whole = fs::read(whole.file(names::SERIES)).unwrap();
    for (n, stop_at) in [0.1, 0.1975, 0.2, 0.2025, 0.325, 0.5]
        .into_iter()
        .enumerate()
    {
        let path = parent.path().join(n.to_string());
        let folder = ResultsFolder::create(&path, Existing::Refuse).unwrap();
        run_of(&text, Some(&folder), None, stop_at).unwrap_err();
        drop(folder);
        let folder = ResultsFolder::create(&path, Existing::Continue).unwrap();
        let bytes = read_checkpoint(&folder.file(names::CHECKPOINT)).unwrap();
        let snapshot = Snapshot::from_bytes(&bytes).unwrap();
        run_of(&text, Some(&folder), Some(snapshot), 2.0).unwrap();
        assert!(
            fs::read(folder.file(names::SERIES)).unwrap() == of_whole,
            "{stop_at}"
        );
    }
}
