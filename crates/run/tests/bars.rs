//! Bodies for the tests, and operations on them.

use dem_engine::stages::ledger::bookkeeping::opened;
use dem_engine::state::State;
use dem_engine::state::bonds::{BondLaw, BondRule, Bonds};
use dem_engine::state::particles::{Particles, Wrench};
use dem_engine::step::step;
use dem_physics::bond::damping::{DampingCoefficients, DampingModel, ReducedInertia, reduced};
use dem_physics::bond::damping_models::{Chen, ChenByMode, Platzer};
use dem_physics::bond::rate_strengthening::{IncreaseCurve, RateStrengthening};
use dem_physics::bond::stiffness::{BondModel, BondShape, Stiffness, stiffness};
use dem_physics::bond::total::direction;
use nalgebra::{UnitQuaternion, Vector3};

use crate::helpers::step_and_balance;

/// A rule without damping and failure.
pub(crate) const ELASTIC: BondRule = BondRule {
    law: BondLaw::Elastic,
    damped: false,
    structural_damping: 0.0,
    criteria: None,
    strengthening: None,
    strain_rate_measure: dem_scene::StrainRateMeasure::Elongation,
    contact_beside: false,
};

/// Strengths that rise by eq. 20 of Platzer 2022 above this rate, 1/s.
pub(crate) const fn eq_20(from_1_s: f64) -> Option<RateStrengthening> {
    Some(RateStrengthening {
        curve: IncreaseCurve::Platzer { from_1_s },
        keeps_largest: false,
    })
}

/// The elastic law, by this formulation.
pub(crate) fn law(incremental: bool) -> BondLaw {
    if incremental {
        BondLaw::Incremental
    } else {
        BondLaw::Elastic
    }
}

/// All bond models, with the names in the reference values, which have no elastic solid bond.
pub(crate) const MODELS: [(BondModel, &str); 5] = [
    (BondModel::Parallel { kappa: None }, "PBM"),
    (BondModel::EulerBernoulli, "EBBM"),
    (BondModel::Timoshenko, "TBBM"),
    (BondModel::ShearCoefficient { alpha: 0.9 }, "OBERMAYR"),
    (BondModel::ElasticSolid, ""),
];

/// Largest stable step of the bar of Timoshenko bonds, s.
pub(crate) const BAR_LIMIT_S: f64 = 6.536982689455117e-5;

/// Damping of bonds.
#[derive(Debug, Clone, Copy)]
pub(crate) enum BondDamping {
    /// Chen et al. 2022, eqs. 9 and 10.
    Chen(f64),
    /// The same with the stiffness of each mode.
    ChenByMode(f64),
    /// Platzer 2022: this fraction of 2 sqrt(k_n m_red) for the velocity, and this factor for the
    /// moments.
    Platzer(f64, f64),
}

impl BondDamping {
    fn coefficients(self, k: &Stiffness, ends: &ReducedInertia) -> DampingCoefficients {
        match self {
            Self::Chen(damping_ratio) => Chen { damping_ratio }.coefficients(k, ends),
            Self::ChenByMode(damping_ratio) => ChenByMode { damping_ratio }.coefficients(k, ends),
            Self::Platzer(fraction, moments) => {
                let model = Platzer {
                    coefficient_n_s_m: 2.0 * fraction * (k.normal * ends.mass_kg).sqrt(),
                    moment_factor: moments,
                };
                model.coefficients(k, ends)
            }
        }
    }
}

/// Properties of a body.
#[derive(Debug, Clone)]
pub(crate) struct Bonding {
    /// Radius of a bond over that of the smaller of its two spheres.
    pub(crate) radius_factor: f64,
    pub(crate) model: BondModel,
    pub(crate) young_modulus_pa: f64,
    pub(crate) rule: BondRule,
}

/// Adds bonds between these pairs, at rest in the present positions, that follow the next rule.
pub(crate) fn add_bonds(
    bonds: &mut Bonds,
    particles: &Particles,
    pairs: &[[u32; 2]],
    of: &Bonding,
) {
    let rule = bonds.rules.len();
    bonds.rules = bonds.rules.iter().chain([&of.rule]).cloned().collect();
    for &[a, b] in pairs {
        let apart = particles.poses[b as usize].place() - particles.poses[a as usize].place();
        let radii = [a, b].map(|end| particles.poses[end as usize].radius_m());
        let shape = BondShape {
            length_m: apart.norm(),
            radius_m: of.radius_factor * radii[0].min(radii[1]),
            end_radii_m: radii,
        };
        let stiffness = stiffness(of.model, &shape, of.young_modulus_pa, 0.3);
        bonds.push(
            [a, b],
            direction(&apart).into(),
            shape.radius_m,
            &stiffness,
            rule,
        );
    }
}

/// Particles with bonds of one type.
pub(crate) fn body(
    particles: Particles,
    pairs: &[[u32; 2]],
    bonding: &Bonding,
    time_step_s: f64,
) -> State {
    let mut bonds = Bonds::default();
    add_bonds(&mut bonds, &particles, pairs, bonding);
    State::new(particles, bonds, time_step_s, 1)
}

/// Spheres of a bar: this many of radius 0.2 m along x that touch, 7850 kg/m3.
pub(crate) fn spheres(count: u32) -> (Particles, Vec<[u32; 2]>) {
    let mut particles = Particles::default();
    for i in 0..count {
        particles.push_sphere([0.4 * f64::from(i), 0.0, 0.0], 0.2, 7850.0);
    }
    (particles, (0..count - 1).map(|i| [i, i + 1]).collect())
}

/// Steel bonds with the radius of the spheres.
pub(crate) fn steel(model: BondModel, rule: BondRule) -> Bonding {
    Bonding {
        radius_factor: 1.0,
        model,
        young_modulus_pa: 200e9,
        rule,
    }
}

/// The bar of case 1 of Chen et al. 2022: 11 spheres of radius 0.2 m along x, density 7850 kg/m3, E
/// = 200 GPa.
pub(crate) fn bar(model: BondModel, rule: BondRule, time_step_s: f64) -> State {
    let (particles, pairs) = spheres(11);
    body(particles, &pairs, &steel(model, rule), time_step_s)
}

#[derive(serde::Deserialize)]
struct RandomBody {
    positions_m: Vec<[f64; 3]>,
    radii_m: Vec<f64>,
    pairs: Vec<[u32; 2]>,
}

/// Spheres and pairs of the random body of the reference values: 500 and 2500.
pub(crate) fn random_spheres() -> (Particles, Vec<[u32; 2]>) {
    let read: RandomBody = serde_json::from_str(include_str!("data/random500.json")).unwrap();
    let mut particles = Particles::default();
    for (position, radius) in read.positions_m.into_iter().zip(read.radii_m) {
        particles.push_sphere(position, radius, 2050.0);
    }
    (particles, read.pairs)
}

/// Bonds of the random body.
pub(crate) fn soft(model: BondModel, rule: BondRule) -> Bonding {
    Bonding {
        young_modulus_pa: 12.05e6,
        ..steel(model, rule)
    }
}

/// The random body of the reference values.
pub(crate) fn random_body(model: BondModel, rule: BondRule, time_step_s: f64) -> State {
    let (particles, pairs) = random_spheres();
    body(particles, &pairs, &soft(model, rule), time_step_s)
}

/// Damps all bonds.
pub(crate) fn damp(state: &mut State, damping: BondDamping) {
    let p = &state.particles;
    let of_bond = |at: usize| {
        let ends = state.bonds.ends[at].map(|end| end as usize);
        let ends = reduced(
            ends.map(|end| p.motions[end].inverse_mass),
            ends.map(|end| p.motions[end].inverse_inertia),
        );
        let d = damping.coefficients(&state.bonds.stiffness(at), &ends);
        [d.normal, d.shear, d.torsion, d.bending]
    };
    state.bonds.damping = (0..state.bonds.len()).map(of_bond).collect();
    let damped = |rule: &BondRule| BondRule {
        damped: true,
        ..rule.clone()
    };
    state.bonds.rules = state.bonds.rules.iter().map(damped).collect();
    state.divide();
}

/// Damps all particles with this fraction of the force on them.
pub(crate) fn damp_particles(state: &mut State, gamma: f64) {
    state.model.particle_damping = gamma;
    state.scratch.particle_resistance = vec![Wrench::default(); state.particles.len()];
}

/// Pseudo-random numbers between -1 and 1, the same on every machine.
pub(crate) fn scattered() -> impl FnMut() -> f64 {
    let mut seed = 1_u64;
    move || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Gives every particle a velocity and spin of up to this size, and reopens the ledger.
pub(crate) fn shake(state: &mut State, velocity_m_s: f64) {
    let mut next = scattered();
    let p = &mut state.particles;
    for (motion, pose) in p.motions.iter_mut().zip(&p.poses) {
        motion.velocity_m_s = [0; 3].map(|_| velocity_m_s * next());
        motion.spin_rad_s = [0; 3].map(|_| velocity_m_s / pose.radius_m() * next());
    }
    reopen(state);
}

/// The bar tumbles about all axes and vibrates in its slow modes, as in the second case of the
/// reference values' drift: 27.2 MJ, of which the bonds take up to about 80 kJ.
pub(crate) fn tumble(state: &mut State) {
    let spin = Vector3::new(20.0, 30.0, 103.5);
    let (centre, half) = (2.0, 2.0);
    for (pose, motion) in state
        .particles
        .poses
        .iter()
        .zip(&mut state.particles.motions)
    {
        let from_centre = pose.place() - Vector3::new(centre, 0.0, 0.0);
        let x = from_centre.x / half;
        // Approximately the slowest bending mode of a free bar: its deflection and its slope.
        let bend = 9.0 * (x * x - 0.4);
        let slope = 18.0 * x / half;
        let stretch = 1.5 * x;
        let velocity = spin.cross(&from_centre) + Vector3::new(stretch, bend, 0.3 * bend);
        let turn = spin + Vector3::new(6.0 * x, -0.3 * slope, slope);
        motion.velocity_m_s = velocity.into();
        motion.spin_rad_s = turn.into();
    }
    reopen(state);
}

/// Reopens the ledger.
pub(crate) fn reopen(state: &mut State) {
    state.ledger = opened(state);
}

/// The largest errors of a run.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Errors {
    /// Energy error, J.
    pub(crate) energy_j: f64,
    pub(crate) energy: f64,
    pub(crate) momentum: f64,
    pub(crate) angular_momentum: f64,
    /// Largest elastic energy, J.
    pub(crate) elastic_j: f64,
    /// Kinetic energy at the end, J.
    pub(crate) kinetic_j: f64,
}

/// Runs this many steps and evaluates the ledger every `every` steps.
pub(crate) fn run(state: &mut State, steps: u64, every: u64) -> Errors {
    let mut errors = Errors::default();
    for at in 1..=steps {
        if at % every != 0 {
            step(state);
            continue;
        }
        let b = step_and_balance(state);
        errors.energy_j = errors.energy_j.max(b.energy_error_j.abs());
        errors.energy = errors.energy.max(b.energy_error.abs());
        errors.momentum = errors.momentum.max(b.momentum_error);
        errors.angular_momentum = errors.angular_momentum.max(b.angular_momentum_error);
        errors.elastic_j = errors.elastic_j.max(b.elastic_j());
        errors.kinetic_j = b.kinetic_j;
    }
    errors
}

/// Runs `work` in a Rayon pool of this many threads. With one, nothing is handed over, which is
/// faster for small bodies.
pub(crate) fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(work)
}

/// Order of convergence from errors at successively halved steps: one number for each halving.
pub(crate) fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}

/// Particles rotated about the origin, with their velocities.
pub(crate) fn turned(particles: &Particles, by: UnitQuaternion<f64>) -> Particles {
    let mut particles = particles.clone();
    for pose in &mut particles.poses {
        let [x, y, z]: [f64; 3] = (by * pose.place()).into();
        pose.put_at([x, y, z]);
    }
    for motion in &mut particles.motions {
        motion.velocity_m_s = (by * Vector3::from(motion.velocity_m_s)).into();
        motion.spin_rad_s = (by * Vector3::from(motion.spin_rad_s)).into();
    }
    particles
}
