//! Curves made of known numbers: offset, drift, seating, a straight part, a bend before the largest
//! force, a tail, noise. Modulus and strength come back.

use dem_io::random::uniform;
use dem_laboratory::{Curve, Dimensions, MeasuredSpecimen, Specimen, TestType, evaluate, material};
use dem_testing::made_test::{Made, USUAL};

/// The curve of a made test.
pub(crate) fn curve(made: &Made) -> Curve {
    let (travel_m, force_n) = made.rows();
    let lines = (1..=travel_m.len()).collect();
    Curve::new(travel_m, force_n, lines).unwrap()
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
        test: TestType::FourPointBending,
        specimen: Specimen::new(TestType::FourPointBending, &dimensions()).unwrap(),
        crack_m: None,
        curve: curve(made),
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

/// The stiffness of a curve without a straight part, F = c x^1.5 as of soft contacts, is its slope
/// between 20 % and 60 % of the largest force, as in a simulated test.
#[test]
fn the_stiffness_of_a_curved_part_is_that_of_a_simulated_test() {
    let (c, failure_m) = (4e6, 2e-3_f64);
    let travel_m: Vec<f64> = (0..2000).map(|row| 2e-6 * f64::from(row)).collect();
    let force = |x: &f64| match x - 1e-3 {
        way if way > failure_m => 0.0,
        way => c * way.max(0.0).powf(1.5),
    };
    let force_n: Vec<f64> = travel_m.iter().map(force).collect();
    let largest_n = c * failure_m.powf(1.5);
    let inner = travel_m
        .iter()
        .zip(&force_n)
        .filter(|(x, force)| **x < 1e-3 + failure_m && (0.2..0.6).contains(&(**force / largest_n)));
    let (ways, forces): (Vec<f64>, Vec<f64>) = inner.map(|(x, force)| (*x, *force)).unzip();
    let wanted = dem_laboratory::Line::fitted(&ways, &forces);
    let lines = (1..=travel_m.len()).collect();
    let one = MeasuredSpecimen {
        curve: Curve::new(travel_m, force_n, lines).unwrap(),
        ..specimen("soft", &USUAL)
    };
    let found = evaluate(vec![one]).remove(0);
    assert!((found.regions.stiffness_n_m / wanted.slope - 1.0).abs() < 2e-3);
    assert!((found.regions.start_m - wanted.zero()).abs() < 2e-6);
    assert!(
        found.notes[0].starts_with("the slope changes by"),
        "{:?}",
        found.notes
    );
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
