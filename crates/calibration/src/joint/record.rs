//! The record of a calibration by several tests, so that it can be resumed.

use std::path::Path;

use dem_io::safe_write::write_file;
use dem_io::{Diagnostic, Result, read_input};

use super::state::Joint;
use crate::case::{Round, Trial};

/// Version of the format of [`Joint`].
pub const JOINT_VERSION: u32 = 1;

/// Writes a record as JSON, whole or not at all.
pub fn write_joint(path: &Path, joint: &Joint) -> Result<()> {
    write_file(path, |out| {
        let text = serde_json::to_string(joint).map_err(std::io::Error::other)?;
        writeln!(out, "{text}")
    })
}

/// Reads what [`write_joint`] wrote; refuses other files, other versions, and rounds without all of
/// their numbers.
pub fn read_joint(path: &Path) -> Result<Joint> {
    let refuse = |problem: String| {
        let remedy = "name the .json file that dem-run calibrate wrote, or leave out --resume";
        Diagnostic::input(path.display().to_string(), problem, remedy)
    };
    let bytes = read_input(path, "the record of a calibration")?;
    let joint: Joint = serde_json::from_slice(&bytes).map_err(|error| {
        refuse(format!(
            "is not the record of a calibration by several tests: {error}"
        ))
    })?;
    if joint.version != JOINT_VERSION {
        return Err(refuse(format!(
            "has version {}, not {JOINT_VERSION}",
            joint.version
        )));
    }
    if !has_all_entries(&joint) {
        return Err(refuse("has rounds without all of their numbers".to_owned()));
    }
    Ok(joint)
}

/// Whether every number that counts another one is there.
fn has_all_entries(joint: &Joint) -> bool {
    let (count, aims, jobs) = (joint.unknowns.len(), joint.aims.len(), joint.jobs());
    let of_trial = |trial: &Trial| trial.results.len() == aims && trial.at_least.len() == aims;
    let of_round = |round: &Round| {
        let mut trials = round.trials.iter().flatten();
        round.factors.len() == count && round.trials.len() == jobs && trials.all(of_trial)
    };
    let starts = joint.start.as_ref();
    let ends = joint.end.as_ref();
    let mut rounds = joint.rounds.iter().chain(&joint.at_twice_the_rate);
    starts.is_none_or(|start| start.factors.len() == count)
        && ends.is_none_or(|(at, _)| *at < joint.rounds.len().max(1))
        && joint.unknowns.iter().all(|one| !one.numbers.is_empty())
        && (joint.aims.iter()).all(|aim| aim.test < joint.tests.len() && aim.slopes.len() == count)
        && rounds.all(of_round)
}
