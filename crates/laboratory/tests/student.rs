//! Student's t distribution.

use dem_laboratory::student_95;

/// Student's t by numerical integration of its density.
#[test]
fn quantiles_of_student() {
    for degrees in 1..60 {
        let nu = degrees as f64;
        let density = |t: f64| (1.0 + t * t / nu).powf(-0.5 * (nu + 1.0));
        // With t = tan(phi) the whole line is a finite interval.
        let part = |to: f64| {
            let steps = 20_000;
            let (from, to) = (0.0, to.atan());
            let h = (to - from) / f64::from(steps);
            let value = |i: i32| {
                let phi = from + h * f64::from(i);
                density(phi.tan()) / phi.cos().powi(2)
            };
            let inner: f64 = (1..steps)
                .map(|i| if i % 2 == 1 { 4.0 } else { 2.0 } * value(i))
                .sum();
            h / 3.0 * (value(0) + inner + value(steps))
        };
        let below = 0.5 + 0.5 * part(student_95(degrees)) / part(1e12);
        assert!((below - 0.975).abs() < 2e-5, "{degrees}: {below}");
    }
}
