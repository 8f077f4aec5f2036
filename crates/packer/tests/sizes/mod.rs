//! Size distributions compared with closed forms that are computed here, independently of the
//! program's tables.

mod closed_forms;
mod curve;
mod draws;
mod parsing;
mod sieve;

use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Error function by its Taylor series up to 3 (terms stay below 1e3, so 1e-13 is kept), beyond by
/// the continued fraction.
fn erf(x: f64) -> f64 {
    if x.abs() > 3.0 {
        return x.signum() * (1.0 - erfc_fraction(x.abs()));
    }
    let mut term = x;
    let mut sum = x;
    for n in 1..200 {
        term *= -x * x / f64::from(n);
        sum += term / f64::from(2 * n + 1);
        if term.abs() < 1e-18 {
            break;
        }
    }
    2.0 / PI.sqrt() * sum
}

/// Complementary error function by its continued fraction, for x > 3.
fn erfc_fraction(x: f64) -> f64 {
    let mut tail = x;
    for n in (1..60).rev() {
        tail = x + 0.5 * f64::from(n) / tail;
    }
    (-x * x).exp() / PI.sqrt() / tail
}

fn normal_below(z: f64) -> f64 {
    0.5 * (1.0 + erf(z / 2.0_f64.sqrt()))
}

/// A distribution function as counted (by number or mass as asked), in mm.
type Below = Box<dyn Fn(f64) -> f64>;

/// Texts with their distribution functions in closed form.
fn laws() -> Vec<(String, Below)> {
    let cut = |below: Below, min: f64, max: f64| -> Below {
        Box::new(move |d: f64| (below(d.clamp(min, max)) - below(min)) / (below(max) - below(min)))
    };
    let (mu, sigma) = {
        let variance = (0.6_f64 / 2.5).powi(2).ln_1p();
        (2.5_f64.ln() - 0.5 * variance, variance.sqrt())
    };
    vec![
        (
            "2mm..3mm".to_owned(),
            Box::new(|d: f64| (d - 2.0).clamp(0.0, 1.0)) as Below,
        ),
        (
            "0.1mm..10mm".to_owned(),
            Box::new(|d: f64| ((d - 0.1) / 9.9).clamp(0.0, 1.0)) as Below,
        ),
        (
            "normal:2.5mm,0.4mm,1.5mm..4mm".to_owned(),
            cut(Box::new(|d| normal_below((d - 2.5) / 0.4)), 1.5, 4.0),
        ),
        (
            "normal:2.5mm,0.002mm,1mm..4mm".to_owned(),
            cut(Box::new(|d| normal_below((d - 2.5) / 0.002)), 1.0, 4.0),
        ),
        (
            "lognormal:2.5mm,0.6mm,1mm..6mm".to_owned(),
            cut(
                Box::new(move |d: f64| normal_below((d.ln() - mu) / sigma)),
                1.0,
                6.0,
            ),
        ),
        (
            "rosin-rammler:3mm,2.2,0.5mm..8mm".to_owned(),
            cut(
                Box::new(|d: f64| 1.0 - (-(d / 3.0).powf(2.2)).exp()),
                0.5,
                8.0,
            ),
        ),
        (
            "weibull:3mm,0.7,1mm..8mm".to_owned(),
            cut(
                Box::new(|d: f64| 1.0 - (-(d / 3.0).powf(0.7)).exp()),
                1.0,
                8.0,
            ),
        ),
        (
            "weibull:3mm,200,1mm..8mm".to_owned(),
            cut(
                Box::new(|d: f64| 1.0 - (-(d / 3.0).powf(200.0)).exp()),
                1.0,
                8.0,
            ),
        ),
    ]
}

static NEXT: AtomicUsize = AtomicUsize::new(0);

/// A text file that is removed at the end of the test.
struct TextFile(std::path::PathBuf);

impl TextFile {
    fn new(text: &str) -> Self {
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = format!("dem-pack-sizes-{}-{number}.csv", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, text).unwrap();
        Self(path)
    }
}

impl Drop for TextFile {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}
