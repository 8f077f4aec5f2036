//! Energy and momentum are kept while bodies take different steps.

use dem_run::stages::ledger::balance;
use dem_run::step::{advance, interact};

use super::{CONTACTS, PLATE, errors, frequency_rad_s, head, levels, pair, parting, planned};

/// Pairs vibrate and fall for 1e5 steps: leapfrog makes the energy of each swing between what it is
/// and 1/(1 - x^2) times that, with x = half of step times frequency, and nothing drifts.
#[test]
fn the_energy_of_a_long_flight_is_kept() {
    let text = head("run.end_time = 1\nrun.gravity = [0, 0, -9.81]")
        + &pair("a", "hard", [0.0; 3], [0.0; 3])
        + &pair("b", "soft", [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let mut state = planned(&text).state;
    for (bond, speed_m_s) in [(0, 1e-2), (1, 1e-2)] {
        parting(&mut state, bond, speed_m_s);
    }
    // Of each pair, in which both spheres move with half of the speed.
    let vibrating_j = (1.0 / state.particles.motions[0].inverse_mass) * 0.005_f64.powi(2);
    let swing = |bond: usize, level: i32| {
        let half = 0.5 * state.time_step_s * 2.0_f64.powi(level) * frequency_rad_s(&state, bond);
        half * half / (1.0 - half * half)
    };
    let swings = swing(0, 0) + swing(1, 3);
    let mut thirds = [0.0_f64; 3];
    let mut momentum = 0.0_f64;
    let steps = 100_000;
    while state.steps < steps {
        interact(&mut state);
        let books = balance(&mut state);
        let third = (3 * state.steps / steps) as usize;
        thirds[third] = thirds[third].max(books.energy_error_j.abs() / vibrating_j);
        momentum = momentum
            .max(books.momentum_error)
            .max(books.angular_momentum_error);
        advance(&mut state);
    }
    assert_eq!(levels(&state), [0, 0, 3, 3]);
    assert!(
        (thirds[0] / swings - 1.0).abs() < 0.01,
        "{thirds:?} {swings}"
    );
    assert!(thirds[2] < 1.001 * thirds[0], "{thirds:?}");
    assert!(momentum < 1e-11, "{momentum}");
}

/// Pairs bounce on a plate, each with its own steps: what the plate gives and takes is booked.
#[test]
fn what_walls_do_is_booked() {
    for damping in [
        "damping_ratio = 0",
        "damping_ratio = 0.1",
        "structural_damping = 0.3",
    ] {
        all_is_booked(damping);
    }
}

fn all_is_booked(damping: &str) {
    let text = head("run.end_time = 0.02\nrun.gravity = [0, 0, -9.81]\nrun.safety_factor = 0.2")
        + &format!("bonds.hard.damping.{damping}\nbonds.soft.damping.{damping}\n")
        + CONTACTS
        + PLATE
        + "surface_velocity = [0.1, 0, 0]\n"
        + &pair("a", "hard", [0.0, 0.0, 1.5e-3], [0.2, 0.0, -0.3])
        + &pair("b", "soft", [0.1, 0.0, 1.5e-3], [0.2, 0.0, -0.3]);
    let mut state = planned(&text).state;
    let mut largest = [0.0_f64; 3];
    let mut touched = [false; 2];
    while state.time_s < 0.02 {
        interact(&mut state);
        let errors = errors(&mut state);
        largest = [0, 1, 2].map(|k| largest[k].max(errors[k]));
        for touch in &state.walls[0].touching {
            touched[touch.particle as usize / 2] = true;
        }
        advance(&mut state);
    }
    assert_eq!(touched, [true; 2]);
    assert!(levels(&state)[2] > levels(&state)[0]);
    interact(&mut state);
    let taken_j = balance(&mut state).structural_damping_j;
    assert_eq!(
        taken_j > 0.0,
        damping.starts_with("structural"),
        "{taken_j}"
    );
    assert!(largest[0] < 2e-3, "{largest:?}");
    assert!(largest[1] < 1e-11 && largest[2] < 1e-11, "{largest:?}");
}
