//! Steps by body, at the start: what the steps of bodies follow from.

use std::sync::Arc;

use dem_scene::Scene;

use super::time_step::{StepChoice, share_of_impact};
use crate::check::linear::at_impact_of;
use crate::check::own_limit::own_eigenvalues;
use crate::stages::levels::any_longer;
use crate::state::State;
use crate::state::clusters::Clusters;
use crate::state::levels::{CYCLE, LevelRule, Levels};

/// Gives bodies steps of their own, if the scene asks for them and any body can take a longer one;
/// then the step is adapted to the end time.
pub(super) fn place_levels(scene: &Scene, state: &mut State, step: &mut StepChoice) {
    if !scene.run.steps_by_body {
        return;
    }
    let safety = scene.run.safety_factor;
    let rule = level_rule(state, step, safety);
    state.model.levels = Some(Arc::new(rule));
    state.time_step_s = step.step_s;
    if !any_longer(state) {
        state.model.levels = None;
        return;
    }
    state.levels = Some(Levels {
        of_particle: vec![0; state.particles.len()],
        ..Levels::default()
    });
    if !step.given {
        let cycles = scene.run.end_time_s / (CYCLE as f64 * step.step_s);
        // A step that fits is kept.
        let cycles = (cycles * (1.0 - 1e-12)).ceil();
        step.step_s = scene.run.end_time_s / (CYCLE as f64 * cycles);
    }
}

fn level_rule(state: &mut State, step: &StepChoice, safety: f64) -> LevelRule {
    let free = state.particles.free;
    let mut body_of = Clusters::new(free, &state.bonds).of_particle;
    let own = own_eigenvalues(state, &body_of);
    for (id, clump) in (own.len() as u32..).zip(&state.clumps.all) {
        body_of.extend(state.clumps.spheres_of(clump).map(|_| id));
    }
    let materials = state.contacts.as_ref();
    let materials = materials.map_or(&[][..], |contacts| &contacts.materials);
    let count = materials
        .iter()
        .max()
        .map_or(0, |most| usize::from(*most) + 1);
    let at_impact = |is_meant: &dyn Fn(usize) -> bool| {
        let [k, c, _] = at_impact_of(state, step.impact_speed_m_s, is_meant);
        [k, c]
    };
    let of_material =
        |material: usize| at_impact(&|i| i < free && usize::from(materials[i]) == material);
    let template_of = |i: usize| {
        let at = state.clumps.carrier_of(i);
        at.map(|at| state.clumps.all[at].template as usize)
    };
    let of_template = |template: usize| at_impact(&|i| template_of(i) == Some(template));
    LevelRule {
        own,
        impact_rates: (0..count).map(of_material).collect(),
        impact_rates_of_clumps: (0..state.clumps.templates.len()).map(of_template).collect(),
        safety: [safety, share_of_impact(state, safety)],
        body_of,
    }
}
