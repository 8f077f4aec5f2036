//! The contents of the table of a sweep.

use dem_scene::study::Study;
use serde::Serialize;

use super::response::Response;
use super::search::Search;

/// All results of a sweep. SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepTable {
    /// The study's file.
    pub study: String,
    /// The scene's file.
    pub scene: String,
    /// Program and version.
    pub program: String,
    /// Processors and cores that ran it. Run times on several are not compared.
    pub machines: Vec<String>,
    /// Smallest number of repeats of each run.
    pub repeats: u32,
    /// Threads of each run.
    pub threads: u32,
    /// "run time" or "processor time".
    pub time: String,
    /// Parameters that vary.
    pub axes: Vec<AxisColumn>,
    /// The axis distinguished by colours.
    pub series: Option<usize>,
    /// The axis over which responses are averaged.
    pub average_over: Option<usize>,
    /// Measures.
    pub measures: Vec<MeasureColumn>,
    /// All runs, in the order of their numbers.
    pub runs: Vec<Row>,
    /// Orders with which errors decrease with the size.
    pub orders: Vec<Order>,
    /// Responses of the measures without a reference, and of that of `find`.
    pub responses: Vec<Response>,
    /// The search for a value, once for each case.
    pub find: Option<Search>,
    /// Notes on the results.
    pub notes: Vec<String>,
}

/// A parameter that varies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AxisColumn {
    /// Its path or name.
    pub name: String,
    /// Its values, human-readable.
    pub values: Vec<String>,
    /// Their sizes.
    pub sizes: Option<Vec<f64>>,
    /// The values as numbers in `unit`, if they are numbers in one unit.
    pub numbers: Option<Vec<f64>>,
    /// Their unit as written; empty for plain numbers.
    pub unit: String,
}

/// A measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasureColumn {
    /// Its name.
    pub name: String,
    /// SI unit of its values; empty for plain numbers.
    pub unit: String,
    /// Its reference, as text. None: it has a response and no errors.
    pub reference: Option<String>,
}

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Number, from 1.
    pub number: usize,
    /// Index of the value on each axis, from 0.
    pub choice: Vec<usize>,
    /// The same, human-readable.
    pub settings: Vec<String>,
    /// The reason why it has no values. None if it has values.
    pub failed: Option<String>,
    /// Time of each repeat, s.
    pub times_s: Vec<f64>,
    /// Their median, s.
    pub time_s: Option<f64>,
    /// Uncertainty of the run time, s; smaller differences are not significant: the width of the
    /// range in which the median lies with a probability of 95 %, or 10 % of the median.
    pub spread_s: Option<f64>,
    /// Number of steps.
    pub steps: Option<u64>,
    /// Last time step, s.
    pub time_step_s: Option<f64>,
    /// Page of its first repeat, relative to the folder of the sweep. None: it has none.
    pub report: Option<String>,
    /// One result for each measure; none for a failed run.
    pub results: Vec<Judged>,
}

/// A measure of one run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judged {
    /// Value in the unit of the measure.
    pub value: f64,
    /// Expected value. None if it is unknown, or if this run is the reference of others.
    pub reference: Option<f64>,
    /// |value - reference|/|reference|; the plain difference for a reference of 0.
    pub error: Option<f64>,
    /// Uncertainty of the error, due to that of the reference.
    pub uncertainty: Option<f64>,
    /// True if this run is the reference of others.
    pub is_reference: bool,
    /// True if it is on the front.
    pub is_on_front: bool,
    /// Time of its reference run over its own.
    pub times_as_fast: Option<f64>,
    /// For a curve: its points (displacement in m, load in N). Otherwise empty.
    #[serde(skip)]
    pub curve: Vec<[f64; 2]>,
}

impl Row {
    /// The size of its value on an axis: its time step itself if the axis is the relative one, as a
    /// run has a smallest number of steps.
    pub fn size(&self, study: &Study, along: usize) -> Option<f64> {
        let axis = &study.axes[along];
        match axis.name.as_str() {
            "run.safety_factor" => self.time_step_s,
            _ => axis.values[self.choice[along]].size,
        }
    }
}

impl Judged {
    /// The error, or the uncertainty if that is larger: smaller errors are not significant.
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
    /// The common choices of the runs: the values of the other axes.
    pub of: Vec<String>,
    /// The order.
    pub order: f64,
    /// Number of runs from which it was found.
    pub runs: usize,
    /// "errors": the slope of error over size; "values": from Richardson extrapolation.
    pub by: String,
}
