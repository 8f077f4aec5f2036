//! Bonds of each size of spheres, calibrated on a bar that is pulled apart.

use std::path::Path;

use dem_calibration::{Record, read_record};

use super::spheres::{ACROSS, THICKNESS_M, diameter_m, diameters};
use crate::bench::{Bench, Failed, ONE_THREAD, root, sets};
use crate::cells::{change, scattered, thousands};
use crate::table::{Table, write};

pub(super) const PAGE: &str = "tests/verification/resolution.md";
const STORED: &str = "tests/resolution/bonds.csv";
/// Packings of the bar for each size.
const PACKINGS: [u32; 4] = [4, 4, 3, 2];
/// Length of the bar, m.
const LENGTH_M: f64 = 0.06;
/// Fracture energy of bonds that soften, J/m2.
const FRACTURE_ENERGY_J_M2: f64 = 5.0;
/// Spheres across for which bonds are found that all sizes take.
const HELD: f64 = 9.0;

/// Bonds by how they fail, and what they were calibrated for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bonds {
    /// They break at their strength. Calibrated for each size.
    Brittle,
    /// They soften with the same fracture energy. Calibrated for each size.
    Softening,
    /// Brittle, and the same for all sizes.
    Held,
}

impl Bonds {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Brittle => "brittle",
            Self::Softening => "5 J/m2",
            Self::Held => "brittle, those of 9",
        }
    }

    /// Its name as a part of one of a file.
    pub(super) fn file_name(self) -> &'static str {
        match self {
            Self::Brittle => "brittle",
            Self::Softening => "softening",
            Self::Held => "held",
        }
    }

    fn failure(self, strength_pa: f64) -> String {
        let energy = match self {
            Self::Softening => format!(",fracture_energy={FRACTURE_ENERGY_J_M2}"),
            Self::Brittle | Self::Held => String::new(),
        };
        format!("bonds.cake.failure={{tensile_strength={strength_pa}{energy}}}")
    }

    /// Strength with which the calibration begins, Pa.
    fn guess_pa(self, size: usize) -> f64 {
        match self {
            Self::Softening => [60e3, 38e3, 32e3, 28e3][size],
            Self::Brittle | Self::Held => [74e3, 63e3, 58e3, 55e3][size],
        }
    }

    /// The keys of a scene that give it the stored bonds.
    pub(super) fn sets(self, across: f64) -> Result<[String; 2], Failed> {
        let (of, across) = match self {
            Self::Held => (Self::Brittle, HELD),
            Self::Brittle | Self::Softening => (self, across),
        };
        let text = std::fs::read_to_string(root().join(STORED))?;
        let row = format!("{},{across},", of.file_name());
        let row = text.lines().find_map(|line| line.strip_prefix(&row));
        let row = row.ok_or("no such bonds are stored")?;
        let (young_pa, strength_pa) = row.split_once(',').ok_or("a stored row is too short")?;
        Ok([
            format!("bonds.cake.young_modulus={young_pa}"),
            self.failure(strength_pa.parse()?),
        ])
    }
}

const CALIBRATED: [Bonds; 2] = [Bonds::Brittle, Bonds::Softening];

/// The first cell of a row.
pub(super) fn label(bonds: Bonds, across: f64) -> String {
    format!("{}, {across}", bonds.name())
}

pub(super) fn table() -> Table {
    let head = "bonds, spheres across | diameter, mm | packings | spheres | tests | \
        modulus of bonds, MPa | strength of bonds, kPa | their E G_f/sigma_t², mm | \
        modulus off | strength off | strength, kPa";
    let rows = CALIBRATED.map(|bonds| ACROSS.map(|across| label(bonds, across)));
    Table::new(PAGE, "resolution bonds", head, rows.concat())
}

/// Calibrates both kinds of bonds for each size of spheres, and stores them.
pub(crate) fn calibrate(bench: &Bench) -> Result<(), Failed> {
    let mut table = table();
    let mut text = "bonds,across,young_modulus_pa,strength_pa\n".to_owned();
    for bonds in CALIBRATED {
        for (size, across) in ACROSS.into_iter().enumerate() {
            let name = format!("{}-{across}.toml", bonds.file_name());
            let file = bench.folder.join(name);
            let record = file.with_extension("json");
            if !(bench.has(&record) && is_complete(&record)?) {
                bench.command_or_miss(&words(bonds, size, &file))?;
            }
            let record = read_record(&record)?;
            let [young_pa, strength_pa] = found(&record)?;
            text += &format!(
                "{},{across},{:.0},{strength_pa:.0}\n",
                bonds.file_name(),
                10.0 * (0.1 * young_pa).round()
            );
            table.row(row(&record, size, bonds, [young_pa, strength_pa])?);
        }
    }
    std::fs::write(root().join(STORED), text)?;
    write(&[table])
}

/// Whether a calibration came to its end.
fn is_complete(record: &Path) -> Result<bool, Failed> {
    let record = read_record(record)?;
    Ok(record.cases.first().is_some_and(|case| case.end.is_some()))
}

/// The command of a calibration.
fn words(bonds: Bonds, size: usize, file: &Path) -> Vec<String> {
    let (across, packings) = (ACROSS[size], PACKINGS[size]);
    let grip_m = diameter_m(across);
    let mut words = vec![
        "calibrate".to_owned(),
        "tests/resolution/tension.toml".to_owned(),
        format!("--packings={packings}"),
    ];
    words.extend(sets(&[
        bonds.failure(bonds.guess_pa(size)),
        format!("groups.lower-grip.box.max=[1,1,{grip_m:.9}]"),
        format!("groups.upper-grip.box.min=[-1,-1,{:.9}]", LENGTH_M - grip_m),
    ]));
    let output = file.display().to_string();
    let shape = "data/shapes/bar.stl";
    words.extend([ONE_THREAD, "--force", "-o", &output, "--", shape].map(str::to_owned));
    words.push(format!("--diameter={}", diameters(across)));
    words
}

/// Modulus and strength of the bonds that a calibration found, Pa.
fn found(record: &Record) -> Result<[f64; 2], Failed> {
    let case = record.cases.first().ok_or("a record without a case")?;
    let round = case.result().ok_or("a calibration without a round")?;
    let pa = |at: usize| {
        let number = &record.unknowns[at].numbers[0];
        let unit_pa = match number.unit.as_str() {
            "MPa" => 1e6,
            "kPa" => 1e3,
            _ => 1.0,
        };
        number.value * round.factors[at] * unit_pa
    };
    Ok([pa(0), pa(1)])
}

/// The cells of a calibration behind its name.
fn row(
    record: &Record,
    size: usize,
    bonds: Bonds,
    [young_pa, strength_pa]: [f64; 2],
) -> Result<Vec<String>, Failed> {
    let case = record.cases.first().ok_or("a record without a case")?;
    let round = case.result().ok_or("a calibration without a round")?;
    let tests: usize = case.rounds.iter().map(|round| round.trials.len()).sum();
    let trials = round.trials.iter().flatten();
    let strengths_kpa = trials.map(|trial| trial.results[1].map_or(f64::NAN, |pa| 1e-3 * pa));
    let strengths_kpa: Vec<f64> = strengths_kpa.collect();
    let mut cells = vec![
        format!("{:.2}", 1e3 * THICKNESS_M / ACROSS[size]),
        PACKINGS[size].to_string(),
        thousands(case.particles as f64),
        tests.to_string(),
        format!("{:.2}", 1e-6 * young_pa),
        format!("{:.1}", 1e-3 * strength_pa),
        match bonds {
            Bonds::Softening => {
                let length_m = young_pa * FRACTURE_ENERGY_J_M2 / strength_pa.powi(2);
                format!("{:.0}", 1e3 * length_m)
            }
            Bonds::Brittle | Bonds::Held => String::new(),
        },
    ];
    let deviations = round.deviations(&record.unknowns).into_iter();
    cells.extend(deviations.map(|off| off.map_or_else(String::new, |off| change(off, 1))));
    cells.push(scattered(&strengths_kpa, 1, ""));
    Ok(cells)
}
