//! Distribution functions by number and by mass, and their moments.

use super::{Below, laws, normal_below};
use dem_pack::{Basis, Sizes};
use std::f64::consts::PI;

/// The function G(d) = integral of x^power dF from F alone, integrated by parts on a fine grid with
/// Richardson extrapolation of the trapezoidal rule: d^p F(d) - a^p F(a) - integral of p x^(p-1) F.
fn moment_below(below: &Below, power: i32, from: f64, to: f64) -> f64 {
    let integrand = |x: f64| f64::from(power) * x.powi(power - 1) * below(x);
    let trapezoid = |n: usize| {
        let h = (to - from) / n as f64;
        let inner: f64 = (1..n).map(|i| integrand(from + h * i as f64)).sum();
        h * (inner + 0.5 * (integrand(from) + integrand(to)))
    };
    let (coarse, fine) = (trapezoid(4000), trapezoid(8000));
    to.powi(power) * below(to) - from.powi(power) * below(from) - (fine + (fine - coarse) / 3.0)
}

#[test]
fn the_distribution_counts_what_it_is_asked_to_count() {
    for (text, below) in laws() {
        let by_number = Sizes::parse(&text, Basis::Number).unwrap();
        let by_mass = Sizes::parse(&text, Basis::Mass).unwrap();
        for i in 0..=1000 {
            let d = (by_number.min_m()
                + (by_number.max_m() - by_number.min_m()) * f64::from(i) / 1000.0)
                * 1e3;
            let wanted = below(d);
            assert!(
                (by_number.cdf_by_number(d * 1e-3) - wanted).abs() < 1e-8,
                "{text} {d}: {wanted}"
            );
            assert!(
                (by_mass.cdf_by_mass(d * 1e-3) - wanted).abs() < 1e-8,
                "{text} {d}: {wanted}"
            );
        }
    }
}

#[test]
fn number_and_mass_are_converted_by_the_third_power() {
    for (text, below) in laws()
        .into_iter()
        .filter(|(t, _)| !t.contains("0.002") && !t.contains(",200,"))
    {
        let by_number = Sizes::parse(&text, Basis::Number).unwrap();
        let by_mass = Sizes::parse(&text, Basis::Mass).unwrap();
        let (min, max) = (by_number.min_m() * 1e3, by_number.max_m() * 1e3);
        let volume = moment_below(&below, 3, min, max);
        let count = moment_below(&below, -3, min, max);
        for i in 1..20 {
            let d = min + (max - min) * f64::from(i) / 20.0;
            let mass = moment_below(&below, 3, min, d) / volume;
            let number = moment_below(&below, -3, min, d) / count;
            assert!(
                (by_number.cdf_by_mass(d * 1e-3) - mass).abs() < 1e-6,
                "{text} {d}: {mass}"
            );
            assert!(
                (by_mass.cdf_by_number(d * 1e-3) - number).abs() < 1e-6,
                "{text} {d}: {number}"
            );
        }
        let mean = moment_below(&below, 1, min, max);
        assert!(
            (by_number.mean_m() * 1e3 / mean - 1.0).abs() < 1e-6,
            "{text}: {mean}"
        );
        assert!(
            (by_number.mean_volume_m3() * 1e9 / (PI / 6.0 * volume) - 1.0).abs() < 1e-6,
            "{text}"
        );
        assert!(
            (by_mass.mean_volume_m3() * 1e9 * count / (PI / 6.0) - 1.0).abs() < 1e-6,
            "{text}"
        );
        let mean_by_mass = moment_below(&below, -2, min, max) / count;
        assert!(
            (by_mass.mean_m() * 1e3 / mean_by_mass - 1.0).abs() < 1e-6,
            "{text}: {mean_by_mass}"
        );
    }
}

#[test]
fn uniform_by_mass_has_its_closed_form() {
    // Number density ~ d^-3: N(d) = (a^-2 - d^-2)/(a^-2 - b^-2), mean 2 (1/a - 1/b)/(a^-2 - b^-2).
    let sizes = Sizes::parse("uniform: 2mm .. 3mm", Basis::Mass).unwrap();
    let whole = 0.25 - 1.0 / 9.0;
    for i in 0..=100 {
        let d = 2.0 + f64::from(i) / 100.0;
        let wanted = (0.25 - 1.0 / (d * d)) / whole;
        assert!((sizes.cdf_by_number(d * 1e-3) - wanted).abs() < 1e-9, "{d}");
        assert!(
            (sizes.quantile_by_number(wanted) - d * 1e-3).abs() < 1e-11,
            "{d}"
        );
    }
    assert!((sizes.mean_m() * 1e3 - 2.0 * (0.5 - 1.0 / 3.0) / whole).abs() < 1e-8);
    assert!((sizes.mean_volume_m3() * 1e9 - PI / 6.0 * 2.0 / whole).abs() < 1e-8);
}

#[test]
fn means_of_cut_distributions() {
    // Symmetric cut: the mean stays. Lognormal without a cut: mean and third moment of the complete
    // distribution, exp(3 mu + 9/2 sigma^2).
    let normal = Sizes::parse("normal:3mm,0.5mm,2mm..4mm", Basis::Number).unwrap();
    assert!((normal.mean_m() - 3e-3).abs() < 1e-11);
    let lognormal = Sizes::parse("lognormal:3mm,0.6mm,0.5mm..20mm", Basis::Number).unwrap();
    assert!((lognormal.mean_m() - 3e-3).abs() < 1e-10);
    let third = 27.0 * (1.0_f64 + 0.04).powi(3);
    assert!((lognormal.mean_volume_m3() * 1e9 / (PI / 6.0 * third) - 1.0).abs() < 1e-7);
}

#[test]
fn without_limits_the_outer_thousandths_are_cut() {
    for (text, below) in [
        (
            "normal:3mm,0.5mm",
            Box::new(|d| normal_below((d - 3.0) / 0.5)) as Below,
        ),
        (
            "weibull:3mm,2",
            Box::new(|d: f64| 1.0 - (-(d / 3.0).powi(2)).exp()),
        ),
        ("lognormal:3mm,3mm", {
            let sigma = 2.0_f64.ln().sqrt();
            Box::new(move |d: f64| normal_below(((d / 3.0).ln() + 0.5 * sigma * sigma) / sigma))
        }),
    ] {
        let sizes = Sizes::parse(text, Basis::Mass).unwrap();
        assert!((below(sizes.min_m() * 1e3) - 0.001).abs() < 1e-9, "{text}");
        assert!((below(sizes.max_m() * 1e3) - 0.999).abs() < 1e-9, "{text}");
    }
    let error = Sizes::parse("normal:3mm,1.5mm", Basis::Number).unwrap_err();
    assert!(
        error.problem.contains("-1.635 mm") && error.remedy.contains("MIN..MAX"),
        "{error}"
    );
}
