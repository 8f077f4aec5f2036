//! Four-point bending of both samples with the printed bonds.

use crate::bench::{Bench, Failed, ONE_THREAD, body, sets};

use super::samples::{BARE, COARSE, PACKINGS, Sample};

/// Readings of Platzer 2022, eq. 13: values of `equivalent_stress`. The first, eq. 13 at its word,
/// is that of the program unless given.
pub(crate) const READINGS: [&str; 4] = [
    "forces-only",
    "axial-in-tension",
    "tensile-edge",
    "bond-in-tension",
];

/// A row of the page: bending tests that differ by their packing only.
pub(crate) struct Row {
    pub(crate) sample: Sample,
    pub(crate) packings: u32,
    pub(crate) reading: &'static str,
}

pub(crate) fn rows() -> Vec<Row> {
    let fine = Sample { long: true, ..BARE };
    let coarse = Sample {
        long: true,
        ..COARSE
    };
    let densified = |of: Sample| Sample { bare: false, ..of };
    let row = |sample, packings, reading| Row {
        sample,
        packings,
        reading,
    };
    let further = Sample {
        bond_range: "1.1",
        ..fine
    };
    let mut rows = vec![
        row(fine, PACKINGS, READINGS[0]),
        row(fine, PACKINGS, READINGS[1]),
        row(further, 1, READINGS[0]),
        row(densified(fine), PACKINGS, READINGS[1]),
    ];
    for reading in READINGS {
        rows.push(row(coarse, PACKINGS, reading));
        rows.push(row(densified(coarse), PACKINGS, reading));
    }
    rows
}

impl Row {
    pub(crate) fn name(&self, seed: u32) -> String {
        let sample = self.sample;
        let [texture, range] = [sample.texture(), sample.bond_range];
        let table = sample.table.number();
        format!("bending-{table}-{texture}-{range}-{}-{seed}", self.reading)
    }

    /// Settings of the scene.
    pub(crate) fn sets(&self) -> Vec<String> {
        let mut sets = self.sample.table.sets();
        sets.insert(
            0,
            format!("bonds.cake.failure.equivalent_stress=\"{}\"", self.reading),
        );
        sets
    }
}

pub(crate) fn compute(bench: &Bench) -> Result<(), Failed> {
    for row in rows() {
        for seed in 1..=row.packings {
            let file = Sample { seed, ..row.sample }.packed(bench)?;
            let mut options = sets(&row.sets());
            options.extend([ONE_THREAD.to_owned(), body("sample", &file)]);
            let scene = "data/thesis/four-point-bending.toml";
            bench.run(&row.name(seed), scene, &options)?;
        }
    }
    Ok(())
}
