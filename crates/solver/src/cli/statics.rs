//! `dem-run check` of a static scene.

use dem_io::Result;
use dem_io::safe_write::write_json_text;
use dem_io::text::visible;
use dem_scene::Scene;
use dem_terminal::standard_output::write_standard_output;
use serde_json::json;

use super::check_form::{Form, VERBOSE, expected_verdict};
use super::memory::size_text;
use dem_io::body::mass::mass_lines;
use dem_plan::Plan;
use dem_runner::statics::StaticsEstimate;

/// Keys and tables that have no effect in such a scene.
const UNUSED: &str = "run.rest_energy_ratio, end_run_above of measures, run.time_step, run.safety_factor, run.adaptive, run.local_damping, damping of bonds, velocities of bodies, output.frames, series, pictures and checkpoint";

/// Prints what will be solved, as text or as JSON. `state_bytes` is the memory of the arrays of the
/// state.
pub(super) fn check(scene: &Scene, plan: &Plan, state_bytes: usize, form: Form) -> Result<()> {
    let state = &plan.state;
    let estimate = StaticsEstimate::of(state, scene.run.end_time_s)
        .map_err(|error| error.within(&scene.source))?;
    let bytes = state_bytes + estimate.memory_bytes;
    write_standard_output(|out| {
        if form == Form::Json {
            let value = json!({
                "scene": scene.source,
                "particles": state.particles.len(),
                "bonds": state.bonds.len(),
                "bodies": plan.masses,
                "equilibrium": estimate,
                "memory_bytes": bytes,
                "notes": plan.notes,
                "warnings": plan.warnings,
                "coarse": plan.coarse,
            });
            return write_json_text(out, &value);
        }
        let is_whole = form == Form::Whole;
        if is_whole {
            writeln!(out, "{}", scene.describe())?;
        } else {
            writeln!(out, "{}", visible(&scene.source))?;
        }
        let mut line = |name: &str, what: &str| writeln!(out, "{name:14} {what}");
        line(
            "holds",
            &format!(
                "{} particles, {} bonds",
                state.particles.len(),
                state.bonds.len()
            ),
        )?;
        for (name, mass) in mass_lines(&plan.masses).iter().filter(|_| is_whole) {
            line(name, mass)?;
        }
        line(
            "solves",
            &format!(
                "equilibrium under what acts at {} s: {} unknowns, {} freedoms held; no time steps",
                scene.run.end_time_s, estimate.unknowns, estimate.held
            ),
        )?;
        let factor = match estimate.factor_entries {
            _ if estimate.iterative => "conjugate gradients, without factors".to_owned(),
            Some(entries) => format!("Cholesky, {entries} entries in the factor"),
            None => {
                "L U, as torques act on particles that can turn: several times as long as Cholesky"
                    .to_owned()
            }
        };
        line("by", &format!("Newton's method; {factor}"))?;
        line("memory", &format!("about {}", size_text(bytes)))?;
        if is_whole {
            line("not used", UNUSED)?;
        } else {
            line("", VERBOSE)?;
        }
        for note in &plan.notes {
            line("note", note)?;
        }
        write!(out, "{}", expected_verdict(plan))
    })
}
