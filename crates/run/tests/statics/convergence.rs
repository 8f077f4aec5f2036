//! Convergence of Newton's method, and the same bits for any number of threads.

use dem_engine::state::State;
use dem_physics::bond::stiffness::BondModel;

use super::{fix, load, rest};
use crate::bars::{ELASTIC, MODELS, random_body, with_threads};

/// Asserts that each residual is at most as large as the square of the previous one, for those with
/// a tangent of their own.
fn assert_quadratic(residuals: &[f64]) {
    let mut seen = 0;
    for pair in residuals.windows(2).filter(|p| p[0] < 0.2 && p[0] > 1e-6) {
        seen += 1;
        assert!(pair[1] < pair[0].powi(2) + 1e-10, "{residuals:?}");
    }
    assert!(seen >= 2, "too few to tell: {residuals:?}");
}

/// With the symmetric part of the tangent, which is exact without torques. A body as wide as it is
/// long: in a slender one every other step stretches what the previous one has bent.
#[test]
fn residuals_fall_quadratically_under_forces() {
    for (model, name) in MODELS {
        let mut state = random(model, 1);
        state.loads[0].force_n = [0.0, 0.05, -0.1];
        let found = rest(&mut state);
        eprintln!("{name}: {} {:?}", found.load_steps, found.residuals);
        assert_quadratic(&found.residuals);
    }
}

/// With the full tangent, which is not symmetric under torques. Axial and transverse loads
/// together, so that the asymmetry matters.
#[test]
fn residuals_fall_quadratically_under_torques() {
    for (model, name) in MODELS {
        let mut state = random(model, 1);
        state.loads[0].force_n = [0.0, 0.02, 0.0];
        state.loads[0].torque_n_m = [2e-5, 3e-5, 4e-5];
        let found = rest(&mut state);
        eprintln!("{name}: {} {:?}", found.load_steps, found.residuals);
        assert_quadratic(&found.residuals);
    }
}

/// The random body, fixed on one side and loaded on the other.
fn random(model: BondModel, threads: usize) -> State {
    let mut state = random_body(model, ELASTIC, 1e-6);
    let mut state = State::new(
        state.particles,
        std::mem::take(&mut state.bonds),
        1e-6,
        threads,
    );
    let place = |i: &u32| state.particles.poses[*i as usize].position_m[0];
    let mut order: Vec<u32> = (0..state.particles.len() as u32).collect();
    order.sort_by(|a, b| place(a).total_cmp(&place(b)));
    let (left, right) = (order[..40].to_vec(), order[460..].to_vec());
    fix(&mut state, &left);
    load(&mut state, &right, [0.0, 1e-3, -2e-3], [0.0; 3]);
    state.model.gravity_m_s2 = [0.0, 0.0, -9.81];
    state
}

#[test]
fn bits_are_the_same_for_any_number_of_threads() {
    let solved = |threads: usize| {
        with_threads(threads, || {
            let mut state = random(BondModel::Timoshenko, threads);
            let found = rest(&mut state);
            assert_eq!(state.scratch.partitions.len(), threads);
            (found, state)
        })
    };
    let (found, state) = solved(1);
    eprintln!("{found:?}");
    for threads in [2, 3] {
        let (other, with_more) = solved(threads);
        assert_eq!(found, other);
        assert_eq!(state.particles.poses, with_more.particles.poses);
        assert_eq!(state.supports, with_more.supports);
    }
}

/// Forces and moments of loads, weight and supports are balanced.
#[test]
fn reactions_balance_the_loads() {
    let mut state = random(BondModel::Timoshenko, 1);
    rest(&mut state);
    let mut sums = [nalgebra::Vector3::<f64>::zeros(); 2];
    let mut size = [0.0_f64; 2];
    let mut add = |i: usize, force: nalgebra::Vector3<f64>, torque: nalgebra::Vector3<f64>| {
        let moment = state.particles.poses[i].place().cross(&force) + torque;
        for ((sum, size), part) in sums.iter_mut().zip(&mut size).zip([force, moment]) {
            *sum += part;
            *size += part.norm();
        }
    };
    for held in &state.supports[0].held {
        let [fx, fy, fz, tx, ty, tz] = held.reactions[0];
        add(
            held.particle as usize,
            [fx, fy, fz].into(),
            [tx, ty, tz].into(),
        );
    }
    for &i in &state.loads[0].particles {
        add(
            i as usize,
            state.loads[0].force_n.into(),
            nalgebra::Vector3::zeros(),
        );
    }
    for (i, motion) in state.particles.motions.iter().enumerate() {
        let weight = [0.0, 0.0, -9.81 / motion.inverse_mass];
        add(i, weight.into(), nalgebra::Vector3::zeros());
    }
    for (sum, size) in sums.iter().zip(size) {
        assert!(sum.norm() < 1e-11 * size, "{sum} of {size}");
    }
}
