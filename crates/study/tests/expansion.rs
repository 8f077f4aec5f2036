//! The runs of a study: their number, order and settings.

use dem_scene::study::Study;
use dem_study::expand::{Run, group, runs};
use proptest::prelude::*;

use super::made::study;

fn labels(study: &Study) -> Vec<String> {
    let runs = runs(study, false).unwrap();
    runs.iter().map(|run| run.labels(study).join(" ")).collect()
}

/// The settings of a run as `PATH=VALUE`.
fn settings(study: &Study, run: &Run) -> Vec<String> {
    let settings = run.settings(study).into_iter();
    settings
        .map(|one| format!("{}={}", one.path, one.value))
        .collect()
}

/// `[vary]` before `[together]`, each in the order of the file; seeds in the order of their list.
#[test]
fn a_grid_is_nested_loops_over_its_axes() {
    let study = study(
        r#"
[set]
"run.end_time" = "1 s"
[together.mesh]
"bodies.bar.radius" = ["2 mm", "1 mm"]
"bonds.bar.radius_factor" = [1, 0.5]
names = ["coarse", "fine"]
[vary]
"run.seed" = [7, 3, 5]
"run.safety_factor" = [0.9, 0.5]
[measures.tip]
"#,
    );
    let mut wanted = Vec::new();
    for seed in [7, 3, 5] {
        for factor in ["0.9", "0.5"] {
            for mesh in ["coarse", "fine"] {
                wanted.push(format!("{seed} {factor} {mesh}"));
            }
        }
    }
    assert_eq!(labels(&study), wanted);
    let runs = runs(&study, false).unwrap();
    let numbers: Vec<usize> = runs.iter().map(|run| run.number).collect();
    assert_eq!(numbers, (1..=12).collect::<Vec<usize>>());
    // Seed 3, factor 0.5, fine.
    assert_eq!(
        settings(&study, &runs[7]),
        [
            "run.end_time=\"1 s\"",
            "run.seed=3",
            "run.safety_factor=0.5",
            "bodies.bar.radius=\"1 mm\"",
            "bonds.bar.radius_factor=0.5",
        ]
    );
}

#[test]
fn pairs_are_rows_of_lists() {
    let study = study(
        r#"
combine = "paired"
[vary]
"run.seed" = [7, 3, 5]
"run.safety_factor" = { from = 0.2, to = 0.8, count = 3 }
[measures.tip]
"#,
    );
    assert_eq!(labels(&study), ["7 0.2", "3 0.5", "5 0.8"]);
}

const FIND: &str = r#"
[find]
parameter = "walls.floor.height"
from = "0 m"
to = "8 m"
measure = "tip"
value = 1
tolerance = "1 m"
[vary]
"bonds.bar.model" = ["parallel", "timoshenko"]
"run.seed" = [1, 2]
[measures.tip]
reference = "none"
"#;

/// Run of each case and seed at each of its points: the points come one after the other, so that
/// the numbers of earlier runs stay when points are added.
#[test]
fn a_search_keeps_the_numbers_of_its_runs() {
    let mut study = study(FIND);
    let numbered = |study: &Study| -> Vec<(usize, String)> {
        let runs = runs(study, false).unwrap().into_iter();
        runs.map(|run| (run.number, run.labels(study).join(" ")))
            .collect()
    };
    let ends = numbered(&study);
    let wanted = [
        (1, "0 m parallel 1"),
        (2, "0 m parallel 2"),
        (3, "0 m timoshenko 1"),
        (4, "0 m timoshenko 2"),
        (5, "8 m parallel 1"),
        (6, "8 m parallel 2"),
        (7, "8 m timoshenko 1"),
        (8, "8 m timoshenko 2"),
    ];
    let owned = |all: &[(usize, &str)]| -> Vec<(usize, String)> {
        all.iter()
            .map(|(at, text)| (*at, (*text).to_owned()))
            .collect()
    };
    assert_eq!(ends, owned(&wanted));
    study.add_point(1, 4.0);
    let added = [(11, "4 m timoshenko 1"), (12, "4 m timoshenko 2")];
    assert_eq!(numbered(&study), [ends.clone(), owned(&added)].concat());
    // The other case may get there later, and by another point.
    study.add_point(0, 2.0);
    let other = [(9, "2 m parallel 1"), (10, "2 m parallel 2")];
    let all = [ends, owned(&other), owned(&added)].concat();
    assert_eq!(numbered(&study), all);
}

/// Numbers of values of the axes of a grid.
fn lengths() -> impl Strategy<Value = Vec<usize>> {
    prop::collection::vec(1..5_usize, 1..5)
}

fn grid(lengths: &[usize]) -> Study {
    let axes = lengths.iter().enumerate().map(|(at, length)| {
        let values: Vec<usize> = (0..*length).collect();
        format!("\"run.key_{at}\" = {values:?}\n")
    });
    study(&format!(
        "[vary]\n{}[measures.tip]",
        axes.collect::<String>()
    ))
}

proptest! {
    /// Every combination once, the last axis fastest, numbered from 1.
    #[test]
    fn a_grid_has_every_combination_once(lengths in lengths()) {
        let runs = runs(&grid(&lengths), false).unwrap();
        prop_assert_eq!(runs.len(), lengths.iter().product::<usize>());
        prop_assert!(runs.windows(2).all(|two| two[0].choice < two[1].choice));
        for (run, number) in runs.iter().zip(1..) {
            prop_assert_eq!(run.number, number);
            prop_assert!(run.choice.iter().zip(&lengths).all(|(at, length)| at < length));
        }
    }

    /// Two runs are of one group along an axis if they agree on all others.
    #[test]
    fn groups_differ_along_one_axis_only(lengths in lengths(), along in 0..4_usize) {
        let study = grid(&lengths);
        let along = along % lengths.len();
        let runs = runs(&study, false).unwrap();
        for (a, b) in runs.iter().zip(runs.iter().rev()) {
            let agree = (0..lengths.len()).all(|at| at == along || a.choice[at] == b.choice[at]);
            prop_assert_eq!(group(&study, a, along) == group(&study, b, along), agree);
        }
    }
}
