//! Static equilibrium: closed forms, convergence, supports, stability, refusals, and comparison
//! with time stepping.

mod convergence;
mod elastica;
mod explicit;
mod large_turns;
mod pressed;
mod refused;
mod small_loads;
mod stability;
mod supports;

use dem_engine::state::State;
use dem_engine::state::loads::GroupLoad;
use dem_engine::state::supports::GroupSupport;
use dem_engine::state::supports::HeldParticle;
use dem_physics::bond::stiffness::BondModel;
use dem_runner::statics::{Equilibrium, equilibrium, set_at_rest};
use dem_scene::{Factor, Hold};
use nalgebra::Vector3;

use crate::bars::{ELASTIC, body, spheres, steel};

/// Time at which loads and supports are evaluated, s.
const END_S: f64 = 1.0;

/// A steel bar along x: this many bonds of length 0.4 m and radius 0.2 m times a factor.
fn bar(model: BondModel, bonds: u32, radius_factor: f64) -> State {
    let (particles, pairs) = spheres(bonds + 1);
    let mut bonding = steel(model, ELASTIC);
    bonding.radius_factor = radius_factor;
    body(particles, &pairs, &bonding, 1.0)
}

/// Fixes these degrees of freedom of these particles.
fn hold(state: &mut State, particles: &[u32], holds: [Option<Hold>; 6], factor: Factor) {
    let held = |&particle: &u32| HeldParticle {
        particle,
        ..HeldParticle::default()
    };
    state.supports.push(GroupSupport {
        end_s: f64::INFINITY,
        holds,
        factor,
        held: particles.iter().map(held).collect(),
    });
}

/// Fixes all degrees of freedom of these particles.
fn fix(state: &mut State, particles: &[u32]) {
    hold(state, particles, [Some(Hold::Fixed); 6], Factor::One);
}

/// Loads each of these particles.
fn load(state: &mut State, particles: &[u32], force_n: [f64; 3], torque_n_m: [f64; 3]) {
    state.loads.push(GroupLoad {
        end_s: f64::INFINITY,
        particles: particles.to_vec(),
        force_n,
        torque_n_m,
        factor: Factor::One,
    });
}

/// Solves for the complete equilibrium of a state.
fn rest(state: &mut State) -> Equilibrium {
    let found = equilibrium(state, END_S, &|_| true).unwrap();
    set_at_rest(state, END_S, 1);
    found
}

/// Displacement of a particle of a bar.
fn moved(state: &State, i: usize) -> Vector3<f64> {
    state.particles.poses[i].place() - Vector3::new(0.4 * i as f64, 0.0, 0.0)
}

fn assert_near(found: f64, wanted: f64, tolerance: f64, what: &str) {
    let off = (found / wanted - 1.0).abs();
    assert!(
        off < tolerance,
        "{what}: {found} instead of {wanted}, off by {off:.1e}"
    );
}
