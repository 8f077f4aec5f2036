//! The samples: which spheres, which texture, which bonds.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use super::bench::{Bench, Failed};
use super::programs::output;

/// The sphere sizes and bonds of a table of Platzer 2022; its printed sizes are radii.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Table {
    One,
    Two,
}

impl Table {
    pub(crate) fn number(self) -> u8 {
        match self {
            Self::One => 1,
            Self::Two => 2,
        }
    }

    fn spheres(self) -> [&'static str; 4] {
        match self {
            Self::One => ["--diameter", "1.4mm..2.0mm", "--overlap", "0.25"],
            Self::Two => ["--diameter", "4mm..6mm", "--overlap", "0.296"],
        }
    }

    /// The critical equivalent stress, Pa.
    pub(crate) fn strength_pa(self) -> f64 {
        match self {
            Self::One => 0.21e6,
            Self::Two => 0.185e6,
        }
    }

    /// Settings of a scene, which has the bonds of table 1.
    pub(crate) fn sets(self) -> Vec<String> {
        let sets: &[&str] = match self {
            Self::One => &[],
            Self::Two => &[
                "bonds.cake.young_modulus=15 MPa",
                "bonds.cake.failure.von_mises_strength=0.185 MPa",
            ],
        };
        sets.iter().map(|set| (*set).to_owned()).collect()
    }
}

/// A packed sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    pub(crate) table: Table,
    /// 200 mm long for the bending test, otherwise 180 mm.
    pub(crate) long: bool,
    /// The bare front, as in Platzer 2022, or densified.
    pub(crate) bare: bool,
    /// `--bond-range`
    pub(crate) bond_range: &'static str,
    pub(crate) seed: u32,
}

/// The touching spheres of a bare front are bonded.
pub(crate) const BARE: Sample = Sample {
    table: Table::One,
    long: false,
    bare: true,
    bond_range: "1.0",
    seed: 1,
};

/// Number of packings of each kind for a mean and its scatter: `--seed 1` to `--seed 4`.
pub(crate) const PACKINGS: u32 = 4;

impl Sample {
    pub(crate) fn texture(&self) -> &'static str {
        if self.bare { "bare" } else { "densified" }
    }

    pub(crate) fn name(&self) -> String {
        let shape = if self.long { "long" } else { "short" };
        let table = self.table.number();
        let [texture, range] = [self.texture(), self.bond_range];
        format!("{shape}-{table}-{texture}-{range}-{}", self.seed)
    }

    /// What `dem-pack` is asked for.
    pub(crate) fn options(&self) -> Vec<String> {
        let shape = if self.long {
            "long-bending-sample"
        } else {
            "bending-sample"
        };
        let mut options = vec![format!("data/shapes/{shape}.stl")];
        options.extend(self.table.spheres().map(str::to_owned));
        options.extend(["--bond-range", self.bond_range].map(str::to_owned));
        if self.bare {
            options.extend(["--densify", "0"].map(str::to_owned));
        }
        options.extend(["--seed".to_owned(), self.seed.to_string()]);
        options
    }

    /// Computes a result from its file and writes it as JSON, if the name of the result contains
    /// `part` and the result is not there.
    pub(crate) fn keep(
        &self,
        bench: &Bench,
        name: &str,
        part: &str,
        compute: impl FnOnce(&Path) -> Result<Value, Failed>,
    ) -> Result<(), Failed> {
        let file = bench.results.join(format!("{name}.json"));
        if !name.contains(part) || file.exists() {
            return Ok(());
        }
        let body = self.packed(bench)?;
        eprintln!("{name}");
        let result = compute(&body)?;
        Ok(std::fs::write(file, serde_json::to_vec(&result)?)?)
    }

    /// Its file, which is packed if that has not been done; the report stands next to it, as JSON.
    pub(crate) fn packed(&self, bench: &Bench) -> Result<PathBuf, Failed> {
        let body = bench.results.join(format!("{}.vtp", self.name()));
        let report = body.with_extension("json");
        if !report.exists() {
            let mut command = Command::new(&bench.programs.dem_pack);
            command.args(self.options()).args(["--json", "-o"]);
            let said = output(command.arg(&body))?;
            std::fs::write(report, said)?;
        }
        Ok(body)
    }
}

/// Samples of 180 mm whose spheres and bonds are counted.
pub(crate) fn counted() -> Vec<(&'static str, Vec<Sample>)> {
    let seeds = |of: Sample| (1..=PACKINGS).map(|seed| Sample { seed, ..of }).collect();
    let table_2 = Sample {
        table: Table::Two,
        ..BARE
    };
    vec![
        ("table 1, bare front, bond range 1.0", seeds(BARE)),
        (
            "table 1, bare front, bond range 1.1",
            vec![Sample {
                bond_range: "1.1",
                ..BARE
            }],
        ),
        (
            "table 1, densified, bond range 1.0",
            seeds(Sample {
                bare: false,
                ..BARE
            }),
        ),
        ("table 2, bare front, bond range 1.0", seeds(table_2)),
        (
            "table 2, densified, bond range 1.0",
            seeds(Sample {
                bare: false,
                ..table_2
            }),
        ),
    ]
}

pub(crate) fn compute(bench: &Bench, part: &str) -> Result<(), Failed> {
    let all = counted().into_iter().flat_map(|(_, samples)| samples);
    for sample in all.filter(|sample| sample.name().contains(part)) {
        sample.packed(bench)?;
    }
    Ok(())
}
