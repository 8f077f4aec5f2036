//! Drops onto an inclined plate, with and without the dynamic increase factor.

use std::path::Path;

use dem_run::physics::bond::strain_rate::{PLATZER_LOWEST_RATE_1_S, fast_branch};
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
    pub(crate) dif: Dif,
}

/// How the dynamic increase factor is applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Dif {
    No,
    /// That of the present strain rate.
    Present,
    /// The largest that a bond has had.
    Largest,
    /// The same, with the curve of eq. 20 going on above 50/s.
    LargestWithoutEnd,
}

impl Dif {
    /// As the page calls it.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::No => "no",
            Self::Present => "yes",
            Self::Largest => "largest so far",
            Self::LargestWithoutEnd => "largest so far, also above 50/s",
        }
    }

    /// As files call it.
    fn name(self) -> &'static str {
        match self {
            Self::No => "static",
            Self::Present => "dif",
            Self::Largest => "largest",
            Self::LargestWithoutEnd => "largest-without-end",
        }
    }

    /// Settings of the failure of bonds.
    fn sets(self) -> Vec<String> {
        let keeps = || "keeps_largest_factor=true".to_owned();
        match self {
            Self::No => vec!["rate_strengthening=false".to_owned()],
            Self::Present => Vec::new(),
            Self::Largest => vec![keeps()],
            Self::LargestWithoutEnd => vec![keeps(), format!("rate_strengthening={}", endless())],
        }
    }
}

/// The second branch of eq. 20 from 1.1/s up to 1000/s as a table; between its rows, a tenth of a
/// decade apart, it is up to 0.002 above the parabola.
fn endless() -> String {
    let first = [PLATZER_LOWEST_RATE_1_S.log10()];
    let lgs = first
        .into_iter()
        .chain((1..=30).map(|tenth| 0.1 * f64::from(tenth)));
    let rows = lgs.map(|lg| format!("[{:e},{}]", 10.0_f64.powf(lg), fast_branch(lg)));
    format!("[{}]", rows.collect::<Vec<_>>().join(","))
}

/// Drops with the first reading and the present factor.
pub(crate) const fn row(sample: Sample, damping: &'static str) -> Row {
    Row {
        sample,
        packings: match sample.table {
            Table::One => 1,
            Table::Two => PACKINGS,
        },
        reading: READINGS[0],
        damping,
        dif: Dif::Present,
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
        dif: Dif::No,
        packings: 1,
        ..row
    }));
    for reading in [READINGS[0], READINGS[1]] {
        rows.extend([Dif::Present, Dif::No].map(|dif| Row {
            reading,
            dif,
            ..row(BARE, DAMPING[0])
        }));
    }
    for dif in [Dif::Largest, Dif::LargestWithoutEnd] {
        let kept = |row| Row { dif, ..row };
        let coarse = row(COARSE, DAMPING[0]);
        rows.extend(
            READINGS[..2]
                .iter()
                .map(|reading| kept(Row { reading, ..coarse })),
        );
        rows.push(kept(row(COARSE, DAMPING[1])));
        rows.push(kept(row(BARE, DAMPING[0])));
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
        let dif = self.dif.name();
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
        let of_failure = self.dif.sets().into_iter();
        sets.extend(of_failure.map(|set| format!("bonds.cake.failure.{set}")));
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
