//! Damping ratios for a given restitution.

use super::hertz::central_impact;
use super::world::{Body, RIGID, World, material};
use super::{assert_near, reference};
use dem_physics::contact::ImpactLaw;
use dem_physics::contact::NormalLaw;
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::law::linear::Linear;
use dem_physics::contact::pair_parameters::{AttractiveDamping, PairInput};
use dem_physics::contact::restitution::{
    damping_ratio, damping_ratio_with_attraction, restitution,
};
use dem_physics::contact::rolling::NoRolling;
use dem_physics::number::Vec3;
use std::f64::consts::PI;

const RADIUS: f64 = 0.0025;
const SPEED: f64 = 3.9;

/// An impact: its restitution, and its contact duration and largest overlap over those of the
/// elastic impact.
struct Impact {
    e: f64,
    pressed: f64,
    overlap: f64,
}

/// An impact in this many steps for the duration of the elastic one, which begins with the first of
/// them.
fn impact<L: NormalLaw<f64>>(law: L, elastic: (f64, f64), steps: f64) -> Impact {
    impact_within(law, elastic, steps, 0.0)
}

/// The same if the ends meet after this fraction of the first step.
fn impact_within<L: NormalLaw<f64>>(
    law: L,
    (duration, overlap): (f64, f64),
    steps: f64,
    fraction: f64,
) -> Impact {
    let above = SPEED * fraction * duration / steps;
    let b = Body::sphere(RADIUS, 4000.0, Vec3(0.0, 0.0, RADIUS + above));
    let mut world = World::new(law, NoRolling, [Body::floor(), b], duration / steps);
    let found = central_impact(&mut world, SPEED);
    Impact {
        e: world.bodies[1].velocity.2 / SPEED,
        pressed: found.duration / duration,
        overlap: found.overlap / overlap,
    }
}

fn hertz(pair_input: &PairInput) -> (HertzMindlin, (f64, f64)) {
    let law = HertzMindlin::new([RIGID, material(380e9, 0.23)], pair_input);
    let mass = 1.0 / Body::sphere(RADIUS, 4000.0, Vec3(0.0, 0.0, 0.0)).per_mass;
    let overlap = law.overlap_at_impact_m(RADIUS, mass, SPEED);
    (law, (2.943_275_184_324_704_3 * overlap / SPEED, overlap))
}

fn pair_input(restitution: f64, pull: AttractiveDamping) -> PairInput {
    PairInput {
        pull,
        ..PairInput::new(restitution, 0.0)
    }
}

/// The reference integrates impacts numerically: its restitution until the overlap is 0, which
/// should be the nominal one, has an error of 1.6e-8. Its ratios for a given restitution are less
/// accurate: an integration of the impact to 1e-12 gives 0.499999934 for that of 0.5.
const REFERENCE_ERROR: f64 = 2e-8;
const SEARCH_ERROR: f64 = 1e-7;

#[test]
fn ratios_are_those_of_the_independent_implementation() {
    for row in reference().alpha_for_wanted_e_without_attraction {
        let given = restitution(row.beta_equiv);
        assert!((given - row.e_wanted).abs() < SEARCH_ERROR, "{given}");
        assert_near(5.0_f64.sqrt() * row.beta_equiv, row.alpha, 1e-14);
    }
    for row in reference().tsuji_restitution {
        let wanted = row.e_actual_force_until_overlap_zero;
        assert!((wanted - row.e_nominal).abs() < REFERENCE_ERROR);
        let found = damping_ratio_with_attraction(row.e_nominal);
        assert!((found - row.beta).abs() < 1e-15, "{found}");
        let cut = restitution(found);
        assert!(
            (cut - row.e_actual_truncated_no_attraction).abs() < REFERENCE_ERROR,
            "{cut}"
        );
    }
}

#[test]
fn a_ratio_gives_back_the_restitution_it_is_made_for() {
    for step in 1..=1000 {
        let wanted = f64::from(step) / 1000.0;
        assert_near(restitution(damping_ratio(wanted)), wanted, 1e-14);
    }
    // Critical damping gives exp(-2), where the two branches of the formula meet.
    assert_near(restitution(1.0), (-2.0_f64).exp(), 1e-15);
    for away in [1e-9, 1e-8, 1e-7, 1e-6] {
        // d(loss)/d(zeta) at 1 is 4/3.
        let slope = (restitution(1.0 - away).ln() - restitution(1.0 + away).ln()) / (2.0 * away);
        assert_near(slope, 4.0 / 3.0, 1e-15 / away + away);
    }
    assert_eq!(damping_ratio(1.0), 0.0);
    assert_eq!(damping_ratio(0.0), f64::INFINITY);
}

#[test]
fn impacts_are_those_of_the_independent_implementation() {
    for row in reference().tsuji_restitution {
        for (pull, e, duration) in [
            (
                AttractiveDamping::AsDamped,
                row.e_actual_force_until_overlap_zero,
                row.duration_ratio_vs_elastic,
            ),
            (
                AttractiveDamping::None,
                row.e_actual_truncated_no_attraction,
                row.duration_ratio_truncated,
            ),
        ] {
            let (mut law, elastic) = hertz(&pair_input(row.e_nominal, pull));
            law.parameters.damping_ratio = row.beta;
            for steps in [2000.0, 20000.0] {
                let found = impact(law, elastic, steps);
                assert_near(found.e, e, 2.0 / steps);
                assert_near(found.overlap, row.max_overlap_ratio, 2.0 / steps);
                assert_near(found.pressed, duration, 2.0 / steps);
            }
        }
    }
}

fn linear(wanted: f64) -> (Linear, (f64, f64)) {
    let law = Linear::new(1e7, 1.0, &pair_input(wanted, AttractiveDamping::None));
    let mass = 1.0 / Body::sphere(RADIUS, 4000.0, Vec3(0.0, 0.0, 0.0)).per_mass;
    let swing = (mass / 1e7).sqrt();
    (law, (PI * swing, SPEED * swing))
}

#[test]
fn a_wanted_restitution_comes_out_of_both_laws() {
    for step in 1..=10 {
        let wanted = f64::from(step) / 10.0;
        let (hertz, of_hertz) = hertz(&pair_input(wanted, AttractiveDamping::None));
        let (linear, of_linear) = linear(wanted);
        for steps in [2000.0, 20000.0] {
            assert_near(impact(hertz, of_hertz, steps).e, wanted, 1.0 / steps);
            assert_near(impact(linear, of_linear, steps).e, wanted, 0.01 / steps);
        }
    }
}

/// Smallest, mean and largest restitution over the times within a step at which the ends may meet.
fn over_moments<L: NormalLaw<f64> + Copy>(law: L, elastic: (f64, f64), steps: f64) -> [f64; 3] {
    let moments = (0..50).map(|n| (f64::from(n) + 0.5) / 50.0);
    let found: Vec<f64> = moments
        .map(|fraction| impact_within(law, elastic, steps, fraction).e)
        .collect();
    let least = found.iter().copied().fold(f64::INFINITY, f64::min);
    let most = found.iter().copied().fold(0.0, f64::max);
    [least, found.iter().sum::<f64>() / 50.0, most]
}

#[test]
fn restitution_of_the_linear_law_is_of_second_order_in_the_step() {
    for wanted in [0.1, 0.3, 0.6, 0.9] {
        let (law, elastic) = linear(wanted);
        for steps in [25.0, 50.0, 100.0] {
            let [_, mean, _] = over_moments(law, elastic, steps);
            assert_near(mean, wanted, 2.0 / (steps * steps));
        }
    }
}

/// Hertz's stiffness increases as the ends approach, so the effect of the velocity's lag is not
/// fully compensated: a tenth of it is left, an eighth with few steps. The lag by itself gives
/// these fractions over the number of steps.
#[test]
fn little_is_left_of_the_lag_of_the_velocity_in_hertz_law() {
    for (wanted, lag) in [(0.1, 2.15), (0.3, 0.61), (0.6, 0.11)] {
        let (law, elastic) = hertz(&pair_input(wanted, AttractiveDamping::None));
        for steps in [25.0, 50.0, 100.0] {
            let [_, mean, _] = over_moments(law, elastic, steps);
            assert_near(mean, wanted, 0.2 * lag / steps);
        }
    }
}

/// The step is an eighth of the stable one: 12.6 for the elastic impact. Without the fraction of
/// the first kick that is due, a restitution of 0.6 would vary between 0.575 and 0.621.
#[test]
fn at_the_automatic_step_the_linear_law_keeps_its_restitution_within_a_percent() {
    for wanted in [0.1, 0.3, 0.6, 0.9, 1.0] {
        let (law, elastic) = linear(wanted);
        let zeta = damping_ratio(wanted);
        let steps = 4.0 * PI * (zeta + (zeta * zeta + 1.0).sqrt());
        let [least, _, most] = over_moments(law, elastic, steps);
        assert!(
            least > 0.99 * wanted && most < 1.01 * wanted,
            "{least} {most}"
        );
    }
}
