//! The fastest run that is accurate enough.

use dem_io::Diagnostic;
use dem_study::outcome::Done;
use dem_study::sweep_table::SweepTable;
use dem_study::want::{Want, fastest};
use proptest::prelude::*;

use super::front::{POINTS, points, table_with};
use super::made::{done, study, table};

/// The number of the fastest run with these largest errors.
fn number(table: &SweepTable, wants: &[&str]) -> Result<usize, Diagnostic> {
    let measures: Vec<&str> = table.measures.iter().map(|one| one.name.as_str()).collect();
    let wants = wants.iter().map(|text| Want::parse(text, &measures));
    let wants: Vec<Want> = wants.collect::<Result<_, _>>()?;
    fastest(table, &wants).map(|row| row.number)
}

/// Of runs that are equally fast, the most accurate; of those, the first.
#[test]
fn the_fastest_run_within_the_error() {
    let table = table_with(&POINTS);
    for (error, wanted) in [("0.2%", 1), ("1.5%", 3), ("3%", 3), ("6%", 5), ("0.6", 7)] {
        for measure in ["tip", "all"] {
            let found = number(&table, &[&format!("{measure}={error}")]);
            assert_eq!(found.unwrap(), wanted, "{error}");
        }
    }
    let nearest = number(&table, &["tip=0.0001"]).unwrap_err();
    let said = "no run is as exact: the nearest, run 1, has 10 times the error";
    assert_eq!((nearest.problem.as_str(), nearest.exit_code()), (said, 2));
}

#[test]
fn every_error_has_to_be_small_enough() {
    let study = study(
        r#"
[vary]
"run.safety_factor" = [0.9, 0.5, 0.1]
[measures.tip]
reference = { value = 1 }
[measures.gap]
reference = { value = 0 }
"#,
    );
    // Errors of tip and gap.
    let errors = [[0.01, 0.5], [0.1, 0.05], [0.02, 0.02]];
    let made = |at: usize| -> Done {
        let [tip, gap] = errors[at];
        done([1.0, 2.0, 4.0][at], &[1.0 + tip, gap])
    };
    let table = table(&study, |run| made(run.choice[0]));
    assert_eq!(number(&table, &["tip=0.15"]).unwrap(), 1);
    assert_eq!(number(&table, &["gap=0.15"]).unwrap(), 2);
    assert_eq!(number(&table, &["all=0.15"]).unwrap(), 2);
    assert_eq!(number(&table, &["tip=0.05", "gap=0.15"]).unwrap(), 3);
    assert_eq!(number(&table, &["all=0.6", "tip=0.015"]).unwrap(), 1);
}

#[test]
fn targets_that_mean_nothing_are_refused() {
    for (text, said) in [
        ("tip", "there is no ="),
        ("top=1%", "nothing that is measured is called 'top'"),
        ("tip=0", "the error is not above 0"),
        ("tip=-1%", "the error is not above 0"),
    ] {
        let refused = Want::parse(text, &["tip"]).unwrap_err();
        assert_eq!((refused.problem.as_str(), refused.exit_code()), (said, 2));
    }
    assert!(Want::parse("all=1%", &[]).is_err());
}

proptest! {
    /// The run is accurate enough, and no other that is so is clearly faster.
    #[test]
    fn no_accurate_run_is_clearly_faster(points in points(), error in 0.0001..1.5_f64) {
        let table = table_with(&points);
        let accurate = || points.iter().filter(|point| point.1 <= error);
        match number(&table, &[&format!("tip={error}")]) {
            Ok(number) => {
                let best = points[number - 1];
                prop_assert!(best.1 <= error);
                prop_assert!(accurate().all(|other| other.0 > best.0 / 1.1 - 1e-9));
            }
            Err(_) => prop_assert_eq!(accurate().count(), 0),
        }
    }
}
