//! The unchanged suite.

use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

use dem_stress::cases::{CASES, Case, chosen};
use dem_stress::limit_map::{largest_step_s, program_limit};
use dem_stress::prediction::{ObservationMethod, Prediction};
use dem_stress::text::row;
use dem_stress::verdict::run_case;
use rayon::prelude::*;

use super::{member, members};

#[test]
fn every_case_does_as_predicted() {
    let wrong = |case: &Case| {
        let result = run_case(case, &AtomicBool::new(false)).unwrap();
        eprintln!("{:.2} s {}", result.wall_s, row(&result));
        let wrong = result.wrong();
        wrong
            .map(|member| format!("{}: {member:?}", case.name))
            .collect::<Vec<_>>()
    };
    let wrong: Vec<String> = CASES.par_iter().flat_map_iter(wrong).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Required contents of the suite, so that no case is lost: predictions of each type, a map of all
/// models, families over all their orders.
#[test]
fn nothing_is_missing() {
    assert_eq!(CASES.len(), 26);
    let count = |case: &str, of: fn(&Prediction) -> bool| {
        let all = members(case).into_iter();
        all.filter(|member| of(&member.prediction)).count()
    };
    let ends = |p: &Prediction| matches!(p, Prediction::Ends(values) if !values.is_empty());
    let refused = |p: &Prediction| matches!(p, Prediction::Refused(words) if !words.is_empty());
    let stopped = |p: &Prediction| matches!(p, Prediction::Stopped(words) if !words.is_empty());
    for (case, wanted) in [
        ("stiffness-ratio", [3, 0, 0]),
        ("mass-ratio", [4, 0, 0]),
        ("damping", [97, 0, 0]),
        ("step", [3, 3, 3]),
        ("overlap", [5, 0, 1]),
        ("shatter", [1, 0, 0]),
        ("softening", [13, 0, 0]),
        ("yielding", [9, 0, 0]),
        ("beside", [7, 0, 0]),
        ("friction", [9, 0, 0]),
        ("joints", [7, 0, 0]),
        ("swap", [20, 0, 0]),
        ("daughters", [8, 0, 0]),
        ("zones", [8, 0, 0]),
        ("one-particle", [5, 0, 0]),
        ("spin", [2, 0, 0]),
        ("impact", [42, 0, 3]),
        ("adhesion", [12, 0, 0]),
        ("bridges", [12, 0, 0]),
        ("bars", [20, 0, 0]),
        ("mesh-wall", [4, 1, 1]),
        ("coordinates", [4, 1, 0]),
        ("size", [8, 0, 0]),
        ("modulus", [8, 0, 0]),
        ("short-bonds", [18, 0, 0]),
        ("rest", [3, 0, 0]),
    ] {
        let found = [
            count(case, ends),
            count(case, refused),
            count(case, stopped),
        ];
        assert_eq!(found, wanted, "{case}");
    }
    let map = members("damping");
    assert!(
        map.iter()
            .all(|member| member.way == ObservationMethod::LargestStep)
    );
    let shatter = members("shatter");
    let bonds = shatter[0].trial.bodies[0].1.bonds.len();
    assert!(bonds > 100_000, "{bonds}");
    // A day in seconds.
    let rests = members("rest");
    assert!(
        rests
            .iter()
            .all(|member| member.trial.scene.contains("end_time = 8.64e4"))
    );
}

#[test]
fn results_are_the_same_for_any_number_of_threads() {
    let cases = ["impact", "short-bonds", "overlap"].map(str::to_owned);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let cases = chosen(&cases).unwrap().into_iter();
            let tried = cases.map(|case| run_case(&case, &AtomicBool::new(false)).unwrap().members);
            tried.collect::<Vec<_>>()
        })
    };
    let one = with(1);
    assert_eq!(one, with(3));
    assert_eq!(one.len(), 3);
}

/// The observed limit of a pair is the closed form, 2 over its largest frequency: the observation
/// is independent of the program's prediction.
#[test]
fn the_observed_limit_is_the_closed_form() {
    for fraction in [1e-2, 1e-9] {
        let what = format!("timoshenko, {fraction:e} of a radius, its limit");
        let pair = member("short-bonds", &what);
        let observed_s = largest_step_s(&pair.trial, &AtomicBool::new(false)).unwrap();
        // Equal spheres of radius R: stretch 2 k_n / m is faster than bending 2 k_b / I, with k_b =
        // k_n R^2 / 4 and I = 0.4 m R^2, and than shear, 2 k_s / m with k_s < k_n, as such a short
        // lever causes no rotation.
        let radius_m = 1e-3_f64;
        let mass_kg = 2500.0 * 4.0 / 3.0 * PI * radius_m.powi(3);
        let normal_n_m = 1e9 * PI * radius_m.powi(2) / (fraction * radius_m);
        let closed_s = 2.0 / (2.0 * normal_n_m / mass_kg).sqrt();
        let observed = observed_s / closed_s - 1.0;
        let member = program_limit(String::new(), pair.trial).unwrap();
        let Prediction::Ends(values) = member.prediction else {
            panic!("no value");
        };
        let own = values[0].value / closed_s - 1.0;
        eprintln!("{what}: observed {observed:e}, by the program {own:e}");
        assert!(observed.abs() < 0.003, "{observed}");
        assert!(own.abs() < 1e-5, "{own}");
    }
}

#[test]
fn unknown_cases_are_named() {
    let said = chosen(&["spin".to_owned(), "spinn".to_owned()]).unwrap_err();
    assert_eq!(said.exit_code(), 2);
    let said = said.to_string();
    assert!(
        said.starts_with("dem-run stress: there is no case 'spinn'; take some of stiffness-ratio, mass-ratio, damping,")
            && said.ends_with("rest; none means all"),
        "{said}"
    );
    let names = |names: &[&str]| -> Vec<&str> {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        chosen(&names)
            .unwrap()
            .iter()
            .map(|case| case.name)
            .collect()
    };
    // In the order of the suite.
    assert_eq!(
        names(&["spin", "mass-ratio", "spin"]),
        ["mass-ratio", "spin"]
    );
    assert_eq!(names(&[]).len(), CASES.len());
}
