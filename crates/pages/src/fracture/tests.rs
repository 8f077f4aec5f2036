//! A cheap row of the page comes out as it stands there.

#![allow(clippy::unwrap_used, clippy::panic)]

use super::*;
use crate::bench::root;
use crate::table::{parts, rows};
use crate::tests::in_place;

/// The curve of a specimen that is run in this process.
fn bent(specimen: &Specimen, material: &Material) -> Result<Curve, Failed> {
    let (scene, keys) = ("tests/fracture/specimen.toml", specimen.sets(material));
    let body = ("specimen", &specimen.body);
    in_place(scene, &keys, body, |run| specimen.curve(run))
}

#[test]
fn small_beams_fail_as_on_the_page() {
    let page = std::fs::read_to_string(root().join(PAGE)).unwrap();
    let [_, text, _] = parts(&page, "fracture sizes", 0).unwrap();
    let shown = rows(text);
    for material in usual() {
        let height_m = HEIGHTS_M[0];
        let found = nominal_pa(None, &bent, &material, height_m).unwrap();
        let row = format!("{}, {:.0} mm", material.name, 1e3 * height_m);
        let row = shown.iter().find(|shown| shown[0] == row).unwrap();
        assert_eq!(row[1], nominal(&found));
    }
}
