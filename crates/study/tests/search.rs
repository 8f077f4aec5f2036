//! The search for the place at which a measure has a value, over tables of made outcomes.

use dem_scene::study::Study;
use dem_study::expand::Run;
use dem_study::outcome::Outcome;
use dem_study::search::{SearchCase, SearchResult, Step, next_of};
use dem_study::sweep_table::SweepTable;

use super::made::{done, study, table_of};

const FIND: &str = r#"
[find]
parameter = "walls.floor.height"
from = "0 m"
to = "8 m"
measure = "tip"
value = 10
tolerance = "1 m"
statistic = "mean"
[vary]
"bonds.bar.model" = ["low", "high"]
"run.seed" = [1, 2, 3]
[measures.tip]
reference = "none"
"#;

/// Adds points until no case has a next one; the last table.
fn searched(study: &mut Study, outcome: impl Fn(f64, &Run) -> Outcome) -> SweepTable {
    loop {
        let heights_m = study.points();
        let table = table_of(study, |run| vec![outcome(heights_m[run.choice[0]], run)]);
        let find = study.find.clone().unwrap();
        let response = &table.responses[0];
        let mut points = Vec::new();
        for case in 0..find.tried.len() {
            if let Step::Try(point) = next_of(study, &find, response, 10.0, case) {
                points.push((case, point));
            }
        }
        if points.is_empty() {
            return table;
        }
        for (case, point) in points {
            study.add_point(case, point);
        }
    }
}

/// A measure that rises with the height, and is 10 at these heights of the two cases; the seeds
/// scatter around it by this much.
fn rising(roots_m: [f64; 2], scatter: f64) -> impl Fn(f64, &Run) -> Outcome {
    move |height_m, run| {
        let off = scatter * (run.choice[2] as f64 - 1.0);
        let value = 10.0 + height_m - roots_m[run.choice[1]] + off;
        Outcome::Done(done(1.0, &[value]))
    }
}

fn cases(table: &SweepTable) -> &[SearchCase] {
    &table.find.as_ref().unwrap().cases
}

fn heights(case: &SearchCase) -> Vec<f64> {
    case.tried.iter().map(|[height_m, _]| *height_m).collect()
}

/// 0 to 8, 0 to 4, 2 to 4, 2 to 3 for one; 0 to 8, 4 to 8, 6 to 8, 6 to 7 for the other.
#[test]
fn each_case_is_halved_by_itself() {
    let table = searched(&mut study(FIND), rising([2.7, 6.1], 0.1));
    let [low, high] = cases(&table) else {
        panic!("{:?}", table.find);
    };
    assert_eq!(low.settings, "bonds.bar.model low");
    assert_eq!(heights(low), [0.0, 2.0, 3.0, 4.0, 8.0]);
    assert_eq!(heights(high), [0.0, 4.0, 6.0, 7.0, 8.0]);
    // The standard error of the mean of -0.1, 0 and 0.1 is 0.1/sqrt(3): twice that is 0.115. At 6 m
    // the mean is 0.1 from the value, so that only 4 m is surely below it.
    let found = |at: f64, is_uncertain: bool, sure: [f64; 2]| SearchResult::Found {
        at,
        between: [at - 0.5, at + 0.5],
        is_uncertain,
        sure_between: Some(sure.map(Some)),
    };
    assert_eq!(low.result, found(2.5, false, [2.0, 3.0]));
    assert_eq!(high.result, found(6.5, true, [4.0, 7.0]));
    assert_eq!(table.notes.len(), 1, "{:?}", table.notes);
    let said = "the mean of tip at an end of the interval found for bonds.bar.model high is within twice its standard error of 10";
    assert!(table.notes[0].starts_with(said), "{:?}", table.notes);
}

#[test]
fn a_value_beyond_the_ends_is_not_found() {
    let table = searched(&mut study(FIND), rising([9.0, 6.1], 0.0));
    let [low, high] = cases(&table) else {
        panic!("{:?}", table.find);
    };
    assert_eq!(low.result, SearchResult::NotBracketed);
    assert_eq!(heights(low), [0.0, 8.0]);
    assert!(matches!(high.result, SearchResult::Found { .. }));
}

/// One of the seeds has no value at 4 m.
#[test]
fn a_search_waits_for_all_seeds() {
    let rising = rising([2.7, 2.7], 0.0);
    let table = searched(&mut study(FIND), |height_m, run| {
        if height_m == 4.0 && run.choice[1..] == [1, 2] {
            Outcome::Failed("it burst".to_owned())
        } else {
            rising(height_m, run)
        }
    });
    let [low, high] = cases(&table) else {
        panic!("{:?}", table.find);
    };
    assert!(matches!(low.result, SearchResult::Found { .. }));
    assert_eq!(high.result, SearchResult::Unfinished);
}

/// One seed of three is off by 30: its mean passes the value 10 m lower, its median does not.
#[test]
fn a_median_is_not_moved_by_one_seed() {
    let skewed = |height_m: f64, run: &Run| {
        let off = [0.0, 30.0, 0.0][run.choice[2]];
        Outcome::Done(done(1.0, &[10.0 + height_m - 2.7 + off]))
    };
    let result = |statistic: &str| {
        let text = FIND.replace("\"mean\"", statistic);
        cases(&searched(&mut study(&text), skewed))[0]
            .result
            .clone()
    };
    assert_eq!(result("\"mean\""), SearchResult::NotBracketed);
    let SearchResult::Found { between, .. } = result("\"median\"") else {
        panic!("not found");
    };
    assert_eq!(between, [2.0, 3.0]);
}
