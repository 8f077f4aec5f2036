//! Bonds break between the times that bodies have in common: nothing is lost or counted twice.

use dem_run::stages::ledger::balance;
use dem_run::step::{advance, interact};
use std::fmt::Write;

use super::{head, levels, pair, planned};

/// A soft rod at the highest level and a hard one spin until they burst.
#[test]
fn breaks_are_booked_and_told_once() {
    let rod = |name: &str, kind: &str, place: &str, spin_rad_s: f64| {
        let (mut particles, mut bonds) = (String::new(), String::new());
        for n in 0..12 {
            write!(particles, "[{}e-3, 0, 0, 1e-3],", 2 * n).unwrap();
            if n > 0 {
                write!(bonds, "[{}, {n}],", n - 1).unwrap();
            }
        }
        format!(
            "[bodies.{name}]\nmaterial = \"{kind}\"\nbonds = \"{kind}-brittle\"\n\
             particles = [{particles}]\nbond_list = [{bonds}]\nposition = {place}\n\
             angular_velocity = [0, 0, {spin_rad_s}]\n"
        )
    };
    let text = head("run.end_time = 0.01\nrun.seed = 3\nrun.safety_factor = 0.3")
        + "bonds.soft-brittle = { young_modulus = 1e6, poisson_ratio = 0.25, failure = { tensile_strength = 2e4, weibull_modulus = 4 } }\n\
           bonds.hard-brittle = { young_modulus = 1e8, poisson_ratio = 0.25, failure = { tensile_strength = 2e6, weibull_modulus = 4 } }\n"
        + &rod("a", "soft", "[0, 0, 0]", 320.0)
        + &rod("b", "hard", "[0, 0, 1]", 3200.0)
        + &pair("c", "soft", [0.0, 0.0, 2.0], [0.0; 3]);
    let mut state = planned(&text).state;
    let mut told = Vec::new();
    let mut between = 0;
    let mut error = 0.0_f64;
    while state.time_s < 0.01 {
        interact(&mut state);
        told.extend(state.scratch.events.broken.iter().map(|one| one.bond));
        let books = balance(&mut state);
        error = error.max(books.energy_error.abs());
        assert!(books.momentum_error < 1e-11, "{}", books.momentum_error);
        advance(&mut state);
        for ((step, time_s), one) in &state.scratch.events.broken_between {
            assert!(*step < state.steps && *time_s < state.time_s);
            told.push(one.bond);
            between += 1;
        }
    }
    let count = told.len();
    told.sort_unstable();
    told.dedup();
    assert_eq!(told.len(), count);
    assert_eq!(state.broken_count, count as u64);
    let broken = (0..state.bonds.len()).filter(|&at| state.bonds.is_broken(at));
    assert!(broken.map(|at| at as u32).eq(told.iter().copied()));
    // Of both rods, and some between common times.
    assert!(
        told.iter().any(|at| *at < 11) && told.iter().any(|at| *at >= 11),
        "{told:?}"
    );
    assert!(between > 0);
    assert!(levels(&state).contains(&3));
    assert!(error < 1e-3, "{error}");
    let fragments = state.clusters.as_ref().unwrap().living().count();
    assert_eq!(fragments, 3 + count);
}
