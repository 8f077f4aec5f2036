//! Logistic curves through runs with and without an outcome.

use dem_io::random::uniform;
use dem_laboratory::logistic::{Logistic, Trials, bound_of_none, wilson};

fn trials(all: &[(f64, usize, usize)]) -> Vec<Trials> {
    let one = |(x, runs, with_outcome): &(f64, usize, usize)| Trials {
        x: *x,
        runs: *runs,
        with_outcome: *with_outcome,
    };
    all.iter().map(one).collect()
}

#[track_caller]
fn assert_near(found: f64, wanted: f64, tolerance: f64) {
    assert!((found - wanted).abs() <= tolerance, "{found}, not {wanted}");
}

/// With two values Firth's penalty adds half a run with and half a run without the outcome to each,
/// as it does for any saturated model of a binary outcome.
#[test]
fn two_values_have_a_closed_form() {
    for (first, last) in [
        ((8, 1), (8, 6)),
        ((8, 0), (8, 8)),
        ((3, 2), (20, 1)),
        ((5, 5), (7, 0)),
    ] {
        let all = trials(&[(0.2, first.0, first.1), (0.7, last.0, last.1)]);
        let fit = Logistic::fit(&all).unwrap();
        for (x, (runs, with_outcome)) in [(0.2, first), (0.7, last)] {
            let wanted = (with_outcome as f64 + 0.5) / (runs as f64 + 1.0);
            assert_near(fit.probability(x), wanted, 1e-9);
        }
    }
}

#[test]
fn a_known_curve_is_recovered() {
    let (a, b) = (-3.0, 0.5);
    let p = |x: f64| 1.0 / (1.0 + (-(a + b * x)).exp());
    let runs = 1_000_000;
    let all: Vec<Trials> = (0..13)
        .map(|k| Trials {
            x: f64::from(k),
            runs,
            with_outcome: (p(f64::from(k)) * runs as f64).round() as usize,
        })
        .collect();
    let fit = Logistic::fit(&all).unwrap();
    let [found_a, found_b] = fit.coefficients();
    // Rounded counts, and a penalty of one run among millions.
    assert_near(found_a, a, 1e-4);
    assert_near(found_b, b, 1e-5);
    assert!(fit.depends() && !fit.is_separated());
    for (probability, wanted) in [(0.5, 6.0), (0.9, 6.0 + 2.0 * 9.0_f64.ln())] {
        let at = fit.value_at(probability).unwrap();
        assert_near(at.value, wanted, 1e-4);
        let [Some(low), Some(high)] = at.between else {
            panic!("{at:?}");
        };
        // The standard error by the delta method, with millions of runs.
        let information = (0..13).map(|k| {
            let (x, weight) = (f64::from(k), p(f64::from(k)) * (1.0 - p(f64::from(k))));
            [weight, weight * x, weight * x * x].map(|sum| sum * runs as f64)
        });
        let [s, sx, sxx] =
            information.fold([0.0; 3], |sum, one| [0, 1, 2].map(|k| sum[k] + one[k]));
        let determinant = s * sxx - sx * sx;
        let variance = (sxx - 2.0 * wanted * sx + wanted * wanted * s) / determinant / (b * b);
        let half = 1.959_964 * variance.sqrt();
        assert_near((wanted - low) / half, 1.0, 0.02);
        assert_near((high - wanted) / half, 1.0, 0.02);
    }
}

#[test]
fn units_and_origins_do_not_matter() {
    let points = [(1.0, 8, 0), (2.0, 8, 3), (3.0, 8, 2), (4.0, 8, 7)];
    let fit = Logistic::fit(&trials(&points)).unwrap();
    let at = fit.value_at(0.5).unwrap();
    let in_other = |x: f64| 2.0 - 1e-3 * x;
    let mut turned = points.map(|(x, runs, with)| (in_other(x), runs, with));
    turned.swap(0, 2);
    let other = Logistic::fit(&trials(&turned)).unwrap();
    for x in [0.0, 1.5, 4.0] {
        assert_near(other.probability(in_other(x)), fit.probability(x), 1e-9);
        let [low, high] = fit.band(x);
        let [other_low, other_high] = other.band(in_other(x));
        assert_near(other_low, low, 1e-6);
        assert_near(other_high, high, 1e-6);
    }
    let turned = other.value_at(0.5).unwrap();
    assert_near(turned.value, in_other(at.value), 1e-9);
    let ends = [at.between[1], at.between[0]].map(|end| in_other(end.unwrap()));
    for (found, wanted) in turned.between.iter().zip(ends) {
        assert_near(found.unwrap(), wanted, 1e-8);
    }
}

/// The interval of the value at 50 % ends where the band reaches 50 %.
#[test]
fn intervals_and_band_say_the_same() {
    let fit = Logistic::fit(&trials(&[
        (1.0, 8, 0),
        (2.0, 8, 3),
        (3.0, 8, 4),
        (4.0, 8, 8),
    ]))
    .unwrap();
    for probability in [0.1, 0.5, 0.9] {
        let at = fit.value_at(probability).unwrap();
        let [low, high] = at.between.map(Option::unwrap);
        assert!(low < at.value && at.value < high);
        assert_near(fit.band(low)[1], probability, 1e-5);
        assert_near(fit.band(high)[0], probability, 1e-5);
        assert_near(fit.probability(at.value), probability, 1e-9);
    }
}

#[test]
fn separated_runs_have_a_finite_curve() {
    let fit = Logistic::fit(&trials(&[
        (1.0, 8, 0),
        (2.0, 8, 0),
        (4.0, 8, 8),
        (5.0, 8, 8),
    ]))
    .unwrap();
    assert!(fit.is_separated() && fit.depends());
    let at = fit.value_at(0.5).unwrap();
    assert_near(at.value, 3.0, 1e-6);
    let [low, high] = at.between.map(Option::unwrap);
    assert!(
        1.5 < low && low < 2.5 && 3.5 < high && high < 4.5,
        "{low} {high}"
    );
    assert!(fit.coefficients()[1] > 0.0 && fit.coefficients()[1].is_finite());
    let [low, high] = fit.band(3.0);
    assert_near(low + high, 1.0, 1e-5);
    assert!(low < 0.2, "{low}");
}

#[test]
fn runs_that_show_nothing_set_no_bounds() {
    let fit = Logistic::fit(&trials(&[(1.0, 8, 4), (2.0, 8, 3), (3.0, 8, 5)])).unwrap();
    assert!(!fit.depends() && !fit.is_separated());
    assert_eq!(fit.value_at(0.9).unwrap().between[1], None);
    assert_eq!(fit.value_at(0.1).unwrap().between[0], None);
    let level = Logistic::fit(&trials(&[(1.0, 8, 4), (2.0, 8, 4)])).unwrap();
    assert_near(level.probability(1.5), 0.5, 1e-12);
    let fifths = Logistic::fit(&trials(&[(1.0, 5, 2), (2.0, 5, 2), (3.0, 5, 2)])).unwrap();
    assert_eq!(fifths.value_at(0.1), None);
}

#[test]
fn what_has_no_curve() {
    for points in [
        &[][..],
        &[(1.0, 8, 4)],
        &[(1.0, 8, 4), (1.0, 8, 2)],
        &[(1.0, 8, 0), (2.0, 8, 0)],
        &[(1.0, 8, 8), (2.0, 3, 3)],
        &[(1.0, 8, 4), (f64::NAN, 8, 5), (f64::INFINITY, 8, 5)],
    ] {
        assert_eq!(Logistic::fit(&trials(points)), None, "{points:?}");
    }
}

/// In 300 made studies of six values with eight runs each, the intervals contain the truth as often
/// as 95 % allows, within three standard deviations of the binomial distribution.
#[test]
fn intervals_contain_the_truth_in_95_of_100_studies() {
    let studies = 300;
    let allowed = 3.0 * (300.0_f64 * 0.95 * 0.05).sqrt();
    for (seed, slope) in [(1, 1.0), (2, 2.0)] {
        let p = |x: f64| 1.0 / (1.0 + (-slope * (x - 3.2)).exp());
        let (mut value, mut band) = (0, 0);
        for study in 0..studies {
            let all: Vec<Trials> = (1..=6)
                .map(|k| {
                    let x = f64::from(k);
                    let has = |run: &u64| uniform(seed, &[study, k as u64, *run]) < p(x);
                    let with_outcome = (0..8).filter(has).count();
                    Trials {
                        x,
                        runs: 8,
                        with_outcome,
                    }
                })
                .collect();
            let fit = Logistic::fit(&all).unwrap();
            let [low, high] = fit.value_at(0.5).unwrap().between;
            let is_in = low.is_none_or(|low| low < 3.2) && high.is_none_or(|high| 3.2 < high);
            value += usize::from(is_in);
            let [low, high] = fit.band(4.5);
            band += usize::from(low < p(4.5) && p(4.5) < high);
        }
        for count in [value, band] {
            let off = count as f64 - 285.0;
            assert!(off.abs() <= allowed, "slope {slope}: {count} of {studies}");
        }
    }
}

#[test]
fn intervals_of_fractions() {
    let z2 = 1.959_964_f64.powi(2);
    // None of n: from 0 to z2/(n + z2).
    let [low, high] = wilson(8, 0);
    assert_near(low, 0.0, 1e-12);
    assert_near(high, z2 / (8.0 + z2), 1e-12);
    let [low, high] = wilson(8, 8);
    assert_near(low, 8.0 / (8.0 + z2), 1e-12);
    assert_near(high, 1.0, 1e-12);
    let [low, high] = wilson(10, 5);
    assert_near(low + high, 1.0, 1e-12);
    // (1 - bound)^n = 0.05.
    assert_near((1.0 - bound_of_none(48)).powi(48), 0.05, 1e-12);
}
