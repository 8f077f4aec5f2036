//! Drops onto an inclined plate, with and without the dynamic increase factor.

use std::path::Path;

use dem_run::plan;
use dem_run::state::clusters::fragments;
use dem_run::step::{advance, interact};
use dem_scene::read_bodies;
use serde_json::{Value, json};

use super::bending::READINGS;
use super::samples::{BARE, COARSE, PACKINGS, Sample, Table, scene};
use super::watch::Watch;
use crate::bench::{Bench, Failed};
use crate::cells::cells;

/// A fall of Platzer 2022: its name, the angle of the plate, whether the sample stands, and where
/// it begins just above the plate, mm.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fall(pub(crate) &'static str, u32, bool, [f64; 3]);

pub(crate) const FALLS: [Fall; 4] = [
    Fall("15-flat", 15, false, [-90.0, -15.0, 26.0]),
    Fall("15-upright", 15, true, [17.5, -15.0, 6.0]),
    Fall("25-flat", 25, false, [-90.0, -15.0, 44.0]),
    Fall("25-upright", 25, true, [17.5, -15.0, 10.0]),
];

impl Fall {
    /// Settings of the scene.
    pub(crate) fn sets(&self) -> Vec<String> {
        let Self(_, angle, is_upright, [x, y, z]) = self;
        let mut sets = vec![
            format!("walls.plate.rotation.angle=\"{angle} deg\""),
            format!("bodies.sample.position=[\"{x} mm\",\"{y} mm\",\"{z} mm\"]"),
        ];
        if *is_upright {
            sets.push("bodies.sample.rotation={axis=[0,1,0],angle=\"-90 deg\"}".to_owned());
        }
        sets
    }
}

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

/// Drops with the first reading and the factor.
pub(crate) const fn row(sample: Sample, damping: &'static str) -> Row {
    Row {
        sample,
        packings: match sample.table {
            Table::One => 1,
            Table::Two => PACKINGS,
        },
        reading: READINGS[0],
        damping,
        dif: true,
    }
}

pub(crate) fn rows() -> Vec<Row> {
    let coarse = |damping| {
        READINGS.map(|reading| Row {
            reading,
            ..row(COARSE, damping)
        })
    };
    let mut rows = DAMPING.map(coarse).concat();
    rows.extend(coarse(DAMPING[0]).map(|row| Row {
        dif: false,
        packings: 1,
        ..row
    }));
    for reading in [READINGS[0], READINGS[1]] {
        rows.extend([true, false].map(|dif| Row {
            reading,
            dif,
            ..row(BARE, DAMPING[0])
        }));
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
        let dif = if self.dif { "dif" } else { "static" };
        let (table, texture) = (self.sample.table.number(), self.sample.texture());
        let [reading, damping] = [self.reading, self.damping];
        format!("drop-{table}-{texture}-{reading}-{damping}-{dif}-{fall}-{seed}")
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
        if !self.dif {
            sets.push("bonds.cake.failure.rate_strengthening=false".to_owned());
        }
        sets.extend(fall.sets());
        sets
    }
}

pub(crate) fn compute(bench: &Bench) -> Result<(), Failed> {
    for row in rows() {
        for fall in FALLS {
            for seed in 1..=row.packings {
                let name = row.name(fall.0, seed);
                let sample = Sample { seed, ..row.sample };
                sample.keep(bench, &name, |body| drop(body, &row.sets(&fall)))?;
            }
        }
    }
    Ok(())
}

/// Drops a sample, and says what became of it.
fn drop(body: &Path, sets: &[String]) -> Result<Value, Failed> {
    let scene = scene("drop", Some(body), sets)?;
    let mut state = plan(&scene, read_bodies(&scene)?, 1, false)?.state;
    let mut watch = Watch::new(&state);
    while state.time_s < scene.run.end_time_s {
        interact(&mut state);
        watch.look(&state);
        advance(&mut state);
    }
    let clusters = state.clusters.as_ref().ok_or("no clusters")?;
    let pieces = fragments::fragments(clusters, &state.particles, &state.clumps, None);
    let masses_kg = || pieces.iter().map(|piece| piece.mass_kg);
    Ok(json!({
        "broken": state.broken_count,
        "largest": masses_kg().fold(0.0, f64::max) / masses_kg().sum::<f64>(),
        "utilisation": watch.report(),
    }))
}
