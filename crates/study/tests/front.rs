//! The Pareto front of error and run time.

use dem_scene::study::Study;
use dem_study::outcome::{Done, Outcome};
use dem_study::sweep_table::SweepTable;
use proptest::prelude::*;

use super::made::{done, study, table, table_of};

/// As many settings without sizes, with a value of 1 that is compared with the truth.
fn settings(count: usize) -> Study {
    let values: Vec<String> = (0..count).map(|at| format!("m{at}")).collect();
    study(&format!(
        "[vary]\n\"bonds.bar.model\" = {values:?}\n[measures.tip]\nreference = {{ value = 1 }}"
    ))
}

/// A run with this time, s, and this error.
fn run_with((time_s, error): (f64, f64)) -> Done {
    done(time_s, &[1.0 + error])
}

pub(crate) fn table_with(points: &[(f64, f64)]) -> SweepTable {
    table(&settings(points.len()), |run| {
        run_with(points[run.choice[0]])
    })
}

/// The numbers of the runs on the front.
fn front(table: &SweepTable) -> Vec<usize> {
    let on = table.runs.iter().filter(|row| row.results[0].is_on_front);
    on.map(|row| row.number).collect()
}

/// Times that differ by less than a tenth are equal.
pub(crate) const POINTS: [(f64, f64); 7] = [
    (10.0, 0.001),
    // As exact as the first, but slower.
    (20.0, 0.001),
    (5.0, 0.01),
    // As fast as the third, but less exact.
    (4.8, 0.02),
    // As fast and as exact as the next.
    (2.0, 0.05),
    (1.9, 0.05),
    (0.5, 0.5),
];

#[test]
fn each_run_on_the_front_is_clearly_faster_than_the_more_exact_ones() {
    assert_eq!(front(&table_with(&POINTS)), [1, 3, 5, 7]);
}

/// The repeats of the fast run scatter by more than it is faster.
#[test]
fn times_that_scatter_are_not_told_apart() {
    let with_times = |fast_s: [f64; 3]| {
        table_of(&settings(2), |run| {
            let (times_s, error) = [([3.0; 3], 0.01), (fast_s, 0.1)][run.choice[0]];
            let repeats = times_s.map(|time_s| Outcome::Done(run_with((time_s, error))));
            repeats.to_vec()
        })
    };
    assert_eq!(front(&with_times([1.9, 2.0, 2.1])), [1, 2]);
    assert_eq!(front(&with_times([1.3, 2.0, 2.4])), [1]);
}

#[test]
fn times_of_several_machines_are_not_compared() {
    let study = study(
        r#"
[vary]
"bodies.bar.radius" = ["2 mm", "1 mm"]
[measures.tip]
reference = "finest"
"#,
    );
    let table = |machines: [&str; 2]| {
        table(&study, |run| Done {
            machine: machines[run.choice[0]].to_owned(),
            ..done(1.0 + run.choice[0] as f64, &[2.0 - run.choice[0] as f64])
        })
    };
    let one = table(["a", "a"]);
    assert_eq!(one.runs[0].results[0].times_as_fast, Some(2.0));
    assert_eq!((front(&one), one.notes.len()), (vec![1], 0));
    let two = table(["b", "a"]);
    assert_eq!(two.machines, ["a", "b"]);
    assert_eq!(two.runs[0].results[0].times_as_fast, None);
    assert_eq!(two.runs[0].results[0].error, Some(1.0));
    assert_eq!(front(&two), [0; 0]);
    let said = "the runs are of several machines, so that their times are not compared";
    assert_eq!(two.notes, [said]);
}

/// Times and errors in steps, so that they are clearly equal or clearly different.
pub(crate) fn points() -> impl Strategy<Value = Vec<(f64, f64)>> {
    let point = (0..60_i32, 0..12_i32);
    let point = point.prop_map(|(time, error)| (1.04_f64.powi(time), 0.5_f64.powi(error)));
    prop::collection::vec(point, 1..20)
}

proptest! {
    /// No run is clearly faster than one on the front and at least as exact.
    #[test]
    fn no_run_on_the_front_is_dominated(points in points()) {
        let table = table_with(&points);
        let front = front(&table);
        for number in &front {
            let (time_s, error) = points[number - 1];
            let dominates = |other: &&(f64, f64)| other.0 < 0.9 * time_s && other.1 <= error;
            prop_assert_eq!(points.iter().find(dominates), None);
        }
        let least = points.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
        prop_assert!(front.iter().any(|number| points[number - 1].1 == least));
    }
}
