//! Distributions from densities.

use dem_pack::internals::Curve;

#[test]
fn a_parabola_is_exact() {
    // Density 6 x (1 - x): the distribution is 3 x^2 - 2 x^3, a cubic, with mean 1/2.
    let curve = Curve::from_density(&[0.0, 1.0], |_, x| 6.0 * x * (1.0 - x)).unwrap();
    assert!((curve.total - 1.0).abs() < 1e-14);
    assert!((curve.mean - 0.5).abs() < 1e-14);
    for i in 0..=100 {
        let x = f64::from(i) / 100.0;
        assert!(
            (curve.cdf(x) - x * x * (3.0 - 2.0 * x)).abs() < 1e-14,
            "{x}"
        );
        assert!((curve.cdf(curve.quantile(x)) - x).abs() < 1e-13, "{x}");
    }
}

#[test]
fn a_steep_power_law_stays_within_tolerance() {
    // Density x^-4 on [1, 100]: (1 - x^-3)/(1 - 1e-6), mean 3/2 (1 - 1e-4)/(1 - 1e-6).
    let curve = Curve::from_density(&[1.0, 100.0], |_, x: f64| x.powi(-4)).unwrap();
    let mut x = 1.0_f64;
    while x < 100.0 {
        let exact = (1.0 - x.powi(-3)) / (1.0 - 1e-6);
        assert!(
            (curve.cdf(x) - exact).abs() < 1e-8,
            "{x}: {} {exact}",
            curve.cdf(x)
        );
        x *= 1.003;
    }
    assert!(
        (curve.mean - 1.5 * (1.0 - 1e-4) / (1.0 - 1e-6)).abs() < 1e-7,
        "{}",
        curve.mean
    );
}

#[test]
fn nothing_is_drawn_from_a_gap() {
    let curve =
        Curve::from_density(&[1.0, 2.0, 3.0, 4.0], |i, _| if i == 1 { 0.0 } else { 1.0 }).unwrap();
    for i in 0..1000 {
        let d = curve.quantile(f64::from(i) / 1000.0);
        assert!(!(d > 2.0 + 1e-9 && d < 3.0 - 1e-9), "{d}");
    }
    assert!((curve.cdf(2.5) - 0.5).abs() < 1e-15);
}

#[test]
fn no_mass_is_no_curve() {
    assert!(Curve::from_density(&[1.0, 2.0], |_, _| 0.0).is_none());
    assert!(Curve::from_density(&[1.0, 2.0], |_, _| f64::NAN).is_none());
}
