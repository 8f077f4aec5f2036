//! The dynamic increase factor at rates with an integer logarithm, and where its branches meet.

use dem_physics::bond::strain_rate::{
    PLATZER_LOWEST_RATE_1_S, dynamic_increase_factor, elongation_rate,
};
use nalgebra::Vector3;

/// Computed by hand from eq. 20 with its parentheses: lg = -5, -3, -1, 0, 1, and 50/s, where lg
/// = 1.6989700043360187.
#[test]
fn the_factor_is_that_of_equation_20() {
    let cases = [
        (1e-5, 1.00749925),
        (1e-3, 1.05249925),
        (0.1, 1.09749925),
        (1.0, 1.6),
        (10.0, 3.5675),
        (50.0, 5.8125885),
    ];
    for (rate, wanted) in cases {
        let found = dynamic_increase_factor(rate, 0.0);
        assert!(
            (found - wanted).abs() < 1e-7,
            "{rate}: {found} instead of {wanted}"
        );
    }
}

#[test]
fn it_is_continuous_and_constant_beyond_its_ends() {
    // The two branches are printed to four decimals: they miss each other by 7.5e-7 at 0.1/s.
    let jump = dynamic_increase_factor(0.1_f64.next_up(), 0.0) - dynamic_increase_factor(0.1, 0.0);
    assert!((jump - 7.5e-7).abs() < 1e-12, "{jump}");
    let steps = 10_000;
    let factors: Vec<f64> = (0..=steps)
        .map(|step| 10.0_f64.powf(-7.0 + 10.0 * f64::from(step) / f64::from(steps)))
        .map(|rate| dynamic_increase_factor(rate, 0.0))
        .collect();
    // Steepest at 50/s: 2 * 0.7325 * 1.699 + 1.235 = 3.72 per decade.
    let steepest = 3.73 * 10.0 / f64::from(steps);
    assert!(
        factors
            .windows(2)
            .all(|pair| (pair[1] - pair[0]).abs() < steepest)
    );
    assert_eq!(factors[0], 1.0);
    assert_eq!(factors[10_000], dynamic_increase_factor(50.0, 0.0));
}

/// The parabola of the second branch has its minimum inside it: lg = -1.235 / (2 * 0.7325), where
/// it is 1.6 - 1.235^2 / (4 * 0.7325).
#[test]
fn the_printed_fit_dips_above_a_tenth_per_second() {
    let found = dynamic_increase_factor(0.143_544, 0.0);
    assert!((found - 1.079_445).abs() < 1e-6, "{found}");
    assert!(found < dynamic_increase_factor(0.1, 0.0));
}

#[test]
fn shortening_and_slow_bonds_are_not_strengthened() {
    for rate in [-1e3, -1.0, -1e-9, 0.0, 1e-9, 1.0] {
        assert_eq!(dynamic_increase_factor(rate, PLATZER_LOWEST_RATE_1_S), 1.0);
    }
    for rate in [-1e3, -1e-9, 0.0] {
        assert_eq!(dynamic_increase_factor(rate, 0.0), 1.0);
    }
    let there = dynamic_increase_factor(PLATZER_LOWEST_RATE_1_S, PLATZER_LOWEST_RATE_1_S);
    assert!((there - 1.652).abs() < 5e-4, "{there}");
}

#[test]
fn only_speed_along_the_bond_strains_it() {
    let c = Vector3::new(0.6, 0.8, 0.0);
    let drift = Vector3::new(1.0, 2.0, 3.0);
    let across = Vector3::new(-0.8, 0.6, 5.0);
    let rate = |v| elongation_rate(&c, &[drift, drift + v], 0.25);
    assert!(rate(across).abs() < 1e-15);
    assert!((rate(0.5 * c + across) - 2.0).abs() < 1e-14);
    assert!((rate(-0.5 * c) + 2.0).abs() < 1e-14);
}
