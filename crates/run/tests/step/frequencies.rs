//! Frequencies of small motions measured in runs, compared with an independent eigenvalue solver.

use crate::bars::{Bonding, ELASTIC, bar, body, steel, with_threads};
use dem_engine::state::State;
use dem_engine::state::particles::{Motion, Particles};
use dem_engine::state::supports::GroupSupport;
use dem_engine::state::supports::HeldParticle;
use dem_engine::step::step;
use dem_physics::bond::stiffness::BondModel;
use dem_scene::{Factor, Hold};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

#[derive(Deserialize)]
struct Oscillation {
    chain: BTreeMap<String, Chain>,
    pairs: Vec<Pair>,
}

#[derive(Deserialize)]
struct Chain {
    free_free_first_8: Vec<f64>,
    clamped_first_6: Vec<f64>,
}

#[derive(Deserialize)]
#[expect(non_snake_case, reason = "names of the reference values")]
struct Pair {
    name: String,
    model: String,
    E: f64,
    nu: f64,
    rho: f64,
    Ra: f64,
    Rb: f64,
    L: f64,
    rb: f64,
    omega_axial: f64,
    omega_torsion: f64,
    bend_modes_state: Vec<Bend>,
}

#[derive(Deserialize)]
struct Bend {
    omega: f64,
    ya: f64,
    theta_za: f64,
    yb: f64,
    theta_zb: f64,
}

fn read() -> Oscillation {
    serde_json::from_str(include_str!("data/oscillation.json")).unwrap()
}

fn model(name: &str) -> BondModel {
    match name {
        "PBM" => BondModel::Parallel { kappa: None },
        "EBBM" => BondModel::EulerBernoulli,
        "TBBM" => BondModel::Timoshenko,
        "MUSEN" => BondModel::ElasticSolid,
        _ => panic!("{name}"),
    }
}

/// Velocity, m/s, and spin, rad/s.
type Moving = ([f64; 3], [f64; 3]);

fn set_moving(motion: &mut Motion, (velocity_m_s, spin_rad_s): Moving) {
    motion.velocity_m_s = velocity_m_s;
    motion.spin_rad_s = spin_rad_s;
}

/// Angular frequency of a mode that starts with these velocities, from the times of the zero
/// crossings of its velocity.
fn measured(mut state: State, motions: [Moving; 2], near: f64) -> f64 {
    let along = |state: &State| -> f64 {
        let p = &state.particles;
        let of = |i: usize| {
            let (now, (velocity, spin)) = (&p.motions[i], motions[i]);
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            dot(now.velocity_m_s, velocity) / now.inverse_mass
                + dot(now.spin_rad_s, spin) / now.inverse_inertia
        };
        of(0) + of(1)
    };
    for (motion, moving) in state.particles.motions.iter_mut().zip(motions) {
        set_moving(motion, moving);
    }
    state.time_step_s = 0.02 / near;
    let (mut before, mut crossings) = (along(&state), Vec::new());
    while crossings.len() < 11 {
        step(&mut state);
        let now = along(&state);
        if before * now < 0.0 {
            // Velocities are those of half a step earlier.
            crossings.push(state.time_s - state.time_step_s * (0.5 + now / (now - before)));
        }
        before = now;
    }
    TAU * 5.0 / (crossings[10] - crossings[0])
}

#[test]
fn two_particles_swing_with_the_frequencies_of_the_reference() {
    let pairs = read().pairs;
    assert_eq!(pairs.len(), 8);
    for pair in pairs {
        assert_eq!(pair.nu, 0.3);
        let mut particles = Particles::default();
        particles.push_sphere([0.0; 3], pair.Ra, pair.rho);
        particles.push_sphere([pair.L, 0.0, 0.0], pair.Rb, pair.rho);
        let [a, b] = [0, 1].map(|i| particles.motions[i]);
        let heavier = a.inverse_mass / b.inverse_mass;
        let harder_to_turn = a.inverse_inertia / b.inverse_inertia;
        let bonding = Bonding {
            radius_factor: pair.rb / pair.Ra.min(pair.Rb),
            young_modulus_pa: pair.E,
            ..steel(model(&pair.model), ELASTIC)
        };
        let state = body(particles, &[[0, 1]], &bonding, 1e-9);
        let small = 1e-4;
        let mut modes = vec![
            (
                pair.omega_axial,
                ([small, 0.0, 0.0], [0.0; 3]),
                ([-small / heavier, 0.0, 0.0], [0.0; 3]),
            ),
            (
                pair.omega_torsion,
                ([0.0; 3], [small, 0.0, 0.0]),
                ([0.0; 3], [-small / harder_to_turn, 0.0, 0.0]),
            ),
        ];
        // In the y plane and in the z plane, where a slope has the opposite sign.
        for bend in &pair.bend_modes_state {
            let [ya, yb, ta, tb] =
                [bend.ya, bend.yb, bend.theta_za, bend.theta_zb].map(|v| small * v);
            modes.push((
                bend.omega,
                ([0.0, ya, 0.0], [0.0, 0.0, ta]),
                ([0.0, yb, 0.0], [0.0, 0.0, tb]),
            ));
            modes.push((
                bend.omega,
                ([0.0, 0.0, ya], [0.0, -ta, 0.0]),
                ([0.0, 0.0, yb], [0.0, -tb, 0.0]),
            ));
        }
        assert_eq!(modes.len(), 6);
        for (omega, a, b) in modes {
            let found = measured(state.clone(), [a, b], omega);
            let off = found / omega - 1.0;
            eprintln!("{} {} {omega:.1}: {off:e}", pair.name, pair.model);
            // With a step of 0.02 radian it is 2e-5 too fast.
            assert!(
                (off - 1.667e-5).abs() < 5e-6,
                "{} {} {omega}: {found}",
                pair.name,
                pair.model
            );
        }
    }
}

/// Frequency near `near` at which the windowed velocities are largest.
fn peak(velocities: &[f64], every_s: f64, near: f64) -> f64 {
    let count = velocities.len() as f64;
    let size = |omega: f64| {
        let (mut re, mut im) = (0.0, 0.0);
        for (i, v) in velocities.iter().enumerate() {
            let window = 1.0 - (TAU * (i as f64 + 0.5) / count).cos();
            let (sin, cos) = (omega * every_s * i as f64).sin_cos();
            re += window * v * cos;
            im += window * v * sin;
        }
        re.hypot(im)
    };
    let (mut low, mut high) = (0.99 * near, 1.01 * near);
    while high - low > 1e-6 * near {
        let third = (high - low) / 3.0;
        if size(low + third) < size(high - third) {
            low += third;
        } else {
            high -= third;
        }
    }
    0.5 * (low + high)
}

/// Velocities of the last particle of the bar after an impact, at regular intervals, summed over
/// all excited degrees of freedom.
fn rung(mut state: State, steps: usize, every: usize) -> Vec<f64> {
    set_moving(
        &mut state.particles.motions[10],
        ([1e-5, 1e-5, 0.0], [1e-4, 0.0, 0.0]),
    );
    let mut velocities = Vec::new();
    for at in 0..steps {
        step(&mut state);
        if at % every == 0 {
            let m = &state.particles.motions[10];
            velocities.push(m.velocity_m_s[0] + m.velocity_m_s[1] + 0.2 * m.spin_rad_s[0]);
        }
    }
    velocities
}

#[test]
fn a_chain_rings_with_the_modes_of_the_reference() {
    let (step_s, every) = (1e-5, 20);
    with_threads(1, || {
        for (name, chain) in read().chain {
            for (clamped, wanted) in [
                (false, &chain.free_free_first_8),
                (true, &chain.clamped_first_6),
            ] {
                let mut state = bar(model(&name), ELASTIC, step_s);
                if clamped {
                    state.supports = vec![GroupSupport {
                        end_s: f64::INFINITY,
                        holds: [Some(Hold::Fixed); 6],
                        factor: Factor::One,
                        held: vec![HeldParticle::default()],
                    }];
                }
                let velocities = rung(state, 60_000, every);
                for &omega in wanted {
                    let found = peak(&velocities, step_s * every as f64, omega);
                    let off = found / omega - 1.0;
                    eprintln!("{name} {clamped} {omega:.1}: {off:e}");
                    assert!(off.abs() < 1e-3, "{name} {clamped} {omega}: {found}");
                }
            }
        }
    });
}
