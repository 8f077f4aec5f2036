//! `[run]`

use std::ops::Bound::{Excluded, Included};

use super::listing::one_field_a_key;
use super::schema::{Key, Kind, Schema, Word};
use super::table::Table;
use super::{Integrator, Run, StartOverlap};
use crate::Result;
use crate::units::{ACCELERATION, TIME};

/// `run.safety` unless given.
pub const SAFETY: f64 = 0.9;

pub(super) static RUN: Schema = Schema {
    title: "[run]",
    doc: "When the run ends, how it steps, what acts everywhere.",
    keys: &[
        Key::quantity("end_time", &TIME, "Simulated time at the end. Needed where no `[test]` says when it ends.")
            .positive()
            .otherwise("that of the test"),
        Key::word::<Integrator>(
            "integrator",
            "leapfrog",
            "Step by step, or `static`: at once into the equilibrium under what acts at `end_time`.",
        ),
        Key::number(
            "rest",
            "The run ends sooner, once the kinetic energy has been below this share of the elastic one during the \
             last fifth of the run and no load or support changes any more.",
        )
        .within(Excluded(0.0), Excluded(1.0))
        .remedy("a small share such as 1e-6 means at rest")
        .otherwise("never"),
        Key::new(
            "time_step",
            Kind::Auto(&TIME),
            "The step; `auto` is `safety` times the exact limit.",
        )
        .positive()
        .remedy("write \"auto\" or a time such as \"1 us\"")
        .or_word("auto"),
        Key::number(
            "safety",
            "The automatic step over the largest stable one; the step that impacts allow is more or less by \
             safety/0.9. 1 and more are for trials only.",
        )
        .within(Excluded(0.0), Excluded(2.0))
        .remedy("a usual value is 0.9")
        .or(SAFETY),
        Key::flag(
            "adaptive",
            false,
            "The automatic step follows the limit up as well as down.",
        ),
        Key::vector("gravity", &ACCELERATION, "Acceleration that acts on everything."),
        Key::number("particle_damping", "Damping of particles: gamma of Chen et al. 2022, eqs. 11 and 12.")
            .within(Included(0.0), Excluded(1.0))
            .remedy("write 0 for none")
            .or(0.0),
        Key::new(
            "seed",
            Kind::Whole { least: 0, most: Some(u64::MAX), of: "" },
            "Of all that is random: scattered strengths, inlets.",
        )
        .remedy("write any such number")
        .or(0.0),
        Key::word::<StartOverlap>(
            "start_overlap",
            "refuse",
            "Bodies or walls that overlap at the start are refused; or `relax`: the overlap is the origin of their \
             contact law; or `keep`: they press with all of it.",
        ),
    ],
};

impl Word for Integrator {
    const WORDS: &'static [(&'static str, Self)] =
        &[("leapfrog", Self::Leapfrog), ("static", Self::Static)];
}

impl Word for StartOverlap {
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
        rest: "rest",
        time_step_s: "time_step",
        safety: "safety",
        adaptive: "adaptive",
        gravity_m_s2: "gravity",
        particle_damping: "particle_damping",
        seed: "seed",
        start_overlap: "start_overlap",
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
        return Err(field.refuse(
            "a step that is given stays as it is",
            "write time_step = \"auto\", or leave adaptive out",
        ));
    }
    Ok(run)
}
