//! Steps by body, at the start: what the steps of bodies follow from.

use std::sync::Arc;

use dem_scene::Scene;

use super::time_step::{Coming, StepChoice, coming, share_of_impact};
use crate::check::linear::at_impact_of;
use crate::check::own_limit::own_eigenvalues;
use crate::stages::levels::{any_longer, note_wholes_of_clumps};
use crate::state::State;
use crate::state::clusters::Clusters;
use crate::state::levels::{CYCLE, LevelRule, Levels};

/// Gives bodies steps of their own, if the scene asks for them and any body can take a longer one;
/// then the step is adapted to the end time.
pub(super) fn place_levels(scene: &Scene, state: &mut State, step: &mut StepChoice) {
    if !scene.run.steps_by_body {
        return;
    }
    let whole_of = Clusters::new(state.particles.free, &state.bonds).of_particle;
    let rule = level_rule(state, step, &whole_of, scene.run.safety_factor);
    state.model.levels = Some(Arc::new(rule));
    state.levels = Some(Levels {
        of_particle: vec![0; state.particles.len()],
        whole_of,
        ..Levels::default()
    });
    note_wholes_of_clumps(state);
    state.time_step_s = step.step_s;
    if !any_longer(state) {
        state.model.levels = None;
        state.levels = None;
        return;
    }
    if !step.given {
        let cycles = scene.run.end_time_s / (CYCLE as f64 * step.step_s);
        // A step that fits is kept.
        let cycles = (cycles * (1.0 - 1e-12)).ceil();
        step.step_s = scene.run.end_time_s / (CYCLE as f64 * cycles);
    }
}

/// What levels follow from. `whole_of`: for each free particle the number of its body.
fn level_rule(state: &mut State, step: &StepChoice, whole_of: &[u32], safety: f64) -> LevelRule {
    let mut own = own_eigenvalues(state, whole_of);
    let mut clusters = coming(state, true);
    let clumps = coming(state, false);
    let mut own_of_template = Vec::new();
    if let Some(clusters) = &mut clusters {
        let first = own.len();
        own.extend(own_of_shapes(clusters));
        let of_shapes = clusters.shape_of.iter().take(state.clumps.templates.len());
        own_of_template = of_shapes.map(|shape| (first + shape) as u32).collect();
    }
    let speed_m_s = step.impact_speed_m_s;
    let starts = &state.model.rules.starts;
    let of_template = |template: usize| {
        let present = impact_of_clumps(state, speed_m_s, |other| other == template);
        let later = clumps.as_ref().map(|all| {
            let shape = all.shape_of[template];
            impact_of_clumps(&all.state, speed_m_s, |other| all.shape_of[other] == shape)
        });
        larger(present, later.unwrap_or_default())
    };
    let templates = &state.clumps.templates;
    let of_templates: Vec<[f64; 2]> = (0..templates.len()).map(of_template).collect();
    let of_material = |material: usize| {
        let present = impact_of_material(state, material, speed_m_s);
        let later = clusters.as_ref();
        let later = later.map(|all| impact_of_material(&all.state, material, speed_m_s));
        let spheres = templates.iter().zip(starts).zip(&of_templates);
        let own = spheres.filter(|((template, start), _)| {
            start.sphere && usize::from(template.material) == material
        });
        own.fold(
            larger(present, later.unwrap_or_default()),
            |all, (_, one)| larger(all, *one),
        )
    };
    let contacts = state.contacts.as_ref();
    let materials = contacts.map_or(0, |contacts| contacts.model.kind_of.len().isqrt());
    LevelRule {
        own,
        own_of_template,
        impact_rates: (0..materials).map(of_material).collect(),
        impact_rates_of_clumps: of_templates,
        impact_speed_m_s: speed_m_s,
        safety: [safety, share_of_impact(state, safety)],
    }
}

/// For each shape the largest eigenvalue of its cluster, 1/s2; infinite if it never has one.
fn own_of_shapes(coming: &mut Coming) -> Vec<f64> {
    let state = &mut coming.state;
    let free = state.particles.free;
    let of_particle = state.clusters.as_ref().map(|all| &all.of_particle[..free]);
    let of_particle = of_particle.map_or(Vec::new(), <[u32]>::to_vec);
    let most = coming.shape_of.iter().max().map_or(0, |most| most + 1);
    let found = own_eigenvalues(state, &of_particle);
    let mut own = vec![f64::INFINITY; most];
    for &shape in &of_particle {
        own[shape as usize] = found[shape as usize];
    }
    own
}

/// Largest eigenvalues that the first impacts of free particles of a material add, at this speed,
/// m/s: 1/s2 and 1/s.
fn impact_of_material(state: &State, material: usize, speed_m_s: f64) -> [f64; 2] {
    let contacts = state.contacts.as_ref();
    let materials = contacts.map_or(&[][..], |contacts| &contacts.materials);
    let is_own = |i: usize| i < state.particles.free && usize::from(materials[i]) == material;
    let [k, c, _] = at_impact_of(state, speed_m_s, is_own);
    [k, c]
}

/// The same of the clumps of some templates.
fn impact_of_clumps(state: &State, speed_m_s: f64, is_meant: impl Fn(usize) -> bool) -> [f64; 2] {
    let template_of = |i: usize| {
        let at = state.clumps.carrier_of(i)?;
        Some(state.clumps.all[at].template as usize)
    };
    let [k, c, _] = at_impact_of(state, speed_m_s, |i| template_of(i).is_some_and(&is_meant));
    [k, c]
}

fn larger(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|n| a[n].max(b[n]))
}
