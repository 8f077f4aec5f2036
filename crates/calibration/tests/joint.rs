//! Several made-up tests of one material, whose results are known in closed form.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use dem_calibration::{
    Aim, End, Free, JOINT_VERSION, Joint, JointStart, JointTest, Number, Trial, calibrate_joint,
    joint_origin, joint_page, joint_report, read_joint, weighted_step, write_joint,
};
use dem_io::{Diagnostic, Result};
use dem_laboratory::TestType;
use nalgebra::DMatrix;

/// The numbers of the hidden material, as factors on those of the scenes: modulus, tensile
/// strength, cohesion and friction angle.
const HIDDEN: [f64; 4] = [0.5, 2.0, 0.6, 1.3];
/// Tests: bending, a disc, and shear under two normal stresses.
const TESTS: [(TestType, Option<f64>); 4] = [
    (TestType::FourPointBending, None),
    (TestType::BrazilianDisc, None),
    (TestType::DirectShear, Some(1e6)),
    (TestType::DirectShear, Some(5e6)),
];
/// Test, name and tolerance of each aim.
const AIMS: [(usize, &str, f64); 5] = [
    (0, "modulus without shear", 0.01),
    (0, "strength", 0.02),
    (1, "strength", 0.02),
    (2, "strength", 0.02),
    (3, "strength", 0.02),
];
/// Roughly the slopes of the results below.
const SLOPES: [[f64; 4]; 5] = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 0.7, 0.3, 0.0],
    [0.0, 0.7, 0.3, 0.0],
    [0.0, 0.3, 0.7, 0.05],
    [0.0, 0.3, 0.6, 0.3],
];

/// The results of the tests with these factors and a packing, N/m2: pins are springs in series,
/// strengths are mixed powers, and the shear strength is that of Mohr and Coulomb.
fn results([modulus, tension, cohesion, angle]: [f64; 4], packing: usize) -> [f64; 5] {
    let scatter = [1.03, 0.97][packing % 2];
    let shear = |normal_pa: f64| {
        let of_bonds = 4e6 * cohesion.powf(0.8) * tension.powf(0.2);
        scatter * (of_bonds + normal_pa * (0.5 * angle).tan())
    };
    [
        scatter / (1.0 / (10e9 * modulus) + 1.0 / 40e9),
        scatter * 3e6 * tension.powf(0.8) * cohesion.powf(0.2),
        scatter * 2e6 * tension.powf(0.5) * cohesion.powf(0.4) * modulus.powf(0.1),
        shear(1e6),
        shear(5e6),
    ]
}

fn all_factors(factors: &[f64]) -> [f64; 4] {
    std::array::from_fn(|at| factors.get(at).copied().unwrap_or(1.0))
}

fn trial(aims: &[Aim], which: &[usize], test: usize, found: [f64; 5]) -> Trial {
    let value = |at: usize| (aims[at].test == test).then_some(found[which[at]]);
    Trial {
        results: (0..aims.len()).map(value).collect(),
        at_least: vec![None; aims.len()],
        curve: vec![[0.0, 0.0], [1.0, 1.0]],
        doubts: Vec::new(),
        broken_at_peak: 3,
        wall_s: 1.5,
    }
}

/// A calibration of the first `unknowns` numbers by these aims. The targets are the mean results of
/// the hidden material.
fn joint(unknowns: usize, which: &[usize]) -> Joint {
    let paths = [
        "young_modulus",
        "tensile_strength",
        "cohesion",
        "friction_angle",
    ];
    let free = |at: usize| Free {
        numbers: vec![Number {
            path: format!("bonds.rock.{}", paths[at]),
            value: 10.0,
            unit: "MPa".to_owned(),
        }],
        largest: 1e3,
    };
    let hidden: [f64; 4] = std::array::from_fn(|at| if at < unknowns { HIDDEN[at] } else { 1.0 });
    let targets = [0, 1].map(|packing| results(hidden, packing));
    let aim = |at: &usize| Aim {
        test: AIMS[*at].0,
        result: AIMS[*at].1.to_owned(),
        unit: "Pa".to_owned(),
        target: 0.5 * (targets[0][*at] + targets[1][*at]),
        tolerance: AIMS[*at].2,
        slopes: SLOPES[*at][..unknowns].iter().copied().map(Some).collect(),
    };
    let test = |(kind, pressure_pa): (TestType, Option<f64>)| JointTest {
        scene: match pressure_pa {
            Some(pressure_pa) => format!("{}-{:.0}MPa.toml", kind.name(), 1e-6 * pressure_pa),
            None => format!("{}.toml", kind.name()),
        },
        kind,
        pressure_pa,
        packings: ["seed 1", "seed 2"].map(str::to_owned).to_vec(),
        packed_with: "bar.stl --diameter 5mm".to_owned(),
        particles: 100,
        bonds: 400,
        spheres_across: 5.0,
        mean_diameter_m: 6e-3,
        travel_m: None,
        wanted_curve: Vec::new(),
    };
    Joint {
        version: JOINT_VERSION,
        program: "dem-run".to_owned(),
        date: "2026-01-31".to_owned(),
        identity: 7,
        tests: TESTS.map(test).to_vec(),
        unknowns: (0..unknowns).map(free).collect(),
        aims: which.iter().map(aim).collect(),
        start: None,
        rounds: Vec::new(),
        end: None,
        at_twice_the_rate: None,
        rate_problem: None,
    }
}

fn run(joint: &mut Joint, which: &[usize]) {
    let copy = joint.clone();
    let test = |factors: &[f64], at: usize| {
        let (test, packing) = copy.job(at);
        Ok(trial(
            &copy.aims,
            which,
            test,
            results(all_factors(factors), packing),
        ))
    };
    calibrate_joint(joint, 2, &test, &|_| Ok(())).unwrap();
}

fn deviations(joint: &Joint) -> Vec<f64> {
    let round = joint.result().unwrap();
    let of = |(at, aim): (usize, &Aim)| joint.statistic(round, at).unwrap().mean / aim.target - 1.0;
    joint.aims.iter().enumerate().map(of).collect()
}

/// Four numbers that are 1.3 to 2 times wrong, by four results and by five: the results are met,
/// and as they determine the numbers, so are these.
#[test]
fn the_numbers_of_a_hidden_material_are_found() {
    for which in [&[0, 1, 3, 4][..], &[0, 1, 2, 3, 4]] {
        let mut joint = joint(4, which);
        run(&mut joint, which);
        assert_eq!(joint.end.as_ref().unwrap().1, End::Met, "{:?}", joint.end);
        assert!(joint.rounds.len() <= 12, "{}", joint.rounds.len());
        for (off, aim) in deviations(&joint).iter().zip(&joint.aims) {
            assert!(off.abs() <= aim.tolerance, "{}: {off}", aim.result);
        }
        for (factor, hidden) in joint.result().unwrap().factors.iter().zip(HIDDEN) {
            assert!((factor / hidden - 1.0).abs() < 0.2, "{factor} {hidden}");
        }
        let text = joint_report(&joint);
        for part in [
            "test         brazilian-disc.toml",
            "failure line direct-shear, 2 strengths:",
        ] {
            assert!(text.contains(part) || !which.contains(&2), "{part}: {text}");
        }
    }
}

/// The step of least squares fulfils its normal equations: J' W (J x - d) = 0; with as many results
/// as unknowns it fulfils the equations themselves; with fewer it is the shortest of those that do.
#[test]
fn steps_are_those_of_weighted_least_squares() {
    let slopes = DMatrix::from_row_slice(3, 2, &[1.0, 0.2, 0.1, 0.8, 0.6, 0.5]);
    let (wanted, tolerances) = ([0.3, -0.2, 0.4], [0.01, 0.02, 0.05]);
    let step = weighted_step(&slopes, &wanted, &tolerances);
    let left = &slopes * &step;
    for column in 0..2 {
        let of = |row: usize| {
            slopes[(row, column)] * (left[row] - wanted[row]) / f64::powi(tolerances[row], 2)
        };
        let sum: f64 = (0..3).map(of).sum();
        assert!(sum.abs() < 1e-8, "{sum}");
    }
    // The result with the small tolerance is met better than that with the large one.
    assert!((left[0] - wanted[0]).abs() < 0.1 * (left[2] - wanted[2]).abs());
    let square = slopes.rows(0, 2).into_owned();
    let step = weighted_step(&square, &wanted[..2], &tolerances[..2]);
    assert!((&square * &step - nalgebra::dvector![0.3, -0.2]).amax() < 1e-12);
    let row = slopes.rows(0, 1).into_owned();
    let step = weighted_step(&row, &wanted[..1], &tolerances[..1]);
    // Along the row: x = J' d/(J J').
    assert!((step[0] - 0.3 / 1.04).abs() < 1e-12 && (step[1] - 0.06 / 1.04).abs() < 1e-12);
    // Two equal rows and columns: nothing is divided by 0.
    let flat = DMatrix::from_element(2, 2, 0.5);
    let step = weighted_step(&flat, &[0.1, 0.1], &[0.02, 0.02]);
    assert!((step[0] - 0.1).abs() < 1e-12 && (step[1] - 0.1).abs() < 1e-12);
}

/// Two strengths that one number moves, 20 % apart: the nearest number leaves a part of both, as
/// their tolerances say, and the calibration says so soon.
#[test]
fn targets_that_contradict_are_not_forced() {
    let which = [0, 1, 2];
    let mut joint = joint(2, &which);
    joint.aims[2].target *= 1.2;
    run(&mut joint, &which);
    let (problem, remedy) = joint.problem().unwrap();
    assert!(
        problem.starts_with("the targets contradict each other; the nearest numbers leave "),
        "{problem}"
    );
    assert!(
        problem.contains("brazilian-disc.toml: strength -"),
        "{problem}"
    );
    assert!(remedy.contains("--free"), "{remedy}");
    assert!(joint.rounds.len() <= 6, "{}", joint.rounds.len());
    let off = deviations(&joint);
    assert!(off[0].abs() < 0.01, "{off:?}");
    // (a s + d)² + (b s + e)² is smallest for a (a s + d) + b (b s + e) = 0, with the true slopes
    // of 0.8 and 0.5.
    let balance = 0.8 * off[1].ln_1p() + 0.5 * off[2].ln_1p();
    assert!(
        off[1] > 0.05 && off[2] < -0.05 && balance.abs() < 0.02,
        "{off:?}"
    );
    assert!(joint_origin(&joint).starts_with("# NOT CALIBRATED: the targets contradict"));
}

/// A target that no free number moves is named.
#[test]
fn a_target_that_nothing_moves_is_named() {
    let which = [0, 1];
    let mut joint = joint(1, &which);
    joint.aims[1].target *= 1.5;
    joint.aims[1].slopes = vec![None];
    run(&mut joint, &which);
    let (problem, _) = joint.problem().unwrap();
    assert_eq!(
        problem,
        "four-point-bending.toml: no free number moves the strength"
    );
}

/// Slopes that nobody knows are found by a round of their own.
#[test]
fn unknown_slopes_are_probed() {
    let which = [0, 1, 3, 4];
    let mut joint = joint(4, &which);
    for aim in &mut joint.aims {
        aim.slopes[3] = None;
    }
    run(&mut joint, &which);
    assert_eq!(joint.end.as_ref().unwrap().1, End::Met);
    let probe = &joint.rounds[1].factors;
    assert!(probe[..3] == [1.0; 3] && (probe[3].ln() - 0.2).abs() < 1e-12);
}

/// Bodies that are too strong to break within the stroke become weaker.
#[test]
fn bodies_that_do_not_break_become_weaker() {
    let which = [0, 1, 2];
    let mut joint = joint(2, &which);
    let copy = joint.clone();
    joint.start = Some(JointStart {
        factors: vec![0.5, 12.0],
        tests: 4,
        wall_s: 0.5,
    });
    let test = |factors: &[f64], at: usize| {
        let (test, packing) = copy.job(at);
        let mut one = trial(
            &copy.aims,
            &which,
            test,
            results(all_factors(factors), packing),
        );
        for at in [1, 2] {
            if one.results[at] > Some(8e6) {
                (one.at_least[at], one.results[at]) = (Some(8e6), None);
            }
        }
        Ok(one)
    };
    calibrate_joint(&mut joint, 2, &test, &|_| Ok(())).unwrap();
    assert_eq!(joint.end.as_ref().unwrap().1, End::Met, "{:?}", joint.end);
    assert_eq!(joint.rounds[0].factors, [0.5, 12.0]);
}

/// Stopped after any number of tests, it goes on to the same result without repeating one, and its
/// record is read as it was written.
#[test]
fn a_stopped_joint_calibration_goes_on() {
    let which = [0, 1, 3, 4];
    let mut whole = joint(4, &which);
    run(&mut whole, &which);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.json");
    for stop in [0, 3, 8, 13] {
        let done = AtomicUsize::new(0);
        let mut cut = joint(4, &which);
        let copy = cut.clone();
        let limited = |factors: &[f64], at: usize| -> Result<Trial> {
            if done.fetch_add(1, Ordering::Relaxed) >= stop {
                return Err(Diagnostic::interrupted("interrupted", ""));
            }
            let (test, packing) = copy.job(at);
            Ok(trial(
                &copy.aims,
                &which,
                test,
                results(all_factors(factors), packing),
            ))
        };
        let saved = Mutex::new(joint(4, &which));
        let save = |joint: &Joint| {
            saved.lock().unwrap().clone_from(joint);
            Ok(())
        };
        calibrate_joint(&mut cut, 1, &limited, &save).expect_err("stopped");
        write_joint(&path, &saved.into_inner().unwrap()).unwrap();
        let mut cut = read_joint(&path).unwrap();
        assert_eq!(cut.cost().1, stop);
        run(&mut cut, &which);
        assert_eq!(cut, whole);
    }
    whole.rounds[0].factors.pop();
    write_joint(&path, &whole).unwrap();
    let error = read_joint(&path).expect_err("cut");
    assert!(error.problem.contains("without all of their numbers"));
}

/// The page and the file of the material name every test, its packings, and what it gives.
#[test]
fn every_test_is_on_the_page_and_in_the_material() {
    let which = [0, 1, 2, 3, 4];
    let mut joint = joint(4, &which);
    run(&mut joint, &which);
    let (page, origin) = (joint_page(&joint), joint_origin(&joint));
    for test in &joint.tests {
        assert!(page.contains(&test.scene), "{}", test.scene);
        assert!(
            origin.contains(&format!("# Test: {}, ", test.scene)),
            "{origin}"
        );
    }
    for part in [
        "with 4 tests at once.",
        "# Packings: seed 1, seed 2, of dem-pack bar.stl --diameter 5mm.",
        "95 % confidence interval",
        "# others: mean of 2 other packings, 95 %: strength ",
        "# direct-shear, 2 strengths: cohesion ",
        "# bonds.rock.cohesion: ",
    ] {
        assert!(origin.contains(part), "{part}: {origin}");
    }
}
