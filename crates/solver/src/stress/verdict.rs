//! What comes of the members of a case, against what was predicted of them.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use dem_io::Result;
use rayon::prelude::*;
use serde::Serialize;

use super::cases::Case;
use super::limit_map::largest_step_s;
use super::prediction::{Member, ObservationMethod, Prediction};
use super::trial::Outcome;

/// What was seen of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Observation {
    /// The run ended, and showed these values: those of the prediction, in its order; none where an
    /// end was not predicted.
    Ended(Vec<f64>),
    /// It was refused before it started: what was said.
    Refused(String),
    /// It was stopped: what was said.
    Stopped(String),
}

/// A member of a case after its run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judged {
    /// What sets it apart from the others of its case.
    pub what: String,
    /// What was predicted.
    pub predicted: Prediction,
    /// What was seen.
    pub observed: Observation,
    /// How far the worst value is off, in tolerances; 0 for what was refused or stopped as
    /// predicted.
    pub deviation: f64,
    /// What is wrong; None: it did as predicted.
    pub wrong: Option<String>,
}

/// A case after its runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseResult {
    /// Its name.
    pub name: &'static str,
    /// What is extreme about it.
    pub extreme: &'static str,
    /// Its members.
    pub members: Vec<Judged>,
    /// Wall time, s.
    pub wall_s: f64,
}

impl CaseResult {
    /// Members that did not do as predicted.
    pub fn wrong(&self) -> impl Iterator<Item = &Judged> {
        self.members.iter().filter(|member| member.wrong.is_some())
    }
}

/// Predicts, runs and judges all members of a case, on all threads.
///
/// # Errors
/// Interrupted, or files that cannot be written. A member that goes wrong is no error.
pub fn run_case(case: &Case, interrupted: &AtomicBool) -> Result<CaseResult> {
    let clock = Instant::now();
    let members = case.members(interrupted)?;
    let judged = members.par_iter().map(|member| judge(member, interrupted));
    Ok(CaseResult {
        name: case.name,
        extreme: case.extreme,
        members: judged.collect::<Result<_>>()?,
        wall_s: clock.elapsed().as_secs_f64(),
    })
}

/// Runs a member and compares.
///
/// # Errors
/// As [`run_case`].
pub fn judge(member: &Member, interrupted: &AtomicBool) -> Result<Judged> {
    let observed = match member.way {
        ObservationMethod::Run => match member.trial.run(interrupted)? {
            Outcome::Ended(summary) => Observation::Ended(match &member.prediction {
                Prediction::Ends(all) => all.iter().map(|one| one.quantity.of(&summary)).collect(),
                _ => Vec::new(),
            }),
            Outcome::Refused(said) => Observation::Refused(said),
            Outcome::Stopped(said) => Observation::Stopped(said),
        },
        ObservationMethod::LargestStep => {
            Observation::Ended(vec![largest_step_s(&member.trial, interrupted)?])
        }
    };
    let (deviation, wrong) = compare(&member.prediction, &observed);
    Ok(Judged {
        what: member.what.clone(),
        predicted: member.prediction.clone(),
        observed,
        deviation,
        wrong,
    })
}

/// How far what was seen is off, in tolerances, and what is wrong with it.
pub fn compare(predicted: &Prediction, observed: &Observation) -> (f64, Option<String>) {
    let (words, said) = match (predicted, observed) {
        (Prediction::Ends(all), Observation::Ended(values)) => {
            let off = all.iter().zip(values);
            let off = off.map(|(shown, value)| (shown.deviation(*value), shown));
            let worst = off.max_by(|a, b| a.0.total_cmp(&b.0));
            let wrong = worst.filter(|(deviation, _)| *deviation > 1.0);
            let wrong = wrong.map(|(_, shown)| format!("{} is off", shown.quantity.name()));
            return (worst.map_or(0.0, |(deviation, _)| deviation), wrong);
        }
        (Prediction::Refused(words), Observation::Refused(said))
        | (Prediction::Stopped(words), Observation::Stopped(said)) => (words, said),
        (_, Observation::Ended(_)) => return (f64::INFINITY, Some("ended in silence".to_owned())),
        (_, Observation::Refused(said)) => {
            return (f64::INFINITY, Some(format!("was refused: {said}")));
        }
        (_, Observation::Stopped(said)) => {
            return (f64::INFINITY, Some(format!("was stopped: {said}")));
        }
    };
    match words.iter().find(|word| !said.contains(word.as_str())) {
        None => (0.0, None),
        Some(missing) => (
            f64::INFINITY,
            Some(format!("'{missing}' is not in: {said}")),
        ),
    }
}
