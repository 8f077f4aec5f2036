//! What the plans of all scenes say is left out, is.

use std::path::{Path, PathBuf};

use dem_run::step::number_of;

use crate::{go, planned_with};

fn scenes_in(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(folder);
    let mut all: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    all.sort();
    all
}

#[test]
fn what_is_said_to_be_left_out_does_nothing_and_takes_no_memory() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/bodies/sample.vtp");
    let mut seen = 0;
    for path in [scenes_in("data/scenes"), scenes_in("tests/scenes/good")].concat() {
        let scene = dem_io::read_scene(&path, &[]).unwrap();
        if scene.test.is_some() {
            // Their supports and loads come from the test, of a body that is made for it.
            continue;
        }
        let missing = |name: &str| {
            let is_there = match &scene.bodies[name].source {
                dem_io::scene::BodySource::File(file) => file.exists(),
                dem_io::scene::BodySource::Inline { .. } => true,
            };
            (!is_there).then(|| dem_io::body::read_body(&sample).unwrap())
        };
        let Ok(mut plan) = planned_with(&scene, missing) else {
            panic!("{}", path.display());
        };
        let steps = if plan.state.bonds.len() > 1000 {
            60
        } else {
            400
        };
        go(&mut plan.state, steps);
        for stage in plan.stages.iter().filter(|stage| !stage.needed) {
            let (stage, place) = (stage.stage, path.display());
            assert_eq!(
                plan.state.clock.done(number_of(stage)),
                0,
                "{place}: {}",
                stage.name
            );
            assert_eq!((stage.bytes)(&plan.state), 0, "{place}: {}", stage.name);
            seen += 1;
        }
    }
    assert!(seen > 100);
}
