//! The curve of a test: its means, its elastic part and its peak.

use dem_laboratory::{elastic_line, elastic_rows};

use super::record::{Record, Row};

/// Time over which loads are averaged, in periods of the lowest frequency.
const WINDOW: f64 = 0.05;

/// Ratio of load to displacement in the elastic part of a test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// N/m.
    pub stiffness_n_m: f64,
    /// Displacement at which the fitted line has no load: play until everything touches, m.
    pub start_m: f64,
}

/// The rows used in the evaluation of a test: means over a twentieth of the lowest period, which
/// remove faster oscillations.
pub fn rows_of(record: &Record, lowest_frequency_hz: f64) -> Vec<Row> {
    record.smoothed(WINDOW / lowest_frequency_hz)
}

/// The slope of the load over a displacement `way`, between 20 % and 60 % of the largest load, by
/// least squares. None: too few rows.
pub fn slope(rows: &[Row], way: impl Fn(&Row) -> f64) -> Option<Slope> {
    let (ways_m, loads_n): (Vec<f64>, Vec<f64>) =
        rows.iter().map(|row| (way(row), row.load_n())).unzip();
    let line = elastic_line(&ways_m, &loads_n, peak(rows)?.load_n())?;
    Some(Slope {
        stiffness_n_m: line.slope,
        start_m: line.zero(),
    })
}

/// The rows between 20 % and 60 % of the largest load. None: too few for a slope.
pub(super) fn elastic_range(rows: &[Row]) -> Option<&[Row]> {
    let loads_n: Vec<f64> = rows.iter().map(Row::load_n).collect();
    let elastic = elastic_rows(&loads_n, peak(rows)?.load_n())?;
    Some(&rows[elastic])
}

/// Travel at which the line fitted to the load over the travel has no load, m: play until
/// everything touches. 0 without a line.
pub(crate) fn play_m(rows: &[Row]) -> f64 {
    slope(rows, |row| row.travel_m).map_or(0.0, |slope| slope.start_m)
}

/// The row with the largest load.
pub fn peak(rows: &[Row]) -> Option<&Row> {
    rows.iter().max_by(|a, b| a.load_n().total_cmp(&b.load_n()))
}
