//! The time steps of Platzer 2022 against the largest stable ones.

use std::collections::BTreeMap;
use std::path::Path;

use dem_io::Body;
use dem_run::plan;
use dem_scene::{Scene, read_bodies};
use serde_json::{Value, json};

use super::bench::{Bench, Failed, read, scene};
use super::samples::{BARE, Sample, Table as Spheres};
use super::text::{Table, number, rounded};

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

const TABLES: [Spheres; 2] = [Spheres::One, Spheres::Two];

pub(crate) fn sets(table: Spheres, damping: &str) -> Vec<String> {
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
    std::fs::write(bench.results.join(FILE), serde_json::to_vec(&all)?)?;
    Ok(())
}

/// The largest stable time step of a scene, s.
pub(crate) fn limit_s(scene: &Scene, bodies: BTreeMap<String, Body>) -> Result<f64, Failed> {
    Ok(plan(scene, bodies, 1, false)?.step.limit.step_s)
}

pub(crate) fn table(results: &Path) -> Table {
    let all = read(&results.join(FILE)).unwrap_or_default();
    let limit = |table: Spheres, damping: &str| {
        let is = |entry: &&Value| entry["table"] == table.number() && entry["damping"] == damping;
        let found = all.as_array().and_then(|all| all.iter().find(is).cloned());
        rounded(
            1e6 * found.map_or(f64::NAN, |entry| number(&entry["limit_s"])),
            2,
        )
    };
    let mut rows = vec![
        ["step of Platzer 2022", "2", "4"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for (name, _) in DAMPING {
        rows.push(vec![
            name.to_owned(),
            limit(Spheres::One, name),
            limit(Spheres::Two, name),
        ]);
    }
    Table {
        word: "steps",
        head: &["damping of the bonds", "table 1, us", "table 2, us"],
        names: 1,
        rows,
    }
}
