//! `[run]`

use std::ops::Bound::{Excluded, Included};

use super::plain_table::plain_table;
use super::schema::{Kind, Word};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ACCELERATION, TIME};

/// How a run reaches its end.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Integrator {
    /// "leapfrog": step by step.
    #[default]
    Leapfrog,
    /// "static": directly, by solving for the equilibrium under the final loads and supports. Only
    /// for bonded bodies on supports, without contacts, breakage, inlets and outlets.
    Static,
}

/// Treatment of bodies or walls that overlap at the start without being joined by a bond.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InitialOverlap {
    /// "refuse": the scene is refused.
    Refuse,
    /// "relax": the overlap is the origin of their contact law.
    Relax,
    /// "keep": contacts like all others, with the force of their overlap.
    Keep,
}

/// Default of `run.safety_factor`.
pub const SAFETY: f64 = 0.9;
/// Default of `run.impact_accuracy`.
pub const IMPACT_ACCURACY: f64 = 0.01;

plain_table! {
    RUN = "[run]";
    /// End of the run, time step, gravity and damping.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Run {
        /// Simulated time at the end. Required unless a `[test]` determines it.
        end_time_s: f64 = quantity("end_time", &TIME).positive().otherwise("that of the test");
        /// Explicit time steps, or `static`: the static equilibrium under the loads at `end_time`,
        /// without steps.
        integrator: Integrator = word::<Integrator>("integrator", "leapfrog");
        /// The run ends early once the kinetic energy has stayed below this fraction of the elastic
        /// energy for the last fifth of the run and no load or support changes any more.
        rest_energy_ratio: Option<f64> = number("rest_energy_ratio")
            .within(Excluded(0.0), Excluded(1.0))
            .remedy("a small ratio such as 1e-6 means at rest")
            .otherwise("never");
        /// Time step; `auto` is `safety_factor` times the exact stability limit.
        time_step_s: Option<f64> = new("time_step", Kind::Auto(&TIME))
            .positive()
            .remedy("write \"auto\" or a time such as \"1 us\"")
            .or_word("auto");
        /// Automatic step as a fraction of the largest stable step; the step that impacts allow is
        /// scaled by safety_factor/0.9. Use values of 1 and more for trials only.
        safety_factor: f64 = number("safety_factor")
            .within(Excluded(0.0), Excluded(2.0))
            .remedy("a usual value is 0.9")
            .or(SAFETY);
        /// Largest error of an impact of one sphere for which the automatic step is chosen: of its
        /// energy over the kinetic energy, and of its restitution. It holds at the default
        /// safety_factor.
        impact_accuracy: f64 = number("impact_accuracy")
            .within(Included(1e-6), Included(0.04))
            .remedy("the default is 0.01; finer ones are smaller")
            .or(IMPACT_ACCURACY);
        /// The automatic step follows the stability limit up as well as down.
        adaptive: bool = flag("adaptive", false);
        /// Gravity.
        gravity_m_s2: [f64; 3] = vector("gravity", &ACCELERATION);
        /// Local (non-viscous) damping of particles: gamma of Chen et al. 2022, eqs. 11 and 12.
        local_damping: f64 = number("local_damping")
            .within(Included(0.0), Excluded(1.0))
            .remedy("write 0 for none")
            .or(0.0);
        /// Seed of all random numbers: scattered strengths, inlets.
        seed: u64 = new("seed", Kind::Whole { least: 0, most: Some(u64::MAX), of: "" })
            .remedy("write any such number")
            .or(0.0);
        /// Bodies or walls that overlap at the start: `refuse` the scene; `relax`: their contact
        /// law begins at this overlap; `keep`: the full overlap acts.
        initial_overlap: InitialOverlap = word::<InitialOverlap>("initial_overlap", "refuse");
    }
}

impl Word for Integrator {
    const WORDS: &'static [(&'static str, Self)] =
        &[("leapfrog", Self::Leapfrog), ("static", Self::Static)];
}

impl Word for InitialOverlap {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("refuse", Self::Refuse),
        ("relax", Self::Relax),
        ("keep", Self::Keep),
    ];
}

pub(super) fn read(root: &Table<'_>) -> Result<Run> {
    let Some(field) = root.get("run") else {
        let remedy = "add [run] with end_time = \"1 s\"";
        return Err(root.refuse("the table [run] is missing", remedy));
    };
    let table = Table::of(&field, &RUN)?;
    if root.get("test").is_none() {
        table.need_such("end_time", "\"1 s\"")?;
    }
    let run = Run::read(&table)?;
    let Some(step_s) = run.time_step_s else {
        return Ok(run);
    };
    if let (true, Some(field)) = (step_s > run.end_time_s, table.get("time_step")) {
        let limit = format!("at most run.end_time, {} s", run.end_time_s);
        return Err(field.wrong(&limit, "write \"auto\" or a shorter time"));
    }
    if let (true, Some(field)) = (run.adaptive, table.get("adaptive")) {
        let problem = "a step that is given stays as it is";
        return Err(field.refuse(problem, "write time_step = \"auto\", or leave adaptive out"));
    }
    if let Some(field) = table.get("impact_accuracy") {
        let problem = format!(
            "{} is that of the automatic step, and run.time_step gives a step of {step_s} s",
            field.path
        );
        let remedy = "write time_step = \"auto\", or leave impact_accuracy out";
        return Err(field.refuse(problem, remedy));
    }
    Ok(run)
}
