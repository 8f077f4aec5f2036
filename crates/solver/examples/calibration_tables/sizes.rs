//! Bonds calibrated for spheres of several sizes: the record of `dem-run calibrate` as a table.

use std::path::Path;
use std::process::Command;

use dem_calibration::{Record, read_record, sizes};

use super::bench::Bench;
use super::programs::{Failed, output};
use super::table::Table;

const SIZES: [&str; 3] = ["7mm..9mm", "5mm..7mm", "3.5mm..4.5mm"];
/// Measured curves, with the dimensions of their specimens.
const LAB: [&str; 14] = [
    "data/measured/a.csv",
    "data/measured/b.txt",
    "data/measured/c.csv",
    "--quiet",
    "--type",
    "four-point-bending",
    "--support-span",
    "180mm",
    "--loading-span",
    "80mm",
    "--width",
    "30mm",
    "--height",
    "35mm",
];
const PACK: [&str; 6] = [
    "--",
    "data/shapes/bending-sample.stl",
    "--overlap",
    "0.296",
    "--bond-range",
    "1.0",
];

pub(crate) fn table() -> Result<Table, Failed> {
    let bench = Bench::new()?;
    let record = bench.results.join("sizes.json");
    if !read_record(&record).is_ok_and(|record| has_ended(&record)) {
        calibrate(&bench, &record)?;
    }
    let table = sizes(&read_record(&record)?);
    Ok(Table {
        word: "sizes",
        head: table
            .columns
            .into_iter()
            .map(|column| column.name)
            .collect(),
        rows: table.rows.into_iter().map(|row| row.cells).collect(),
    })
}

fn has_ended(record: &Record) -> bool {
    record.cases.iter().all(|case| case.end.is_some())
}

/// The commands of the page.
fn calibrate(bench: &Bench, record: &Path) -> Result<(), Failed> {
    let measured = bench.results.join("measured.json");
    if !measured.exists() {
        let mut command = Command::new(&bench.programs.dem_run);
        command.arg("lab").args(LAB).arg("-o").arg(&measured);
        output(&mut command)?;
    }
    let mut command = Command::new(&bench.programs.dem_run);
    command.args(["calibrate", "data/scenes/four-point-bending.toml"]);
    let set = format!("test.measured={:?}", measured.display().to_string());
    command.args(["--set", &set, "--threads", "1", "--quiet"]);
    command.arg("-o").arg(record.with_extension("toml"));
    if record.exists() {
        command.arg("--resume");
    }
    for size in SIZES {
        command.args(["--size", size]);
    }
    output(command.args(PACK)).map(|_| ())
}
