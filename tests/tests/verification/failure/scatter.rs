//! Strengths of many bonds, scattered after Weibull.

use std::f64::consts::PI;

use dem_run::step;

use super::bond::{Criterion, LENGTH_M, POISSON, RADIUS_M, TENSION_PA, YOUNG_PA};
use crate::verification::scene::started;
use crate::verification::table::{Case, compared};

/// Gamma function, by Stirling's series.
fn gamma(x: f64) -> f64 {
    let y = x + 12.0;
    let series = 1.0 / (12.0 * y) - 1.0 / (360.0 * y.powi(3)) + 1.0 / (1260.0 * y.powi(5));
    let far = (y - 0.5) * y.ln() - y + 0.5 * (2.0 * PI).ln() + series;
    let between: f64 = (0..12).map(|i| (x + f64::from(i)).ln()).sum();
    (far - between).exp()
}

/// Ratios of the strengths of bonds under equal elongation to the given one, in the order of
/// breakage.
fn scattered(modulus: f64, count: usize, steps: f64) -> Vec<f64> {
    let spheres = (0..count).map(|i| {
        let y = 4.0 * RADIUS_M * i as f64;
        format!("[0, {y:e}, 0, {RADIUS_M:e}], [{LENGTH_M:e}, {y:e}, 0, {RADIUS_M:e}]")
    });
    let spheres: Vec<String> = spheres.collect();
    let pairs: Vec<String> = (0..count)
        .map(|i| format!("[{}, {}]", 2 * i, 2 * i + 1))
        .collect();
    let half_box = |low: f64, high: f64| {
        format!("{{ box = {{ min = [{low:e}, -1, -1], max = [{high:e}, 1000, 1] }} }}")
    };
    let middle = 0.5 * LENGTH_M;
    let (strain, text) = (
        TENSION_PA / YOUNG_PA,
        [spheres.join(", "), pairs.join(", ")],
    );
    let [spheres, pairs] = text;
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = 4, time_step = {:e}, seed = {modulus} }}
        materials.stone = {{ density = 2500 }}
        bodies.rods = {{ particles = [{spheres}], bond_list = [{pairs}], material = "stone", bonds = "glue" }}
        groups.left = {}
        groups.right = {}
        bonds.glue = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e}, failure = {{ {}, weibull_modulus = {modulus:e} }} }}
        supports.left = {{ group = "left", fixed = true }}
        supports.right = {{ group = "right", fixed = ["y", "z", "rx", "ry", "rz"], velocity = {{ x = {:e} }} }}
        "#,
        1.0 / steps,
        half_box(-1.0, middle),
        half_box(middle, 1.0),
        Criterion::Tension.key(),
        strain * LENGTH_M
    ));
    let mut strengths = Vec::new();
    while strengths.len() < count && state.time_s < 4.0 {
        let now_s = state.time_s;
        step(&mut state);
        strengths.resize(state.broken_count as usize, now_s);
    }
    strengths
}

/// Mean and standard deviation of the strengths, and their distance from the distribution. Bounds
/// are three standard errors, and the step of the load.
pub(crate) fn scatter() -> String {
    const COUNT: usize = 2000;
    const STEPS: f64 = 500.0;
    let n = COUNT as f64;
    let mut cases = Vec::new();
    for modulus in [3.0, 6.0, 12.0] {
        let found = scattered(modulus, COUNT, STEPS);
        assert_eq!(found.len(), COUNT);
        let mean = found.iter().sum::<f64>() / n;
        let squares: f64 = found.iter().map(|s| (s - mean) * (s - mean)).sum();
        let deviation = (squares / (n - 1.0)).sqrt();
        let [m1, m2, m3, m4] = [1.0, 2.0, 3.0, 4.0].map(|k| gamma(1.0 + k / modulus));
        let wanted = (m2 - m1 * m1).sqrt();
        let fourth = m4 - 4.0 * m1 * m3 + 6.0 * m1 * m1 * m2 - 3.0 * m1.powi(4);
        let kurtosis = fourth / wanted.powi(4);
        let distance = found.iter().enumerate().map(|(i, strength)| {
            let fraction = 1.0 - (-strength.powf(modulus)).exp();
            (fraction - i as f64 / n)
                .abs()
                .max((fraction - (i as f64 + 1.0) / n).abs())
        });
        let of_mean = 3.0 * wanted / n.sqrt() / m1 + 1.0 / STEPS;
        let of_deviation = 3.0 * (0.25 * (kurtosis - 1.0) / n).sqrt() + 1.0 / STEPS;
        // The density is below 0.4 of the modulus.
        let of_distance = 1.63 / n.sqrt() + 0.4 * modulus / STEPS;
        let distance = distance.fold(0.0, f64::max);
        cases.push(Case::new(format!("{modulus}: mean"), mean, m1, of_mean));
        cases.push(Case::new(
            format!("{modulus}: standard deviation"),
            deviation,
            wanted,
            of_deviation,
        ));
        cases.push(Case::of_scale(
            format!("{modulus}: distance of Kolmogorov and Smirnov"),
            [distance, 0.0],
            1.0,
            of_distance,
        ));
    }
    compared("Weibull modulus", "", &cases)
}
