//! Calibration of made-up tests whose results are known in closed form.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod joint;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use dem_calibration::{
    Case, End, FORMAT_VERSION, Number, Record, Start, Trial, Unknown, calibrate, coarsest,
    curve_error, half_width, page, read_record, report, write_record,
};
use dem_io::{Diagnostic, Result};
use dem_laboratory::Statistic;

fn unknown(path: &str, result: &str, target: f64, tolerance: f64) -> Unknown {
    Unknown {
        numbers: vec![Number {
            path: path.to_owned(),
            value: 10.0,
            unit: "MPa".to_owned(),
        }],
        result: result.to_owned(),
        unit: "Pa".to_owned(),
        target,
        tolerance,
        is_proportional: true,
    }
}

/// Modulus 12 and strength 0.2.
fn both() -> Vec<Unknown> {
    vec![
        unknown("bonds.cake.young_modulus", "modulus", 12.0, 0.01),
        unknown(
            "bonds.cake.failure.von_mises_strength",
            "strength",
            0.2,
            0.02,
        ),
    ]
}

fn empty(name: &str) -> Case {
    Case {
        name: name.to_owned(),
        particles: 100,
        bonds: 400,
        spheres_across: 5.0,
        mean_diameter_m: 6e-3,
        start: None,
        rounds: Vec::new(),
        end: None,
        at_twice_the_rate: None,
        rate_problem: None,
    }
}

fn trial(results: Vec<Option<f64>>) -> Trial {
    Trial {
        at_least: vec![None; results.len()],
        results,
        curve: vec![[0.0, 0.0], [1.0, 1.0]],
        doubts: Vec::new(),
        broken_at_peak: 3,
        wall_s: 1.5,
    }
}

/// A body of springs in series, of the bonds and of the contacts at the pins, whose packings differ
/// by 5 % and 10 %; its strength follows that of its bonds, and a little their modulus.
fn soft_at_pins(factors: &[f64], packing: usize) -> Trial {
    let stiff = [1.05, 0.95, 1.02, 0.98][packing % 4];
    let strong = [1.1, 0.9, 1.05, 0.95][packing % 4];
    let modulus = 1.0 / (1.0 / (7.0 * stiff * factors[0]) + 1.0 / 40.0);
    let strength = 0.11 * strong * factors[1] * factors[0].powf(0.1);
    trial(vec![Some(modulus), Some(strength)])
}

fn run(case: &mut Case, unknowns: &[Unknown], test: impl Fn(&[f64], usize) -> Trial + Sync) {
    let test = |factors: &[f64], packing: usize| -> Result<Trial> { Ok(test(factors, packing)) };
    calibrate(unknowns, 4, case, 2, &test, &|_| Ok(())).unwrap();
}

#[test]
fn modulus_and_strength_are_met_within_four_rounds() {
    let mut case = empty("");
    run(&mut case, &both(), soft_at_pins);
    let (at, end) = case.end.clone().unwrap();
    assert_eq!(end, End::Met);
    assert!(case.rounds.len() <= 4 && at + 1 == case.rounds.len());
    let round = case.result().unwrap();
    for (deviation, unknown) in round.deviations(&both()).iter().zip(both()) {
        assert!(deviation.unwrap().abs() <= unknown.tolerance);
    }
    // The mean modulus is 12 for bonds of the exact solution of the mean of the four; for equal
    // packings it is 12 = 1/(1/(7 f) + 1/40).
    let exact = 1.0 / (7.0 * (1.0 / 12.0 - 1.0 / 40.0));
    assert!((round.factors[0] / exact - 1.0).abs() < 0.02);
    assert_eq!(
        case.cost(),
        (6.0 * case.rounds.len() as f64, 4 * case.rounds.len())
    );
}

/// From a good first guess, one round is enough.
#[test]
fn a_good_start_saves_rounds() {
    let mut found = empty("");
    run(&mut found, &both(), soft_at_pins);
    let mut case = empty("");
    case.start = Some(Start {
        factors: found.result().unwrap().factors.clone(),
        slopes: vec![0.7, 1.0],
        travel_m: Some(1e-3),
        tests: 4,
        wall_s: 0.5,
    });
    run(&mut case, &both(), soft_at_pins);
    assert_eq!(case.rounds.len(), 1);
    let text = report(&record(vec![case], Vec::new()), None);
    assert!(
        text.contains("cost         4 tests, 6 s; 4 tests without steps before them, 0.5 s"),
        "{text}"
    );
}

#[test]
fn the_number_of_workers_does_not_change_the_result() {
    let of = |workers: usize| {
        let mut case = empty("");
        let test = |factors: &[f64], packing: usize| Ok(soft_at_pins(factors, packing));
        calibrate(&both(), 4, &mut case, workers, &test, &|_| Ok(())).unwrap();
        case
    };
    assert_eq!(of(1), of(3));
}

/// Stopped after any number of tests, it goes on to the same result without repeating one.
#[test]
fn a_stopped_calibration_goes_on() {
    let mut whole = empty("");
    run(&mut whole, &both(), soft_at_pins);
    let tests = whole.cost().1;
    for stop in 0..tests {
        let done = AtomicUsize::new(0);
        let mut case = empty("");
        let limited = |factors: &[f64], packing: usize| {
            if done.fetch_add(1, Ordering::Relaxed) < stop {
                return Ok(soft_at_pins(factors, packing));
            }
            Err(Diagnostic::interrupted("interrupted", ""))
        };
        let saved = Mutex::new(empty(""));
        let save = |case: &Case| {
            saved.lock().unwrap().clone_from(case);
            Ok(())
        };
        calibrate(&both(), 4, &mut case, 1, &limited, &save).expect_err("stopped");
        let mut case = saved.into_inner().unwrap();
        assert_eq!(case.cost().1, stop);
        let further = AtomicUsize::new(0);
        let counted = |factors: &[f64], packing: usize| {
            further.fetch_add(1, Ordering::Relaxed);
            Ok(soft_at_pins(factors, packing))
        };
        calibrate(&both(), 4, &mut case, 2, &counted, &|_| Ok(())).unwrap();
        assert_eq!(case, whole);
        assert_eq!(further.into_inner(), tests - stop);
    }
}

fn problem(test: impl Fn(&[f64], usize) -> Trial + Sync) -> (String, String) {
    let mut case = empty("");
    run(&mut case, &both(), test);
    assert!(!case.is_met());
    case.problem().unwrap()
}

#[test]
fn targets_that_cannot_be_met_are_named_with_a_remedy() {
    // Soft contacts determine the modulus.
    let (said, remedy) = problem(|factors, _| {
        trial(vec![
            Some(6.0 * factors[0].powf(0.01)),
            Some(0.2 * factors[1]),
        ])
    });
    assert!(
        said.contains("the modulus hardly follows bonds.cake.young_modulus"),
        "{said}"
    );
    assert!(remedy.contains("contacts at pins"), "{remedy}");
    // A target in the wrong unit.
    let (said, remedy) = problem(|factors, _| trial(vec![Some(12.0), Some(2e-7 * factors[1])]));
    assert!(
        said.contains("the target of the strength is out of reach"),
        "{said}"
    );
    assert!(remedy.contains("unit"), "{remedy}");
    // A stroke that ends before the body breaks.
    let whole = |_: &[f64], _: usize| Trial {
        at_least: vec![None, Some(0.15)],
        ..trial(vec![Some(12.0), None])
    };
    let (said, remedy) = problem(whole);
    assert!(
        said.contains(
            "the bodies do not break: at the end of the stroke the strength is 0.750 of its target"
        ),
        "{said}"
    );
    assert_eq!(remedy, "lengthen test.stroke");
    // No result at all.
    let (said, _) = problem(|_, _| trial(vec![None, None]));
    assert_eq!(said, "no test gave the modulus");
    // A strength that jumps from too small to too large and does not scatter.
    let (said, remedy) = problem(|factors, _| {
        let strength = if factors[1] < 1.5 { 0.15 } else { 0.3 };
        trial(vec![Some(12.0), Some(strength * factors[1].powf(0.3))])
    });
    assert!(said.contains("from its target after 4 rounds"), "{said}");
    assert!(remedy.contains("more packings"), "{remedy}");
}

/// A result that falls as its number rises, by no simple law: damping and rebound.
#[test]
fn a_result_that_falls_is_met() {
    let mut rebound = unknown("bonds.cake.damping.damping_ratio", "rebound", 0.3, 0.02);
    rebound.is_proportional = false;
    for target in [0.02, 0.3, 0.6, 0.75] {
        rebound.target = target;
        let mut case = empty("");
        run(&mut case, std::slice::from_ref(&rebound), |factors, _| {
            trial(vec![Some((-0.6 * factors[0] - 0.2).exp())])
        });
        assert_eq!(case.end.as_ref().unwrap().1, End::Met, "{target}");
        let mean = case.result().unwrap().mean(0).unwrap();
        assert!((mean / target - 1.0).abs() <= 0.02, "{target}");
    }
}

/// Bodies that were too strong to break in the first round break in a later one.
#[test]
fn too_strong_a_first_guess_is_lowered() {
    let mut case = empty("");
    run(&mut case, &both(), |factors, packing| {
        let mut trial = soft_at_pins(&[factors[0], 10.0 * factors[1]], packing);
        trial.results[0] = Some(12.0);
        if trial.results[1] > Some(0.8) {
            trial.results[1] = None;
            trial.at_least[1] = Some(0.8);
        }
        trial
    });
    assert_eq!(case.end.as_ref().unwrap().1, End::Met);
    assert!((case.rounds[1].factors[1] - 0.25).abs() < 1e-12);
    // Guesses that are far too strong, where the stroke ends a little above the target.
    for guess in [3.0, 10.0, 100.0, 900.0] {
        let mut case = empty("");
        run(&mut case, &both(), |factors, packing| {
            let mut trial = soft_at_pins(&[factors[0], guess * factors[1]], packing);
            if trial.results[1] > Some(0.24) {
                trial.results[1] = None;
                trial.at_least[1] = Some(0.24);
            }
            trial
        });
        assert_eq!(case.end.as_ref().unwrap().1, End::Met, "{guess}");
    }
}

/// Bodies that break so early that their stiffness cannot be measured.
#[test]
fn too_weak_a_first_guess_is_raised() {
    let mut case = empty("");
    run(&mut case, &both(), |factors, packing| {
        let mut trial = soft_at_pins(&[factors[0], 0.01 * factors[1]], packing);
        if trial.results[1] < Some(0.02) {
            trial.results[0] = None;
        }
        trial
    });
    assert_eq!(case.end.as_ref().unwrap().1, End::Met);
}

/// Bodies that are too soft to break within the stroke become stiffer first.
#[test]
fn a_body_that_is_too_soft_to_break_becomes_stiffer() {
    let mut case = empty("");
    run(&mut case, &both(), |factors, packing| {
        let mut trial = soft_at_pins(factors, packing);
        if trial.results[0] < Some(8.0) {
            trial.results[1] = None;
            trial.at_least[1] = Some(0.1);
        }
        trial
    });
    assert_eq!(case.end.as_ref().unwrap().1, End::Met);
    assert_eq!(case.rounds[1].factors[1], 1.0);
}

/// Means that are not within 2 %, but whose confidence interval contains the target.
#[test]
fn a_target_within_the_scatter_is_said_to_be() {
    let mut case = empty("");
    run(&mut case, &both(), |factors, packing| {
        // Each round gives a mean near 0.1905, whatever the strength, with a scatter of 20 %.
        let strength = 0.1905 * [1.2, 0.8, 1.2, 0.8][packing];
        trial(vec![Some(12.0), Some(strength * factors[1].powf(0.06))])
    });
    assert_eq!(case.end.as_ref().unwrap().1, End::WithinScatter);
    assert!(case.is_met() && case.problem().is_none());
}

#[test]
fn half_widths_of_means() {
    let one = Statistic::of(&[1.0]);
    assert_eq!(half_width(&one), None);
    // Four values with a standard deviation of 1: 3.1824/2.
    let four = Statistic {
        mean: 0.0,
        standard_deviation: 1.0,
        count: 4,
    };
    assert!((half_width(&four).unwrap() - 1.5912).abs() < 1e-9);
}

fn record(cases: Vec<Case>, wanted_curve: Vec<[f64; 2]>) -> Record {
    Record {
        version: FORMAT_VERSION,
        program: "dem-run".to_owned(),
        date: "2026-01-31".to_owned(),
        identity: 7,
        scene: "bending.toml".to_owned(),
        unknowns: both(),
        packings: ["a", "b", "c", "d"].map(str::to_owned).to_vec(),
        packed_with: "bar.stl --diameter 5mm..7mm".to_owned(),
        wanted_curve,
        cases,
    }
}

/// A case whose four tests have triangles of this load at a displacement of 1.
fn triangle(name: &str, load_n: f64) -> Case {
    let mut case = empty(name);
    run(&mut case, &both(), |factors, packing| Trial {
        curve: vec![[0.0, 0.0], [0.5, 0.5 * load_n], [1.0, load_n], [1.1, 0.0]],
        ..soft_at_pins(factors, packing)
    });
    case
}

#[test]
fn the_coarsest_size_that_keeps_the_error_is_named() {
    let cases = || {
        vec![
            triangle("6mm", 1.2),
            triangle("4mm", 1.04),
            triangle("2mm", 1.0),
        ]
    };
    // Against the finest: half of 0.2 over half of 1, and so on.
    let own = record(cases(), Vec::new());
    let errors: Vec<Option<f64>> = own
        .cases
        .iter()
        .map(|case| curve_error(&own, case))
        .collect();
    assert!((errors[0].unwrap() - 0.2).abs() < 1e-9 && (errors[1].unwrap() - 0.04).abs() < 1e-9);
    assert_eq!(errors[2], None);
    assert_eq!(coarsest(&own, 0.05).unwrap().name, "4mm");
    assert!(coarsest(&own, 0.01).is_none());
    // Against a measured curve with a load of 1.2.
    let measured = record(cases(), vec![[0.0, 0.0], [1.0, 1.2]]);
    assert_eq!(coarsest(&measured, 0.05).unwrap().name, "6mm");
    // A size that has not met its targets does not count.
    let mut unmet = record(cases(), Vec::new());
    unmet.cases[1].end = Some((0, End::NotMet("it".to_owned(), "that".to_owned())));
    assert!(coarsest(&unmet, 0.05).is_none());
    let text = report(&own, Some(0.05));
    assert!(
        text.contains("resolution   4mm is the coarsest whose curve is within 5 %: 4.0 %"),
        "{text}"
    );
    let html = page(&own, Some(0.05));
    assert!(html.contains("4mm is the coarsest") && html.contains("20.0 %"));
}

#[test]
fn a_record_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.json");
    let written = record(vec![triangle("", 1.0)], Vec::new());
    write_record(&path, &written).unwrap();
    let read = read_record(&path).unwrap();
    assert_eq!(read, written);
    let mut cut = written.clone();
    cut.cases[0].rounds[0].factors.pop();
    write_record(&path, &cut).unwrap();
    let said = read_record(&path)
        .expect_err("a number is missing")
        .to_string();
    assert!(
        said.contains("has rounds without all of their numbers"),
        "{said}"
    );
    std::fs::write(&path, "{}").unwrap();
    let said = read_record(&path).expect_err("not a record").to_string();
    assert!(
        said.contains("is not the record of a calibration"),
        "{said}"
    );
}
