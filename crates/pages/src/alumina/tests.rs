//! A cheap row of the page comes out as it stands there.

#![allow(clippy::unwrap_used, clippy::panic)]

use super::*;
use crate::bench::root;
use crate::table::{parts, rows};
use crate::tests::in_place;

#[test]
fn a_coarse_bar_breaks_as_on_the_page() {
    let page = std::fs::read_to_string(root().join(PAGE)).unwrap();
    let shown = |at| rows(parts(&page, WORDS, at).unwrap()[1]);
    let cell = |row: usize| -> f64 { shown(0)[row][2].parse().unwrap() };
    let material = material([1e9 * cell(1), 1e6 * cell(2)], BAR);
    let run = |specimen: &Specimen, material: &Material| {
        let (scene, keys) = ("tests/fracture/specimen.toml", specimen.sets(material));
        let body = ("specimen", &specimen.body);
        in_place(scene, &keys, body, |run| specimen.curve(run))
    };
    let found = bent(None, &run, &COARSE_BAR, &material).unwrap();
    let shown = shown(1);
    let row = shown.iter().find(|row| row[0] == COARSE_BAR.name).unwrap();
    assert_eq!(row[1..6], bar_cells(&found));
}

/// The loads that the sources give.
#[test]
fn loads_of_the_sources_follow_from_their_strengths() {
    assert!((bar_n(BAR[1]) - 295.0).abs() < 1.0);
    assert!((disc_n(DISC[1], SOLID_M) - 2830.0).abs() < 5.0);
}

/// Walls between neighbouring holes, and between a hole and the face, are as thick.
#[test]
fn walls_are_as_thick() {
    let outside_m = 0.5 * HOLED_M[0] - hole_circle_m() - 0.5 * HOLE_M;
    let between_m = 2_f64.sqrt() * hole_circle_m() - HOLE_M;
    assert!((outside_m / between_m - 1.0).abs() < 1e-12);
    assert!((1e3 * outside_m - 1.75).abs() < 0.01, "{outside_m}");
}
