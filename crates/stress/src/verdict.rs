//! Comparison of the members of a case with their predictions.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use dem_io::Result;
use rayon::prelude::*;
use serde::Serialize;

use super::cases::Case;
use super::limit_map::largest_step_s;
use super::prediction::{Member, ObservationMethod, Prediction};
use super::trial::Outcome;

/// Observed outcome of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Observation {
    /// The run ended with these values: those of the prediction, in its order; none if an end was
    /// not predicted.
    Ended(Vec<f64>),
    /// It was refused before it started: the message.
    Refused(String),
    /// It was stopped: the message.
    Stopped(String),
}

/// A member of a case after its run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judged {
    /// Its difference from the others of its case.
    pub what: String,
    /// The prediction.
    pub predicted: Prediction,
    /// The observation.
    pub observed: Observation,
    /// Deviation of the worst value, in tolerances; 0 if it was refused or stopped as predicted.
    pub deviation: f64,
    /// The problem; None: as predicted.
    pub wrong: Option<String>,
}

/// A case after its runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseResult {
    /// Its name.
    pub name: &'static str,
    /// Its extreme feature.
    pub extreme: &'static str,
    /// Its members.
    pub members: Vec<Judged>,
    /// Wall time, s.
    pub wall_s: f64,
}

impl CaseResult {
    /// Members that differ from their prediction.
    pub fn wrong(&self) -> impl Iterator<Item = &Judged> {
        self.members.iter().filter(|member| member.wrong.is_some())
    }
}

/// Predicts, runs and judges all members of a case, on all threads. A member that goes wrong is not
/// an error.
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

/// Runs a member and compares it with its prediction.
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

/// Deviation of the observation, in tolerances, and the problem.
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
