//! The plan of a scene with its laboratory test.

use std::collections::BTreeMap;

use dem_io::{Body, Result};
use dem_plan::alike::told_once;
use dem_plan::groups::particles_of;
use dem_plan::{Plan, plan};
use dem_scene::Scene;

use crate::setup::{Setup, setup};

/// The plan of a scene as of [`plan`], and its laboratory test in its initial arrangement, whose
/// notes and warnings are among those of the plan. None: the scene has no test.
pub fn plan_with_test(
    scene: &Scene,
    read: BTreeMap<String, Body>,
    threads: usize,
    allow_any_step: bool,
) -> Result<(Plan, Option<Setup>)> {
    let tested = scene.test.as_ref().and_then(|test| read.get(&test.body));
    let shape_m3 = tested.and_then(|body| body.about.shape_volume_m3);
    let mut plan = plan(scene, read, threads, allow_any_step)?;
    let setup = setup_of(scene, &plan, shape_m3)?;
    if let Some(setup) = &setup {
        plan.notes.extend(setup.notes.iter().cloned());
        plan.warnings.extend(setup.warnings.iter().cloned());
        plan.notes = told_once(plan.notes, scene.bodies.keys());
        plan.warnings = told_once(plan.warnings, scene.bodies.keys());
    }
    Ok((plan, setup))
}

/// The test of a scene. `shape_m3`: volume of the shape of the tested body.
fn setup_of(scene: &Scene, plan: &Plan, shape_m3: Option<f64>) -> Result<Option<Setup>> {
    let Some(test) = &scene.test else {
        return Ok(None);
    };
    let particles = particles_of(&plan.groups, &test.body);
    let supports = scene.supports.values();
    let (driven, held): (Vec<_>, Vec<_>) =
        supports.partition(|support| test.crosshead.contains(&support.group));
    let halves = [driven, held].map(|supports| -> Vec<u32> {
        let all = supports.iter();
        all.flat_map(|support| particles_of(&plan.groups, &support.group))
            .copied()
            .collect()
    });
    setup(scene, test, &plan.state, particles, &halves, shape_m3).map(Some)
}
