//! Rods for the failure tests.

use std::sync::Arc;

use std::f64::consts::PI;

use crate::bars::{ELASTIC, law};
use dem_engine::check::limit::limit;
use dem_engine::state::State;
use dem_engine::state::bonds::{BondRule, Bonds};
use dem_engine::state::loads::GroupLoad;
use dem_engine::state::particles::{Particles, Wrench};
use dem_engine::state::supports::GroupSupport;
use dem_engine::state::supports::HeldParticle;
use dem_physics::bond::failure::{Criteria, EquivalentStress};
use dem_physics::bond::stiffness::{BondModel, BondShape, stiffness};
use dem_physics::bond::total::direction;
use dem_scene::{Factor, Hold};

/// Radius of spheres and bonds, m.
pub(crate) const RADIUS_M: f64 = 1e-3;
/// Length of a bond, m.
pub(crate) const LENGTH_M: f64 = 2e-3;
/// Tensile strength, Pa; the others are similar.
pub(crate) const STRENGTH_PA: f64 = 1e6;
/// So stiff that the deflected shape does not matter: an axial force on a rod of five bonds that is
/// bent to its strength changes the moment by about (stress over stiffness) (length over radius)^2,
/// 1e-5, a tenth of the load's step, and less for combined loads. With a softer rod it would
/// matter; with a stiffer one the rounding of positions would.
pub(crate) const YOUNG_PA: f64 = 1e13;

/// Criteria without strengths.
pub(crate) const NONE: Criteria = Criteria {
    tensile_strength_pa: f64::INFINITY,
    compressive_strength_pa: f64::INFINITY,
    shear_strength_pa: f64::INFINITY,
    cohesion_pa: f64::INFINITY,
    friction_tangent: 0.0,
    von_mises_strength_pa: f64::INFINITY,
    equivalent_stress: EquivalentStress::AxialInTension,
};
/// Strength at the tensile edge.
pub(crate) const NORMAL: Criteria = Criteria {
    tensile_strength_pa: STRENGTH_PA,
    ..NONE
};
/// Strength at the compressed edge.
pub(crate) const PRESSED: Criteria = Criteria {
    compressive_strength_pa: 1.3 * STRENGTH_PA,
    ..NONE
};
/// MUSEN's shear strength.
pub(crate) const SHEAR: Criteria = Criteria {
    shear_strength_pa: 0.6 * STRENGTH_PA,
    ..NONE
};
/// The equivalent stress of Platzer 2022, eq. 13.
pub(crate) const VON_MISES: Criteria = Criteria {
    von_mises_strength_pa: 1.1 * STRENGTH_PA,
    ..NONE
};
/// The strength of Mohr and Coulomb.
pub(crate) const MOHR_COULOMB: Criteria = Criteria {
    cohesion_pa: 0.55 * STRENGTH_PA,
    friction_tangent: 0.6,
    ..NONE
};
/// All five.
pub(crate) const ALL: Criteria = Criteria {
    tensile_strength_pa: NORMAL.tensile_strength_pa,
    compressive_strength_pa: PRESSED.compressive_strength_pa,
    shear_strength_pa: SHEAR.shear_strength_pa,
    cohesion_pa: MOHR_COULOMB.cohesion_pa,
    friction_tangent: MOHR_COULOMB.friction_tangent,
    von_mises_strength_pa: VON_MISES.von_mises_strength_pa,
    ..NONE
};

/// Cross-section of a bond, m2.
pub(crate) fn area_m2() -> f64 {
    PI * RADIUS_M * RADIUS_M
}

/// A row of spheres from the origin along x, with this many bonds, free and at rest. Its step is
/// half of the limit.
pub(crate) fn rod(bonds: usize, criteria: Criteria, incremental: bool) -> State {
    let mut particles = Particles::default();
    for i in 0..=bonds {
        particles.push_sphere([LENGTH_M * i as f64, 0.0, 0.0], RADIUS_M, 2500.0);
    }
    let pairs: Vec<[u32; 2]> = (0..bonds as u32).map(|i| [i, i + 1]).collect();
    bonded(particles, &pairs, criteria, incremental)
}

/// These spheres with bonds between these pairs. The step is half of the limit.
pub(crate) fn bonded(
    particles: Particles,
    pairs: &[[u32; 2]],
    criteria: Criteria,
    incremental: bool,
) -> State {
    let mut bonds = Bonds {
        rules: Arc::new([BondRule {
            law: law(incremental),
            criteria: Some(criteria),
            ..ELASTIC
        }]),
        ..Bonds::default()
    };
    for &[a, b] in pairs {
        let apart = particles.poses[b as usize].place() - particles.poses[a as usize].place();
        let shape = BondShape {
            length_m: apart.norm(),
            radius_m: RADIUS_M,
            end_radii_m: [RADIUS_M; 2],
        };
        let stiffness = stiffness(BondModel::Timoshenko, &shape, YOUNG_PA, 0.3);
        bonds.push([a, b], direction(&apart).into(), RADIUS_M, &stiffness, 0);
    }
    let mut state = State::new(particles, bonds, 1e-9, 1);
    state.time_step_s = 0.5 * limit(&mut state).step_s;
    state
}

/// Fixes these spheres, except for a motion along x at this speed.
pub(crate) fn hold(state: &mut State, particles: impl Iterator<Item = u32>, speed_m_s: f64) {
    let mut holds = [Some(Hold::Fixed); 6];
    holds[0] = Some(Hold::Velocity(speed_m_s));
    let held = |particle| HeldParticle {
        particle,
        ..HeldParticle::default()
    };
    state.supports.push(GroupSupport {
        end_s: f64::INFINITY,
        holds,
        factor: Factor::One,
        held: particles.map(held).collect(),
    });
}

/// Number of steps in which a load of [`push`] reaches its full slope; it reaches its value in
/// twice as many.
pub(crate) const SOFT_STEPS: u32 = 8000;
/// Growth of such a load per step, as a fraction of its value.
pub(crate) const LOAD_STEP: f64 = 2.0 / (3.0 * SOFT_STEPS as f64);

/// Loads a sphere so slowly and smoothly that the body does not oscillate: the slope of the load
/// increases as the square of a sine and then stays constant. The remaining oscillations are pi^2 /
/// 2 / (N^2 (omega dt)^3) of the load's step, N = 8000: a fiftieth for a rod of five bonds, whose
/// slowest omega dt is 0.017.
pub(crate) fn push(state: &mut State, particle: u32, force_n: [f64; 3], torque_n_m: [f64; 3]) {
    let soft = f64::from(SOFT_STEPS);
    let factor = |step: u32| {
        let n = f64::from(step);
        let risen = n.min(soft);
        // The integral of sin^2.
        LOAD_STEP * (0.5 * risen - soft / (2.0 * PI) * (PI * risen / soft).sin() + n - risen)
    };
    let points =
        (0..=3 * SOFT_STEPS).map(|step| [f64::from(step) * state.time_step_s, factor(step)]);
    state.loads.push(GroupLoad {
        end_s: f64::INFINITY,
        particles: vec![particle],
        force_n,
        torque_n_m,
        factor: Factor::Table(points.collect()),
    });
}

/// Damps all particles by gamma.
pub(crate) fn damp(state: &mut State, gamma: f64) {
    state.model.particle_damping = gamma;
    state.scratch.particle_resistance = vec![Wrench::default(); state.particles.len()];
}

/// Runs on one worker thread: handing each step of a small body to another thread takes longer than
/// the step.
pub(crate) fn on_one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(work)
}
