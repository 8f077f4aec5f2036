//! Responses: the value of a measure over the varied parameters, with its scatter over one of them.

use std::collections::BTreeMap;

use dem_io::units::significant;
use dem_scene::study::{Average, Reference, Study};
use serde::Serialize;

use super::expand::Run;
use super::median::median;
use super::row::Row;

/// The values of a measure without a reference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Response {
    /// Index of the measure.
    pub measure: usize,
    /// Its values, in the order of the runs; for a search case by case, ascending in the
    /// parameter.
    pub points: Vec<ResponsePoint>,
}

/// The value of a measure at one setting: the mean of the runs that differ along the averaged axis
/// only.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResponsePoint {
    /// Index of the value on each axis, from 0; 0 on the averaged one.
    pub choice: Vec<usize>,
    /// The same, human-readable; empty for the averaged one.
    pub settings: Vec<String>,
    /// Value of each run, in the unit of the measure.
    pub values: Vec<f64>,
    /// Their mean.
    pub mean: f64,
    /// Their median; of an even number the mean of the middle two.
    pub median: f64,
    /// Their standard deviation (divided by their number less 1). None for a single value.
    pub standard_deviation: Option<f64>,
    /// How many of these runs are doubtful by their verdict.
    pub doubtful: usize,
}

impl ResponsePoint {
    /// From the values of its runs, at least one.
    pub(crate) fn new(choice: Vec<usize>, settings: Vec<String>, values: Vec<f64>) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let mut rising = values.clone();
        rising.sort_by(f64::total_cmp);
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Self {
            choice,
            settings,
            mean,
            // There is at least one.
            median: median(&rising).unwrap_or(mean),
            standard_deviation: (values.len() > 1).then(|| (squares / (count - 1.0)).sqrt()),
            values,
            doubtful: 0,
        }
    }

    /// The mean or the median.
    pub fn average(&self, average: Average) -> f64 {
        match average {
            Average::Mean => self.mean,
            Average::Median => self.median,
        }
    }

    /// Smallest and largest value.
    pub fn range(&self) -> [f64; 2] {
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        let wider = |[low, high]: [f64; 2], value: &f64| [low.min(*value), high.max(*value)];
        self.values.iter().fold(ends, wider)
    }

    /// How the values scatter around this average, for a text after it: ` ± 0.3`, the standard
    /// deviation, or ` (1.2 to 1.9)`, the smallest and the largest. Empty for a single value.
    pub(crate) fn scatter_text(&self, average: Average) -> String {
        match (average, self.standard_deviation) {
            (_, None) => String::new(),
            (Average::Mean, Some(deviation)) => format!(" ± {}", significant(deviation, 2)),
            (Average::Median, Some(_)) => {
                let [low, high] = self.range().map(|end| significant(end, 3));
                format!(" ({low} to {high})")
            }
        }
    }

    /// The verdict, for a text after the value: empty, ` doubtful`, or of several runs how many.
    pub(crate) fn verdict_text(&self) -> String {
        match (self.doubtful, self.values.len()) {
            (0, _) => String::new(),
            (_, 1) => " doubtful".to_owned(),
            (doubtful, _) => format!(" {doubtful} doubtful"),
        }
    }

    /// Standard deviation of the mean. None for a single value.
    pub fn standard_error(&self) -> Option<f64> {
        let count = self.values.len() as f64;
        self.standard_deviation
            .map(|deviation| deviation / count.sqrt())
    }
}

/// The response of each measure without a reference, and of the measure of `[find]`. Runs without
/// values are left out.
pub(crate) fn responses(study: &Study, runs: &[Run], rows: &[Row]) -> Vec<Response> {
    let is_shown = |at: &usize| {
        let is_found = study.find.as_ref().is_some_and(|find| find.measure == *at);
        is_found || study.measures[*at].reference == Reference::None
    };
    let measures = (0..study.measures.len()).filter(is_shown);
    let response = |measure| Response {
        measure,
        points: points(study, runs, rows, measure),
    };
    measures.map(response).collect()
}

fn points(study: &Study, runs: &[Run], rows: &[Row], measure: usize) -> Vec<ResponsePoint> {
    let mut groups: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
    for (at, run) in runs.iter().enumerate() {
        let mut choice = run.choice.clone();
        if let Some(averaged) = study.average_over {
            choice[averaged] = 0;
        }
        groups.entry(choice).or_default().push(at);
    }
    let of_group = |(choice, members): (Vec<usize>, Vec<usize>)| {
        let with_value = members.iter().map(|&at| &rows[at]);
        let with_value: Vec<(&Row, f64)> = with_value
            .filter_map(|row| Some((row, row.results.get(measure)?.value)))
            .collect();
        let doubtful = with_value.iter().filter(|(row, _)| !row.doubts.is_empty());
        let doubtful = doubtful.count();
        let values: Vec<f64> = with_value.iter().map(|(_, value)| *value).collect();
        let mut settings = runs[*members.first()?].labels(study);
        if let Some(averaged) = study.average_over {
            settings[averaged].clear();
        }
        (!values.is_empty()).then(|| ResponsePoint {
            doubtful,
            ..ResponsePoint::new(choice, settings, values)
        })
    };
    let mut points: Vec<ResponsePoint> = groups.into_iter().filter_map(of_group).collect();
    if study.find.is_some() {
        let tried = study.points();
        points.sort_by(|a, b| {
            let by_case = a.choice[1..].cmp(&b.choice[1..]);
            by_case.then(tried[a.choice[0]].total_cmp(&tried[b.choice[0]]))
        });
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_scatter() {
        let point = ResponsePoint::new(Vec::new(), Vec::new(), vec![2.0, 4.0, 4.0, 6.0]);
        assert_eq!(point.scatter_text(Average::Mean), " ± 1.6");
        assert_eq!(point.scatter_text(Average::Median), " (2 to 6)");
        assert_eq!(point.mean, 4.0);
        // Squares 4 + 0 + 0 + 4 over 3.
        let deviation = (8.0_f64 / 3.0).sqrt();
        assert_eq!(point.standard_deviation, Some(deviation));
        assert_eq!(point.standard_error(), Some(deviation / 2.0));
        assert_eq!(point.range(), [2.0, 6.0]);
        let skewed = ResponsePoint::new(Vec::new(), Vec::new(), vec![0.2, 1.0, 0.96, 0.3]);
        assert_eq!((skewed.median, skewed.mean), (0.63, 0.615));
        let one = ResponsePoint::new(Vec::new(), Vec::new(), vec![3.0]);
        assert_eq!((one.mean, one.median), (3.0, 3.0));
        assert_eq!(one.standard_deviation, None);
    }
}
