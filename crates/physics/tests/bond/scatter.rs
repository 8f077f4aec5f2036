//! Scattered strengths: their distribution, and the quantities on which they depend.

use dem_physics::bond::scatter::strength_factor;

const BONDS: u64 = 100_000;

/// Factors of many bonds of one body, in the order of numbering in a packing: neighbours in space,
/// so close numbers.
fn factors(seed: u64, body: u64, modulus: f64) -> Vec<f64> {
    (0..BONDS)
        .map(|bond| strength_factor(seed, body, [bond / 7, bond / 7 + 1 + bond % 7], modulus))
        .collect()
}

/// Largest distance between the observed fractions and the distribution, times the square root of
/// their number (Kolmogorov and Smirnov).
fn misfit(mut values: Vec<f64>, share_below: impl Fn(f64) -> f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let count = values.len() as f64;
    let distance = values.iter().enumerate().map(|(i, &value)| {
        let fraction = share_below(value);
        (fraction - i as f64 / count)
            .abs()
            .max(((i + 1) as f64 / count - fraction).abs())
    });
    distance.fold(0.0, f64::max) * count.sqrt()
}

/// Misfit that chance exceeds once in a thousand times.
const RARE: f64 = 1.95;

#[test]
fn factors_follow_the_weibull_distribution() {
    for (seed, body, modulus) in [(1, 0, 1.0), (2, 0, 3.0), (3, 41, 10.0)] {
        let found = misfit(factors(seed, body, modulus), |x| {
            1.0 - (-x.powf(modulus)).exp()
        });
        assert!(found < RARE, "seed {seed}, modulus {modulus}: {found}");
    }
}

#[test]
fn seeds_and_bodies_scatter_independently() {
    let base = factors(1, 0, 1.0);
    for other in [factors(2, 0, 1.0), factors(1, 1, 1.0), factors(0, 1, 1.0)] {
        assert!(base.iter().zip(&other).all(|(a, b)| a != b));
        // The smaller of two independent exponential numbers is exponential with twice the rate.
        let lesser = base.iter().zip(&other).map(|(a, b)| a.min(*b)).collect();
        let found = misfit(lesser, |x| 1.0 - (-2.0 * x).exp());
        assert!(found < RARE, "{found}");
    }
}

#[test]
fn it_does_not_matter_which_particle_is_named_first() {
    for (a, b) in [(0, 1), (5, 3), (u64::MAX, 7)] {
        assert_eq!(
            strength_factor(9, 2, [a, b], 4.0),
            strength_factor(9, 2, [b, a], 4.0)
        );
    }
    assert!(strength_factor(9, 2, [3, 4], 4.0) != strength_factor(9, 2, [3, 5], 4.0));
    assert!(strength_factor(9, 3, [2, 4], 4.0) != strength_factor(9, 2, [3, 4], 4.0));
}

#[test]
fn an_infinite_modulus_is_one_value() {
    assert!((0..1000).all(|bond| strength_factor(4, 0, [bond, bond + 1], f64::INFINITY) == 1.0));
}
