//! Bond forces in as many lanes as the machine has.

use std::sync::Arc;

use crate::bars::ELASTIC;
use dem_engine::stages::bonds::forces::{bond_wrenches, bond_wrenches_one_by_one};
use dem_engine::state::bonds::{BondRule, Bonds};
use dem_engine::state::particles::Particles;
use dem_engine::state::partitions::divide;
use dem_physics::bond::failure::{Criteria, EquivalentStress, Factors, stresses, utilisation};
use dem_physics::bond::stiffness::Stiffness;

/// Pseudo-random numbers between -1 and 1.
fn scattered(seed: u64) -> impl FnMut() -> f64 {
    let mut hash = seed;
    move || {
        hash ^= hash << 13;
        hash ^= hash >> 7;
        hash ^= hash << 17;
        (hash >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Forty particles in a row, joined by bonds of these strengths, with or without scatter.
fn chain(criteria: Criteria, is_scattered: bool) -> (Particles, Bonds) {
    let mut any = scattered(7);
    let mut particles = Particles::default();
    for i in 0..40 {
        particles.push_sphere([f64::from(i) + 0.3 * any(), any(), any()], 1.0, 1.0);
        let q = [any(), any(), any(), any()];
        let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        particles.poses[i as usize].turned = q.map(|x| x / norm);
    }
    let mut bonds = Bonds {
        rules: Arc::new([BondRule {
            criteria: Some(criteria),
            ..ELASTIC
        }]),
        ..Bonds::default()
    };
    for (a, b) in (0..39).map(|a| (a, a + 1)).chain([(37, 39)]) {
        let k = [any(), any(), any()].map(|x| 2.0 + x);
        let stiffness = Stiffness {
            normal: k[0],
            shear: k[1],
            torsion: k[2],
            bending: 0.25 * k[0] * (1.0 + 0.2 * any()).powi(2),
            levers_m: [0.5 + 0.1 * any(), 0.5],
        };
        bonds.push([a, b], [1.0, 0.0, 0.0], 1.0, &stiffness, 0);
    }
    if is_scattered {
        let factors = (0..40).map(|at| 10.0_f64.powf(0.1 * f64::from(at) - 3.0));
        bonds.strength_factors = factors.collect();
    }
    (particles, bonds)
}

/// Bonds that have reached their strength, checked one by one.
fn reached(bonds: &Bonds, particles: &Particles) -> Vec<u32> {
    let is_reached = |at: &u32| {
        let at = *at as usize;
        let load = bonds.forces(at, &particles.poses).load;
        let criteria = bonds.rules[0].criteria.unwrap_or(NEVER);
        let factors = Factors::scattered(bonds.strength_factor(at));
        utilisation(&criteria, &stresses(&load, bonds.radius_m(at)), factors) >= 1.0
    };
    (0..bonds.len() as u32).filter(is_reached).collect()
}

const NEVER: Criteria = Criteria {
    tensile_strength_pa: f64::INFINITY,
    compressive_strength_pa: f64::INFINITY,
    shear_strength_pa: f64::INFINITY,
    cohesion_pa: f64::INFINITY,
    friction_tangent: 0.0,
    von_mises_strength_pa: f64::INFINITY,
    equivalent_stress: EquivalentStress::AxialInTension,
};

#[test]
fn as_many_lanes_as_there_are_give_the_bits_of_one() {
    let tension = Criteria {
        tensile_strength_pa: 1.5,
        ..NEVER
    };
    let compression = Criteria {
        compressive_strength_pa: 0.7,
        ..NEVER
    };
    let shear = Criteria {
        shear_strength_pa: 0.6,
        ..NEVER
    };
    let mohr_coulomb = Criteria {
        cohesion_pa: 1.0,
        friction_tangent: 0.1,
        ..NEVER
    };
    let all = Criteria {
        tensile_strength_pa: 2.0,
        compressive_strength_pa: 2.0,
        shear_strength_pa: 2.0,
        von_mises_strength_pa: 3.0,
        ..NEVER
    };
    let equivalent = |equivalent_stress| Criteria {
        von_mises_strength_pa: 1.5,
        equivalent_stress,
        ..NEVER
    };
    let readings = [
        EquivalentStress::ForcesOnly,
        EquivalentStress::TensileEdge,
        EquivalentStress::BondInTension,
    ]
    .map(equivalent);
    let separate = [tension, compression, shear, mohr_coulomb, all];
    for criteria in separate.into_iter().chain(readings) {
        for is_scattered in [false, true] {
            let (particles, bonds) = chain(criteria, is_scattered);
            lanes_agree(&particles, &bonds);
        }
    }
}

/// Several lanes give the same forces as one lane, and list the bonds that have reached their
/// strength.
fn lanes_agree(particles: &Particles, bonds: &Bonds) {
    for partitions in [1, 3] {
        let results = [false, true].map(|several| {
            let mut partitions = divide(bonds, particles.len(), partitions);
            if several {
                let mut wrenches = particles.wrenches.clone();
                bond_wrenches(bonds, &particles.poses, &mut partitions, &mut wrenches);
                (wrenches, partitions)
            } else {
                let mut wrenches = particles.wrenches.clone();
                bond_wrenches_one_by_one(bonds, &particles.poses, &mut partitions, &mut wrenches);
                (wrenches, partitions)
            }
        });
        let [one, many] = &results;
        for (one, many) in one.0.iter().zip(&many.0) {
            assert_eq!(one.force_n[..3], many.force_n[..3]);
            assert_eq!(one.torque_n_m[..3], many.torque_n_m[..3]);
        }
        assert_eq!(one.1, many.1);
        let mut listed: Vec<u32> = one.1.iter().flat_map(|s| s.failing.clone()).collect();
        listed.sort_unstable();
        assert_eq!(listed, reached(bonds, particles));
        let failing = listed.len();
        assert!(failing > 0 && failing < bonds.len(), "{failing} failing");
    }
}
