//! A cheap row of the page comes out as it stands there.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::sync::atomic::AtomicBool;

use dem_results::folder::{Existing, ResultsFolder};
use dem_run::{RunSettings, plan, run};
use dem_scene::scene_from_text;

use super::*;
use crate::bench::{finished, root};
use crate::table::{parts, rows};

/// Runs a specimen in this process.
fn in_place(specimen: &Specimen, material: &Material) -> Result<Curve, Failed> {
    let text = std::fs::read_to_string(root().join("tests/fracture/specimen.toml"))?;
    let scene = scene_from_text(&text, "specimen.toml", &specimen.sets(material))?;
    let bodies = [("specimen".to_owned(), specimen.body.clone())];
    let plan = plan(&scene, bodies.into(), 1, false)?;
    let parent = tempfile::tempdir()?;
    let folder = ResultsFolder::create(&parent.path().join("out"), Existing::Refuse)?;
    let settings = RunSettings {
        folder: Some(&folder),
        resume: None,
        test: None,
        setup: None,
        threads: 1,
        interrupted: &AtomicBool::new(false),
    };
    run(plan, &scene, settings, &|_| ())?;
    specimen.curve(&finished(&parent.path().join("out")).unwrap())
}

#[test]
fn small_beams_fail_as_on_the_page() {
    let page = std::fs::read_to_string(root().join(PAGE)).unwrap();
    let [_, text, _] = parts(&page, "fracture sizes", 0).unwrap();
    let shown = rows(text);
    for material in usual() {
        let height_m = HEIGHTS_M[0];
        let found = nominal_pa(None, &in_place, &material, height_m).unwrap();
        let row = format!("{}, {:.0} mm", material.name, 1e3 * height_m);
        let row = shown.iter().find(|shown| shown[0] == row).unwrap();
        assert_eq!(row[1], nominal(&found));
    }
}
