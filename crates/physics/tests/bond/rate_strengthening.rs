//! Factors over the strain rate by a table, and the largest factor of a bond.

use dem_physics::bond::rate_strengthening::{IncreaseCurve, RateStrengthening};
use dem_physics::bond::strain_rate::dynamic_increase_factor;

fn table() -> IncreaseCurve {
    IncreaseCurve::Table(vec![[1e-4, 1.1], [1e-2, 1.2], [1.0, 1.8]])
}

/// Decades: half a row between 1e-4 and 1e-2 is 1e-3, a tenth between 1e-2 and 1 is 10^-1.8.
#[test]
fn a_table_is_linear_in_the_logarithm_and_has_ends() {
    for (rate, wanted) in [
        (1e-4, 1.1),
        (1e-3, 1.15),
        (1e-2, 1.2),
        (10.0_f64.powf(-1.8), 1.26),
        (0.1, 1.5),
        (1.0, 1.8),
        (1e6, 1.8),
    ] {
        let found = table().factor(rate);
        assert!((found - wanted).abs() < 1e-14, "{rate}: {found}");
    }
    for rate in [-1.0, 0.0, 1e-5, 1e-4_f64.next_down()] {
        assert_eq!(table().factor(rate), 1.0, "{rate}");
    }
    let jump = IncreaseCurve::Table(vec![[1.1, 1.652]]);
    assert_eq!(
        [1.0, 1.1, 2.0].map(|rate| jump.factor(rate)),
        [1.0, 1.652, 1.652]
    );
}

#[test]
fn eq_20_keeps_its_bits() {
    for from_1_s in [4.64e-6, 1.1] {
        let strengthening = RateStrengthening {
            curve: IncreaseCurve::Platzer { from_1_s },
            keeps_largest: false,
        };
        for rate in [-1.0, 1e-7, 1e-3, 0.1, 0.12, 1.1, 7.0, 80.0] {
            let wanted = dynamic_increase_factor(rate, from_1_s);
            assert_eq!(strengthening.factor(rate).to_bits(), wanted.to_bits());
        }
    }
}

/// The largest factor is that of the fastest of finely spaced rates, which each curve passes on its
/// way up: also where the printed fit dips, and where it begins within the dip.
#[test]
fn the_largest_factor_never_falls() {
    for curve in [
        IncreaseCurve::Platzer { from_1_s: 4.64e-6 },
        IncreaseCurve::Platzer { from_1_s: 0.12 },
        IncreaseCurve::Platzer { from_1_s: 1.1 },
        table(),
    ] {
        let mut largest = 1.0_f64;
        for step in 0..=80_000 {
            let rate = 10.0_f64.powf(-6.0 + f64::from(step) * 1e-4);
            largest = largest.max(curve.factor(rate));
            let found = curve.largest_factor(rate);
            // Two rates of this spacing differ by 3.73e-4 in their factors at most.
            assert!(
                found >= largest && found < largest + 4e-4,
                "{curve:?} {rate}"
            );
        }
        assert_eq!(curve.largest_factor(0.0), 1.0);
    }
}
