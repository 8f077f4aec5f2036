//! A cheap row of the page comes out as it stands there, and the order of made-up answers.

#![allow(clippy::unwrap_used)]

use dem_io::Body;

use super::bonds::{Bonds, PAGE, label};
use super::compare::{Interval, convergence};
use super::drop::{Fall, QUESTION, SPECIMENS, START, answers, keys};
use super::spheres::{ACROSS, Lump, REFINEMENT};
use crate::bench::{Failed, Run, root};
use crate::table::{parts, rows};
use crate::tests::in_place;

/// A fall of a lump in this process.
fn falls(bonds: Bonds, lump: Lump, packed: &Body, rung: i32) -> Result<Fall, Failed> {
    let keys = keys(bonds, lump.across, rung)?;
    let read = |run: &Run| Fall::of(run, lump.across);
    in_place("tests/resolution/drop.toml", &keys, ("lump", packed), read)
}

#[test]
fn lumps_of_large_spheres_break_as_on_the_page() {
    let page = std::fs::read_to_string(root().join(PAGE)).unwrap();
    let [_, text, _] = parts(&page, QUESTION.words, 0).unwrap();
    let shown = rows(text);
    let (bonds, across) = (Bonds::Softening, ACROSS[0]);
    let fall = |lump: Lump, packed: &Body, rung| falls(bonds, lump, packed, rung);
    let found = answers(across, None, &mut [START; SPECIMENS], &fall).unwrap();
    let row = label(bonds, across);
    let row = shown.iter().find(|shown| shown[0] == row).unwrap();
    assert_eq!(row[2], found.spheres.to_string());
    for (at, quantity) in QUESTION.quantities.iter().enumerate() {
        assert_eq!(row[3 + at], quantity.cell(&found.values[at]));
    }
}

fn certain(mean: f64) -> Interval {
    Interval {
        mean,
        least: mean - 1e-3,
        most: mean + 1e-3,
    }
}

/// Answers 2 + h^p are found again, and there is no order where changes scatter or grow.
#[test]
fn the_order_of_answers_is_found() {
    let answer = |across: f64| 2.0 + across.powf(-1.3);
    let sizes = [4.0, 4.0 * REFINEMENT, 4.0 * REFINEMENT * REFINEMENT];
    let changes = [0, 1].map(|at| certain(answer(sizes[at + 1]) - answer(sizes[at])));
    let [order, limit] = convergence(answer(sizes[2]), &changes).unwrap();
    assert!((order - 1.3).abs() < 1e-9, "{order}");
    assert!((limit - 2.0).abs() < 1e-9, "{limit}");

    let turned = [changes[0], certain(-changes[1].mean)];
    let grown = [changes[1], changes[0]];
    let scattered = [
        changes[0],
        Interval {
            most: 1.0,
            ..changes[1]
        },
    ];
    for changes in [turned, grown, scattered] {
        assert!(convergence(2.0, &changes).is_err());
    }
}
