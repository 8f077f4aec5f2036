//! `dem-run check`: dry run of a scene.

use std::path::Path;

use dem_io::safe_write::write_file;
use dem_io::safe_write::write_json_text;
use dem_io::text::visible;
use dem_io::units::significant;
use dem_io::write_target::need_folder_of;
use dem_io::{Diagnostic, Result};
use dem_pictures::png_file::{Compression, to_png};
use dem_scene::{Integrator, Scene};
use dem_terminal::standard_output::write_standard_output;
use serde_json::{Value, json};

use super::check_form::{Form, VERBOSE, expected_verdict};
use super::memory::{memory_bytes, size_text};
use super::pool::in_pool;
use super::scene_arguments::SceneArguments;
use super::statics;
use super::trial::Trial;
use dem_engine::state::State;
use dem_io::body::mass::mass_lines;
use dem_plan::time_step::StepLimit;
use dem_plan::{Plan, PlannedStage};
use dem_rig::arrange::{arrange, tested_body};
use dem_rig::plan_with_test;
use dem_runner::pictures::View;

/// Number of lines on the contents of a scene that are always shown.
const SHOWN: usize = 4;

/// Samples that differ by less than this factor are told as one.
const ALIKE: f64 = 1.2;

/// Does a dry run of the scene that the arguments name, with a picture of its start if a file for
/// it is named.
pub(super) fn check_scene(
    arguments: &SceneArguments,
    picture: Option<&Path>,
    form: Form,
) -> Result<()> {
    if !arguments.names_a_scene() {
        let within = Path::new(&arguments.place()).join("scene.toml");
        let remedy = match within.is_file() {
            true => format!("name its scene: {}", within.display()),
            false => "name a scene; dem-run describes a body without check".to_owned(),
        };
        return Err(Diagnostic::input(
            arguments.place(),
            "this is not a scene (.toml)",
            remedy,
        ));
    }
    in_pool(arguments.threads, |threads| {
        let (scene, bodies) = arguments.read()?;
        let scene = match tested_body(&scene, &bodies, threads)? {
            Some(body) => arrange(&scene, &body, 1.0)?,
            None => scene,
        };
        let (mut plan, _) = plan_with_test(&scene, bodies, threads, arguments.force_step)
            .map_err(|error| arguments.naming_set(error))?;
        plan.inputs.set = arguments.all_overrides();
        if let Some(file) = picture {
            write_picture(&scene, &plan, file)?;
        }
        match form {
            Form::Nothing => Ok(()),
            form => check(&scene, &plan, form),
        }
    })
}

/// Writes a picture of the start of a scene; refuses a file that is not a .png.
fn write_picture(scene: &Scene, plan: &Plan, file: &Path) -> Result<()> {
    if file.extension().is_none_or(|ending| ending != "png") {
        let name = file.display().to_string();
        let problem = "this is not the name of a picture";
        return Err(Diagnostic::input(name, problem, "end it with .png"));
    }
    need_folder_of(file)?;
    let output = scene.output.as_ref();
    let from = output.and_then(|output| output.view_from);
    let view = View::with_regions(&plan.state, from);
    let (end_s, names) = (scene.run.end_time_s, scene.regions.keys());
    let image = view.picture_with_regions(&plan.state, &plan.bodies, end_s, names);
    let bytes = to_png(&image, Compression::High)?;
    write_file(file, |out| out.write_all(&bytes))
}

/// Prints the plan of a scene, as text or as JSON.
fn check(scene: &Scene, plan: &Plan, form: Form) -> Result<()> {
    if scene.run.integrator == Integrator::Static {
        return statics::check(scene, plan, memory_bytes(&plan.state), form);
    }
    let steps = steps(scene, plan);
    let bytes = memory_bytes(&plan.state);
    let limits = limited_by(plan);
    let trial = Trial::of(scene, plan, steps.first)?;
    let of_stages = |needed: bool| -> Vec<Value> {
        let of_stage = |stage: &PlannedStage| {
            let cost_ns = trial.cost_ns(stage);
            let would = (stage.stage.saving)(&plan.state);
            json!({
                "name": stage.stage.name,
                "why": stage.why,
                "bytes": if needed { Some(stage.bytes) } else { would.map(|saved| saved.bytes) },
                "ns_per_step": if needed { cost_ns } else { would.map(|saved| saved.ns) },
            })
        };
        (plan.stages.iter().filter(|stage| stage.needed == needed))
            .map(of_stage)
            .collect()
    };
    write_standard_output(|out| {
        if form == Form::Json {
            let value = json!({
                "scene": scene.source,
                "particles": plan.state.particles.len(),
                "bonds": plan.state.bonds.len(),
                "bodies": plan.masses,
                "time_step_s": plan.step.step_s,
                "limit_s": plan.step.limit.step_s,
                "limit_at_impact_s": plan.step.foreseen_s,
                "impact_speed_m_s": plan.step.impact_speed_m_s,
                "limited_by": limits.map(|[first, _]| first),
                "next_limit": limits.map(|[_, next]| next),
                "notes": plan.notes.iter().chain(&trial.notes).collect::<Vec<_>>(),
                "warnings": plan.warnings.iter().chain(&plan.forecast.warnings).collect::<Vec<_>>(),
                "coarse": plan.coarse,
                "first_contacts": plan.forecast.first_contacts,
                "to_be_fed": plan.forecast.to_come,
                "inputs": plan.inputs,
                "limit_undamped_s": plan.step.limit.undamped_step_s,
                "rayleigh_s": plan.step.rayleigh_s.is_finite().then_some(plan.step.rayleigh_s),
                "platzer_eq_15_s": plan.step.platzer_eq_15_s.is_finite().then_some(plan.step.platzer_eq_15_s),
                "steps": steps.first,
                "steps_once_replaced": steps.once_replaced,
                "stages": of_stages(true),
                "inactive": of_stages(false),
                "memory_bytes": bytes,
                "predicted_run_time_s": trial.range_s[0],
                "predicted_time_of_pictures_s": trial.pictures_s,
                "predicted_run_time_range_s": trial.range_s,
            });
            write_json_text(out, &value)
        } else if form == Form::Short {
            write!(out, "{}", short(scene, plan, steps, bytes, &trial))
        } else {
            write!(
                out,
                "{}\n{}",
                scene.describe(),
                text(plan, steps, bytes, &trial)
            )
        }
    })
}

/// Number of steps of a run.
#[derive(Clone, Copy)]
struct Steps {
    /// With the first step.
    first: f64,
    /// With the smaller step of an adaptive run whose clumps have all become clusters.
    once_replaced: Option<f64>,
}

fn steps(scene: &Scene, plan: &Plan) -> Steps {
    let number = |step_s: f64| (scene.run.end_time_s / step_s).round();
    let replaced_s = plan.step.replaced.step_s;
    let becomes_smaller = plan.is_adaptive && replaced_s < plan.step.step_s;
    Steps {
        first: number(plan.step.step_s),
        once_replaced: becomes_smaller.then(|| number(replaced_s)),
    }
}

/// What the run will be in about ten lines: contents, time step, run time, and reasons to doubt its
/// result or to call it coarse.
fn short(scene: &Scene, plan: &Plan, steps: Steps, bytes: usize, trial: &Trial) -> String {
    let mut text = format!("{}\n", visible(&scene.source));
    let contents = contents(plan);
    let named = contents.lines().filter(|line| !line.starts_with(' '));
    for line in named.take(SHOWN) {
        text += &format!("{line}\n");
    }
    let mut line = |name: &str, what: &str| text += &format!("{name:14} {what}\n");
    let limit = limited_by(plan).map_or_else(String::new, |[first, _]| {
        format!(", limited by {}", first.reason)
    });
    let step = significant(plan.step.step_s, 4);
    line(
        "time step",
        &format!("{step} s{limit}; {} steps", steps.first),
    );
    line("memory", &format!("about {}", size_text(bytes)));
    line("run time", &(run_time_text(trial) + &trial.pictures_text()));
    line("", VERBOSE);
    for note in plan.notes.iter().chain(&trial.notes) {
        line("note", &visible(note));
    }
    text + &expected_verdict(plan)
}

fn text(plan: &Plan, steps: Steps, bytes: usize, trial: &Trial) -> String {
    let mut text = contents(plan);
    for (name, mass) in mass_lines(&plan.masses) {
        text += &format!("{name:14} {mass}\n");
    }
    text += &time_step(plan);
    let mut line = |name: &str, what: String| text += &format!("{name:14} {what}\n");
    let state = &plan.state;
    let number = |steps: f64| {
        if steps < 1e15 {
            format!("{steps}")
        } else {
            significant(steps, 2)
        }
    };
    let first = number(steps.first);
    line(
        "steps",
        steps.once_replaced.map_or(first.clone(), |more| {
            format!(
                "{first} at the first step, {} at that of clusters, more while contacts are pressed",
                number(more)
            )
        }),
    );
    for stage in &plan.stages {
        let name = if stage.needed { "active" } else { "inactive" };
        line(name, stage_text(stage, state, trial));
    }
    for note in plan.notes.iter().chain(&trial.notes) {
        line("note", note.clone());
    }
    for warning in plan.warnings.iter().chain(&plan.forecast.warnings) {
        line("warning", warning.clone());
    }
    for reason in &plan.coarse {
        line("coarse", reason.clone());
    }
    let fed_bytes: f64 = plan.forecast.to_come.iter().map(|fed| fed.bytes).sum();
    let with_fed = if fed_bytes > 0.0 {
        let most = size_text((bytes as f64 + fed_bytes) as usize);
        format!(" at the start, {most} if all that is fed is bonded and none is discharged")
    } else {
        String::new()
    };
    line("memory", format!("about {}{with_fed}", size_text(bytes)));
    line("run time", run_time_text(trial) + &trial.pictures_text());
    text
}

/// The run time between two predictions.
fn run_time_text(trial: &Trial) -> String {
    let [least_s, most_s] = trial.range_s;
    let [least, most] = [least_s, most_s].map(|s| significant(s, 2));
    if most_s <= ALIKE * least_s {
        format!("about {least} s on this machine")
    } else {
        format!(
            "about {least} s on this machine, {most} s {}",
            trial.longest_if
        )
    }
}

/// Contents of the scene, bodies to be added, and first contacts.
fn contents(plan: &Plan) -> String {
    let state = &plan.state;
    let mut text = String::new();
    let mut line = |name: &str, what: String| text += &format!("{name:14} {what}\n");
    line(
        "holds",
        format!(
            "{} particles, {} bonds{}",
            state.particles.len(),
            state.bonds.len(),
            if state.model.rules.inlets.is_empty() {
                ""
            } else {
                " at the start"
            }
        ),
    );
    for (name, bonds) in &plan.unused_bonds {
        line(
            "",
            format!(
                "'{name}' as a rigid clump; its {} not used",
                bonds_are(*bonds)
            ),
        );
    }
    for fed in &plan.forecast.to_come {
        line(
            "to be fed",
            format!(
                "{} bodies by the inlet '{}' until the end: {} spheres and {} bonds once they are bonded",
                fed.bodies,
                fed.inlet,
                fed.spheres.round(),
                fed.bonds.round()
            ),
        );
    }
    for first in &plan.forecast.first_contacts {
        line("first contact", first.clone());
    }
    text
}

/// The time step and the reason for it.
fn time_step(plan: &Plan) -> String {
    let choice = &plan.step;
    let mut text = String::new();
    let mut line = |name: &str, what: String| text += &format!("{name:14} {what}\n");
    let why = if choice.given { "given" } else { "chosen" };
    let step = significant(choice.step_s, 5);
    let limit = if choice.foreseen_s.is_finite() {
        format!(
            "{} of the largest stable one, {} s{}",
            significant(choice.fraction_of_limit(), 3),
            significant(choice.foreseen_s, 5),
            match choice.limit.iterations {
                0 => String::new(),
                iterations => format!(" ({iterations} Lanczos steps)"),
            }
        )
    } else {
        "no limit, as nothing vibrates".to_owned()
    };
    line("time step", format!("{step} s {why}: {limit}"));
    if let Some([first, next]) = limited_by(plan) {
        let [least, more] = [first, next].map(|limit| significant(limit.step_s, 3));
        let text = format!(
            "{}: {least} s; next: {}, {more} s",
            first.reason, next.reason
        );
        line("", text);
    }
    if plan.is_adaptive {
        let replaced = if choice.replaced.step_s < choice.step_s {
            let least = significant(choice.replaced.step_s, 5);
            format!("; about {least} s once clumps have become clusters")
        } else {
            String::new()
        };
        line(
            "",
            format!("adaptive: this is the first step, it follows the limit{replaced}"),
        );
    }
    if choice.foreseen_s < choice.limit.step_s {
        line(
            "",
            format!(
                "{} without impacts; impacts at {} m/s are predicted",
                if choice.limit.step_s.is_finite() {
                    format!("{} s", significant(choice.limit.step_s, 5))
                } else {
                    "no limit".to_owned()
                },
                significant(choice.impact_speed_m_s, 3)
            ),
        );
    }
    if choice.limit.damping_1_s > 0.0 {
        line(
            "",
            format!(
                "{} s without damping",
                significant(choice.limit.undamped_step_s, 5)
            ),
        );
    }
    let estimate = |name: &str, step_s: f64| estimate(name, step_s, plan);
    line("", estimate("Rayleigh's estimate", choice.rayleigh_s));
    line("", estimate("20 % of it", 0.2 * choice.rayleigh_s));
    if choice.platzer_eq_15_s.is_finite() {
        line(
            "",
            estimate(
                "Platzer 2022, eq. 15: 0.17 sqrt(m/K) =",
                choice.platzer_eq_15_s,
            ),
        );
    }
    text
}

/// What limits the step, and what would limit it next. None: the step is given.
fn limited_by(plan: &Plan) -> Option<[StepLimit; 2]> {
    (!plan.step.given).then_some(plan.step.limited_by)
}

/// An estimate of the largest stable step, s, beside the limit.
fn estimate(name: &str, step_s: f64, plan: &Plan) -> String {
    let limit_s = plan.step.limit.step_s;
    if !step_s.is_finite() {
        return match plan.state.smallest_radius_m().is_finite() {
            true => format!("{name} unknown: no material has an elastic modulus"),
            false => format!("{name} unknown: there are no particles and none will be fed"),
        };
    }
    let of_limit = if limit_s.is_finite() {
        format!(", {} of the limit", significant(step_s / limit_s, 3))
    } else {
        String::new()
    };
    format!("{name} {} s{of_limit}", significant(step_s, 5))
}

/// A stage: the reason why it is active or not, its cost, or the saving from skipping it.
fn stage_text(stage: &PlannedStage, state: &State, trial: &Trial) -> String {
    let mut text = format!("{}: {}", stage.stage.name, stage.why);
    let mut costs = Vec::new();
    if stage.needed {
        if stage.bytes > 0 {
            costs.push(size_text(stage.bytes));
        }
        costs.extend(trial.cost_ns(stage).map(time_text));
        costs.extend((stage.stage.within).map(|other| format!("timed with {other}")));
    } else if let Some(saved) = (stage.stage.saving)(state) {
        if saved.bytes > 0 {
            costs.push(size_text(saved.bytes));
        }
        costs.push(time_text(saved.ns));
    }
    if !costs.is_empty() {
        let what = if stage.needed { "" } else { "saves about " };
        text += &format!(" ({what}{})", costs.join(", "));
    }
    text
}

fn bonds_are(count: usize) -> String {
    match count {
        1 => "bond is".to_owned(),
        _ => format!("{count} bonds are"),
    }
}

fn time_text(ns: f64) -> String {
    match ns {
        few if few < 1e3 => format!("{few:.0} ns per step"),
        some if some < 1e6 => format!("{} us per step", significant(some * 1e-3, 2)),
        many => format!("{} ms per step", significant(many * 1e-6, 2)),
    }
}
