//! Responses: mean, median and scatter over the seeds.

use dem_results::summary::Verdict;
use dem_study::outcome::{Done, Outcome};
use dem_study::response::ResponsePoint;
use dem_study::sweep_table::SweepTable;
use proptest::prelude::*;

use super::made::{assert_near, done, study, table, table_of};

/// Two models, with the seeds 1 to 5.
const SEEDS: &str = r#"
[vary]
"bonds.bar.model" = ["parallel", "timoshenko"]
"run.seed" = [1, 2, 3, 4, 5]
[measures.tip]
reference = "none"
"#;

/// The value of each model with each seed.
const VALUES: [[f64; 5]; 2] = [[1.0, 9.0, 4.0, 2.0, 4.0], [-3.0, 5.0, 7.0, 6.0, -1.0]];

fn value(choice: &[usize]) -> Done {
    done(1.0, &[VALUES[choice[0]][choice[1]]])
}

fn points(table: &SweepTable) -> &[ResponsePoint] {
    assert_eq!(table.responses.len(), 1);
    &table.responses[0].points
}

#[test]
fn a_response_has_a_point_for_each_setting() {
    let table = table(&study(SEEDS), |run| value(&run.choice));
    let [parallel, timoshenko] = points(&table) else {
        panic!("{:?}", table.responses);
    };
    assert_eq!(parallel.settings, ["parallel", ""]);
    assert_eq!(timoshenko.settings, ["timoshenko", ""]);
    // 1 2 4 4 9: mean 4, squares 9 + 4 + 0 + 0 + 25 over 4.
    assert_eq!(parallel.values, VALUES[0]);
    assert_eq!((parallel.mean, parallel.median), (4.0, 4.0));
    assert_near(parallel.standard_deviation.unwrap(), 9.5_f64.sqrt());
    assert_near(parallel.standard_error().unwrap(), 1.9_f64.sqrt());
    assert_eq!(parallel.range(), [1.0, 9.0]);
    // -3 -1 5 6 7: mean 2.8.
    assert_near(timoshenko.mean, 2.8);
    assert_eq!(timoshenko.median, 5.0);
    assert_eq!(timoshenko.range(), [-3.0, 7.0]);
    // Nothing is compared.
    assert!(!table.has_errors() && table.notes.is_empty());
    assert!(table.runs.iter().all(|row| row.results[0].error.is_none()));
}

#[test]
fn a_response_counts_only_the_runs_with_values() {
    let table = table_of(&study(SEEDS), |run| {
        let found = value(&run.choice);
        vec![match run.choice.as_slice() {
            [0, 1] => Outcome::Failed("it burst".to_owned()),
            [0, 2] => Outcome::Done(Done {
                verdict: Verdict::new(vec!["the energy error is large".to_owned()], Vec::new()),
                ..found
            }),
            [0, _] => Outcome::Done(found),
            _ => Outcome::Missing,
        }]
    });
    let [parallel] = points(&table) else {
        panic!("{:?}", table.responses);
    };
    // 1 2 4 4.
    assert_eq!(parallel.values, [1.0, 4.0, 2.0, 4.0]);
    assert_eq!((parallel.mean, parallel.median), (2.75, 3.0));
    assert_eq!(parallel.doubtful, 1);
}

#[test]
fn scatter_that_means_nothing_is_noted() {
    let constant = table(&study(SEEDS), |run| done(1.0, &[run.choice[0] as f64]));
    let said = "run.seed changes no value of any measure";
    assert!(constant.notes[0].starts_with(said), "{:?}", constant.notes);
    let twice = study(&SEEDS.replace("[1, 2, 3, 4, 5]", "[1, 2, 1, 4, 5]"));
    let twice = table(&twice, |run| value(&run.choice));
    let said = "run.seed has the value 1 more than once";
    assert!(twice.notes[0].starts_with(said), "{:?}", twice.notes);
}

fn single(seeds: &[usize], value_of: &[f64]) -> ResponsePoint {
    let study = study(&format!(
        "[vary]\n\"run.seed\" = {seeds:?}\n[measures.tip]\nreference = \"none\""
    ));
    let table = table(&study, |run| done(1.0, &[value_of[seeds[run.choice[0]]]]));
    points(&table)[0].clone()
}

proptest! {
    /// As many values lie below the median as above it, and it is one of them or the mean of the
    /// two next to it.
    #[test]
    fn half_of_the_values_lie_on_either_side_of_the_median(
        values in prop::collection::vec(-1e3..1e3_f64, 1..12),
    ) {
        let seeds: Vec<usize> = (0..values.len()).collect();
        let point = single(&seeds, &values);
        let [low, high] = point.range();
        prop_assert!(low <= point.median && point.median <= high);
        prop_assert!(low <= point.mean + 1e-9 && point.mean - 1e-9 <= high);
        let below: Vec<f64> = values.iter().copied().filter(|x| *x < point.median).collect();
        let above: Vec<f64> = values.iter().copied().filter(|x| *x > point.median).collect();
        prop_assert_eq!(below.len(), above.len());
        if values.contains(&point.median) {
            prop_assert_eq!(values.len() % 2, 1);
        } else {
            let low = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let high = above.iter().copied().fold(f64::INFINITY, f64::min);
            prop_assert!((point.median - 0.5 * (low + high)).abs() <= 1e-9);
        }
    }

    #[test]
    fn the_order_of_the_seeds_does_not_matter(
        (values, seeds) in prop::collection::vec(-1e3..1e3_f64, 1..12).prop_flat_map(|values| {
            let seeds: Vec<usize> = (0..values.len()).collect();
            (Just(values), Just(seeds).prop_shuffle())
        }),
    ) {
        let rising: Vec<usize> = (0..values.len()).collect();
        let [one, other] = [single(&rising, &values), single(&seeds, &values)];
        prop_assert_eq!((one.median, one.range()), (other.median, other.range()));
        prop_assert!((one.mean - other.mean).abs() <= 1e-9);
        let spread = |point: &ResponsePoint| point.standard_deviation.unwrap_or(0.0);
        prop_assert!((spread(&one) - spread(&other)).abs() <= 1e-9);
    }
}
