//! Rows of runs with several repeats: run times and their spread, failures, doubts.

use dem_results::summary::Verdict;
use dem_study::outcome::{Done, Outcome};
use dem_study::row::Row;
use dem_study::sweep_table::SweepTable;
use dem_study::text::csv;

use super::made::{assert_near, done, study, table, table_of};

const FACTORS: &str = r#"
[vary]
"run.safety_factor" = [0.9, 0.5, 0.1]
[measures.tip]
reference = { value = 2 }
"#;

/// The first run of a study whose repeats take these times.
fn timed(times_s: &[f64]) -> Row {
    let table = table_of(&study(FACTORS), |_| {
        let repeats = times_s.iter().map(|time_s| done(*time_s, &[1.0]));
        repeats.map(Outcome::Done).collect()
    });
    table.runs[0].clone()
}

#[test]
fn the_run_time_is_the_median_of_the_repeats() {
    let row = timed(&[3.0, 1.0, 2.0]);
    assert_eq!(row.times_s, [3.0, 1.0, 2.0]);
    assert_eq!((row.time_s, row.spread_s), (Some(2.0), Some(2.0)));
    assert_eq!(timed(&[4.0, 1.0, 3.0, 2.0]).time_s, Some(2.5));
    // Times that are close count as different by a tenth of the median.
    assert_near(timed(&[2.0, 2.01, 2.02]).spread_s.unwrap(), 0.201);
    assert_near(timed(&[5.0]).spread_s.unwrap(), 0.5);
}

/// The median of nine values lies within the second and the second last with a probability of 96 %
/// (of 512 equally likely divisions 20 have fewer than two on one side), that of five within the
/// first and the last with 94 %.
#[test]
fn the_spread_is_the_range_in_which_the_median_lies() {
    let nine = [9.0, 1.0, 8.0, 2.0, 5.0, 3.0, 4.0, 6.0, 7.0];
    assert_eq!(timed(&nine).spread_s, Some(8.0 - 2.0));
    assert_eq!(timed(&nine[..5]).spread_s, Some(9.0 - 1.0));
}

fn notes(table: &SweepTable) -> String {
    table.notes.join("\n")
}

#[test]
fn runs_without_values_keep_their_place() {
    let table = table_of(&study(FACTORS), |run| match run.choice[0] {
        0 => vec![Outcome::Missing, Outcome::Failed("it burst".to_owned())],
        1 => vec![Outcome::Missing; 2],
        _ => vec![
            Outcome::Failed("no disk".to_owned()),
            Outcome::Done(done(2.0, &[1.0])),
        ],
    });
    let numbers: Vec<usize> = table.runs.iter().map(|row| row.number).collect();
    assert_eq!(numbers, [1, 2, 3]);
    let failed: Vec<Option<&str>> = table.runs.iter().map(|row| row.failed.as_deref()).collect();
    let missing = "it has not been run to its end";
    assert_eq!(failed, [Some("it burst"), Some(missing), None]);
    assert_eq!(table.failed().count(), 2);
    for row in table.failed() {
        assert!(row.results.is_empty() && row.times_s.is_empty());
        assert_eq!((row.time_s, row.spread_s, row.steps), (None, None, None));
        assert_eq!(row.verdict(), "");
    }
    let last = &table.runs[2];
    assert_eq!((last.time_s, last.verdict()), (Some(2.0), "sound"));
    assert_eq!(last.results[0].error, Some(0.5));
    let said = "run 3: of its 2 repeats 1 left results; its time is theirs";
    assert_eq!(notes(&table), said);
    let wanted = [
        "1,0.9,,,0,,,,,,,,,,it burst",
        "2,0.5,,,0,,,,,,,,,,it has not been run to its end",
        "3,0.1,2,0.2,1,100,1e-6,1,2,0.5,,1,,sound,",
    ];
    let text = csv(&table);
    let lines: Vec<&str> = text.lines().skip(1).collect();
    assert_eq!(lines, wanted);
}

#[test]
fn repeats_with_other_values_are_noted() {
    let table = table_of(&study(FACTORS), |run| {
        let again = if run.number == 2 { 1.5 } else { 1.0 };
        let repeats = [done(1.0, &[1.0]), done(1.0, &[again])];
        repeats.map(Outcome::Done).to_vec()
    });
    let said = "run 2 gave other values when it was done again";
    assert_eq!(notes(&table), said);
    assert_eq!(table.runs[1].results[0].value, 1.0, "that of the first");
}

/// Each kind of warning once: kinds differ in their words, not in their numbers.
#[test]
fn doubtful_runs_are_counted() {
    let table = table(&study(FACTORS), |run| {
        let doubts = match run.number {
            1 => vec!["the overlap 3 % is large".to_owned()],
            2 => Vec::new(),
            _ => ["the overlap 5 % is large", "the step changed"]
                .map(str::to_owned)
                .to_vec(),
        };
        Done {
            verdict: Verdict::new(doubts, Vec::new()),
            ..done(1.0, &[1.0])
        }
    });
    let verdicts: Vec<&str> = table.runs.iter().map(Row::verdict).collect();
    assert_eq!(verdicts, ["doubtful", "sound", "doubtful"]);
    assert_eq!(
        table.notes,
        [
            "2 of 3 runs are doubtful (verdict in their summary.json)",
            "in 2 of them, first in run 1: the overlap 3 % is large",
            "in 1 of them, first in run 3: the step changed",
        ]
    );
}
