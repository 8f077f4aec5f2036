//! Specimens and curves that are doubted or left out, and why.

use dem_laboratory::{Dimensions, TestType, evaluate};

use dem_testing::made_test::{Made, USUAL};

use crate::synthetic::{dimensions, specimen};

/// Curves that can be read and mean nothing are left out, and it is said why.
#[test]
fn doubtful_specimens_are_named() {
    let doubts = |made: &Made| evaluate(vec![specimen("a", made)])[0].doubts.clone();
    assert_eq!(doubts(&USUAL), Vec::<String>::new());
    let first = |made: &Made| doubts(made).into_iter().next().unwrap_or_default();
    let seating = first(&Made {
        seating_m: 3.2e-3,
        ..USUAL
    });
    assert!(seating.starts_with("its seating takes 1."), "{seating}");
    let whole = first(&Made {
        tail: 0.95,
        ..USUAL
    });
    assert_eq!(
        whole,
        "it did not fail: the force is still 95 % of its largest at the end"
    );
    let begun = first(&Made {
        before_m: 0.0,
        seating_m: 0.0,
        ..USUAL
    });
    assert_eq!(
        begun,
        "it begins in contact: the offset of the load cell is taken to be 0"
    );
    let bent = first(&Made {
        bend: 0.05,
        seating_m: 0.0,
        noise_n: 0.005,
        ..USUAL
    });
    assert!(bent.starts_with("it has no linear part"), "{bent}");
}

/// Numbers that no material has are a wrong unit or dimension.
#[test]
fn impossible_specimens_are_left_out() {
    let doubts_with = |travel: f64, force: f64, height_m: f64| {
        let mut one = specimen("a", &USUAL);
        let size = Dimensions {
            height_m: Some(height_m),
            ..dimensions()
        };
        one.specimen = dem_laboratory::Specimen::new(TestType::FourPointBending, &size).unwrap();
        one.curve.travel_m.iter_mut().for_each(|x| *x *= travel);
        one.curve.force_n.iter_mut().for_each(|f| *f *= force);
        evaluate(vec![one])[0].doubts.join("; ")
    };
    assert_eq!(doubts_with(1.0, 1.0, 0.035), "");
    for (travel, force, height_m, wanted) in [
        (1e3, 1.0, 0.035, "its strain at failure is"),
        (1e-4, 1.0, 0.035, "its strain at failure is"),
        (
            1.0,
            1.0,
            35.0,
            "its height of 35 m is more than its support span of 0.18 m",
        ),
        (1.0, 1e6, 0.035, "not between 1 kPa and 1 TPa"),
        (1.0, 1e-5, 0.035, "not between 1 kPa and 1 TPa"),
    ] {
        let found = doubts_with(travel, force, height_m);
        assert!(
            found.contains(wanted),
            "{travel} {force} {height_m}: {found}"
        );
        assert!(found.contains("check the units"), "{found}");
    }
}

/// A length in another unit leaves the strain and the modulus of a stiff material possible, but not
/// the shape.
#[test]
fn specimens_of_an_impossible_shape_are_left_out() {
    let doubts_with = |test: TestType, size: Dimensions| {
        let mut one = specimen("a", &USUAL);
        one.test = test;
        one.specimen = dem_laboratory::Specimen::new(test, &size).unwrap();
        evaluate(vec![one])[0].doubts.join("; ")
    };
    let bar = |length_m: f64| Dimensions {
        length_m: Some(length_m),
        area_m2: Some(9e-4),
        ..Dimensions::default()
    };
    let beam = |width_m: f64| Dimensions {
        width_m: Some(width_m),
        ..dimensions()
    };
    use TestType::{Compression, FourPointBending, Tension};
    for found in [
        doubts_with(Compression, bar(0.06)),
        doubts_with(Tension, bar(35.0)),
        doubts_with(FourPointBending, beam(0.05)),
    ] {
        assert!(!found.contains(" over "), "{found}");
    }
    for (found, wanted) in [
        (
            doubts_with(Compression, bar(35.0)),
            "its length over the side of its section is 1.167e3 (usual: 0.02 to 50)",
        ),
        (
            doubts_with(FourPointBending, beam(35.0)),
            "its width over its height is 1.000e3 (usual: 0.02 to 50)",
        ),
    ] {
        assert!(found.contains(wanted), "{found}");
    }
}

/// A specimen 43 % weaker than the others is named; usual scatter is not.
#[test]
fn outliers_are_named() {
    let notes = |factors: &[f64]| {
        let specimens = factors.iter().enumerate().map(|(at, factor)| {
            let made = Made {
                failure_n: factor * USUAL.failure_n,
                seed: at as u64,
                ..USUAL
            };
            specimen("a", &made)
        });
        let found = evaluate(specimens.collect());
        found
            .iter()
            .map(|one| one.notes.join("; "))
            .collect::<Vec<String>>()
    };
    for factors in [
        vec![1.0, 1.02, 0.57],
        vec![1.0, 0.98, 1.01, 0.57],
        vec![1.0, 1.04, 0.97, 1.01, 0.99, 0.57],
    ] {
        let found = notes(&factors);
        let (last, others) = found.split_last().unwrap();
        assert!(
            last.contains("% below the mean of the others, an outlier"),
            "{found:?}"
        );
        assert!(others.iter().all(String::is_empty), "{found:?}");
    }
    assert!(notes(&[1.0, 0.9, 1.12, 0.95, 1.05]).concat().is_empty());
    assert!(notes(&[1.0, 0.57])[1].contains("43 % below that of the other specimen"));
}

/// A large drift is subtracted and named where the unloaded cell behind the failure confirms it,
/// and named without being subtracted where nothing does.
#[test]
fn a_large_drift_needs_an_unloaded_tail() {
    // 3.4 % of the largest force up to it.
    let made = Made {
        drift_n: 2.0,
        before_m: 1.2e-3,
        noise_n: 0.05,
        ..USUAL
    };
    let found = |made: &Made| {
        let one = evaluate(vec![specimen("a", made)]).remove(0);
        (
            one.young_modulus_pa.unwrap(),
            one.notes.join("; "),
            one.doubts,
        )
    };
    let (without, none, _) = found(&Made {
        drift_n: 0.0,
        ..made
    });
    assert_eq!(none, "");
    let (confirmed, said, doubts) = found(&made);
    assert!(said.starts_with("the load cell drifts by"), "{said}");
    assert!(doubts.is_empty(), "{doubts:?}");
    assert!((confirmed / without - 1.0).abs() < 5e-3);
    let (not, said, _) = found(&Made { tail: 0.3, ..made });
    assert!(said.contains("not subtracted"), "{said}");
    let rise = 2.0 / 4e-3 / USUAL.stiffness_n_m;
    assert!(
        (not / without - 1.0 - rise).abs() < 0.02,
        "{not} {without} {rise}"
    );
}

#[test]
fn two_peaks_cracks_outside_and_other_units_are_named() {
    let other = |name: &str, seed: u64| specimen(name, &Made { seed, ..USUAL });
    let mut slipped = other("slipped", 4);
    for (at, force) in slipped.curve.force_n.iter_mut().enumerate() {
        if (600..660).contains(&at) {
            *force *= 0.5;
        }
    }
    let mut outside = other("outside", 5);
    outside.crack_m = Some(-0.05);
    let mut kilo = other("kilo", 6);
    kilo.curve
        .force_n
        .iter_mut()
        .for_each(|force| *force *= 1e-3);
    let good = [("a", 1), ("b", 2), ("c", 3)].map(|(name, seed)| other(name, seed));
    let copy = other("copy", 2);
    let all = good
        .into_iter()
        .chain([slipped, outside, kilo, copy])
        .collect();
    let found = evaluate(all);
    let doubts: Vec<&str> = found
        .iter()
        .flat_map(|one| &one.doubts)
        .map(String::as_str)
        .collect();
    assert!(
        doubts[0].starts_with("it has two peaks: the force falls from"),
        "{doubts:?}"
    );
    assert_eq!(
        doubts[1],
        "it cracked 50.0 mm from the middle, outside the loading pins at 40.0 mm"
    );
    assert!(
        doubts[2].contains("one of them is in another unit"),
        "{doubts:?}"
    );
    assert_eq!(doubts[3], "it has the same rows as b");
    assert_eq!(doubts.len(), 4, "{doubts:?}");
}

/// Doubts about the load cell of a made test after its rows were changed.
fn limits(made: &Made, change: &dyn Fn(usize, f64) -> f64) -> Vec<String> {
    let mut one = specimen("a", made);
    for (row, force) in one.curve.force_n.iter_mut().enumerate() {
        *force = change(row, *force);
    }
    let doubts = evaluate(vec![one]).remove(0).doubts;
    let is_limit = |doubt: &String| doubt.starts_with("its load cell is at its limit");
    doubts.into_iter().filter(is_limit).collect()
}

/// Regression: the limit of the load cell was taken as the strength.
#[test]
fn a_load_cell_at_its_limit_is_named() {
    let clipped = |limit_n: f64| move |_: usize, force: f64| force.min(limit_n);
    assert_eq!(
        limits(&USUAL, &clipped(30.0)),
        [
            "its load cell is at its limit: the force was rising and stays at exactly 30 N (lines 534 to 984) while the travel goes on by 1.847 mm; the strength is at least this: measure with a cell of larger range"
        ]
    );
    let none = Made {
        noise_n: 0.0,
        drift_n: 0.0,
        ..USUAL
    };
    for limit_n in [25.0, 30.0, 40.0] {
        assert_eq!(limits(&USUAL, &clipped(limit_n)).len(), 1, "{limit_n}");
        assert_eq!(limits(&none, &clipped(limit_n)).len(), 1, "{limit_n}");
        let display = |_: usize, force: f64| (force.min(limit_n) / 0.1).round() * 0.1;
        assert_eq!(limits(&USUAL, &display).len(), 1, "{limit_n}");
    }
}

/// Yielding, round tops and the steps of a display are no limit.
#[test]
fn plateaus_of_the_material_are_no_limit_of_the_cell() {
    let rounded = |step_n: f64| move |_: usize, force: f64| (force / step_n).round() * step_n;
    for seed in 0..3 {
        for bend in [0.3, 0.6, 0.8, 0.95, 1.0] {
            for noise_n in [0.0, 0.1, 1.0] {
                for rows in [200, 1500] {
                    let made = Made {
                        bend,
                        noise_n,
                        rows,
                        seed,
                        ..USUAL
                    };
                    for step_n in [0.01, 0.1, 1.0, 5.0] {
                        let found = limits(&made, &rounded(step_n));
                        assert!(found.is_empty(), "{made:?} {step_n}: {found:?}");
                    }
                }
            }
        }
        // It yields at 40 N, as sharply as may be, with noise of some steps of the display.
        let made = Made {
            noise_n: 0.0,
            drift_n: 0.0,
            seed,
            ..USUAL
        };
        let noisy = Made {
            noise_n: 0.3,
            ..made
        }
        .rows()
        .1;
        let smooth = made.rows().1;
        for step_n in [1e-6, 0.1] {
            let yields = |row: usize, force: f64| {
                rounded(step_n)(row, force.min(40.0) + noisy[row] - smooth[row])
            };
            let found = limits(&made, &yields);
            assert!(found.is_empty(), "{seed} {step_n}: {found:?}");
        }
    }
}
