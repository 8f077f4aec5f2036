//! One run in the table of a sweep.

use dem_results::summary::Trust;
use dem_scene::study::Study;
use serde::Serialize;

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
    /// Its verdict in one word. None if it has no values.
    pub trust: Option<Trust>,
    /// The warnings of its verdict: none unless it is doubtful.
    pub doubts: Vec<String>,
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

impl Row {
    /// Its verdict in one word; empty for a failed run.
    pub fn verdict(&self) -> &'static str {
        self.trust.map_or("", Trust::word)
    }

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

impl Judged {
    /// The error, or the uncertainty if that is larger: smaller errors are not significant.
    pub fn sure_error(&self) -> Option<f64> {
        let error = self.error.filter(|error| !error.is_nan())?;
        Some(error.max(self.uncertainty.unwrap_or(0.0)))
    }
}
