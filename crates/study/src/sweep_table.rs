//! The contents of the table of a sweep.

use dem_scene::study::Average;
use serde::Serialize;

use super::increase_table::IncreaseTable;
use super::probability::Probability;
use super::ranking::DesignTable;
use super::response::Response;
use super::row::Row;
use super::search::Search;
use dem_laboratory::FailureLine;

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
    /// What responses show of the values along it, unless `[find]` says otherwise.
    pub statistic: Average,
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
    /// The probability of an outcome. None: the study has no `[probability]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub probability: Option<Probability>,
    /// What the parameters of `[design]` change. None: the study has no such table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub design: Option<DesignTable>,
    /// Cohesion and friction angle. None: the study does not vary the pressure of a test.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure_line: Option<FailureLine>,
    /// Tables for `rate_strengthening`. Empty: the study does not vary the velocity of a striker.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub increase_tables: Vec<IncreaseTable>,
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
    /// True if the study names the values: tables show the names, plots the numbers.
    pub named: bool,
}

impl AxisColumn {
    /// The numbers that a table shows: none if the study names the values.
    pub fn numbers_in_tables(&self) -> Option<&[f64]> {
        self.numbers.as_deref().filter(|_| !self.named)
    }
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
