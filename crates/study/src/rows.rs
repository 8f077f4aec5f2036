//! What the table of a sweep holds.

use dem_scene::study::Study;
use serde::Serialize;

/// Everything that came of a sweep. SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepTable {
    /// The study's file.
    pub study: String,
    /// The scene's file.
    pub scene: String,
    /// Program and version.
    pub program: String,
    /// Processors and cores that did it. Run times of several are not compared.
    pub machines: Vec<String>,
    /// How often each run was to be done, at least.
    pub repeats: u32,
    /// Threads of each run.
    pub threads: u32,
    /// "run time" or "processor time".
    pub time: String,
    /// What varies.
    pub axes: Vec<AxisColumn>,
    /// The axis that colours tell apart.
    pub series: Option<usize>,
    /// What is measured.
    pub measures: Vec<MeasureColumn>,
    /// All runs, in the order of their numbers.
    pub runs: Vec<Row>,
    /// How fast errors fall with the size.
    pub orders: Vec<Order>,
    /// What is to be known of it.
    pub notes: Vec<String>,
}

/// Something that varies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AxisColumn {
    /// Its path or name.
    pub name: String,
    /// Its values, for a person.
    pub values: Vec<String>,
    /// How coarse they are.
    pub sizes: Option<Vec<f64>>,
}

/// Something that is measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasureColumn {
    /// Its name.
    pub name: String,
    /// SI unit of its values; empty for plain numbers.
    pub unit: String,
    /// What it is compared with, in words.
    pub reference: String,
}

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// From 1.
    pub number: usize,
    /// Value of each axis, from 0.
    pub choice: Vec<usize>,
    /// The same for a person.
    pub settings: Vec<String>,
    /// Why it has no values. None: it has.
    pub failed: Option<String>,
    /// Time of each repeat, s.
    pub times_s: Vec<f64>,
    /// Their median, s.
    pub time_s: Option<f64>,
    /// Differences of run times up to this mean nothing, s: the width of the range in which the
    /// median lies with a probability of 95 %, or 10 % of the median.
    pub spread_s: Option<f64>,
    /// Steps.
    pub steps: Option<u64>,
    /// Last time step, s.
    pub time_step_s: Option<f64>,
    /// One for each measure; none of a run that failed.
    pub results: Vec<Judged>,
}

/// A measure of one run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judged {
    /// In the unit of the measure.
    pub value: f64,
    /// What it should be. None: that is not known, or this run is what others are compared with.
    pub reference: Option<f64>,
    /// |value - reference|/|reference|; the plain difference for a reference of 0.
    pub error: Option<f64>,
    /// By how much the error may be off, as the reference is not known better.
    pub uncertainty: Option<f64>,
    /// Whether others are compared with this run.
    pub is_reference: bool,
    /// Whether it is on the [front](super::front).
    pub is_on_front: bool,
    /// Time of the run that it is compared with over its own.
    pub times_as_fast: Option<f64>,
    /// Of a curve: its points (displacement in m, load in N). Otherwise empty.
    #[serde(skip)]
    pub curve: Vec<[f64; 2]>,
}

impl Row {
    /// How coarse its value of an axis is: its step itself where the axis is the relative one, as a
    /// run has a least number of steps.
    pub fn size(&self, study: &Study, along: usize) -> Option<f64> {
        let axis = &study.axes[along];
        match axis.name.as_str() {
            "run.safety_factor" => self.time_step_s,
            _ => axis.values[self.choice[along]].size,
        }
    }
}

impl Judged {
    /// The error, or the uncertainty where that is larger: below it nothing can be told.
    pub fn sure_error(&self) -> Option<f64> {
        let error = self.error.filter(|error| !error.is_nan())?;
        Some(error.max(self.uncertainty.unwrap_or(0.0)))
    }
}

/// An observed order.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Order {
    /// The measure.
    pub measure: String,
    /// The axis along which the size changes.
    pub along: String,
    /// What the runs have in common: the values of the other axes.
    pub of: Vec<String>,
    /// The order.
    pub order: f64,
    /// Number of runs from which it was found.
    pub runs: usize,
    /// "errors": the slope of error over size; "values": from Richardson extrapolation.
    pub by: String,
}
