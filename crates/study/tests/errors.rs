//! Errors against every kind of reference.

use dem_study::outcome::{Done, Outcome, Reading};
use dem_study::row::Judged;
use dem_study::sweep_table::SweepTable;

use super::made::{assert_near, done, reading, study, table, table_of};

/// Result of each run for a measure.
fn results(table: &SweepTable, measure: usize) -> Vec<&Judged> {
    let results = table.runs.iter().map(|row| &row.results[measure]);
    results.collect()
}

fn errors(table: &SweepTable, measure: usize) -> Vec<Option<f64>> {
    results(table, measure)
        .iter()
        .map(|one| one.error)
        .collect()
}

#[test]
fn errors_are_relative_except_to_zero() {
    let study = study(
        r#"
[vary]
"run.safety_factor" = [0.9, 0.5]
[measures.tip]
reference = { value = -2 }
[measures.gap]
reference = { value = 0 }
[measures.sag]
reference = "closed-form"
[measures.energy]
balance = "energy"
"#,
    );
    let table = table(&study, |run| {
        let mut done = done(1.0, &[-1.5, -0.25, 5.0, 0.01]);
        done.readings[2].closed_form = (run.number == 1).then_some(4.0);
        done.readings[3].closed_form = Some(0.0);
        done
    });
    assert_eq!(errors(&table, 0), [Some(0.25); 2]);
    assert_eq!(errors(&table, 1), [Some(0.25); 2]);
    assert_eq!(errors(&table, 2), [Some(0.25), None]);
    assert_eq!(errors(&table, 3), [Some(0.01); 2]);
    let words = table.measures.iter().map(|one| one.reference.as_deref());
    let words: Vec<&str> = words.map(Option::unwrap).collect();
    assert_eq!(
        words,
        [
            "-2",
            "0",
            "the reference of the scene",
            "an error by itself"
        ]
    );
    assert!(table.responses.is_empty());
}

/// Two models; the second of the radii is the finest.
const RADII: &str = r#"
[vary]
"bonds.bar.model" = ["parallel", "timoshenko"]
"bodies.bar.radius" = ["4 mm", "1 mm", "2 mm"]
[measures.tip]
"#;

fn radii(reference: &str) -> String {
    format!("{RADII}reference = {{ {reference} = \"bodies.bar.radius\" }}")
}

#[test]
fn the_finest_run_of_each_case_is_its_reference() {
    let values = [[12.0, 10.0, 11.0], [-3.0, -4.0, -5.0]];
    let times_s = [[1.0, 8.0, 2.0], [3.0, 12.0, 4.0]];
    let made = |choice: &[usize]| {
        let [model, radius] = [choice[0], choice[1]];
        done(times_s[model][radius], &[values[model][radius]])
    };
    let study = study(&radii("finest"));
    let whole = table(&study, |run| made(&run.choice));
    let found = results(&whole, 0);
    let faster: Vec<Option<f64>> = found.iter().map(|one| one.times_as_fast).collect();
    let wanted = [Some(8.0), None, Some(4.0), Some(4.0), None, Some(3.0)];
    assert_eq!(faster, wanted);
    for (at, error) in [(0, 0.2), (2, 0.1), (3, 0.25), (5, 0.25)] {
        assert_near(found[at].error.unwrap(), error);
        assert_eq!(found[at].uncertainty, None);
    }
    for at in [1, 4] {
        assert!(found[at].is_reference);
        assert_eq!((found[at].error, found[at].is_on_front), (None, false));
    }
    assert_eq!(found.iter().filter(|one| one.is_reference).count(), 2);

    let partly = table_of(&study, |run| match run.choice.as_slice() {
        [0, 1] => vec![Outcome::Failed("it burst".to_owned())],
        choice => vec![Outcome::Done(made(choice))],
    });
    assert_eq!(partly.runs[0].results[0].error, None);
    assert_near(partly.runs[3].results[0].error.unwrap(), 0.25);
    let said =
        "tip: the finest run failed (parallel, 1 mm), so others have nothing to be compared with";
    assert_eq!(partly.notes, [said]);
}

/// Second order towards 3, first order towards -1; the uncertainty is 1.25 times the difference
/// between the finest value and the extrapolated one (Roache 1994).
#[test]
fn richardson_finds_the_value_at_size_0() {
    let sizes_m = [4e-3, 1e-3, 2e-3_f64];
    let value = |model: usize, size_m: f64| match model {
        0 => 3.0 + 2e3 * size_m.powi(2),
        _ => -1.0 - 5.0 * size_m,
    };
    let study = study(&radii("richardson"));
    let made = |choice: &[usize]| done(1.0, &[value(choice[0], sizes_m[choice[1]])]);
    let whole = table(&study, |run| made(&run.choice));
    for (row, judged) in whole.runs.iter().zip(results(&whole, 0)) {
        let model = row.choice[0];
        let truth: f64 = [3.0, -1.0][model];
        assert_near(judged.reference.unwrap(), truth);
        assert_near(
            judged.error.unwrap(),
            (judged.value - truth).abs() / truth.abs(),
        );
        let finest = (value(model, 1e-3) - truth).abs() / truth.abs();
        assert_near(judged.uncertainty.unwrap(), 1.25 * finest);
        let either = [judged.error, judged.uncertainty];
        let larger = either.into_iter().flatten().reduce(f64::max);
        assert_eq!(judged.sure_error(), larger);
    }
    assert!(whole.notes.is_empty());

    let partly = table_of(&study, |run| match run.choice.as_slice() {
        [1, 2] => vec![Outcome::Missing],
        choice => vec![Outcome::Done(made(choice))],
    });
    assert_eq!(partly.runs[3].results[0].error, None);
    let said = "tip: fewer than three runs along bodies.bar.radius came to their end";
    assert!(partly.notes[0].starts_with(said), "{:?}", partly.notes);
}

/// Then the finest value is the reference, good to three times the range of the values.
#[test]
fn values_that_go_up_and_down_are_not_extrapolated() {
    let values = [1.2, 1.0, 0.9];
    let table = table(&study(&radii("richardson")), |run| {
        done(1.0, &[values[run.choice[1]]])
    });
    for judged in results(&table, 0) {
        assert_eq!(judged.reference, Some(1.0));
        assert_near(judged.uncertainty.unwrap(), 3.0 * (1.2 - 0.9));
    }
    assert_eq!(table.notes.len(), 2, "{:?}", table.notes);
    let said = "its values go up and down with the size; compared with the finest run, good to 0.9";
    assert!(table.notes[0].ends_with(said), "{:?}", table.notes);
}

const TWO_RADII: &str = r#"
[vary]
"bodies.bar.radius" = ["2 mm", "1 mm"]
[measures.of_run]
reference = "finest"
"#;

/// At 2 kg the coarse run has 2 of 4 pieces at or below, the fine one none of 2. Chance exceeds
/// sqrt(-ln(0.05/2)/2) sqrt(1/n + 1/m) in one of twenty cases.
#[test]
fn masses_are_compared_by_their_distributions() {
    let study = study(&format!("{TWO_RADII}fragment_masses = \"discharged\""));
    let masses_kg = [vec![6.0, 1.0, 5.0, 2.0], vec![3.0, 6.0]];
    let table = table(&study, |run| Done {
        readings: vec![Reading {
            masses_kg: masses_kg[run.choice[0]].clone(),
            ..reading(0.0)
        }],
        ..done(1.0, &[])
    });
    let judged = &table.runs[0].results[0];
    assert_near(judged.error.unwrap(), 0.5);
    let one_of_twenty = (-0.025_f64.ln() / 2.0).sqrt() * (0.25_f64 + 0.5).sqrt();
    assert!((judged.uncertainty.unwrap() / one_of_twenty - 1.0).abs() < 1e-3);
}

/// The fine curve rises to 1 N at 1 m and stays there, the coarse one rises on to 2 N at 2 m: 0.5 J
/// lie between them, 1.5 J below the fine one.
#[test]
fn curves_are_compared_by_the_area_between_them() {
    let study = study(&format!("{TWO_RADII}curve = \"force-displacement\""));
    let table = table(&study, |run| Done {
        readings: vec![Reading {
            curve: vec![[0.0, 0.0], [[2.0; 2], [1.0; 2]][run.choice[0]]],
            ..reading(1.0)
        }],
        ..done(1.0, &[])
    });
    assert_near(table.runs[0].results[0].error.unwrap(), 0.5 / 1.5);
}
