//! Bodies that the tests run.

use dem_run::physics::bond::stiffness::{BondModel, BondShape, stiffness};
use dem_run::state::State;
use dem_run::state::bonds::{BondRule, Bonds};
use dem_run::state::particles::Particles;

/// A rule without damping and failure.
pub(crate) const ELASTIC: BondRule = BondRule {
    incremental: false,
    damped: false,
    criteria: None,
    strengthening_from_1_s: None,
};

/// Bonds between these pairs, in rest as the particles stand.
pub(crate) fn bonds(
    particles: &Particles,
    pairs: &[[u32; 2]],
    radius_factor: f64,
    model: BondModel,
    young_modulus_pa: f64,
    rule: BondRule,
) -> Bonds {
    let mut bonds = Bonds {
        rules: vec![rule],
        ..Bonds::default()
    };
    for &[a, b] in pairs {
        let apart = particles.poses[b as usize].place() - particles.poses[a as usize].place();
        let radii = [a, b].map(|end| particles.radii_m[end as usize]);
        let shape = BondShape {
            length_m: apart.norm(),
            radius_m: radius_factor * radii[0].min(radii[1]),
            end_radii_m: radii,
        };
        let stiffness = stiffness(model, &shape, young_modulus_pa, 0.3);
        bonds.push(
            [a, b],
            apart.normalize().into(),
            shape.radius_m,
            &stiffness,
            0,
        );
    }
    bonds
}

/// The bar of case 1 of Chen et al. 2022: 11 spheres of radius 0.2 m along x, density 7850 kg/m3, E = 200 GPa.
pub(crate) fn bar(model: BondModel, rule: BondRule, time_step_s: f64) -> State {
    let mut particles = Particles::default();
    for i in 0..11 {
        particles.push_sphere([0.4 * f64::from(i), 0.0, 0.0], 0.2, 7850.0);
    }
    let pairs: Vec<[u32; 2]> = (0..10).map(|i| [i, i + 1]).collect();
    let bonds = bonds(&particles, &pairs, 1.0, model, 200e9, rule);
    State::new(particles, bonds, time_step_s, 1)
}
