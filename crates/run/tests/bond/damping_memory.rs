//! Damping of bonds in one stage with a memory: closed forms, the undamped limit, both momenta,
//! energy, and the same bits after a checkpoint and for any number of threads.

use std::f64::consts::PI;

use crate::bars::{
    BondDamping, ELASTIC, bar, body, damp, orders, random_body, reopen, run, shake, spheres, steel,
    tumble, with_threads,
};
use dem_engine::check::limit::{damping_bound_1_s, limit as step_limit};
use dem_engine::stages::bonds::damping::ONE_STAGE;
use dem_engine::stages::ledger::totals::kinetic_energy;
use dem_engine::state::State;
use dem_engine::step::step;
use dem_physics::bond::stiffness::BondModel;
use dem_physics::remembered::MOST;

/// The random body, damped and shaken.
fn shaken(damping_ratio: f64) -> State {
    let mut state = random_body(BondModel::Timoshenko, ELASTIC, 1e-9);
    damp(&mut state, BondDamping::Chen(damping_ratio));
    shake(&mut state, 0.1);
    state
}

/// A chain of spheres whose only motion is a stretching mode, and its closed form: displacement of
/// the first sphere over its speed at the start, s, after a time. Each bond has this damping ratio.
fn mode_of_chain(count: u32, mode: u32, damping_ratio: f64) -> (State, impl Fn(f64) -> f64) {
    let (particles, pairs) = spheres(count);
    let mut state = body(
        particles,
        &pairs,
        &steel(BondModel::Timoshenko, ELASTIC),
        1e-9,
    );
    damp(&mut state, BondDamping::Chen(damping_ratio));
    let k = state.bonds.stiffness(0).normal;
    let kg = 1.0 / state.particles.motions[0].inverse_mass;
    let angle = PI * f64::from(mode) / f64::from(count);
    for (i, motion) in (0..count).zip(&mut state.particles.motions) {
        motion.velocity_m_s = [(angle * (f64::from(i) + 0.5)).cos(), 0.0, 0.0];
    }
    reopen(&mut state);
    let omega = 2.0 * (k / kg).sqrt() * (0.5 * angle).sin();
    // c = 2 eta sqrt(k m/2) for each bond, so that c/k is the same for all.
    let rate = damping_ratio * (0.5 * kg / k).sqrt() * omega * omega;
    let speed = (0.5 * angle).cos();
    let moved = move |t: f64| {
        let square = omega * omega - rate * rate;
        let root = square.abs().sqrt().max(1e-6 * omega);
        let swing = if square > 0.0 {
            (root * t).sin()
        } else {
            (root * t).sinh()
        };
        speed * (-rate * t).exp() * swing / root
    };
    (state, moved)
}

/// Both bonds and chains follow exp(-zeta omega t), at any damping ratio, in one stage a step.
#[test]
fn stretching_modes_meet_their_closed_form_to_second_order() {
    for (count, mode) in [(2, 1), (12, 3)] {
        for damping_ratio in [0.2, 1.0, 5.0] {
            let (start, moved) = mode_of_chain(count, mode, damping_ratio);
            let end_s = 2e-4;
            let errors = [1, 2, 4, 8].map(|finer| {
                let steps = finer * (32.0 * damping_ratio.max(1.0)) as u32;
                let mut state = start.clone();
                state.time_step_s = end_s / f64::from(steps);
                assert!(state.time_step_s * state.damping_rate_1_s < MOST);
                state.damping_rate_1_s = 0.999 * MOST / state.time_step_s;
                for _ in 0..steps {
                    step(&mut state);
                }
                assert_eq!(state.scratch.damping_passes, u64::from(steps) + 2);
                let place_m = state.particles.poses[0].position_m[0];
                (place_m / moved(end_s) - 1.0).abs()
            });
            let found = orders(&errors);
            assert!((found[2] - 2.0).abs() < 0.1, "{errors:?}: {found:?}");
        }
    }
}

/// From weak damping to the strongest, a shaken network does not gain energy right below the limit
/// without damping.
#[test]
fn any_damping_is_stable_up_to_the_undamped_limit() {
    let limit_s = step_limit(&mut shaken(0.01)).step_s;
    for damping_ratio in [0.01, 0.1, 0.15, 0.2, 0.3, 1.0, 10.0, 100.0] {
        let mut state = shaken(damping_ratio);
        state.damping_rate_1_s = damping_bound_1_s(&mut state);
        state.time_step_s = 0.99 * limit_s;
        let energy_j =
            |state: &State| kinetic_energy(&state.particles, |i| state.particles.motions[i]);
        let opening_j = energy_j(&state);
        let steps = if damping_ratio > 5.0 { 400 } else { 2000 };
        for _ in 0..steps {
            step(&mut state);
        }
        assert!(energy_j(&state) < 0.5 * opening_j, "{damping_ratio}");
    }
}

/// A damping ratio of 0.2 in a packed body, at four tenths of the limit as in the chute, and above
/// what one pass covers.
#[test]
fn damping_takes_one_pass_over_the_bonds() {
    let passes = |fraction: f64| {
        let mut state = shaken(0.2);
        state.damping_rate_1_s = damping_bound_1_s(&mut state);
        state.time_step_s = fraction * step_limit(&mut state).step_s;
        for _ in 0..200 {
            step(&mut state);
        }
        let largest = state.time_step_s * state.damping_rate_1_s;
        (largest, state.scratch.damping_passes)
    };
    let (largest, of_one_pass) = passes(0.4);
    assert!(ONE_STAGE < largest && largest < MOST, "{largest}");
    assert!(of_one_pass <= 202, "{of_one_pass} passes in 200 steps");
    let (largest, of_stages) = passes(0.9);
    assert!(largest > MOST && of_stages > 600, "{largest}: {of_stages}");
}

/// A bar that tumbles and vibrates: both momenta are kept to rounding, and the error of the energy
/// balance falls with the square of the step.
#[test]
fn momenta_are_kept_and_energy_to_second_order() {
    let errors = [1_u32, 2, 4].map(|finer| {
        let mut state = bar(BondModel::Timoshenko, ELASTIC, 1e-9);
        damp(&mut state, BondDamping::Chen(0.2));
        tumble(&mut state);
        state.time_step_s = 8e-6 / f64::from(finer);
        assert!(state.time_step_s * state.damping_rate_1_s < MOST);
        state.damping_rate_1_s = 0.999 * MOST / state.time_step_s;
        let found = run(&mut state, 500 * u64::from(finer), u64::from(finer));
        assert!(
            found.momentum < 1e-12 && found.angular_momentum < 1e-12,
            "{found:?}"
        );
        found.energy
    });
    assert!(orders(&errors)[1] > 1.9, "{errors:?}");
}

#[test]
fn a_checkpoint_and_threads_do_not_change_a_bit() {
    let places = |partitions: usize, threads: usize, saved_at: Option<u32>| {
        with_threads(threads, || {
            let mut state = shaken(0.2);
            state.scratch.threads = partitions;
            state.scratch.worth_a_thread = 0;
            state.divide();
            state.time_step_s = 2.0 / state.damping_rate_1_s;
            for n in 0..100 {
                step(&mut state);
                if saved_at == Some(n) {
                    assert!(!state.damping_memory.is_empty());
                    let bytes = postcard::to_stdvec(&state).unwrap();
                    let copy: State = postcard::from_bytes(&bytes).unwrap();
                    let mut model = state.model.clone();
                    model.bond_rules = state.bonds.rules.clone();
                    state = copy.rebuilt(model, &state.scratch).unwrap();
                }
            }
            state.particles.poses
        })
    };
    let one = places(1, 1, None);
    for (partitions, threads, saved_at) in [(1, 1, Some(50)), (3, 2, None), (4, 4, Some(1))] {
        assert!(places(partitions, threads, saved_at) == one, "{partitions}");
    }
}
