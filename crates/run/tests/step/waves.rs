//! Waves along a chain: the dispersion of a discrete chain, and the speed of the continuum.

use crate::bars::{ELASTIC, body, spheres, steel, with_threads};
use dem_engine::state::State;
use dem_engine::step::step;
use dem_physics::bond::stiffness::BondModel;
use std::f64::consts::PI;

const SPACING_M: f64 = 0.4;
/// Bonds along a straight chain are linear, however large this is; a small one would vanish in the
/// rounding of positions.
const SPEED_M_S: f64 = 1.0;

/// A chain, and the square root of its normal stiffness over mass, 1/s.
fn chain(count: u32, model: BondModel) -> (State, f64) {
    let (particles, pairs) = spheres(count);
    let state = body(particles, &pairs, &steel(model, ELASTIC), 1e-6);
    let rate = (state.bonds.normal(0) * state.particles.motions[0].inverse_mass).sqrt();
    (state, rate)
}

/// A standing wave of wave number q of a free chain keeps its shape and oscillates with 2 sqrt(k/m)
/// sin(q L/2); with a step dt, sin(omega dt/2) follows from that.
#[test]
fn standing_waves_have_the_dispersion_of_the_discrete_chain() {
    with_threads(1, || {
        let count = 50;
        for mode in [1, 3, 10, 25, 40, 49] {
            let (mut state, rate) = chain(count, BondModel::Timoshenko);
            state.time_step_s = 0.5 / rate;
            let phase = PI * f64::from(mode) / f64::from(count);
            let shape = |i: usize| (phase * (i as f64 + 0.5)).cos();
            for (i, motion) in state.particles.motions.iter_mut().enumerate() {
                motion.velocity_m_s[0] = SPEED_M_S * shape(i);
            }
            let continuous = 2.0 * rate * (0.5 * phase).sin();
            let omega = 2.0 / state.time_step_s * (0.5 * state.time_step_s * continuous).asin();
            let mut worst = 0.0_f64;
            for _ in 0..2000 {
                step(&mut state);
                // Velocities start at the time of the poses and are then half a step before them.
                let at_s = state.time_s - 0.5 * state.time_step_s;
                let start = (0.5 * omega * state.time_step_s).cos();
                for (i, motion) in state.particles.motions.iter().enumerate() {
                    let wanted = SPEED_M_S * shape(i) * (omega * at_s).cos() / start;
                    worst = worst.max((motion.velocity_m_s[0] - wanted).abs() / SPEED_M_S);
                }
            }
            eprintln!("mode {mode}: {worst:e}");
            assert!(worst < 1e-6, "mode {mode}: {worst:e}");
        }
    });
}

/// Centre of the kinetic energy, in spacings.
fn centre(state: &State) -> f64 {
    let (mut weight, mut sum) = (0.0, 0.0);
    for (i, motion) in state.particles.motions.iter().enumerate() {
        let energy = motion.velocity_m_s[0].powi(2);
        weight += energy;
        sum += energy * i as f64;
    }
    sum / weight
}

#[test]
fn a_long_pulse_travels_with_the_speed_of_the_continuum() {
    with_threads(1, || {
        for model in [BondModel::Timoshenko, BondModel::Parallel { kappa: None }] {
            let (mut state, rate) = chain(700, model);
            // sqrt(E A / (m / L)).
            let area = PI * 0.2 * 0.2;
            let line_kg_m = 1.0 / state.particles.motions[0].inverse_mass / SPACING_M;
            let speed = (200e9 * area / line_kg_m).sqrt();
            assert!((speed / (SPACING_M * rate) - 1.0).abs() < 1e-12);
            state.time_step_s = 0.1 / rate;
            let (start, width) = (180.0, 30.0);
            for i in 0..state.particles.len() {
                // Displacement exp(-z^2/2) that travels: its velocity is minus the speed times its
                // slope.
                let back = -0.5 * state.time_step_s * rate;
                let (z, z_back) = (
                    (i as f64 - start) / width,
                    (i as f64 - start - back) / width,
                );
                let shift = 1e-6 * (-0.5 * z * z).exp();
                state.particles.poses[i].position_m[0] += shift;
                let velocity =
                    1e-6 * z_back * (-0.5 * z_back * z_back).exp() * speed / (width * SPACING_M);
                state.particles.motions[i].velocity_m_s[0] = velocity;
            }
            // As if it had been running: velocities are half a step before the poses.
            state.previous_time_step_s = state.time_step_s;
            let (from, at_s) = (centre(&state), state.time_s);
            for _ in 0..3000 {
                step(&mut state);
            }
            let found = (centre(&state) - from) * SPACING_M / (state.time_s - at_s);
            let off = found / speed - 1.0;
            // Group velocity c cos(q L/2), averaged over q^2 in the energy of the pulse, 3/(2
            // width^2).
            let discrete = -3.0 / (16.0 * width * width);
            eprintln!("{model:?}: {off:e}, as a discrete chain {discrete:e}");
            assert!(off.abs() < 1e-3, "{model:?}: {off:e}");
            assert!(
                (off - discrete).abs() < 5e-5,
                "{model:?}: {off:e} instead of {discrete:e}"
            );
        }
    });
}
