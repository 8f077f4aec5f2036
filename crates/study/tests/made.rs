//! Studies, and tables of made outcomes.

use dem_results::summary::Verdict;
use dem_scene::study::{Reference, Study, study_from_text};
use dem_study::expand::{Run, runs};
use dem_study::outcome::{Done, Outcome, Reading};
use dem_study::sweep_table::SweepTable;

/// A study with these lines.
pub(crate) fn study(lines: &str) -> Study {
    let text = format!("version = 1\nscene = \"bar.toml\"\n{lines}\n");
    study_from_text(&text, "study.toml").unwrap_or_else(|error| panic!("{error}\n{text}"))
}

pub(crate) fn reading(value: f64) -> Reading {
    Reading {
        value,
        unit: "m".to_owned(),
        closed_form: None,
        masses_kg: Vec::new(),
        curve: Vec::new(),
    }
}

/// A sound run with these values of the measures.
pub(crate) fn done(time_s: f64, values: &[f64]) -> Done {
    Done {
        time_s,
        steps: 100,
        time_step_s: 1e-6,
        machine: "a machine, 2 cores".to_owned(),
        verdict: Verdict::new(Vec::new(), Vec::new()),
        report: None,
        readings: values.iter().copied().map(reading).collect(),
    }
}

/// The table of runs that are done once.
pub(crate) fn table(study: &Study, done: impl Fn(&Run) -> Done) -> SweepTable {
    table_of(study, |run| vec![Outcome::Done(done(run))])
}

/// The table of runs with these outcomes of their repeats.
pub(crate) fn table_of(study: &Study, outcomes: impl Fn(&Run) -> Vec<Outcome>) -> SweepTable {
    let runs = runs(study, false).unwrap();
    let outcomes: Vec<Vec<Outcome>> = runs.iter().map(outcomes).collect();
    let number = |text: &str| text.parse().unwrap();
    let references = study.measures.iter().map(|one| match &one.reference {
        Reference::Value(text) => Some(number(text)),
        _ => None,
    });
    let references: Vec<Option<f64>> = references.collect();
    let of_find = study.find.as_ref().map(|find| &find.value);
    let of_probability = study.probability.as_ref().map(|of| &of.limit);
    let looked_for = of_find.or(of_probability).map(|text| number(text));
    SweepTable::new(study, &runs, &outcomes, &references, looked_for)
}

pub(crate) fn assert_near(found: f64, wanted: f64) {
    let off = (found - wanted).abs();
    assert!(
        off <= 1e-9 * wanted.abs().max(1e-3),
        "{found}, not {wanted}"
    );
}
