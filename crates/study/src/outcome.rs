//! Outcomes of the processes of a sweep.

use dem_results::summary::Verdict;

/// The result of one process.
#[derive(Debug, Clone, PartialEq)]
pub struct Done {
    /// Time of its steps, as defined by the study, s.
    pub time_s: f64,
    /// Number of steps.
    pub steps: u64,
    /// Last time step, s.
    pub time_step_s: f64,
    /// Processor and cores.
    pub machine: String,
    /// Its verdict.
    pub verdict: Verdict,
    /// Its page, relative to the folder of the sweep; None: it has none.
    pub report: Option<String>,
    /// One for each measure of the study.
    pub readings: Vec<Reading>,
}

/// A measure of one process.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Value in `unit`.
    pub value: f64,
    /// SI unit; empty for plain numbers.
    pub unit: String,
    /// Expected value from the scene or the theory.
    pub closed_form: Option<f64>,
    /// For masses of pieces: each mass, kg. Otherwise empty.
    pub masses_kg: Vec<f64>,
    /// For a curve: its points (displacement in m, load in N). Otherwise empty.
    pub curve: Vec<[f64; 2]>,
}

/// The outcome of a process.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It finished, and all measures are numbers.
    Done(Done),
    /// It failed, for this reason.
    Failed(String),
    /// It has not finished.
    Missing,
}
