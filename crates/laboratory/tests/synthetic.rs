//! Curves made of known numbers: offset, drift, seating, a straight part, a bend before the largest
//! force, a tail, noise. Modulus and strength come back.

use dem_io::random::uniform;
use dem_laboratory::{Curve, Dimensions, MeasuredSpecimen, Specimen, TestType, evaluate, material};

/// Numbers of a made-up test.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Made {
    pub(crate) stiffness_n_m: f64,
    pub(crate) failure_n: f64,
    /// Travel before contact, m.
    pub(crate) before_m: f64,
    /// Length of the seating, over which the force rises with the square of the travel, m.
    pub(crate) seating_m: f64,
    /// Offset, N.
    pub(crate) offset_n: f64,
    /// Drift over the entire test, N.
    pub(crate) drift_n: f64,
    /// Standard deviation of the noise, N.
    pub(crate) noise_n: f64,
    /// Fraction of the largest force above which the curve bends.
    pub(crate) bend: f64,
    /// Force behind the failure, as a fraction of the largest.
    pub(crate) tail: f64,
    pub(crate) rows: usize,
    pub(crate) seed: u64,
}

pub(crate) const USUAL: Made = Made {
    stiffness_n_m: 18_230.0,
    failure_n: 51.45,
    before_m: 0.5e-3,
    seating_m: 0.3e-3,
    offset_n: 1.7,
    drift_n: 0.5,
    noise_n: 0.1,
    bend: 0.8,
    tail: 0.0,
    rows: 1200,
    seed: 1,
};

/// The normally distributed number of a row.
fn normal(seed: u64, row: usize) -> f64 {
    let [u, v]: [f64; 2] = [0, 1].map(|word| uniform(seed, &[row as u64, word]));
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

impl Made {
    /// Travel from contact at which the force is largest, m.
    fn failure_m(&self) -> f64 {
        let straight = self.bend * self.failure_n / self.stiffness_n_m;
        let bent = 2.0 * (1.0 - self.bend) * self.failure_n / self.stiffness_n_m;
        0.5 * self.seating_m + straight + bent
    }

    /// Force at a travel from contact: k x^2/(2 s) up to s, then a line, then a parabola that is
    /// level at the largest force, then a tail.
    fn force_n(&self, x: f64) -> f64 {
        let k = self.stiffness_n_m;
        if x <= 0.0 {
            return 0.0;
        }
        if x > self.failure_m() {
            return self.tail * self.failure_n;
        }
        if x < self.seating_m {
            return 0.5 * k * x * x / self.seating_m;
        }
        let line = k * (x - 0.5 * self.seating_m);
        let bend_n = self.bend * self.failure_n;
        if line <= bend_n {
            return line;
        }
        let over = (line - bend_n) / k;
        let length = 2.0 * (1.0 - self.bend) * self.failure_n / k;
        bend_n + k * over - 0.5 * k * over * over / length
    }

    /// Travel at the end of the test, m.
    fn end_m(&self) -> f64 {
        self.before_m + 1.25 * self.failure_m()
    }

    /// Travel, m, and force, N.
    pub(crate) fn rows(&self) -> (Vec<f64>, Vec<f64>) {
        let end_m = self.end_m();
        (0..self.rows)
            .map(|row| {
                let x = end_m * row as f64 / (self.rows - 1) as f64;
                let drift = self.offset_n + self.drift_n * x / end_m;
                let noise = self.noise_n * normal(self.seed, row);
                (x, drift + noise + self.force_n(x - self.before_m))
            })
            .unzip()
    }

    pub(crate) fn curve(&self) -> Curve {
        let (travel_m, force_n) = self.rows();
        let lines = (1..=travel_m.len()).collect();
        Curve::new(travel_m, force_n, lines).unwrap()
    }
}

/// Platzer 2022, 4.4.1.
pub(crate) fn dimensions() -> Dimensions {
    Dimensions {
        support_span_m: Some(0.18),
        loading_span_m: Some(0.08),
        width_m: Some(0.03),
        height_m: Some(0.035),
        ..Dimensions::default()
    }
}

pub(crate) fn specimen(name: &str, made: &Made) -> MeasuredSpecimen {
    MeasuredSpecimen {
        name: name.to_owned(),
        specimen: Specimen::new(TestType::FourPointBending, &dimensions()).unwrap(),
        crack_m: None,
        curve: made.curve(),
    }
}

fn assert_within(found: f64, wanted: f64, fraction: f64, made: &Made) {
    let off = (found / wanted - 1.0).abs();
    assert!(
        off <= fraction,
        "{found}, not {wanted}: off by {off:.5} in {made:?}"
    );
}

/// Modulus and strength of every curve within 0.5 %, for a hundred of them.
#[test]
fn modulus_and_strength_come_back() {
    let reference = Specimen::new(TestType::FourPointBending, &dimensions()).unwrap();
    for seed in 0..100 {
        let mut number = 0;
        let mut within = |low: f64, high: f64| {
            number += 1;
            low + (high - low) * uniform(1000 + seed, &[number])
        };
        let made = Made {
            stiffness_n_m: within(5e3, 50e3),
            before_m: within(0.2e-3, 1e-3),
            seating_m: within(0.0, 0.5e-3),
            offset_n: within(-10.0, 10.0),
            drift_n: within(-0.5, 0.5),
            noise_n: within(0.0, 0.15),
            bend: within(0.7, 1.0),
            rows: within(600.0, 4000.0) as usize,
            seed,
            ..USUAL
        };
        let one = &evaluate(vec![specimen("a", &made)])[0];
        let modulus_pa = reference.modulus_pa(made.stiffness_n_m).unwrap();
        assert_within(one.young_modulus_pa.unwrap(), modulus_pa, 0.005, &made);
        assert_within(
            one.strength_pa,
            reference.stress_pa(made.failure_n),
            0.005,
            &made,
        );
    }
}

#[test]
fn several_specimens_have_a_mean_and_a_scatter() {
    let stiffnesses = [17e3, 18e3, 20e3];
    let made = stiffnesses.map(|stiffness_n_m| Made {
        stiffness_n_m,
        seed: stiffness_n_m as u64,
        ..USUAL
    });
    let specimens = made.iter().map(|made| specimen("a", made)).collect();
    let reference = Specimen::new(TestType::FourPointBending, &dimensions()).unwrap();
    let found = material(
        TestType::FourPointBending,
        &dimensions(),
        &reference,
        &evaluate(specimens),
    )
    .unwrap();
    let wanted = 55e3 / 3.0;
    assert_eq!(found.stiffness_n_m.count, 3);
    assert!((found.stiffness_n_m.mean / wanted - 1.0).abs() < 0.003);
    // (17, 18, 20): standard deviation 1.5275.
    assert!((found.stiffness_n_m.standard_deviation / 1527.5 - 1.0).abs() < 0.05);
    let last = found.curve.last().unwrap();
    assert!((last.load_n / 51.45 - 1.0).abs() < 0.005);
    assert!((last.displacement_m / found.travel_at_failure_m.mean - 1.0).abs() < 1e-12);
}
