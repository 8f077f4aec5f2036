//! The table of `rate_strengthening` from the dynamic tests of a study: increase factors of a body
//! over its strain rate.

use std::collections::BTreeMap;

use dem_io::units::significant;
use dem_laboratory::test_result::{INCREASE_FACTOR, STRAIN_RATE};
use dem_results::summary::Trust;
use dem_scene::study::{MeasureOf, Study};
use serde::Serialize;

use super::row::Row;

/// The axis along which the rate of a table changes.
const VELOCITY: &str = "test.striker.velocity";
/// Digits of rates and factors.
const DIGITS: usize = 4;

/// Factors over the strain rate, of the runs that differ in the velocity of the striker only.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct IncreaseTable {
    /// Their common settings, human-readable; empty if nothing else varies.
    pub settings: String,
    /// Strain rate, 1/s, and factor of each row; rates rise, factors are 1 or more and do not fall.
    pub rows: Vec<[f64; 2]>,
    /// Number of tests that it comes from.
    pub tests: usize,
    /// Number of tests left out: doubtful ones, and bodies that did not break.
    pub left_out: usize,
}

impl IncreaseTable {
    /// The tables of a study that varies the velocity of the striker of split-Hopkinson tests, and
    /// measures `strain rate` and `dynamic increase factor`. Empty: another study, or no valid
    /// test.
    pub(crate) fn all_of(study: &Study, rows: &[Row]) -> Vec<Self> {
        let measure = |wanted: &str| {
            let is = |of: &MeasureOf| matches!(of, MeasureOf::Figure(name) if name == wanted);
            study.measures.iter().position(|one| is(&one.of))
        };
        let varies_rate = study.axes.iter().any(|axis| axis.name == VELOCITY);
        let measures = measure(STRAIN_RATE).zip(measure(INCREASE_FACTOR));
        let Some((rate, factor)) = measures.filter(|_| varies_rate) else {
            return Vec::new();
        };
        let is_common =
            |at: &usize| study.axes[*at].name != VELOCITY && Some(*at) != study.average_over;
        let common: Vec<usize> = (0..study.axes.len()).filter(is_common).collect();
        let mut cases: BTreeMap<Vec<usize>, Vec<&Row>> = BTreeMap::new();
        for row in rows {
            let case = common.iter().map(|at| row.choice[*at]).collect();
            cases.entry(case).or_default().push(row);
        }
        let table = |of_case: Vec<&Row>| {
            let named =
                |at: &usize| format!("{} = {}", study.axes[*at].name, of_case[0].settings[*at]);
            let settings: Vec<String> = common.iter().map(named).collect();
            let points = of_case.iter().filter_map(|row| point(row, rate, factor));
            let points: Vec<[f64; 2]> = points.collect();
            Self {
                settings: settings.join(", "),
                tests: points.len(),
                left_out: of_case.len() - points.len(),
                rows: rising(points),
            }
        };
        let tables = cases.into_values().map(table);
        tables.filter(|table| table.tests > 0).collect()
    }

    /// The line of a scene.
    pub fn line(&self) -> String {
        let row = |[rate, factor]: &[f64; 2]| {
            let [rate, factor] = [rate, factor].map(|number| significant(*number, DIGITS));
            format!("[\"{rate} 1/s\", {factor}]")
        };
        let rows: Vec<String> = self.rows.iter().map(row).collect();
        format!("rate_strengthening = [{}]", rows.join(", "))
    }

    /// The line, and where it comes from.
    pub(crate) fn note(&self) -> String {
        let of = match self.settings.as_str() {
            "" => String::new(),
            settings => format!("{settings}: "),
        };
        let left_out = match self.left_out {
            0 => String::new(),
            count => format!(" ({count} left out: doubtful, or unbroken)"),
        };
        let tests = dem_io::text::counted(self.tests, "valid test");
        format!("{of}{} from {tests}{left_out}", self.line())
    }
}

/// Strain rate and factor of a valid test.
fn point(row: &Row, rate: usize, factor: usize) -> Option<[f64; 2]> {
    let is_valid = row.trust.is_some_and(|trust| trust != Trust::Doubtful);
    let value = |measure: usize| Some(row.results.get(measure)?.value);
    let point = [value(rate)?, value(factor)?];
    (is_valid && point[0] > 0.0 && point[1].is_finite()).then_some(point)
}

/// Points as rows of a table: in the order of rates, those with the same rate in the digits shown
/// as one, and where factors fall with the rate their mean (the nearest rising factors by least
/// squares); no factor is below 1.
fn rising(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let same = |a: &[f64; 2], b: &[f64; 2]| significant(a[0], DIGITS) == significant(b[0], DIGITS);
    // Runs of points that get their mean factor.
    let mut runs: Vec<Vec<[f64; 2]>> = Vec::new();
    for equal in points.chunk_by(same) {
        let mut run = vec![[mean(equal, 0), mean(equal, 1)]];
        while let Some(before) = runs.pop_if(|before| mean(before, 1) > mean(&run, 1)) {
            run = [before, run].concat();
        }
        runs.push(run);
    }
    let rows = |run: Vec<[f64; 2]>| {
        let factor = mean(&run, 1).max(1.0);
        run.into_iter().map(move |[rate, _]| [rate, factor])
    };
    runs.into_iter().flat_map(rows).collect()
}

fn mean(points: &[[f64; 2]], which: usize) -> f64 {
    points.iter().map(|point| point[which]).sum::<f64>() / points.len() as f64
}
