//! Evaluation of known records.

use std::f64::consts::PI;

use dem_laboratory::Specimen;
use dem_laboratory::TestType;
use dem_laboratory::figure::{Figure, Source};
use dem_laboratory::test_result::TestResult;
use dem_laboratory::theory::{Beam, KAPPA};
use dem_physics::bond::failure::Cause;
use dem_rig::dynamic::{evaluate_dynamic, results_of};
use dem_rig::evaluate::{TestInput, evaluate};
use dem_rig::record::{BrokenBond, Record, Row};
use dem_rig::setup::Setup;
use dem_scene::{Bars, BondKind, Test};

const BEAM: Beam = Beam {
    span_m: 0.18,
    loading_span_m: 0.08,
    width_m: 0.03,
    height_m: 0.035,
};
const MODULUS: f64 = 12.05e6;
const STRENGTH: f64 = 0.21e6;
/// Clearance before the pins touch, m.
const PLAY: f64 = 0.0002;
/// Compliance at the pins, m/N.
const SOFT: f64 = 4e-6;

pub(crate) fn test(kind: TestType) -> Test {
    Test {
        kind,
        body: "bar".to_owned(),
        crosshead: vec!["pin".to_owned()],
        direction: [0.0, 0.0, -1.0],
        stroke_m: 0.005,
        rate_m_s: Some(0.01),
        periods: 20.0,
        rate_check: false,
        bars: None,
        weight: None,
        confinement: None,
        normal_stress: None,
        young_modulus_pa: Some(MODULUS),
        poisson_ratio: 0.3,
        strength_pa: Some(STRENGTH),
        measured: None,
        support_span_m: None,
        loading_span_m: None,
        width_m: None,
        height_m: None,
        length_m: None,
        area_m2: None,
    }
}

pub(crate) fn setup(specimen: Specimen) -> Setup {
    Setup {
        specimen,
        direction: [0.0, 0.0, -1.0],
        along: [1.0, 0.0, 0.0],
        middle_m: [0.09, 0.015, 0.0175],
        crack_within_m: 0.04,
        moving: vec![0],
        resting: vec![1],
        gauge_m: 0.05,
        mean_radius_m: 0.001,
        sides: Vec::new(),
        strip: Vec::new(),
        slabs: 0,
        section_m2: None,
        pressed: None,
        notes: Vec::new(),
        warnings: Vec::new(),
    }
}

/// Force in proportion to the deflection of the body up to `largest`, then a drop to a tenth; the
/// crosshead moves farther by its compliance.
pub(crate) fn record(stiffness: f64, largest: f64) -> Record {
    let rows = (0..=1100).map(|i| {
        let fraction = f64::from(i) / 1000.0;
        let force_n = if fraction <= 1.0 {
            fraction * largest
        } else {
            0.1 * largest
        };
        let deflection_m = fraction * largest / stiffness;
        Row {
            time_s: fraction,
            travel_m: PLAY + deflection_m + SOFT * fraction * largest,
            force_n,
            reaction_n: force_n,
            deflection_m,
            ..Row::default()
        }
    });
    let broken = [(0.8, 7), (1.0, 3)];
    let broken = broken.map(|(time_s, bond)| BrokenBond {
        time_s,
        bond,
        cause: Cause::VonMises,
    });
    let mut record = Record::default();
    record.rows = rows.collect();
    record.broken = broken.to_vec();
    record
}

pub(crate) const PLACES: [[f64; 3]; 2] = [[0.1, 0.01, 0.002], [0.15, 0.02, 0.01]];

pub(crate) fn evaluated(test: &Test, setup: &Setup, record: &Record, broken: bool) -> TestResult {
    evaluated_at(40.0, test, setup, record, broken)
}

/// Number of bonds of the body, including broken ones.
const ALL_BONDS: usize = 20;

fn evaluated_at(
    lowest_frequency_hz: f64,
    test: &Test,
    setup: &Setup,
    record: &Record,
    broken: bool,
) -> TestResult {
    let bonds = clay(SCENE);
    with_known_units(evaluate(&TestInput {
        test,
        setup,
        record,
        places_m: &PLACES,
        bonds: Some(&bonds),
        lowest_frequency_hz,
        wanted_n: None,
        broken,
        all_bonds: ALL_BONDS,
        pieces: None,
    }))
}

fn clay(scene: &str) -> BondKind {
    let scene = dem_scene::scene_from_text(scene, "scene.toml", &[]).unwrap();
    scene.bonds["clay"].clone()
}

const SCENE: &str = r#"version = 1
[run]
end_time = 1
[materials.clay]
density = 2000
[bonds.clay]
young_modulus = "15 MPa"
poisson_ratio = 0.3
failure = { von_mises_strength = "0.185 MPa", equivalent_stress = "axial-in-tension" }
[bodies.bar]
particles = [[0, 0, 0, 1]]
material = "clay"
"#;

#[track_caller]
fn assert_near(got: Option<f64>, wanted: f64) {
    let got = got.unwrap();
    assert!(
        (got / wanted - 1.0).abs() < 1e-9,
        "{got:e} is not {wanted:e}"
    );
}

/// The forces on the two ends of a specimen between bars differ by a part of the largest load: what
/// counts is the largest difference between half of that load and all of it.
#[test]
fn forces_on_both_ends_agree_from_half_of_the_largest_load_on() {
    let bars = Bars {
        transmission: "below".to_owned(),
        density_kg_m3: 7850.0,
        young_modulus_pa: 210e9,
        diameter_m: 0.05,
        striker_m: 1.0,
        striker_m_s: 10.0,
        rise_time_s: 0.0,
        gauges: None,
    };
    let specimen = Specimen::Bar {
        length_m: 0.05,
        area_m2: 2e-3,
    };
    // The load rises to 1 kN and falls again; here the forces differ by this much in these rows.
    let apart = |differences: &[(usize, f64)]| {
        let test = Test {
            bars: Some(bars.clone()),
            ..test(TestType::HopkinsonPressure)
        };
        let mut record = Record::default();
        record.rows = (0..=40)
            .map(|i| {
                let load_n = 1000.0 - 50.0 * (f64::from(i) - 20.0).abs();
                let here = differences.iter().find(|(at, _)| *at == i as usize);
                let half_n = 0.5 * here.map_or(0.0, |(_, difference_n)| *difference_n);
                Row {
                    time_s: 1e-6 * f64::from(i),
                    force_n: load_n + half_n,
                    reaction_n: load_n - half_n,
                    ..Row::default()
                }
            })
            .collect();
        // A frequency so high that nothing is averaged.
        let input_hz = 1e9;
        let result = evaluated_dynamic(input_hz, &test, &setup(specimen), &record);
        result.figure("force equilibrium").unwrap()
    };
    assert_eq!(apart(&[(20, 50.0)]), 0.05);
    assert_eq!(apart(&[(12, -300.0), (20, 10.0)]), -0.3);
    // Below half of the largest load, and behind it, nothing counts.
    assert_eq!(apart(&[(8, 300.0), (21, 300.0), (20, 20.0)]), 0.02);
}

fn evaluated_dynamic(
    lowest_frequency_hz: f64,
    test: &Test,
    setup: &Setup,
    record: &Record,
) -> TestResult {
    with_known_units(evaluate_dynamic(&TestInput {
        test,
        setup,
        record,
        places_m: &PLACES,
        bonds: None,
        lowest_frequency_hz,
        wanted_n: None,
        broken: false,
        all_bonds: ALL_BONDS,
        pieces: None,
    }))
}

/// A result whose figures have the dimensions that targets for them are read with.
fn with_known_units(result: TestResult) -> TestResult {
    for (name, dimension) in results_of(result.kind) {
        for figure in result.figures.iter().filter(|figure| figure.name == *name) {
            assert_eq!(figure.unit, dimension.si, "{figure:?}");
        }
    }
    result
}

#[test]
fn a_beam_by_its_force_and_way() {
    let test = test(TestType::FourPointBending);
    // A body a tenth stiffer and stronger than the target.
    let stiffness = 1.1 * BEAM.stiffness_n_m(MODULUS, 0.3, KAPPA);
    let force = 1.1 * BEAM.force_n(STRENGTH);
    let record = record(stiffness, force);
    let result = evaluated(&test, &setup(Specimen::Beam(BEAM)), &record, true);
    let by_travel = 1.0 / (1.0 / stiffness + SOFT);
    assert_near(result.figure("stiffness"), by_travel);
    assert_near(result.figure("specimen stiffness"), stiffness);
    assert_near(result.figure("specimen modulus"), 1.1 * MODULUS);
    let shear = BEAM.shear_over_bending(0.3, KAPPA);
    let without = by_travel / stiffness * 1.1 * MODULUS / (1.0 + shear);
    assert_near(result.figure("modulus without shear"), without);
    assert_near(result.figure("modulus with shear"), without * (1.0 + shear));
    assert_near(result.figure("failure force"), force);
    assert_near(result.figure("strength"), 1.1 * STRENGTH);
    assert_near(
        result.figure("crosshead travel at failure"),
        force / by_travel,
    );
    for name in [
        "specimen stiffness",
        "specimen modulus",
        "failure force",
        "strength",
    ] {
        let figure = result.figures.iter().find(|f| f.name == name).unwrap();
        assert!((figure.error.unwrap() - 0.1).abs() < 1e-9, "{figure:?}");
    }
    let calibrated = |name: &str| {
        let found = result.calibration.iter().find(|figure| figure.name == name);
        found.map(|figure| figure.value)
    };
    assert_near(
        calibrated("bond modulus for the target"),
        15e6 * MODULUS / (1.1 * MODULUS),
    );
    assert_near(calibrated("bond strength for the target"), 0.185e6 / 1.1);

    let first = result.first_broken.clone().unwrap();
    assert_near(Some(first.force_n), 0.8 * force);
    // From the zero of the fitted line, like the displacement at failure.
    assert_near(Some(first.travel_m), 0.8 * force / by_travel);
    assert_eq!(first.place_m, PLACES[0]);
    let crack = result.crack.clone().unwrap();
    assert_near(Some(crack.offset_m), 0.035);
    assert_near(Some(crack.spread_m), 0.025);
    assert!(crack.is_within);
    assert_near(Some(crack.fraction_within), 0.5);
    assert!(result.doubts().is_empty());
}

/// An accelerated body exerts less force on its supports than the loading pins exert on it.
#[test]
fn inertia_of_the_body_is_no_load() {
    let test = test(TestType::FourPointBending);
    let setup = setup(Specimen::Beam(BEAM));
    let slow = record(2e4, 50.0);
    let mut shaken = slow.clone();
    for row in &mut shaken.rows {
        let inertia_n = 3.0 * (200.0 * row.time_s).sin() + 5.0 * row.time_s;
        row.force_n += inertia_n;
        row.reaction_n -= inertia_n;
    }
    let [slow, shaken] = [slow, shaken].map(|record| evaluated(&test, &setup, &record, true));
    for name in ["stiffness", "specimen modulus", "failure force"] {
        assert_near(shaken.figure(name), slow.figure(name).unwrap());
    }
}

/// Oscillations faster than a twentieth of the lowest period are averaged out.
#[test]
fn fast_oscillations_are_left_out() {
    let test = test(TestType::FourPointBending);
    let setup = setup(Specimen::Beam(BEAM));
    let mut record = record(2e4, 50.0);
    // Rows are 1 ms apart, the lowest period is 100 ms: means are over five rows, which is the
    // period of this oscillation.
    for (at, row) in record.rows.iter_mut().enumerate() {
        let swing_n = 4.0 * (0.4 * PI * at as f64).sin();
        row.force_n += swing_n;
        row.reaction_n += swing_n;
    }
    let result = evaluated_at(10.0, &test, &setup, &record, true);
    assert_near(result.figure("specimen stiffness"), 2e4);
    // The mean over five rows that end with the drop.
    assert_near(result.figure("failure force"), 50.0 * 0.998);
    // Without the means, the rule for noise leaves little of the crest.
    let crest_n = record.rows.iter().map(Row::load_n).fold(0.0, f64::max);
    assert!(crest_n > 53.0);
    let raw = evaluated(&test, &setup, &record, true);
    let raw_n = raw.figure("failure force").unwrap();
    assert!((raw_n - 50.0).abs() < 2.0, "{raw_n}");
}

#[test]
fn means_at_the_ends_and_of_rows_that_become_shorter() {
    let record = record(2e4, 50.0);
    let whole = record.smoothed(0.0051);
    assert_eq!(whole.len(), record.rows.len());
    // Of the first three rows.
    assert_near(Some(whole[0].force_n), record.rows[1].force_n);
    assert_near(Some(whole[500].travel_m), record.rows[500].travel_m);
    assert_eq!(Record::default().smoothed(1.0), []);

    let row = |time_s: f64, force_n: f64| Row {
        time_s,
        force_n,
        ..Row::default()
    };
    let mut uneven = Record::default();
    uneven.rows = (0..10).map(|i| row(f64::from(i), 0.0)).collect();
    uneven
        .rows
        .extend((0..20).map(|i| row(10.0 + 0.25 * f64::from(i), f64::from(i == 8))));
    // Three rows are within 1 s of an earlier one, nine of the one at 12 s.
    let smooth = uneven.smoothed(2.0);
    assert_near(Some(smooth[18].force_n), 1.0 / 9.0);
    assert_near(Some(smooth[5].time_s), 5.0);
    assert!(smooth[5].force_n == 0.0);
}

#[test]
fn a_body_that_holds_has_no_strength() {
    let test = test(TestType::FourPointBending);
    let record = record(2e4, 50.0);
    let result = evaluated(&test, &setup(Specimen::Beam(BEAM)), &record, false);
    for name in ["failure force", "strength", "crosshead travel at failure"] {
        assert_eq!(result.figure(name), None, "{name}");
    }
    assert_near(result.figure("largest force"), 50.0);
    let [broken_bonds, all_bonds] = result.broken_bonds;
    assert_eq!((broken_bonds, all_bonds), (record.broken.len(), ALL_BONDS));
    let text = result.text(&[]);
    let fraction = format!(
        "the load did not fall to half of its largest; {broken_bonds} of {ALL_BONDS} bonds broke"
    );
    assert!(text.contains(&fraction), "{text}");
    let doubts = result.doubts();
    assert_eq!(doubts.len(), 1, "{doubts:?}");
    let said =
        "the load did not fall to half of its largest within the stroke, so there is no strength";
    assert!(doubts[0].starts_with(said), "{doubts:?}");
    let fraction = 100.0 * broken_bonds as f64 / ALL_BONDS as f64;
    assert!(
        doubts[0].contains(&format!("although {fraction:.0} % of the bonds are broken")),
        "{doubts:?}"
    );
    // A request for stiffness alone is fulfilled.
    let mut elastic = test.clone();
    elastic.strength_pa = None;
    let result = evaluated(&elastic, &setup(Specimen::Beam(BEAM)), &record, false);
    assert!(result.doubts().is_empty(), "{:?}", result.doubts());
}

/// Strengths of bonds do not increase the strength of a body in proportion if they have none.
#[test]
fn bonds_without_strength_are_not_calibrated() {
    let result = evaluate(&TestInput {
        test: &test(TestType::FourPointBending),
        setup: &setup(Specimen::Beam(BEAM)),
        record: &record(2e4, 50.0),
        places_m: &PLACES,
        bonds: Some(&clay(&SCENE.replace("0.185 MPa", "0 Pa"))),
        lowest_frequency_hz: 40.0,
        wanted_n: None,
        broken: true,
        all_bonds: ALL_BONDS,
        pieces: None,
    });
    assert!(!result.calibration.is_empty());
    assert!(result.calibration.iter().all(|f| f.value.is_finite()));
    let of_strength = |name: &str| name.starts_with("strength");
    assert!(!result.calibration.iter().any(|f| of_strength(&f.name)));
}

#[test]
fn an_empty_record_has_no_figures() {
    let test = test(TestType::Compression);
    let bar = Specimen::Bar {
        length_m: 0.1,
        area_m2: 0.001,
    };
    let empty = Record::default();
    let result = evaluated(&test, &setup(bar), &empty, false);
    assert!(result.figures.is_empty(), "{:?}", result.figures);
    let doubts = result.doubts().join("; ");
    assert!(
        doubts.contains("the stiffness could not be determined"),
        "{doubts}"
    );
}

#[test]
fn bars_and_discs() {
    let (length_m, area_m2) = (0.1, 0.0009);
    let bar = Specimen::Bar { length_m, area_m2 };
    let record = record(3e5, 200.0);
    for kind in [TestType::Compression, TestType::Tension] {
        let result = evaluated(&test(kind), &setup(bar), &record, true);
        assert_near(result.figure("strength"), 200.0 / 0.0009);
        // From the elongation of the middle, which is 50 mm long.
        assert_near(result.figure("specimen modulus"), 3e5 * 0.05 / 0.0009);
        assert_near(result.figure("stiffness"), 1.0 / (1.0 / 3e5 + SOFT));
    }
    let disc = Specimen::Disc {
        diameter_m: 0.05,
        thickness_m: 0.02,
    };
    let result = evaluated(&test(TestType::BrazilianDisc), &setup(disc), &record, true);
    assert_near(
        result.figure("strength"),
        400.0 / (std::f64::consts::PI * 0.001),
    );
}

#[test]
fn a_crack_elsewhere_and_a_rate_that_matters_are_doubts() {
    let test = test(TestType::FourPointBending);
    let mut setup = setup(Specimen::Beam(BEAM));
    setup.crack_within_m = 0.03;
    let mut slow = evaluated(&test, &setup, &record(2e4, 50.0), true);
    let fast = evaluated(&test, &setup, &record(2e4, 40.0), true);
    slow.compare(&fast);
    let change = slow
        .half_the_rate_changes
        .iter()
        .find(|f| f.name == "failure force");
    assert_near(change.map(|figure| figure.value), 0.25);
    let doubts = slow.doubts().join("; ");
    assert!(
        doubts.contains("the crack is outside the region"),
        "{doubts}"
    );
    assert!(
        doubts.contains("half the rate changes failure force by +25.0 %"),
        "{doubts}"
    );
    // Its slope has not changed.
    assert!(!doubts.contains("stiffness"), "{doubts}");
}

/// The stress of a disc at another load is compared over its closed form at that load.
#[test]
fn figures_with_a_closed_form_are_compared_over_it() {
    let beam = setup(Specimen::Beam(BEAM));
    let with = |stress_pa: f64, theory_pa: f64| {
        let test = test(TestType::FourPointBending);
        let mut result = evaluated(&test, &beam, &record(2e4, 50.0), true);
        let figure = Figure::new("stress", stress_pa, "Pa", Some(theory_pa));
        result.figures.push(figure.by(Source::ClosedForm));
        result
    };
    for (slow, change) in [([110e3, 121e3], 0.0), ([120e3, 100e3], 0.32)] {
        let mut slow = with(slow[0], slow[1]);
        slow.compare(&with(100e3, 110e3));
        let changes = &slow.half_the_rate_changes;
        let found = changes.iter().find(|figure| figure.name == "stress");
        assert!((found.unwrap().value - change).abs() < 1e-12, "{found:?}");
    }
}
