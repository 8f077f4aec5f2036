//! Bonds that break during a run: their energy is recorded, and the error of each break decreases
//! with the step.

use crate::bars::{BondDamping, ELASTIC, bar, damp, law, random_body, reopen, with_threads};
use crate::helpers::step_and_balance;
use dem_engine::state::State;
use dem_engine::state::bonds::BondRule;
use dem_physics::bond::failure::{Criteria, EquivalentStress};
use dem_physics::bond::stiffness::BondModel;

fn breaking(tensile_strength_pa: f64, incremental: bool) -> BondRule {
    BondRule {
        law: law(incremental),
        criteria: Some(Criteria {
            tensile_strength_pa,
            compressive_strength_pa: f64::INFINITY,
            shear_strength_pa: f64::INFINITY,
            cohesion_pa: f64::INFINITY,
            friction_tangent: 0.0,
            von_mises_strength_pa: f64::INFINITY,
            equivalent_stress: EquivalentStress::AxialInTension,
        }),
        ..ELASTIC
    }
}

/// Results of a run in which bonds break.
#[derive(Debug)]
struct Left {
    /// Mean of the energy error that each break adds, over the mean energy that one releases.
    per_break: f64,
    broken: u64,
    /// Largest energy error of the run.
    energy: f64,
    momentum: f64,
    angular_momentum: f64,
    /// A free particle moves by the same length in every step and is rounded in the same direction:
    /// its position, and with it the angular momentum about a point, has an error of up to the
    /// number of steps times this.
    rounding: f64,
}

fn left(mut state: State, steps: u64) -> Left {
    let mut left = Left {
        per_break: 0.0,
        broken: 0,
        energy: 0.0,
        momentum: 0.0,
        angular_momentum: 0.0,
        rounding: 1e-13 + steps as f64 * f64::EPSILON,
    };
    let mut released = 0.0;
    let mut jumps = 0.0;
    let mut before = 0.0;
    for _ in 0..steps {
        let b = step_and_balance(&mut state);
        if !state.scratch.events.broken.is_empty() {
            jumps += (b.energy_error_j - before).abs();
        }
        before = b.energy_error_j;
        released = b.bond_breakage_j;
        left.energy = left.energy.max(b.energy_error.abs());
        left.momentum = left.momentum.max(b.momentum_error);
        left.angular_momentum = left.angular_momentum.max(b.angular_momentum_error);
    }
    left.broken = state.broken_count;
    left.per_break = jumps / released;
    left
}

/// The bar flies apart: its halves are pulled away from each other and rotate, so that bonds break
/// one after another.
fn torn(incremental: bool, step_s: f64) -> State {
    let mut state = bar(BondModel::Timoshenko, breaking(100e6, incremental), step_s);
    for (i, motion) in state.particles.motions.iter_mut().enumerate() {
        let x = (i as f64 - 5.0) / 5.0;
        motion.velocity_m_s = [8.0 * x.powi(3), 10.0 * x * x, 2.0];
        motion.spin_rad_s = [10.0 * x, 0.0, 10.0 * x];
    }
    reopen(&mut state);
    state
}

#[test]
fn the_error_of_a_break_falls_with_the_step() {
    with_threads(1, || {
        for incremental in [false, true] {
            for damped in [false, true] {
                let runs = [10_u32, 20, 40, 80, 160].map(|finer| {
                    let mut state = torn(incremental, 6.5e-5 / f64::from(finer));
                    if damped {
                        damp(&mut state, BondDamping::ChenByMode(0.05));
                    }
                    left(state, 200 * u64::from(finer))
                });
                eprintln!("incremental {incremental}, damped {damped}");
                for run in &runs {
                    eprintln!("  {run:?}");
                    assert!(run.broken >= 3, "{run:?}");
                    assert!(
                        run.momentum < 1e-12 && run.angular_momentum < run.rounding,
                        "{run:?}"
                    );
                }
                // A sixteenth of the step: at most a sixteenth of the error.
                assert!(runs[4].per_break < runs[0].per_break / 16.0);
                assert!(runs[4].energy < runs[0].energy / 16.0);
            }
        }
    });
}

/// A random body spun to pieces: hundreds of bonds.
#[test]
fn many_breaks_leave_a_small_error() {
    with_threads(1, || {
        let runs = [4.0, 8.0, 16.0].map(|finer| {
            let mut state =
                random_body(BondModel::Timoshenko, breaking(0.15e6, false), 4e-6 / finer);
            for (pose, motion) in state
                .particles
                .poses
                .iter()
                .zip(&mut state.particles.motions)
            {
                let [x, y, _]: [f64; 3] = pose.place().into();
                motion.velocity_m_s = [-6000.0 * (y - 0.0026), 6000.0 * (x - 0.0026), 0.0];
                motion.spin_rad_s = [0.0, 0.0, 6000.0];
            }
            reopen(&mut state);
            left(state, (100.0 * finer) as u64)
        });
        for run in &runs {
            eprintln!("{run:?}");
            assert!(run.broken > 100, "{run:?}");
            assert!(
                run.momentum < 1e-12 && run.angular_momentum < run.rounding,
                "{run:?}"
            );
        }
        assert!(runs[2].per_break < runs[0].per_break / 4.0);
    });
}
