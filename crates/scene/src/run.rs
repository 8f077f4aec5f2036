//! `[run]`

use std::ops::Bound::{Excluded, Included};

use super::listing::one_field_a_key;
use super::schema::{Key, Kind, Schema, Word};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ACCELERATION, TIME};

/// End of the run, time step, and effects on all particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// `end_time`: simulated time at the end, s. Infinite if a `[test]` determines the end.
    pub end_time_s: f64,
    /// `integrator`, "leapfrog" unless given.
    pub integrator: Integrator,
    /// `rest_energy_ratio`, in (0, 1): end sooner, when the kinetic energy has been below this
    /// fraction of the elastic energy during the last fifth of the run.
    pub rest_energy_ratio: Option<f64>,
    /// `time_step`: seconds, or None for "auto", which is `safety_factor` times the exact limit.
    pub time_step_s: Option<f64>,
    /// `safety_factor`: the automatic step over the limit, 0.9 unless given; in (0, 2). Values from
    /// 1 are for trials only.
    pub safety_factor: f64,
    /// `adaptive`: the automatic step follows the limit up as well as down; false unless given.
    pub adaptive: bool,
    /// `gravity`, m/s2; 0 unless given. Length 3.
    pub gravity_m_s2: [f64; 3],
    /// `local_damping`: gamma of Chen et al. 2022, eqs. 11 and 12; 0 unless given; in [0, 1).
    pub local_damping: f64,
    /// `seed` of all random numbers (scatter of strengths); 0 unless given.
    pub seed: u64,
    /// `initial_overlap`, "refuse" unless given.
    pub initial_overlap: InitialOverlap,
}

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

pub(super) static RUN: Schema = Schema {
    title: "[run]",
    doc: "End of the run, time step, gravity and damping.",
    keys: &[
        Key::quantity("end_time", &TIME, "Simulated time at the end. Required unless a `[test]` determines it.")
            .positive()
            .otherwise("that of the test"),
        Key::word::<Integrator>(
            "integrator",
            "leapfrog",
            "Explicit time steps, or `static`: the static equilibrium under the loads at `end_time`, without steps.",
        ),
        Key::number(
            "rest_energy_ratio",
            "The run ends early once the kinetic energy has stayed below this fraction of the elastic energy for the \
             last fifth of the run and no load or support changes any more.",
        )
        .within(Excluded(0.0), Excluded(1.0))
        .remedy("a small ratio such as 1e-6 means at rest")
        .otherwise("never"),
        Key::new(
            "time_step",
            Kind::Auto(&TIME),
            "Time step; `auto` is `safety_factor` times the exact stability limit.",
        )
        .positive()
        .remedy("write \"auto\" or a time such as \"1 us\"")
        .or_word("auto"),
        Key::number(
            "safety_factor",
            "Automatic step as a fraction of the largest stable step; the step that impacts allow is scaled by \
             safety_factor/0.9. Use values of 1 and more for trials only.",
        )
        .within(Excluded(0.0), Excluded(2.0))
        .remedy("a usual value is 0.9")
        .or(SAFETY),
        Key::flag(
            "adaptive",
            false,
            "The automatic step follows the stability limit up as well as down.",
        ),
        Key::vector("gravity", &ACCELERATION, "Gravity."),
        Key::number("local_damping", "Local (non-viscous) damping of particles: gamma of Chen et al. 2022, eqs. 11 and 12.")
            .within(Included(0.0), Excluded(1.0))
            .remedy("write 0 for none")
            .or(0.0),
        Key::new(
            "seed",
            Kind::Whole { least: 0, most: Some(u64::MAX), of: "" },
            "Seed of all random numbers: scattered strengths, inlets.",
        )
        .remedy("write any such number")
        .or(0.0),
        Key::word::<InitialOverlap>(
            "initial_overlap",
            "refuse",
            "Bodies or walls that overlap at the start: `refuse` the scene; `relax`: their contact law begins at this \
             overlap; `keep`: the full overlap acts.",
        ),
    ],
};

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

one_field_a_key! {
    Run {
        end_time_s: "end_time",
        integrator: "integrator",
        rest_energy_ratio: "rest_energy_ratio",
        time_step_s: "time_step",
        safety_factor: "safety_factor",
        adaptive: "adaptive",
        gravity_m_s2: "gravity",
        local_damping: "local_damping",
        seed: "seed",
        initial_overlap: "initial_overlap",
    }
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
    let run = fields(&table)?;
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
    Ok(run)
}
