//! The lowest frequency of free bodies.

use std::f64::consts::TAU;

use dem_engine::check::lowest_frequency::lowest_frequency_hz;
use dem_engine::state::State;
use dem_engine::state::particles::Particles;
use dem_physics::bond::stiffness::BondModel;

use crate::bars::{ELASTIC, bar, body, random_body, spheres, steel};

/// Lowest frequency of the bar of 11 spheres, rad/s, by an independent eigenvalue solver:
/// `free_free_first_8` of `data/oscillation.json`.
fn of_reference(model: &str) -> f64 {
    let read: serde_json::Value =
        serde_json::from_str(include_str!("data/oscillation.json")).unwrap();
    read["chain"][model]["free_free_first_8"][0]
        .as_f64()
        .unwrap()
}

#[test]
fn is_above_that_of_the_reference_by_little() {
    for (model, name) in [
        (BondModel::Parallel { kappa: None }, "PBM"),
        (BondModel::EulerBernoulli, "EBBM"),
        (BondModel::Timoshenko, "TBBM"),
    ] {
        let mut state = bar(model, ELASTIC, 1e-5);
        let found = TAU * lowest_frequency_hz(&mut state).unwrap();
        let off = found / of_reference(name) - 1.0;
        eprintln!("{name} {off:e}");
        assert!((-1e-6..0.01).contains(&off), "{name}: {off}");
    }
}

/// omega = 22.3733 sqrt(EI/(rho A L^4)); point masses and bonds that end at the centres of the last
/// spheres change it by about the slenderness squared.
#[test]
fn of_a_slender_bar_is_that_of_euler_and_bernoulli() {
    let count = 101_u32;
    let (particles, pairs) = spheres(count);
    let mass_kg = 1.0 / particles.motions[0].inverse_mass;
    let mut state = body(
        particles,
        &pairs,
        &steel(BondModel::Timoshenko, ELASTIC),
        1e-5,
    );
    let found = TAU * lowest_frequency_hz(&mut state).unwrap();
    let (spacing, radius) = (0.4_f64, 0.2_f64);
    let second_moment = std::f64::consts::PI * radius.powi(4) / 4.0;
    // Each sphere represents a piece of beam as long as their distance.
    let length = spacing * f64::from(count);
    let per_length = mass_kg / spacing;
    let wanted = 22.373_285_448 * (200e9 * second_moment / per_length).sqrt() / length.powi(2);
    let off = found / wanted - 1.0;
    eprintln!("{off:e}");
    // Its ends are stiffer by half a bond each, 1/100 of the length in total, and the polynomial
    // is 0.3 % high.
    assert!((0.0..0.03).contains(&off), "{off}");
}

#[test]
fn is_the_same_for_a_body_that_is_moved_and_turned() {
    let mut state = random_body(BondModel::Timoshenko, ELASTIC, 1e-7);
    let found = lowest_frequency_hz(&mut state).unwrap();
    let p = &mut state.particles;
    for pose in &mut p.poses {
        let [x, y, z, radius] = pose.position_m;
        pose.position_m = [x + 0.01, y - 0.02, z + 0.03, radius];
    }
    let moved = lowest_frequency_hz(&mut state).unwrap();
    assert!((moved / found - 1.0).abs() < 1e-5, "{found} {moved}");
}

#[test]
fn what_cannot_vibrate_has_none() {
    let (particles, _) = spheres(6);
    let steel = steel(BondModel::Timoshenko, ELASTIC);
    let mut loose = body(particles, &[], &steel, 1e-5);
    assert_eq!(lowest_frequency_hz(&mut loose), None);
    let mut nothing = State::new(Particles::default(), Default::default(), 1e-5, 1);
    assert_eq!(lowest_frequency_hz(&mut nothing), None);
}
