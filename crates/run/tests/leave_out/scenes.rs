//! The stages reported as inactive in the plans of all scenes are inactive.

use std::path::{Path, PathBuf};

use dem_engine::clock::StageClock;
use dem_engine::state::State;
use dem_engine::step::{number_of, step};

use super::{go, planned, planned_with};

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

/// Leaving stages out does not change a bit.
fn assert_same(one: &State, other: &State) {
    let (a, b) = (&one.particles, &other.particles);
    assert!(a.poses == b.poses && a.motions == b.motions);
    assert_eq!(one.clumps.all, other.clumps.all);
    assert_eq!(one.population.bond_steps, other.population.bond_steps);
    assert_eq!(one.fastest_m_s.to_bits(), other.fastest_m_s.to_bits());
}

#[test]
fn spheres_that_meet_where_there_is_nothing_else_meet() {
    let (_, plan) = planned(
        "version = 1
run = { end_time = 1, safety_factor = 0.1 }
materials.m = { density = 2000, young_modulus = 1e7 }
contacts.m-m = { restitution = 1, friction = 0 }
bodies.a = { particles = [[0, 0, 0, 1e-3]], material = \"m\", velocity = [1, 0, 0] }
bodies.b = { particles = [[4e-3, 0, 0, 1e-3]], material = \"m\" }
",
    );
    let (mut state, mut all_stages) = (plan.state.clone(), plan.state);
    all_stages.scratch.clock = StageClock::default();
    while state.time_s < 3e-3 {
        step(&mut state);
        step(&mut all_stages);
    }
    assert_same(&state, &all_stages);
    assert!(state.particles.motions[1].velocity_m_s[0] > 0.99);
}

#[test]
fn what_is_said_to_be_left_out_does_nothing_and_takes_no_memory() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/bodies/sample.vtp");
    let mut seen = 0;
    for path in [scenes_in("data/scenes"), scenes_in("tests/scenes/good")].concat() {
        let scene = dem_scene::read_scene(&path, &[]).unwrap();
        if scene.test.is_some() {
            // Their supports and loads come from the test, for a body that is made for it.
            continue;
        }
        let missing = |name: &str| {
            let is_there = match &scene.bodies[name].source {
                dem_scene::BodySource::File(file) => file.exists(),
                dem_scene::BodySource::Inline { .. } => true,
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
        let mut all_stages = plan.state.clone();
        all_stages.scratch.clock = StageClock::default();
        go(&mut plan.state, steps);
        go(&mut all_stages, steps);
        assert_same(&plan.state, &all_stages);
        for stage in plan.stages.iter().filter(|stage| !stage.needed) {
            let (stage, place) = (stage.stage, path.display());
            assert_eq!(
                plan.state.scratch.clock.done(number_of(stage)),
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
