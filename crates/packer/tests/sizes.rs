//! Size distributions against closed forms that are computed here, independently of the program's tables.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use dem_pack::sizes::{By, Sizes, ks_distance_by_mass, ks_distance_by_number};
use proptest::prelude::*;
use std::f64::consts::PI;

/// Error function by its Taylor series up to 3 (terms stay below 1e3, so 1e-13 is kept), beyond by the continued fraction.
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

/// Uniform numbers in [0, 1), splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    }
}

fn draws(sizes: &Sizes, count: usize, seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    (0..count)
        .map(|_| sizes.quantile_by_number(random.next()))
        .collect()
}

fn sieve_file() -> tempfile_path::TextFile {
    tempfile_path::TextFile::new("opening_mm,passing_percent\n1,0\n2,20\n3,20\n4,75\n5.6,100\n")
}

/// A text file that is removed at the end of the test.
mod tempfile_path {
    use std::sync::atomic::{AtomicUsize, Ordering};

    static NEXT: AtomicUsize = AtomicUsize::new(0);

    pub(crate) struct TextFile(pub(crate) std::path::PathBuf);

    impl TextFile {
        pub(crate) fn new(text: &str) -> Self {
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

/// The function G(d) = integral of x^power dF from F alone, integrated by parts on a fine grid with Richardson
/// extrapolation of the trapezoidal rule: d^p F(d) - a^p F(a) - integral of p x^(p-1) F.
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
        let by_number = Sizes::parse(&text, By::Number).unwrap();
        let by_mass = Sizes::parse(&text, By::Mass).unwrap();
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
        let by_number = Sizes::parse(&text, By::Number).unwrap();
        let by_mass = Sizes::parse(&text, By::Mass).unwrap();
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
    let sizes = Sizes::parse("uniform: 2mm .. 3mm", By::Mass).unwrap();
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
    // Symmetric cut: the mean stays. Lognormal wide open: mean and third moment of the whole, exp(3 mu + 9/2 sigma^2).
    let normal = Sizes::parse("normal:3mm,0.5mm,2mm..4mm", By::Number).unwrap();
    assert!((normal.mean_m() - 3e-3).abs() < 1e-11);
    let lognormal = Sizes::parse("lognormal:3mm,0.6mm,0.5mm..20mm", By::Number).unwrap();
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
        let sizes = Sizes::parse(text, By::Mass).unwrap();
        assert!((below(sizes.min_m() * 1e3) - 0.001).abs() < 1e-9, "{text}");
        assert!((below(sizes.max_m() * 1e3) - 0.999).abs() < 1e-9, "{text}");
    }
    let error = Sizes::parse("normal:3mm,1.5mm", By::Number).unwrap_err();
    assert!(
        error.problem.contains("-1.635 mm") && error.remedy.contains("MIN..MAX"),
        "{error}"
    );
}

#[test]
fn a_hundred_thousand_draws_follow_the_distribution() {
    let file = sieve_file();
    let path = file.0.to_string_lossy().into_owned();
    let mut all = laws();
    all.push((
        path,
        Box::new(|d: f64| match d {
            d if d < 2.0 => 0.2 * (d - 1.0),
            d if d < 3.0 => 0.2,
            d if d < 4.0 => 0.2 + 0.55 * (d - 3.0),
            d => 0.75 + 0.25 * (d - 4.0) / 1.6,
        }),
    ));
    for (text, below) in all {
        let count = 100_000;
        let sizes = Sizes::parse(&text, By::Number).unwrap();
        let mut sample = draws(&sizes, count, 1);
        sample.sort_by(f64::total_cmp);
        let mut distance = 0.0_f64;
        for (i, d) in sample.iter().enumerate() {
            let wanted = below(d * 1e3);
            distance = distance.max((wanted - i as f64 / count as f64).abs());
            distance = distance.max((wanted - (i + 1) as f64 / count as f64).abs());
        }
        assert!(
            distance < 1.358 / (count as f64).sqrt(),
            "{text}: {distance}"
        );
        let fit = ks_distance_by_number(&sample, &sizes);
        assert!(
            (fit.distance - distance).abs() < 2e-8,
            "{text}: {} {distance}",
            fit.distance
        );
        assert!(fit.passes() && (fit.effective_samples - 1e5).abs() < 1e-6);

        // By mass: the weighted sample against the closed form.
        let sizes = Sizes::parse(&text, By::Mass).unwrap();
        let mut sample = draws(&sizes, count, 2);
        sample.sort_by(f64::total_cmp);
        let total: f64 = sample.iter().map(|d| d.powi(3)).sum();
        let effective = total * total / sample.iter().map(|d| d.powi(6)).sum::<f64>();
        let (mut passed, mut distance) = (0.0, 0.0_f64);
        for d in &sample {
            let wanted = below(d * 1e3);
            distance = distance.max((wanted - passed / total).abs());
            passed += d.powi(3);
            distance = distance.max((wanted - passed / total).abs());
        }
        assert!(
            distance < 1.358 / effective.sqrt(),
            "{text}: {distance} of {effective}"
        );
        let fit = ks_distance_by_mass(&sample, &sizes);
        assert!(
            (fit.distance - distance).abs() < 2e-8,
            "{text}: {} {distance}",
            fit.distance
        );
        assert!((fit.effective_samples / effective - 1.0).abs() < 1e-9);
        assert!(ks_distance_by_number(&sample, &sizes).passes(), "{text}");
    }
}

#[test]
fn the_limit_is_passed_by_about_nineteen_samples_of_twenty() {
    let sizes = Sizes::parse("lognormal:2.5mm,0.6mm,1mm..6mm", By::Mass).unwrap();
    let samples = 400;
    let (mut number, mut mass) = (0, 0);
    for seed in 0..samples {
        let sample = draws(&sizes, 1000, 1000 + seed * 7919);
        number += u32::from(ks_distance_by_number(&sample, &sizes).passes());
        mass += u32::from(ks_distance_by_mass(&sample, &sizes).passes());
    }
    // Binomial of 400 at 0.95: 380 with a standard deviation of 4.4.
    assert!((367..=393).contains(&number), "{number}");
    assert!((360..=400).contains(&mass), "{mass}");
}

#[test]
fn a_wrong_sample_is_seen() {
    let sizes = Sizes::parse("2mm..3mm", By::Number).unwrap();
    let mut random = Random(3);
    let small: Vec<f64> = (0..2000).map(|_| 2e-3 + 0.9e-3 * random.next()).collect();
    let fit = ks_distance_by_number(&small, &sizes);
    assert!(
        !fit.passes() && (fit.distance - 0.1).abs() < 0.02,
        "{fit:?}"
    );
    assert!(!ks_distance_by_mass(&small, &sizes).passes());
    let one = Sizes::parse("2mm", By::Number).unwrap();
    assert_eq!(ks_distance_by_number(&[2e-3; 50], &one).distance, 0.0);
    assert!(
        (ks_distance_by_number(&[2e-3, 2e-3, 2e-3, 2.1e-3], &one).distance - 0.25).abs() < 1e-12
    );
    assert_eq!(ks_distance_by_number(&[], &sizes).distance, 0.0);
}

#[test]
fn one_size_and_descriptions() {
    let sizes = Sizes::parse(" 2.5 mm ", By::Mass).unwrap();
    assert_eq!(
        (sizes.min_m(), sizes.max_m(), sizes.mean_m()),
        (2.5e-3, 2.5e-3, 2.5e-3)
    );
    assert!(sizes.is_one_size());
    assert_eq!(sizes.quantile_by_number(0.3), 2.5e-3);
    assert_eq!(
        (sizes.cdf_by_number(2.4e-3), sizes.cdf_by_mass(2.5e-3)),
        (0.0, 1.0)
    );
    assert!((sizes.mean_volume_m3() / (PI / 6.0 * 2.5e-3_f64.powi(3)) - 1.0).abs() < 1e-15);
    assert_eq!(sizes.describe(), "all 2.5 mm");
    let sizes = Sizes::parse("2mm..2mm", By::Number).unwrap();
    assert!(sizes.is_one_size());
    let sizes = Sizes::parse("0.002..0.003", By::Number).unwrap();
    assert_eq!(
        sizes.describe(),
        "uniform by number, 2 mm to 3 mm, mean 2.5 mm by number and 2.597 mm by mass"
    );
    let sizes = Sizes::parse("Normal: 3mm, 0.5mm, 2mm..4mm", By::Number).unwrap();
    assert!(
        sizes
            .describe()
            .contains("95.45 % of it between the limits"),
        "{}",
        sizes.describe()
    );
}

#[test]
fn bad_sizes_name_value_limit_and_remedy() {
    for (text, problem, remedy) in [
        ("", "'' is not a length", "write one of"),
        ("abc", "'abc' is not a length", "write one of"),
        (
            "3mm..2mm",
            "3 mm is above the largest 2 mm",
            "smallest first",
        ),
        ("0mm", "'0mm' is not positive", "above zero"),
        ("-2mm..3mm", "'-2mm' is not positive", "above zero"),
        ("nan", "'nan' is not a length", "write one of"),
        ("inf..3mm", "'inf' is not a length", "write one of"),
        ("1e400mm", "not a finite", ""),
        ("1e300mm", "outside", "check the unit"),
        ("2 furlong", "unknown unit 'furlong'", "use one of"),
        ("2..3mm", "mixes numbers", "unit at each"),
        ("2mm..3", "mixes numbers", "unit at each"),
        (
            "gauss:2mm,1mm",
            "'gauss' is not a distribution",
            "lognormal",
        ),
        ("normal:2mm", "here are 1", "normal:MEAN,STD,MIN..MAX"),
        ("normal:2,5mm,0,3mm,1mm..4mm", "here are 5", "decimal point"),
        ("normal:2mm,0mm,1mm..3mm", "is 0 m", "one size"),
        ("normal:2mm,-1mm,1mm..3mm", "is -1 mm", "one size"),
        (
            "normal:2mm,1mm,3mm..1mm",
            "above the largest",
            "smallest first",
        ),
        (
            "normal:2mm,1mm,3mm..3mm",
            "both limits are 3 mm",
            "one size",
        ),
        ("normal:2mm,1mm,3mm", "'3mm' is not a range", "two dots"),
        (
            "normal:2mm,0.1mm,10mm..20mm",
            "only 0 % of the normal",
            "move MIN..MAX",
        ),
        (
            "lognormal:2mm,0.1mm,2.3mm..20mm",
            "of the lognormal",
            "move MIN..MAX",
        ),
        (
            "lognormal:-2mm,0.1mm,1mm..3mm",
            "'-2mm' is not positive",
            "above zero",
        ),
        ("weibull:2mm,0,1mm..3mm", "0 is outside", "narrower"),
        ("weibull:2mm,nan,1mm..3mm", "NaN is outside", "narrower"),
        (
            "weibull:2mm,3mm,1mm..3mm",
            "'3mm' is not a plain number",
            "without a unit",
        ),
        ("weibull:2mm,3,8mm..9mm", "of the Weibull", "move MIN..MAX"),
        ("weibull:2mm,0.1", "limit is 1000", "closer together"),
        (
            "1um..2mm",
            "a factor of 2000, the limit is 1000",
            "closer together",
        ),
        (
            "sieve:no-such-file.csv",
            "cannot read the sieve curve",
            "path of a text file",
        ),
        (
            "no-such-file.CSV",
            "cannot read the sieve curve",
            "path of a text file",
        ),
    ] {
        let error = Sizes::parse(text, By::Mass).expect_err(text);
        assert!(
            error.place.starts_with(&format!("--diameter '{text}'")),
            "{text}: {error}"
        );
        assert!(error.problem.contains(problem), "{text}: {error}");
        assert!(error.remedy.contains(remedy), "{text}: {error}");
        assert_eq!(error.exit_code(), 2);
    }
    let file = tempfile_path::TextFile::new("opening_mm,%\n1,0\n2,60\n3,50\n4,100\n");
    let error = Sizes::parse(&format!("sieve:{}", file.0.display()), By::Mass).unwrap_err();
    assert!(error.place.ends_with(".csv: line 4"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_answered(text in "\\PC{0,40}") {
        let _ = Sizes::parse(&text, By::Mass);
    }

    #[test]
    fn any_nearly_good_text_is_answered(text in "(normal|lognormal|weibull|uniform|sieve|):?[-+0-9.e]{0,6}(mm|um|m|),?[-+0-9.e]{0,6}(mm|),?[0-9.]{0,4}(mm|)(\\.\\.)?[0-9.]{0,4}(mm|)") {
        if let Ok(sizes) = Sizes::parse(&text, By::Number) {
            prop_assert!(sizes.min_m() > 0.0 && sizes.max_m() >= sizes.min_m() && sizes.max_m().is_finite());
            prop_assert!(sizes.mean_m() >= sizes.min_m() * (1.0 - 1e-9) && sizes.mean_m() <= sizes.max_m() * (1.0 + 1e-9));
        }
    }

    #[test]
    fn quantile_and_cdf_are_inverse(
        law in 0..4usize, mean in 1.0..5.0f64, spread in 0.02..0.8f64, low in 0.1..0.9f64, high in 1.1..4.0f64,
        mass in any::<bool>(), us in proptest::collection::vec(0.0..1.0f64, 20),
    ) {
        let (min, max) = (low * mean, high * mean);
        let text = match law {
            0 => format!("{min}mm..{max}mm"),
            1 => format!("normal:{mean}mm,{}mm,{min}mm..{max}mm", spread * mean),
            2 => format!("lognormal:{mean}mm,{}mm,{min}mm..{max}mm", spread * mean),
            _ => format!("weibull:{mean}mm,{},{min}mm..{max}mm", 1.0 / spread),
        };
        let sizes = Sizes::parse(&text, if mass { By::Mass } else { By::Number }).unwrap();
        let mut previous = sizes.min_m();
        let mut us = us;
        us.sort_by(f64::total_cmp);
        for u in us {
            let d = sizes.quantile_by_number(u);
            prop_assert!(d >= sizes.min_m() && d <= sizes.max_m() && d >= previous);
            prop_assert!((sizes.cdf_by_number(d) - u).abs() < 1e-9, "{} {} {}", text, u, sizes.cdf_by_number(d));
            prop_assert!(sizes.cdf_by_mass(d) <= sizes.cdf_by_number(d) + 1e-8);
            previous = d;
        }
        let first = sizes.quantile_by_number(0.0);
        prop_assert!(first >= sizes.min_m() && sizes.cdf_by_number(first) < 1e-9);
        let last = sizes.quantile_by_number(1.0);
        prop_assert!(last <= sizes.max_m() * (1.0 + 1e-15) && sizes.cdf_by_number(last) > 1.0 - 1e-9);
    }
}
