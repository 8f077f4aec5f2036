//! `[run]`

use super::field::Field;
use super::table::Table;
use super::tree::Value;
use super::{Integrator, Run, StartOverlap};
use crate::Result;
use crate::units::{ACCELERATION, NUMBER, TIME};

const KEYS: [&str; 10] = [
    "end_time",
    "integrator",
    "rest",
    "time_step",
    "safety",
    "adaptive",
    "gravity",
    "particle_damping",
    "seed",
    "start_overlap",
];

/// How a run may come to its end.
pub(super) const INTEGRATORS: [(&str, Integrator); 2] = [
    ("leapfrog", Integrator::Leapfrog),
    ("static", Integrator::Static),
];

/// What may happen to overlaps at the start.
pub(super) const START_OVERLAPS: [(&str, StartOverlap); 3] = [
    ("refuse", StartOverlap::Refuse),
    ("relax", StartOverlap::Relax),
    ("keep", StartOverlap::Keep),
];

/// `run.safety` unless given.
pub const SAFETY: f64 = 0.9;

pub(super) fn read(root: &Table<'_>) -> Result<Run> {
    let is_test = root.get("test").is_some();
    let Some(field) = root.get("run") else {
        let remedy = "add [run] with end_time = \"1 s\"";
        return Err(root.refuse("the table [run] is missing", remedy));
    };
    let table = field.table(&KEYS)?;
    let end_time_s = match table.get("end_time") {
        None if is_test => f64::INFINITY,
        _ => table.need("end_time", "\"1 s\"")?.positive(&TIME)?,
    };
    let time_step_s = match table.get("time_step") {
        Some(field) => time_step(&field, end_time_s)?,
        None => None,
    };
    let adaptive = table
        .read("adaptive", |field| field.boolean())?
        .unwrap_or_default();
    if let (true, Some(_), Some(field)) = (adaptive, time_step_s, table.get("adaptive")) {
        return Err(field.refuse(
            "a step that is given stays as it is",
            "write time_step = \"auto\", or leave adaptive out",
        ));
    }
    Ok(Run {
        end_time_s,
        integrator: table
            .read("integrator", |field| field.choice(&INTEGRATORS))?
            .unwrap_or_default(),
        rest: table.read("rest", |field| {
            field.between(0.0, 1.0, "a small share such as 1e-6 means at rest")
        })?,
        time_step_s,
        safety: table
            .read("safety", |field| {
                field.between(0.0, 2.0, "a usual value is 0.9")
            })?
            .unwrap_or(SAFETY),
        adaptive,
        gravity_m_s2: table
            .read("gravity", |field| field.vector(&ACCELERATION))?
            .unwrap_or_default(),
        particle_damping: table
            .read("particle_damping", |field| {
                field.limited(
                    &NUMBER,
                    |gamma| (0.0..1.0).contains(&gamma),
                    "at least 0 and less than 1",
                    "write 0 for none",
                )
            })?
            .unwrap_or_default(),
        seed: table
            .read("seed", |field| {
                field.whole(u64::MAX, "write any such number")
            })?
            .unwrap_or_default(),
        start_overlap: table
            .read("start_overlap", |field| field.choice(&START_OVERLAPS))?
            .unwrap_or(StartOverlap::Refuse),
    })
}

/// None for "auto".
fn time_step(field: &Field<'_>, end_time_s: f64) -> Result<Option<f64>> {
    if matches!(&field.node.value, Value::Text(text) if text == "auto") {
        return Ok(None);
    }
    let remedy = "write \"auto\" or a time such as \"1 us\"";
    if field.is_word() {
        return Err(field.wrong("\"auto\" or a time", remedy));
    }
    let step_s = field.limited(&TIME, |step| step > 0.0, "more than 0 s", remedy)?;
    if step_s > end_time_s {
        let limit = format!("at most run.end_time, {end_time_s} s");
        return Err(field.wrong(&limit, "write \"auto\" or a shorter time"));
    }
    Ok(Some(step_s))
}
