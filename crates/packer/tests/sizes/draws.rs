//! Draws compared with the distribution, and the Kolmogorov-Smirnov distances of the report.

use super::{TextFile, laws};
use dem_pack::{Basis, Sizes, ks_distance_by_mass, ks_distance_by_number};
use dem_testing::Random;

fn draws(sizes: &Sizes, count: usize, seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    (0..count)
        .map(|_| sizes.quantile_by_number(random.fraction()))
        .collect()
}

fn sieve_file() -> TextFile {
    TextFile::new("opening_mm,passing_percent\n1,0\n2,20\n3,20\n4,75\n5.6,100\n")
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
        let sizes = Sizes::parse(&text, Basis::Number).unwrap();
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
        let sizes = Sizes::parse(&text, Basis::Mass).unwrap();
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
    let sizes = Sizes::parse("lognormal:2.5mm,0.6mm,1mm..6mm", Basis::Mass).unwrap();
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
    let sizes = Sizes::parse("2mm..3mm", Basis::Number).unwrap();
    let mut random = Random(3);
    let small: Vec<f64> = (0..2000)
        .map(|_| 2e-3 + 0.9e-3 * random.fraction())
        .collect();
    let fit = ks_distance_by_number(&small, &sizes);
    assert!(
        !fit.passes() && (fit.distance - 0.1).abs() < 0.02,
        "{fit:?}"
    );
    assert!(!ks_distance_by_mass(&small, &sizes).passes());
    let one = Sizes::parse("2mm", Basis::Number).unwrap();
    assert_eq!(ks_distance_by_number(&[2e-3; 50], &one).distance, 0.0);
    assert!(
        (ks_distance_by_number(&[2e-3, 2e-3, 2e-3, 2.1e-3], &one).distance - 0.25).abs() < 1e-12
    );
    assert_eq!(ks_distance_by_number(&[], &sizes).distance, 0.0);
}
