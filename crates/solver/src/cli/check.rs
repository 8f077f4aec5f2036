//! `dem-run check`: what a scene will do.

use std::collections::BTreeMap;
use std::time::Instant;

use dem_io::safe_write::write_standard_output;
use dem_io::scene::{Integrator, Scene};
use dem_io::units::significant;
use dem_io::{Body, Result};
use serde_json::json;

use crate::plan::{Plan, plan};
use crate::state::State;
use crate::step::step;

/// Steps that are tried on a copy, for the prediction of the run time, and the seconds they may take.
const TRIAL: (u32, f64) = (2000, 0.5);

/// Plans the scene and says what came of it, as text or as JSON.
pub(super) fn check(
    scene: &Scene,
    bodies: BTreeMap<String, Body>,
    threads: usize,
    force_step: bool,
    as_json: bool,
) -> Result<()> {
    let plan = plan(scene, bodies, threads, force_step)?;
    if scene.run.integrator == Integrator::Static {
        return super::statics::check(scene, &plan, memory_bytes(&plan.state), as_json);
    }
    let steps = (scene.run.end_time_s / plan.step.step_s).round();
    let bytes = memory_bytes(&plan.state);
    // What the first steps take says nothing where bodies come, go, or become others.
    let per_step_s = (plan.state.rules.are_none()).then(|| trial_s(&plan.state));
    write_standard_output(|out| {
        if as_json {
            let value = json!({
                "scene": scene.source,
                "particles": plan.state.particles.len(),
                "bonds": plan.state.bonds.len(),
                "time_step_s": plan.step.step_s,
                "limit_s": plan.step.limit.step_s,
                "foreseen_limit_s": plan.step.foreseen_s,
                "impact_speed_m_s": plan.step.impact_speed_m_s,
                "notes": plan.notes,
                "limit_undamped_s": plan.step.limit.undamped_step_s,
                "rayleigh_s": plan.step.rayleigh_s.is_finite().then_some(plan.step.rayleigh_s),
                "thesis_s": plan.step.thesis_s.is_finite().then_some(plan.step.thesis_s),
                "steps": steps,
                "stages": plan.stages.iter().filter(|s| s.needed).map(|s| s.name).collect::<Vec<_>>(),
                "left_out": plan.stages.iter().filter(|s| !s.needed).map(|s| s.name).collect::<Vec<_>>(),
                "memory_bytes": bytes,
                "predicted_run_time_s": per_step_s.map(|s| steps * s),
            });
            serde_json::to_writer_pretty(&mut *out, &value)?;
            writeln!(out)
        } else {
            write!(
                out,
                "{}\n{}",
                scene.describe(),
                text(&plan, steps, bytes, per_step_s)
            )
        }
    })
}

fn text(plan: &Plan, steps: f64, bytes: usize, per_step_s: Option<f64>) -> String {
    let state = &plan.state;
    let choice = &plan.step;
    let mut text = String::new();
    let mut line = |name: &str, what: String| text += &format!("{name:14} {what}\n");
    line(
        "holds",
        format!(
            "{} particles, {} bonds",
            state.particles.len(),
            state.bonds.len()
        ),
    );
    let why = if choice.given { "given" } else { "chosen" };
    let step = significant(choice.step_s, 5);
    let limit = if choice.foreseen_s.is_finite() {
        format!(
            "{} of the largest stable one, {} s ({} Lanczos steps)",
            significant(choice.share_of_limit(), 3),
            significant(choice.foreseen_s, 5),
            choice.limit.iterations,
        )
    } else {
        "nothing vibrates, so none is too large".to_owned()
    };
    line("time step", format!("{step} s {why}: {limit}"));
    if choice.foreseen_s < choice.limit.step_s {
        line(
            "",
            format!(
                "at rest the largest would be {} s; impacts at {} m/s are foreseen",
                significant(choice.limit.step_s, 5),
                significant(choice.impact_speed_m_s, 3)
            ),
        );
    }
    if choice.limit.damping_1_s > 0.0 {
        line(
            "",
            format!(
                "without damping the largest would be {} s",
                significant(choice.limit.undamped_step_s, 5)
            ),
        );
    }
    let beside = |name: &str, step_s: f64| {
        if step_s.is_finite() {
            let share = significant(step_s / choice.limit.step_s, 3);
            let of_limit = if choice.limit.step_s.is_finite() {
                format!(", {share} of the limit")
            } else {
                String::new()
            };
            format!("{name} {} s{of_limit}", significant(step_s, 5))
        } else {
            format!("{name} unknown: no elastic modulus of a material is given")
        }
    };
    line("", beside("Rayleigh's estimate", choice.rayleigh_s));
    line("", beside("20 % of it", 0.2 * choice.rayleigh_s));
    if choice.thesis_s.is_finite() {
        line("", beside("0.17 sqrt(m/K)", choice.thesis_s));
    }
    let exact = steps < 1e15;
    line(
        "steps",
        if exact {
            format!("{steps}")
        } else {
            significant(steps, 2)
        },
    );
    for stage in &plan.stages {
        let name = if stage.needed { "does" } else { "leaves out" };
        line(name, format!("{}: {}", stage.name, stage.why));
    }
    for note in &plan.notes {
        line("note", note.clone());
    }
    line("memory", memory_text(bytes));
    line(
        "run time",
        per_step_s.map_or(
            "not foreseen: bodies come, go, or become others".to_owned(),
            |s| {
                let run_s = significant(steps * s, 2);
                format!("about {run_s} s, if this machine stays as it is")
            },
        ),
    );
    text
}

/// A number of bytes, for a person.
pub(super) fn memory_text(bytes: usize) -> String {
    match bytes as f64 {
        few if few < 1e6 => format!("about {} kB", significant(few * 1e-3, 3)),
        many => format!("about {} MB", significant(many * 1e-6, 3)),
    }
}

/// What the arrays of a state take, bytes.
fn memory_bytes(state: &State) -> usize {
    let p = &state.particles;
    let b = &state.bonds;
    let templates = state.clumps.templates.iter();
    let of_templates: usize = templates
        .map(|t| 112 * t.spheres.len() + (8 + 8 * 8 + 32 + 4) * t.bonds.len())
        .sum();
    let per_particle = 3 * 64 + 8;
    let per_bond = 8 + 8 * 8;
    p.len() * per_particle
        + b.len() * per_bond
        + of_templates
        + 64 * (state.bond_resistance.len() + state.particle_resistance.len())
        + 8 * b.strength_factors.len()
        + 32 * b.damping.len()
        + 48 * b.histories.len()
        + state.contacts.as_ref().map_or(0, |contacts| {
            // Every particle may come to touch a few others.
            (16 + 5 + 3 * (8 + 128)) * contacts.materials.len()
        })
        + state.clusters.as_ref().map_or(0, |_| 24 * p.len())
}

/// Time of a step, tried on a copy, s.
fn trial_s(state: &State) -> f64 {
    let mut copy = state.clone();
    let clock = Instant::now();
    let mut done = 0;
    while done < TRIAL.0 && (done < 3 || clock.elapsed().as_secs_f64() < TRIAL.1) {
        step(&mut copy);
        done += 1;
    }
    clock.elapsed().as_secs_f64() / f64::from(done)
}
