//! Features that a scene does not need cost neither work nor memory: counted, not timed.

mod one_feature;
mod scenes;

use std::collections::BTreeMap;

use dem_engine::state::State;
use dem_engine::step::{number_of, stages, step};
use dem_io::{Body, Result};
use dem_plan::{Plan, plan};
use dem_scene::scene_from_text;
use dem_scene::{BodySource, Scene};

/// A planned scene, with its bodies read by `read`.
fn planned_with(scene: &Scene, read: impl Fn(&str) -> Option<Body>) -> Result<Plan> {
    let mut bodies = BTreeMap::new();
    for (name, entry) in &scene.bodies {
        let body = match &entry.source {
            BodySource::Inline { particles, bonds } => Body::from_spheres(particles, bonds)?,
            BodySource::File(path) => match read(name) {
                Some(body) => body,
                None => dem_io::body::read_body(path)?,
            },
        };
        bodies.insert(name.clone(), body);
    }
    plan(scene, bodies, 1, true)
}

pub(crate) fn planned(text: &str) -> (Scene, Plan) {
    let scene = scene_from_text(text, "scene.toml", &[]).unwrap();
    let plan = planned_with(&scene, |_| None).unwrap_or_else(|e| panic!("{e}: {text}"));
    (scene, plan)
}

/// Steps as in a run.
fn go(state: &mut State, steps: u64) {
    for _ in 0..steps {
        step(state);
    }
}

/// Stages that have been active.
fn busy(state: &State) -> Vec<&'static str> {
    let all = stages().iter();
    let busy = all.filter(|stage| state.scratch.clock.done(number_of(stage)) > 0);
    busy.map(|stage| stage.name).collect()
}

/// Stages that have arrays.
fn stored(state: &State) -> Vec<&'static str> {
    let all = stages().iter();
    let stored = all.filter(|stage| (stage.bytes)(state) > 0);
    stored.map(|stage| stage.name).collect()
}
