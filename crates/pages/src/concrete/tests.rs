//! A cheap row of the page comes out as it stands there.

#![allow(clippy::unwrap_used, clippy::panic)]

use super::*;
use crate::bench::root;
use crate::table::{parts, rows};
use crate::tests::in_place;

#[test]
fn a_coarse_beam_bends_as_on_the_page() {
    let page = std::fs::read_to_string(root().join(PAGE)).unwrap();
    let shown = |at| rows(parts(&page, WORDS, at).unwrap()[1]);
    let cell = |row: usize| -> f64 { shown(0)[row][2].parse().unwrap() };
    let bonds = [1e9 * cell(1), cell(2), 1e6 * cell(3)];
    let run = |specimen: &Specimen, material: &Material, beam: &Beam| {
        let (scene, keys) = ("tests/fracture/specimen.toml", specimen.sets(material));
        let spheres = specimen.body.radii.len();
        in_place(scene, &keys, ("specimen", &specimen.body), |run| {
            Bent::of(beam, &specimen.curve(run)?, run, spheres)
        })
    };
    let bent = bent(None, &run, &COARSE, bonds).unwrap();
    let band = measured(MEASURED[0]).unwrap().loads();
    let shown = shown(1);
    let row = shown.iter().find(|row| row[0] == COARSE.name).unwrap();
    assert_eq!(row[1..], load_cells(&bent, &band));
}

#[test]
fn a_triangle_has_its_loads_and_its_work() {
    // 10 N at 10 um, 0 at 110 um.
    let points = [
        [0.0, 0.0],
        [10e-6, 10.0],
        [60e-6, 5.0],
        [100e-6, 1.0],
        [110e-6, 0.0],
    ];
    let found = Load::of(&points).numbers();
    let work_mj = 1e3 * (0.5 * 10.0 * 110e-6 - 0.5 * 1.0 * 10e-6);
    let wanted = [10.0, 10.0, 9.0, 6.0, 1.0, work_mj, 10.0];
    for (found, wanted) in found.into_iter().zip(wanted) {
        assert!((found / wanted - 1.0).abs() < 1e-9, "{found} {wanted}");
    }
}

#[test]
fn the_bands_have_the_peaks_of_the_sources() {
    let [first, second] = MEASURED.map(|beam| measured(beam).unwrap().loads());
    // N, as read in the full curves.
    for (band, peaks) in [(first, [932.8, 1113.9]), (second, [4894.0, 5405.0])] {
        for (stored, read) in band[Load::LARGEST].into_iter().zip(peaks) {
            assert!((stored / read - 1.0).abs() < 1e-3, "{stored} {read}");
        }
    }
}
