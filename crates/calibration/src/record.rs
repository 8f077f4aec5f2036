//! The record of a calibration: everything that was found, so that it can be resumed.

use std::path::Path;

use dem_io::safe_write::write_file;
use dem_io::{Diagnostic, Result, read_input};
use serde::{Deserialize, Serialize};

use crate::case::{Case, Round};
use crate::unknown::Unknown;

/// Version of the format of [`Record`].
pub const FORMAT_VERSION: u32 = 2;

/// The record of a calibration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Version of this format.
    pub version: u32,
    /// Program and its version.
    pub program: String,
    /// Day on which it began, as in 2026-01-31.
    pub date: String,
    /// Hash of the scene, its files and the packings: a calibration of something else cannot be
    /// resumed.
    pub identity: u64,
    /// The scene's file.
    pub scene: String,
    /// What is varied, and what it is to give.
    pub unknowns: Vec<Unknown>,
    /// Names of the packings.
    pub packings: Vec<String>,
    /// How they were made: the arguments of `dem-pack`. Empty: they were given.
    pub packed_with: String,
    /// The wanted curve: displacement, m, and load, N. Empty: there is none.
    pub wanted_curve: Vec<[f64; 2]>,
    /// The calibrations, one for each size of spheres, from coarse to fine.
    pub cases: Vec<Case>,
}

impl Record {
    /// The record without its curves.
    pub fn without_curves(&self) -> Self {
        let mut record = self.clone();
        record.wanted_curve.clear();
        for case in &mut record.cases {
            let rounds = case.rounds.iter_mut().chain(&mut case.at_twice_the_rate);
            for trial in rounds.flat_map(|round| round.trials.iter_mut().flatten()) {
                trial.curve.clear();
            }
        }
        record
    }
}

/// Writes a record as JSON, whole or not at all.
pub fn write_record(path: &Path, record: &Record) -> Result<()> {
    write_file(path, |out| {
        let text = serde_json::to_string(record).map_err(std::io::Error::other)?;
        writeln!(out, "{text}")
    })
}

/// Reads what [`write_record`] wrote; refuses other files, other versions, and rounds without all
/// of their numbers.
pub fn read_record(path: &Path) -> Result<Record> {
    let refuse = |problem: String| {
        let remedy = "name the .json file that dem-run calibrate wrote, or leave out --resume";
        Diagnostic::input(path.display().to_string(), problem, remedy)
    };
    let bytes = read_input(path, "the record of a calibration")?;
    let record: Record = serde_json::from_slice(&bytes)
        .map_err(|error| refuse(format!("is not the record of a calibration: {error}")))?;
    if record.version != FORMAT_VERSION {
        return Err(refuse(format!(
            "has version {}, not {FORMAT_VERSION}",
            record.version
        )));
    }
    if !has_all_entries(&record) {
        return Err(refuse("has rounds without all of their numbers".to_owned()));
    }
    Ok(record)
}

/// Whether every round has a factor and a result for each unknown, and a test for each packing.
fn has_all_entries(record: &Record) -> bool {
    let count = record.unknowns.len();
    let is_whole = |round: &Round| {
        let mut trials = round.trials.iter().flatten();
        round.factors.len() == count
            && round.trials.len() == record.packings.len()
            && trials.all(|trial| trial.results.len() == count && trial.at_least.len() == count)
    };
    let is_number = |unknown: &Unknown| !unknown.numbers.is_empty();
    let of_case = |case: &Case| {
        let starts = case
            .start
            .as_ref()
            .is_none_or(|start| start.factors.len() == count && start.slopes.len() == count);
        let ends = case
            .end
            .as_ref()
            .is_none_or(|(at, _)| *at < case.rounds.len().max(1));
        let mut rounds = case.rounds.iter().chain(&case.at_twice_the_rate);
        starts && ends && rounds.all(is_whole)
    };
    record.unknowns.iter().all(is_number) && record.cases.iter().all(of_case)
}
