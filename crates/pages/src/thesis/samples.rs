//! The samples: which spheres, which texture, which bonds.

use std::path::{Path, PathBuf};

use dem_scene::{Scene, read_scene};
use serde_json::Value;

use crate::bench::{Bench, Failed, keep, root};

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

    /// The same with bonds whose strength no stress reaches.
    pub(crate) fn unbreakable_sets(self) -> Vec<String> {
        let mut sets = self.sets();
        sets.retain(|set| !set.contains("failure"));
        sets.push("bonds.cake.failure={von_mises_strength=\"1 GPa\"}".to_owned());
        sets
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

/// The same of table 2.
pub(crate) const COARSE: Sample = Sample {
    table: Table::Two,
    ..BARE
};

/// Number of packings of each kind for a mean and its scatter: `--seed 1` to `--seed 4`.
pub(crate) const PACKINGS: u32 = 4;

impl Sample {
    pub(crate) fn texture(&self) -> &'static str {
        if self.bare { "bare" } else { "densified" }
    }

    /// As the page calls it.
    pub(crate) fn title(&self) -> String {
        let texture = if self.bare { "bare front" } else { "densified" };
        format!("table {}, {texture}", self.table.number())
    }

    pub(crate) fn name(&self) -> String {
        let shape = if self.long { "long" } else { "short" };
        let table = self.table.number();
        let [texture, range] = [self.texture(), self.bond_range];
        format!("{shape}-{table}-{texture}-{range}-{}", self.seed)
    }

    /// Its shape in `data/shapes`.
    pub(crate) fn shape(&self) -> &'static str {
        if self.long {
            "long-bending-sample"
        } else {
            "bending-sample"
        }
    }

    /// What `dem-pack` is asked for.
    pub(crate) fn options(&self) -> Vec<String> {
        let mut options = self.table.spheres().map(str::to_owned).to_vec();
        options.extend(["--bond-range", self.bond_range].map(str::to_owned));
        if self.bare {
            options.extend(["--densify", "0"].map(str::to_owned));
        }
        options.extend(["--seed".to_owned(), self.seed.to_string()]);
        options
    }

    /// Computes a result from its file and writes it as JSON, if the result is not there.
    #[allow(clippy::print_stderr, reason = "it says what it computes")]
    pub(crate) fn keep(
        &self,
        bench: &Bench,
        name: &str,
        compute: impl FnOnce(&Path) -> Result<Value, Failed>,
    ) -> Result<(), Failed> {
        let file = bench.folder.join(format!("{name}.json"));
        if file.exists() {
            return Ok(());
        }
        let body = self.packed(bench)?;
        eprintln!("{name}");
        keep(&file, &compute(&body)?)
    }

    /// Its file, which is packed if that has not been done.
    pub(crate) fn packed(&self, bench: &Bench) -> Result<PathBuf, Failed> {
        bench.pack(&self.name(), self.shape(), &self.options())
    }
}

/// A scene of `data/thesis` with these settings, and this sample if it has one.
pub(crate) fn scene(name: &str, body: Option<&Path>, sets: &[String]) -> Result<Scene, Failed> {
    let mut all = sets.to_vec();
    if let Some(body) = body {
        all.push(format!(
            "bodies.sample.file={:?}",
            body.display().to_string()
        ));
    }
    let file = root().join(format!("data/thesis/{name}.toml"));
    Ok(read_scene(&file, &all)?)
}

/// Samples of 180 mm whose spheres and bonds are counted: the packings of each kind.
pub(crate) fn counted() -> Vec<Vec<Sample>> {
    let further = Sample {
        bond_range: "1.1",
        ..BARE
    };
    let densified = |of: Sample| Sample { bare: false, ..of };
    let kinds = [BARE, further, densified(BARE), COARSE, densified(COARSE)];
    let packings = |of: Sample| match of.bond_range {
        "1.1" => 1,
        _ => PACKINGS,
    };
    let seeds = |of: Sample| {
        (1..=packings(of))
            .map(|seed| Sample { seed, ..of })
            .collect()
    };
    kinds.map(seeds).into()
}

pub(crate) fn compute(bench: &Bench) -> Result<(), Failed> {
    for sample in counted().into_iter().flatten() {
        sample.packed(bench)?;
    }
    Ok(())
}
