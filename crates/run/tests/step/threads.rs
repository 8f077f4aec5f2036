//! The same bits for any number of partitions and threads, with all features active.

use crate::bars::{
    BondDamping, add_bonds, damp, damp_particles, eq_20, random_spheres, reopen, soft, with_threads,
};
use crate::helpers::step_and_balance;
use dem_engine::Balance;
use dem_engine::check::limit::{Limit, limit};
use dem_engine::stages::bonds::energy_kernel::elastic_energy;
use dem_engine::state::State;
use dem_engine::state::bonds::{BondLaw, BondRule, Bonds};
use dem_engine::state::events::Break;
use dem_engine::state::loads::GroupLoad;
use dem_engine::state::particles::{Motion, Pose};
use dem_engine::state::supports::GroupSupport;
use dem_engine::state::supports::HeldParticle;
use dem_physics::bond::damage::Damage;
use dem_physics::bond::failure::{Criteria, EquivalentStress};
use dem_physics::bond::rate_strengthening::{IncreaseCurve, RateStrengthening};
use dem_physics::bond::stiffness::BondModel;
use dem_scene::{Factor, Hold};

const BREAKING: BondRule = BondRule {
    law: BondLaw::Elastic,
    damped: false,
    structural_damping: 0.1,
    criteria: Some(Criteria {
        tensile_strength_pa: 0.1e6,
        compressive_strength_pa: 0.1e6,
        shear_strength_pa: 0.2e6,
        cohesion_pa: 0.2e6,
        friction_tangent: 0.5,
        von_mises_strength_pa: 0.12e6,
        equivalent_stress: EquivalentStress::AxialInTension,
    }),
    strengthening: eq_20(1.1),
    strain_rate_measure: dem_scene::StrainRateMeasure::Elongation,
    contact_beside: false,
};

/// Three random bodies side by side: incremental, total, incremental; all break. The bonds of the
/// last one keep their largest factor.
fn scene(partitions: usize) -> State {
    let (mut particles, pairs) = random_spheres();
    let one = particles.clone();
    for shift in [0.01, 0.02] {
        for pose in &one.poses {
            let [x, y, z] = pose.place().into();
            particles.push_sphere([x + shift, y, z], pose.radius_m(), 2050.0);
        }
    }
    let mut bonds = Bonds::default();
    for (body, incremental) in [(0, true), (1, false), (2, true)] {
        let first = body * one.len() as u32;
        let pairs: Vec<[u32; 2]> = pairs
            .iter()
            .map(|pair| pair.map(|end| end + first))
            .collect();
        let rule = BondRule {
            law: if incremental {
                BondLaw::Incremental
            } else {
                BondLaw::Softening {
                    fracture_energy_j_m2: 5.0,
                }
            },
            strengthening: Some(RateStrengthening {
                curve: IncreaseCurve::Platzer { from_1_s: 1.1 },
                keeps_largest: body == 2,
            }),
            ..BREAKING
        };
        add_bonds(
            &mut bonds,
            &particles,
            &pairs,
            &soft(BondModel::Timoshenko, rule),
        );
    }
    bonds.strength_factors = (0..bonds.len())
        .map(|at| 0.8 + 0.01 * (at % 50) as f64)
        .collect();
    bonds.histories.damages = (0..bonds.len())
        .map(|at| Damage::none(&bonds.stiffness(at), bonds.strength_factor(at)))
        .collect();
    let mut state = State::new(particles, bonds, 5e-7, partitions);
    damp(&mut state, BondDamping::Chen(0.05));
    damp_particles(&mut state, 0.1);
    state.model.gravity_m_s2 = [1.0, 2.0, -9.81];
    state.loads = vec![GroupLoad {
        end_s: f64::INFINITY,
        particles: (100..1400).step_by(7).collect(),
        force_n: [1e-3, 2e-3, 0.0],
        torque_n_m: [0.0, 1e-7, 0.0],
        factor: Factor::Ramp { until_s: 1e-4 },
    }];
    state.supports = vec![GroupSupport {
        end_s: f64::INFINITY,
        holds: [
            Some(Hold::Fixed),
            None,
            Some(Hold::Velocity(0.2)),
            None,
            Some(Hold::Fixed),
            None,
        ],
        factor: Factor::One,
        held: (0..1500)
            .step_by(31)
            .map(|particle| HeldParticle {
                particle,
                ..HeldParticle::default()
            })
            .collect(),
    }];
    for (pose, motion) in state
        .particles
        .poses
        .iter()
        .zip(&mut state.particles.motions)
    {
        let p = pose.place() * 1500.0;
        motion.velocity_m_s = [p.y.sin(), p.z.cos(), (p.x + p.y).sin()];
        motion.spin_rad_s = [1000.0 * p.x.sin(), 0.0, 500.0 * p.y.cos()];
    }
    reopen(&mut state);
    state
}

/// All results of a run.
#[derive(Debug, PartialEq)]
struct Left {
    limit: Limit,
    poses: Vec<Pose>,
    motions: Vec<Motion>,
    balances: Vec<Balance>,
    broken: Vec<Break>,
}

fn left(partitions: usize, threads: usize) -> Left {
    with_threads(threads, || {
        let mut state = scene(partitions);
        let limit = limit(&mut state);
        let (mut balances, mut broken) = (Vec::new(), Vec::new());
        for _ in 0..150 {
            balances.push(step_and_balance(&mut state));
            assert!(state.scratch.events.broken.is_sorted_by_key(|b| b.bond));
            broken.extend(&state.scratch.events.broken);
        }
        Left {
            limit,
            poses: state.particles.poses,
            motions: state.particles.motions,
            balances,
            broken,
        }
    })
}

#[test]
fn shares_and_threads_do_not_change_a_bit() {
    let one = left(1, 1);
    let per_body: Vec<usize> = (0..3)
        .map(|body| {
            one.broken
                .iter()
                .filter(|b| b.bond as usize / 2500 == body)
                .count()
        })
        .collect();
    eprintln!("broken {per_body:?}, {:?}", one.balances.last().unwrap());
    assert!(per_body.iter().all(|&count| count > 10), "{per_body:?}");
    assert!(one.balances.last().unwrap().bond_damage_j > 0.0);
    for (partitions, threads) in [(2, 2), (3, 1), (3, 4), (7, 2), (7, 4), (1, 4)] {
        assert!(
            left(partitions, threads) == one,
            "{partitions} partitions, {threads} threads"
        );
    }
}

#[test]
fn the_elastic_energy_is_the_sum_over_bonds_one_by_one() {
    let mut state = scene(2);
    for _ in 0..150 {
        step_and_balance(&mut state);
    }
    let bonds = &state.bonds;
    let count =
        |is_so: fn(&Bonds, usize) -> bool| (0..bonds.len()).filter(|&at| is_so(bonds, at)).count();
    // Broken ones, damaged ones, and two kinds.
    assert!(count(Bonds::is_broken) > 30);
    assert!(count(|bonds, at| bonds.histories.damages[at].damage > 0.0) > 30);
    let energy = |at: usize| match bonds.is_broken(at) {
        true => [0.0; 4],
        false => {
            let energy = bonds.forces(at, &state.particles.poses).energy;
            [energy.normal, energy.shear, energy.torsion, energy.bending]
        }
    };
    let mut sums = [0.0; 4];
    for at in 0..bonds.len() {
        for (sum, mode) in sums.iter_mut().zip(energy(at)) {
            *sum += mode;
        }
    }
    let found = elastic_energy(&state);
    let found = [found.normal, found.shear, found.torsion, found.bending];
    for (found, sum) in found.into_iter().zip(sums) {
        assert!(
            sum > 0.0 && (found / sum - 1.0).abs() < 1e-13,
            "{found} {sum}"
        );
    }
}
