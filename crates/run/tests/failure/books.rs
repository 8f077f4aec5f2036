//! The balances of energy and momentum stay closed when bonds break: their errors decrease with the
//! square of the time step.

use std::f64::consts::PI;

use dem_engine::Balance;
use dem_engine::stages::ledger::bookkeeping::{balance, opened};
use dem_engine::state::State;
use dem_engine::state::loads::GroupLoad;
use dem_engine::step::{advance, interact};
use dem_physics::bond::failure::Criteria;
use dem_results::summary::ENERGIES;
use dem_scene::Factor;

use super::bodies::{
    LENGTH_M, NORMAL, RADIUS_M, STRENGTH_PA, area_m2, damp, hold, on_one_thread, rod,
};

/// Effects on a rod besides its bonds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Besides {
    Nothing,
    Load,
    Support,
    Damping,
}

/// A rod that is shaken so that its bonds break one after another, or is pulled apart.
fn shaken(incremental: bool, besides: Besides) -> State {
    let both_edges = Criteria {
        compressive_strength_pa: STRENGTH_PA,
        ..NORMAL
    };
    let mut state = rod(6, both_edges, incremental);
    let m = 1.0 / state.particles.motions[0].inverse_mass;
    let speed = STRENGTH_PA * area_m2() / (m * state.bonds.normal(0)).sqrt();
    for (i, motion) in state.particles.motions.iter_mut().enumerate() {
        let phase = PI * i as f64 / 6.0;
        let along = -(phase.cos()) * 2.2 * speed;
        motion.velocity_m_s = [along, 0.3 * speed * (2.0 * phase).cos(), 0.0];
        motion.spin_rad_s = [
            0.5 * speed * phase.cos() / RADIUS_M,
            0.0,
            0.1 * speed / RADIUS_M,
        ];
    }
    match besides {
        Besides::Nothing => {}
        Besides::Load => state.loads.push(GroupLoad {
            end_s: f64::INFINITY,
            particles: vec![6],
            force_n: [
                0.5 * STRENGTH_PA * area_m2(),
                0.1 * STRENGTH_PA * area_m2(),
                0.0,
            ],
            torque_n_m: [0.0, 0.1 * STRENGTH_PA * area_m2() * LENGTH_M, 0.0],
            factor: Factor::One,
        }),
        Besides::Support => {
            hold(&mut state, std::iter::once(0), 0.0);
            hold(&mut state, std::iter::once(6), speed);
            for (end, velocity) in [(0, 0.0), (6, speed)] {
                let motion = &mut state.particles.motions[end];
                motion.velocity_m_s = [velocity, 0.0, 0.0];
                motion.spin_rad_s = [0.0; 3];
            }
        }
        Besides::Damping => damp(&mut state, 0.2),
    }
    state.ledger = opened(&state);
    state
}

/// Largest errors after the first break within a given time, and the breaks.
fn errors(mut state: State, part: f64, until_s: f64) -> (f64, f64, u64, Balance) {
    state.time_step_s *= part;
    let (mut energy, mut momentum) = (0.0_f64, 0.0_f64);
    let mut last = Balance::default();
    while state.time_s < until_s {
        interact(&mut state);
        if state.broken_count > 0 {
            last = balance(&mut state);
            energy = energy.max(last.energy_error.abs());
            momentum = momentum
                .max(last.momentum_error)
                .max(last.angular_momentum_error);
        }
        advance(&mut state);
    }
    (energy, momentum, state.broken_count, last)
}

#[test]
fn books_stay_closed_through_breaks() {
    on_one_thread(|| {
        for besides in [
            Besides::Nothing,
            Besides::Load,
            Besides::Support,
            Besides::Damping,
        ] {
            for incremental in [false, true] {
                let until_s = 400.0 * shaken(incremental, besides).time_step_s;
                let found = [0.25, 0.125, 0.0625]
                    .map(|part| errors(shaken(incremental, besides), part, until_s));
                let what = format!("{besides:?}, incremental: {incremental}");
                for (_, momentum, broken, last) in &found {
                    assert!(*momentum < 1e-12, "{what}: momentum off by {momentum}");
                    assert!(
                        *broken >= 3 && last.bond_breakage_j > 0.0,
                        "{what}: {broken} breaks"
                    );
                }
                // 16 in the limit of small steps.
                let falls = found[0].0 / found[2].0;
                assert!((14.0..20.0).contains(&falls), "{what}: falls by {falls}");
            }
        }
    });
}

#[test]
fn the_listed_energies_add_up_to_the_error() {
    on_one_thread(|| {
        for besides in [Besides::Load, Besides::Support, Besides::Damping] {
            let mut state = shaken(false, besides);
            let mut at_start_j = None;
            for _ in 0..400 {
                interact(&mut state);
                let now = balance(&mut state);
                let terms = ENERGIES.iter().map(|one| one.kind.sign() * (one.of)(&now));
                let left_j = terms.sum::<f64>() - now.energy_error_j;
                let off_j = left_j - *at_start_j.get_or_insert(left_j);
                assert!(
                    off_j.abs() < 1e-12 * now.energy_scale_j,
                    "{besides:?}: {off_j}"
                );
                advance(&mut state);
            }
            assert!(state.broken_count > 0, "{besides:?}");
        }
    });
}

/// A fixed sphere does not move when its bond breaks, and its support does no work.
#[test]
fn a_support_at_rest_does_no_work_in_a_break() {
    on_one_thread(|| {
        for incremental in [false, true] {
            let mut state = rod(1, NORMAL, incremental);
            hold(&mut state, std::iter::once(0), 0.0);
            let m = 1.0 / state.particles.motions[1].inverse_mass;
            let speed = 2.0 * STRENGTH_PA * area_m2() / (m * state.bonds.normal(0)).sqrt();
            state.particles.motions[1].velocity_m_s = [speed, 0.1 * speed, 0.0];
            state.ledger = opened(&state);
            while state.broken_count == 0 {
                interact(&mut state);
                assert_eq!(balance(&mut state).support_work_j, 0.0);
                advance(&mut state);
                assert!(state.steps < 1000, "does not break");
            }
            interact(&mut state);
            assert_eq!(balance(&mut state).support_work_j, 0.0);
        }
    });
}

/// A bond between a fixed sphere and one that is moved away: all forces are those of the supports,
/// so the balance closes to rounding also in the step in which it breaks, and the measured reaction
/// is that of the bond.
#[test]
fn a_bond_between_supports_breaks_without_an_error() {
    for steps in [20.0, 200.0, 2000.0] {
        let mut state = rod(1, NORMAL, false);
        hold(&mut state, std::iter::once(0), 0.0);
        let to_failure = STRENGTH_PA * area_m2() / state.bonds.normal(0);
        let speed = to_failure / (steps * state.time_step_s);
        hold(&mut state, std::iter::once(1), speed);
        state.particles.motions[1].velocity_m_s[0] = speed;
        state.ledger = opened(&state);
        let (mut largest_j, mut scale_j) = (0.0_f64, 0.0);
        let mut last_reaction = 0.0;
        while state.broken_count == 0 {
            advance(&mut state);
            interact(&mut state);
            let balance = balance(&mut state);
            largest_j = largest_j.max(balance.energy_error_j.abs());
            scale_j = balance.energy_scale_j;
            assert!(balance.momentum_error < 1e-12, "{balance:?}");
            last_reaction = state.supports[1].held[0].reactions[0][0];
        }
        // Positions are rounded in every step, relative to the displacement in it.
        let rounding = f64::EPSILON * LENGTH_M / (speed * state.time_step_s) + 1e-12;
        assert!(
            largest_j < rounding * scale_j,
            "{steps} steps: {largest_j:e} J of {scale_j:e} J, rounding {rounding:e}"
        );
        let wanted = STRENGTH_PA * area_m2();
        assert!(
            last_reaction >= wanted * (1.0 - 1e-9),
            "{last_reaction} {wanted} {steps}"
        );
        assert!(last_reaction <= wanted * (1.0 + 1.0 / steps + 1e-9));
    }
}
