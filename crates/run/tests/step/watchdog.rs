//! Just below the limit a run stays bounded, just above it the instability is detected.

use crate::bars::{
    BondDamping, ELASTIC, MODELS, bar, damp, damp_particles, random_body, shake, with_threads,
};
use dem_engine::check::limit::limit;
use dem_engine::check::watchdog::Watchdog;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{advance, interact};

/// Bond damping and particle damping, each or both or none.
const DAMPING: [(Option<BondDamping>, f64); 8] = [
    (None, 0.0),
    (Some(BondDamping::Chen(0.05)), 0.0),
    (Some(BondDamping::Chen(0.4)), 0.0),
    (Some(BondDamping::ChenByMode(0.2)), 0.0),
    (Some(BondDamping::Platzer(0.1, 0.3)), 0.0),
    (None, 0.05),
    (None, 0.7),
    (Some(BondDamping::ChenByMode(0.1)), 0.3),
];

/// The step at which a run is stopped, if it is.
fn stopped_at(state: &mut State, steps: u64) -> Option<u64> {
    let watchdog = Watchdog::new(0.98);
    (0..steps).find(|_| {
        interact(state);
        let balance = balance(state);
        let stopped = watchdog.look(state, &balance, &[]).is_err();
        advance(state);
        stopped
    })
}

/// Runs `body` with all dampings at 0.98 and 1.02 of its limit.
fn try_all(name: &str, body: impl Fn() -> State, speed_m_s: f64, steps: u64) {
    for (bonds, particles) in DAMPING {
        let mut state = body();
        if let Some(damping) = bonds {
            damp(&mut state, damping);
        }
        if particles > 0.0 {
            damp_particles(&mut state, particles);
        }
        let limit_s = limit(&mut state).step_s;
        shake(&mut state, speed_m_s);
        let [stable, unstable] = [0.98, 1.02].map(|fraction| {
            let mut state = state.clone();
            if fraction > 1.0 && bonds.is_some() && particles > 0.0 {
                // Damping of particles acts against the fastest mode once that moves most, and
                // damping of bonds makes it grow too slowly to come that far by itself.
                state.time_step_s = 1.04 * limit_s;
                for _ in 0..10 {
                    interact(&mut state);
                    advance(&mut state);
                }
            }
            state.time_step_s = fraction * limit_s;
            stopped_at(&mut state, steps)
        });
        eprintln!("{name} {bonds:?} {particles}: {stable:?} {unstable:?}");
        assert_eq!(stable, None, "{name} {bonds:?} {particles}");
        assert!(
            // Strong damping grows slowly: 4 % per step.
            unstable.is_some_and(|at| at < 400),
            "{name} {bonds:?} {particles}: {unstable:?}"
        );
    }
}

#[test]
fn a_bar_is_stable_just_below_its_limit_and_caught_just_above() {
    with_threads(1, || {
        for (model, _) in MODELS {
            try_all(
                &format!("{model:?}"),
                || bar(model, ELASTIC, 1e-9),
                0.1,
                2000,
            );
        }
    });
}

#[test]
fn a_random_body_is_stable_just_below_its_limit_and_caught_just_above() {
    with_threads(1, || {
        for (model, _) in MODELS {
            try_all(
                &format!("{model:?}"),
                || random_body(model, ELASTIC, 1e-9),
                1e-2,
                400,
            );
        }
    });
}
