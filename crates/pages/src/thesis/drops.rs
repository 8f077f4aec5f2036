//! Drops onto an inclined plate, with and without the dynamic increase factor.

use std::path::Path;
use std::time::Instant;

use dem_run::state::clusters::fragments;
use dem_run::step::{advance, interact};
use dem_run::{balance, plan};
use dem_scene::{Scene, read_bodies};
use serde_json::{Value, json};

use super::bending::READINGS;
use super::samples::{BARE, PACKINGS, Sample, Table, scene};
use super::watch::Watch;
use crate::bench::{Bench, Failed};
use crate::cells::cells;

/// A fall of Platzer 2022. The sample begins just above the plate.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fall {
    pub(crate) name: &'static str,
    pub(crate) angle: &'static str,
    /// Settings of the scene.
    pub(crate) sets: &'static [&'static str],
}

const UPRIGHT: &str = "bodies.sample.rotation={axis=[0,1,0],angle=\"-90 deg\"}";

pub(crate) const FALLS: [Fall; 4] = [
    Fall {
        name: "15-flat",
        angle: "15 deg",
        sets: &["bodies.sample.position=[\"-90 mm\",\"-15 mm\",\"26 mm\"]"],
    },
    Fall {
        name: "15-upright",
        angle: "15 deg",
        sets: &[
            UPRIGHT,
            "bodies.sample.position=[\"17.5 mm\",\"-15 mm\",\"6 mm\"]",
        ],
    },
    Fall {
        name: "25-flat",
        angle: "25 deg",
        sets: &["bodies.sample.position=[\"-90 mm\",\"-15 mm\",\"44 mm\"]"],
    },
    Fall {
        name: "25-upright",
        angle: "25 deg",
        sets: &[
            UPRIGHT,
            "bodies.sample.position=[\"17.5 mm\",\"-15 mm\",\"10 mm\"]",
        ],
    },
];

/// Damping ratios of the bonds: the largest round one with which the steps of Platzer 2022 are
/// stable, and the printed one.
pub(crate) const DAMPING: [&str; 2] = ["0.2", "0.6"];

/// A row of the page: drops that differ by packing and fall only.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    pub(crate) sample: Sample,
    pub(crate) packings: u32,
    pub(crate) reading: &'static str,
    pub(crate) damping: &'static str,
    /// With the dynamic increase factor.
    pub(crate) dif: bool,
}

pub(crate) fn rows() -> Vec<Row> {
    let fine = Row {
        sample: BARE,
        packings: 1,
        reading: READINGS[0],
        damping: DAMPING[0],
        dif: true,
    };
    let coarse = Row {
        sample: Sample {
            table: Table::Two,
            ..BARE
        },
        packings: PACKINGS,
        ..fine
    };
    let mut rows = Vec::new();
    for damping in DAMPING {
        for reading in READINGS {
            rows.push(Row {
                reading,
                damping,
                ..coarse
            });
        }
    }
    for reading in READINGS {
        rows.push(Row {
            reading,
            dif: false,
            packings: 1,
            ..coarse
        });
    }
    for reading in [READINGS[0], READINGS[1]] {
        for dif in [true, false] {
            rows.push(Row {
                reading,
                dif,
                ..fine
            });
        }
    }
    rows
}

impl Row {
    /// The first cells of its row.
    pub(crate) fn title(&self) -> Vec<String> {
        let table = self.sample.table.number();
        cells(&format!("{table} | `{}` | {}", self.reading, self.damping))
    }

    pub(crate) fn name(&self, fall: &str, seed: u32) -> String {
        let Self {
            sample,
            reading,
            damping,
            ..
        } = self;
        let dif = if self.dif { "dif" } else { "static" };
        let table = sample.table.number();
        format!(
            "drop-{table}-{}-{reading}-{damping}-{dif}-{fall}-{seed}",
            sample.texture()
        )
    }

    /// Settings of the scene.
    pub(crate) fn sets(&self, fall: &Fall) -> Vec<String> {
        let mut sets = self.sample.table.sets();
        sets.push(format!(
            "bonds.cake.failure.equivalent_stress=\"{}\"",
            self.reading
        ));
        sets.push(format!(
            "bonds.cake.damping={{damping_ratio={}}}",
            self.damping
        ));
        sets.push(format!("walls.plate.rotation.angle=\"{}\"", fall.angle));
        if !self.dif {
            sets.push("bonds.cake.failure.rate_strengthening=false".to_owned());
        }
        sets.extend(fall.sets.iter().map(|set| (*set).to_owned()));
        sets
    }
}

pub(crate) fn compute(bench: &Bench) -> Result<(), Failed> {
    for row in rows() {
        for fall in FALLS {
            for seed in 1..=row.packings {
                let name = row.name(fall.name, seed);
                let sample = Sample { seed, ..row.sample };
                sample.keep(bench, &name, |body| drop(body, &row.sets(&fall)))?;
            }
        }
    }
    Ok(())
}

/// Drops a sample, and says what became of it.
fn drop(body: &Path, sets: &[String]) -> Result<Value, Failed> {
    let scene: Scene = scene("drop", Some(body), sets)?;
    let started = Instant::now();
    let mut state = plan(&scene, read_bodies(&scene)?, 1, false)?.state;
    let mut watch = Watch::new(&state);
    let (mut first_s, mut last_s) = (None, None);
    while state.time_s < scene.run.end_time_s {
        interact(&mut state);
        watch.look(&state);
        if !state.scratch.events.broken.is_empty() {
            first_s = first_s.or(Some(state.time_s));
            last_s = Some(state.time_s);
        }
        advance(&mut state);
    }
    let energy_error = balance(&mut state).energy_error;
    let clusters = state.clusters.as_ref().ok_or("no clusters")?;
    let pieces = fragments::fragments(clusters, &state.particles, &state.clumps, None);
    let masses_kg = || pieces.iter().map(|piece| piece.mass_kg);
    Ok(json!({
        "spheres": state.particles.poses.len(),
        "bonds": state.bonds.len(),
        "steps": state.steps,
        "time_step_s": state.time_step_s,
        "seconds": started.elapsed().as_secs_f64(),
        "energy_error": energy_error,
        "broken": state.broken_count,
        "first_broken_s": first_s,
        "last_broken_s": last_s,
        "pieces": pieces.len(),
        "largest": masses_kg().fold(0.0, f64::max) / masses_kg().sum::<f64>(),
        "utilisation": watch.report(),
    }))
}
