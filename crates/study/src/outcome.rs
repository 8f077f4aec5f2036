//! What came of the processes of a sweep.

/// What one process came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Done {
    /// Time of its steps as the study asks for it, s.
    pub time_s: f64,
    /// Steps.
    pub steps: u64,
    /// Last time step, s.
    pub time_step_s: f64,
    /// Processor and cores.
    pub machine: String,
    /// One for each measure of the study.
    pub readings: Vec<Reading>,
}

/// A measure of one process.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// In `unit`.
    pub value: f64,
    /// SI unit; empty for plain numbers.
    pub unit: String,
    /// What the scene or the theory says it should be.
    pub closed_form: Option<f64>,
    /// Of masses of pieces: each, kg. Otherwise empty.
    pub masses_kg: Vec<f64>,
    /// Of a curve: its points (displacement in m, load in N). Otherwise empty.
    pub curve: Vec<[f64; 2]>,
}

/// What came of a process.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It came to its end, and all measures are numbers.
    Done(Done),
    /// Why not.
    Failed(String),
    /// It has not been run to its end.
    Missing,
}
