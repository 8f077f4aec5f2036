//! The spheres placed have the requested sizes: Kolmogorov-Smirnov tests, by number and by mass,
//! against the distributions' own formulas.

use super::{Bench, Made};
use crate::helpers::facets::cuboid;
use rayon::prelude::*;
use std::fs;
use std::path::Path;

/// Chance exceeds this/sqrt(n) once in twenty times,
const LIMIT_95: f64 = 1.358;
/// and this once in a thousand times.
const LIMIT_999: f64 = 1.949;

/// Largest distance between the fraction of the weight at or below each diameter and its expected
/// value, with the effective number of spheres (Kish: the sum of weights squared over the sum of
/// squares).
fn kolmogorov_smirnov(
    made: &Made,
    weight: &dyn Fn(f64) -> f64,
    wanted: &dyn Fn(f64) -> f64,
) -> (f64, f64) {
    let mut diameters: Vec<f64> = made.body.radii.iter().map(|r| 2e3 * r).collect();
    diameters.sort_by(f64::total_cmp);
    let total: f64 = diameters.iter().map(|d| weight(*d)).sum();
    let squares: f64 = diameters.iter().map(|d| weight(*d).powi(2)).sum();
    let (mut below, mut distance) = (0.0, 0.0_f64);
    for d in &diameters {
        let fraction = wanted(*d);
        distance = distance.max((fraction - below / total).abs());
        below += weight(*d);
        distance = distance.max((fraction - below / total).abs());
    }
    (distance, total * total / squares)
}

/// A distribution function with its other weighting: from a density, smooth between some diameters
/// (mm), by Simpson's rule.
struct Law {
    breaks: Vec<f64>,
    density: Box<dyn Fn(f64) -> f64 + Send>,
}

impl Law {
    /// The fraction at or below `d`, counted with the weight d^power.
    fn fraction(&self, d: f64, power: i32) -> f64 {
        self.moment(d, power) / self.moment(f64::INFINITY, power)
    }

    /// Mean and standard deviation of the diameter, counted with the weight d^power.
    fn mean_and_deviation(&self, power: i32) -> [f64; 2] {
        let [all, first, second] = [0, 1, 2].map(|k| self.moment(f64::INFINITY, power + k));
        [first / all, (second / all - (first / all).powi(2)).sqrt()]
    }

    /// Integral of density times d^power up to `to`.
    fn moment(&self, to: f64, power: i32) -> f64 {
        let value = |d: f64| (self.density)(d) * d.powi(power);
        let between = |from: f64, to: f64| {
            let pieces = 200;
            let step = (to - from) / f64::from(pieces);
            let simpson = |i: i32| {
                let d = from + f64::from(i) * step;
                // Just inside the breaks, where the density may jump.
                let (low, high) = (
                    f64::max(d, from * (1.0 + 1e-12)),
                    f64::min(d + step, to * (1.0 - 1e-12)),
                );
                step / 6.0 * (value(low) + 4.0 * value(d + 0.5 * step) + value(high))
            };
            (0..pieces).map(simpson).sum::<f64>()
        };
        self.breaks
            .windows(2)
            .map(|pair| between(pair[0].min(to), pair[1].min(to)))
            .sum()
    }
}

/// The texts for `--diameter`, and their distributions.
fn laws(folder: &Path) -> Vec<(String, Law)> {
    let curve = folder.join("curve.csv");
    fs::write(
        &curve,
        "opening,passing\n0.8mm,0\n1.0mm,20\n1.4mm,80\n1.8mm,100\n",
    )
    .unwrap();
    // Mean and deviation of the lognormal law are those of the diameter itself.
    let variance = (1.0 + (0.3_f64 / 1.2).powi(2)).ln();
    let centre = 1.2_f64.ln() - 0.5 * variance;
    let law = |breaks: &[f64], density: Box<dyn Fn(f64) -> f64 + Send>| Law {
        breaks: breaks.to_vec(),
        density,
    };
    vec![
        ("1mm..1.5mm".to_owned(), law(&[1.0, 1.5], Box::new(|_| 1.0))),
        (
            "normal:1.25mm,0.2mm,0.8mm..1.7mm".to_owned(),
            law(
                &[0.8, 1.7],
                Box::new(|d| (-0.5 * ((d - 1.25) / 0.2).powi(2)).exp()),
            ),
        ),
        (
            "lognormal:1.2mm,0.3mm,0.6mm..2.4mm".to_owned(),
            law(
                &[0.6, 2.4],
                Box::new(move |d| (-0.5 * (d.ln() - centre).powi(2) / variance).exp() / d),
            ),
        ),
        (
            "weibull:1.3mm,4,0.6mm..2mm".to_owned(),
            law(
                &[0.6, 2.0],
                Box::new(|d| (d / 1.3).powi(3) * (-(d / 1.3).powi(4)).exp()),
            ),
        ),
        (
            format!("sieve:{}", curve.display()),
            law(
                &[0.8, 1.0, 1.4, 1.8],
                Box::new(|d| {
                    if d < 1.0 {
                        1.0
                    } else if d < 1.4 {
                        1.5
                    } else {
                        0.5
                    }
                }),
            ),
        ),
    ]
}

/// Powers of d that weight the density by number and by mass, for a density given as `by`.
fn powers(by: &str) -> [i32; 2] {
    if by == "number" { [0, 3] } else { [-3, 0] }
}

/// Ten packings of about 10,000 spheres. By chance, three or more of ten exceed the limit of 95 %
/// once in a hundred times.
#[test]
fn every_distribution_is_followed_by_number_and_by_mass() {
    let bench = Bench::new();
    let file = bench.stl("box.stl", &cuboid([28.0, 19.0, 16.0]));
    let mut beyond_95 = Vec::new();
    for (diameter, law) in laws(bench.folder.path()) {
        for by in ["number", "mass"] {
            let made = bench.pack(&file, &["-d", &diameter, "--basis", by]);
            let count = made.body.radii.len();
            assert!(
                (7000..18000).contains(&count),
                "{diameter} by {by}: {count} spheres"
            );
            for (what, weight, power) in [("number", 0, powers(by)[0]), ("mass", 3, powers(by)[1])]
            {
                let (distance, samples) =
                    kolmogorov_smirnov(&made, &|d| d.powi(weight), &|d| law.fraction(d, power));
                let off = distance * samples.sqrt();
                assert!(
                    off < LIMIT_999,
                    "{diameter} by {by}: off by {distance} in {what}, {off} / sqrt(n)"
                );
                if what == by && off > LIMIT_95 {
                    beyond_95.push(format!("{diameter} by {by}: {off:.2} / sqrt(n)"));
                }
                let reported = made.number(&format!("/quality/sizes_by_{what}/distance"));
                assert!(
                    (reported - distance).abs() < 1e-6,
                    "{diameter} by {by}: the report says {reported}, not {distance}"
                );
            }
        }
    }
    assert!(beyond_95.len() <= 2, "{beyond_95:?}");
}

/// A small bias is hidden by the noise of one packing, but not of many.
#[test]
fn no_size_is_favoured() {
    const SEEDS: usize = 10;
    let bench = Bench::new();
    let file = bench.stl("box.stl", &cuboid([15.0, 12.0, 11.0]));
    (laws(bench.folder.path()).into_par_iter()).for_each(|(diameter, law)| {
        // A folder of its own: all bodies have the same name.
        let bench = Bench::new();
        let [mean, deviation] = law.mean_and_deviation(0);
        let in_sigma = |seed: usize| {
            let body = bench.pack_only(&file, &["-d", &diameter, "--seed", &seed.to_string()]);
            let count = body.radii.len() as f64;
            let found = body.radii.iter().map(|r| 2e3 * r).sum::<f64>() / count;
            (found - mean) / (deviation / count.sqrt())
        };
        let bias = (1..=SEEDS).map(in_sigma).sum::<f64>() / SEEDS as f64;
        // The mean of this many standard normal numbers, at three of its standard deviations.
        let limit = 3.0 / (SEEDS as f64).sqrt();
        assert!(
            bias.abs() < limit,
            "{diameter}: the mean diameter is off by {bias:.2} sigma on average, chance allows {limit:.2}"
        );
    });
}

#[test]
fn one_size() {
    let bench = Bench::new();
    let made = bench.pack(
        &bench.stl("box.stl", &cuboid([20.0, 15.0, 12.0])),
        &["-d", "1.2mm"],
    );
    assert!(made.body.radii.len() > 2000);
    assert!(
        made.body
            .radii
            .iter()
            .all(|r| (r / 0.6e-3 - 1.0).abs() < 1e-14)
    );
}

/// What a sieve curve leaves out is said where a person reads it.
#[test]
fn a_curve_that_does_not_reach_from_0_to_100_has_a_note() {
    let bench = Bench::new();
    let file = bench.stl("box.stl", &cuboid([16.0, 16.0, 16.0]));
    let said = |curve: &str| {
        let path = bench.path("curve.csv");
        fs::write(&path, curve).unwrap();
        let sizes = format!("sieve:{}", path.display());
        let output = super::dem_pack()
            .arg(&file)
            .args(["-d", &sizes, "--basis", "mass", "-o"])
            .arg(bench.path("b.csv"))
            .output()
            .unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let cut = said("opening_mm,passing_percent\n1.6,3\n2.0,15\n2.5,60\n3.15,96\n");
    assert!(
        cut.contains("note       The sieve curve leaves the 3 % below 1.6 mm and the 4 % above 3.15 mm by mass without sizes"),
        "{cut}"
    );
    let one = said("opening_mm,passing_percent\n1.6,0\n2.0,15\n2.5,60\n3.15,96\n");
    assert!(
        one.contains("leaves the 4 % above 3.15 mm by mass"),
        "{one}"
    );
    let whole = said("opening_mm,passing_percent\n1.6,0\n2.0,15\n2.5,60\n3.15,100\n");
    assert!(!whole.contains("note"), "{whole}");
}
