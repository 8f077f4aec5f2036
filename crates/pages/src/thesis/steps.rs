//! The time steps of Platzer 2022 against the largest stable ones.

use std::collections::BTreeMap;
use std::path::Path;

use dem_io::Body;
use dem_run::plan;
use dem_scene::{Scene, read_bodies};
use serde_json::{Value, json};

use super::samples::{BARE, Sample, Table, scene};
use crate::bench::{Bench, Failed, keep, number, read};
use crate::cells::rounded;

pub(crate) const FILE: &str = "steps.json";
/// Damping: in the table, and in the scene.
pub(crate) const DAMPING: [(&str, &str); 6] = [
    ("none", "damping_ratio=0"),
    ("0.2 of critical", "damping_ratio=0.2"),
    ("0.25 of critical", "damping_ratio=0.25"),
    ("0.3 of critical", "damping_ratio=0.3"),
    ("0.6 of critical", "damping_ratio=0.6"),
    (
        "0.6 N s/m in eq. 7, and eq. 9",
        "damping_coefficient=\"0.6 N s/m\",torque_factor=1",
    ),
];

const TABLES: [Table; 2] = [Table::One, Table::Two];

pub(crate) fn sets(table: Table, damping: &str) -> Vec<String> {
    let mut sets = table.sets();
    sets.push(format!("bonds.cake.damping={{{damping}}}"));
    sets
}

pub(crate) fn compute(bench: &Bench) -> Result<(), Failed> {
    let mut all = Vec::new();
    for table in TABLES {
        let body = Sample { table, ..BARE }.packed(bench)?;
        for (name, damping) in DAMPING {
            let scene = scene("drop", Some(&body), &sets(table, damping))?;
            let limit_s = limit_s(&scene, read_bodies(&scene)?)?;
            all.push(json!({ "table": table.number(), "damping": name, "limit_s": limit_s }));
        }
    }
    keep(&bench.folder.join(FILE), &all.into())
}

/// The largest stable time step of a scene, s.
pub(crate) fn limit_s(scene: &Scene, bodies: BTreeMap<String, Body>) -> Result<f64, Failed> {
    Ok(plan(scene, bodies, 1, false)?.step.limit.step_s)
}

/// The largest stable step that has been computed, us.
pub(crate) fn limit_us(results: &Path, table: Table, damping: &str) -> String {
    let all = read(&results.join(FILE)).unwrap_or_default();
    let is = |entry: &&Value| entry["table"] == table.number() && entry["damping"] == damping;
    let found = all.as_array().and_then(|all| all.iter().find(is));
    rounded(
        1e6 * found.map_or(f64::NAN, |entry| number(&entry["limit_s"])),
        2,
    )
}
