//! `[probability]`: in which part of the runs a measure is below or above a limit, and the logistic
//! curve of this part over a parameter.

use std::collections::BTreeMap;

use dem_io::units::significant;
use dem_laboratory::logistic::{Logistic, Trials, ValueAt, bound_of_none, wilson};
use dem_scene::study::{self, Study};
use serde::Serialize;

use super::row::Row;
use super::words::with_unit;

/// The probabilities whose values of the parameter are given.
pub(crate) const SHOWN: [f64; 3] = [0.1, 0.5, 0.9];
/// Number of points of a curve.
const CURVE: usize = 61;

/// The probability of an outcome over a parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Probability {
    /// Index of the measure.
    pub measure: usize,
    /// A run has the outcome if the measure is on one side of this limit, in its unit.
    pub limit: f64,
    /// The limit as written.
    pub limit_as_written: String,
    /// True if the outcome is a measure below the limit, false for above.
    pub is_below: bool,
    /// Index of the axis of the parameter.
    pub over: usize,
    /// The parameter.
    pub parameter: String,
    /// Its unit as written; empty for plain numbers.
    pub unit: String,
    /// True if the curve is one over the logarithm of the parameter.
    pub is_log: bool,
    /// One for each combination of the values of the other axes except the averaged one.
    pub cases: Vec<ProbabilityCase>,
}

/// The runs that differ in the parameter and along the averaged axis only.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProbabilityCase {
    /// Index of the value on each axis; 0 for the parameter and on the averaged axis.
    pub choice: Vec<usize>,
    /// The values of the other axes on one line; empty if there are none.
    pub settings: String,
    /// The values of the parameter that have runs with a value of the measure, ascending.
    pub points: Vec<ProbabilityPoint>,
    /// The curve. None: all runs have the outcome, or none has, or they are of one value.
    pub fit: Option<ProbabilityFit>,
    /// If all runs have the outcome, or none: the bound of the mean probability over these runs,
    /// with a confidence of 95 %.
    pub bound: Option<f64>,
}

/// The runs at one value of the parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProbabilityPoint {
    /// Index of the value on the axis.
    pub choice: usize,
    /// The value, in its unit as written.
    pub value: f64,
    /// Number of runs.
    pub runs: usize,
    /// How many of them have the outcome.
    pub with_outcome: usize,
    /// How many of the runs are doubtful by their verdict.
    pub doubtful: usize,
    /// The fraction with the outcome.
    pub fraction: f64,
    /// 95 % confidence interval of the probability from these runs alone (Wilson).
    pub between: [f64; 2],
    /// The probability by the curve, and its 95 % confidence interval.
    pub fitted: Option<[f64; 3]>,
}

/// A logistic curve, p = 1/(1 + exp(-(a + b x))).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProbabilityFit {
    /// a, with x the parameter in its unit as written, or its natural logarithm.
    pub a: f64,
    /// b.
    pub b: f64,
    /// The values of the parameter at 10, 50 and 90 %, in its unit as written: without those, and
    /// the ends of intervals, that are negative where the parameter never is.
    pub values: Vec<ValueAt>,
    /// Which of 10, 50 and 90 % the curve has at a negative value that the parameter never has.
    pub at_none: Vec<f64>,
    /// Whether the runs show, with a confidence of 95 %, that the parameter matters.
    pub depends: bool,
    /// Whether a value of the parameter separates the runs with the outcome from those without.
    pub is_separated: bool,
    /// Points for plots: the parameter, the probability and the ends of its confidence interval.
    #[serde(skip)]
    pub curve: Vec<[f64; 4]>,
}

impl Probability {
    /// From the runs of a study. `limit`: that of `[probability]`, in the unit of its measure.
    /// None: the study has no such table.
    pub(crate) fn of(study: &Study, rows: &[Row], limit: Option<f64>) -> Option<Self> {
        let (wanted, limit) = (study.probability.as_ref()?, limit?);
        let (numbers, unit) = study.axes[wanted.over].numbers()?;
        let mut cases: BTreeMap<Vec<usize>, Vec<&Row>> = BTreeMap::new();
        for row in rows {
            let mut choice = row.choice.clone();
            choice[wanted.over] = 0;
            if let Some(averaged) = study.average_over {
                choice[averaged] = 0;
            }
            cases.entry(choice).or_default().push(row);
        }
        let case = |(choice, rows): (Vec<usize>, Vec<&Row>)| {
            let points = points(wanted, limit, &numbers, &rows);
            ProbabilityCase {
                settings: settings(study, wanted.over, &choice),
                choice,
                ..ProbabilityCase::of(points, wanted)
            }
        };
        Some(Self {
            measure: wanted.measure,
            limit,
            limit_as_written: wanted.limit.clone(),
            is_below: wanted.is_below,
            over: wanted.over,
            parameter: study.axes[wanted.over].name.clone(),
            unit,
            is_log: wanted.is_log,
            cases: cases.into_iter().map(case).collect(),
        })
    }

    /// The outcome in words, of a measure of this name: `largest below 0.9`.
    pub(crate) fn outcome(&self, measure: &str) -> String {
        let side = if self.is_below { "below" } else { "above" };
        format!("{measure} {side} {}", self.limit_as_written)
    }

    /// The result of a case on one line, for a measure of this name.
    pub fn in_words(&self, case: &ProbabilityCase, measure: &str) -> String {
        let (outcome, parameter) = (self.outcome(measure), &self.parameter);
        let of_case = match case.settings.as_str() {
            "" => String::new(),
            settings => format!(" for {settings}"),
        };
        let (runs, with_outcome) = case.counts();
        let Some(fit) = &case.fit else {
            let found = match (with_outcome, case.bound) {
                (0, Some(bound)) => format!(
                    "none of {runs} runs: its mean probability in them is below {} %",
                    percent(bound)
                ),
                (_, Some(bound)) => format!(
                    "all of {runs} runs: its mean probability in them is above {} %",
                    percent(bound)
                ),
                (_, None) => format!("{with_outcome} of {runs} runs, at one value of {parameter}"),
            };
            let confidence = if case.bound.is_some() {
                " with a confidence of 95 %"
            } else {
                ""
            };
            return format!(
                "{outcome}{of_case} in {found}{confidence}; there is no curve over {parameter}"
            );
        };
        let at_none = fit.at_none.iter();
        let at_none = at_none.map(|p| format!("{} % at no value above 0", percent(*p)));
        let values = fit.values.iter().map(|value| self.value_in_words(value));
        let values: Vec<String> = at_none.chain(values).collect();
        let values = match values.is_empty() {
            true => "the same at all values".to_owned(),
            false => values.join(", "),
        };
        format!("{outcome}{of_case} over {parameter}: {values}; {with_outcome} of {runs} runs")
    }

    /// `50 % at 0.3 m (0.2 to 0.4)`.
    fn value_in_words(&self, at: &ValueAt) -> String {
        let number = |value: f64| significant(value, 3);
        let between = match at.between {
            [Some(low), Some(high)] => format!("{} to {}", number(low), number(high)),
            [Some(low), None] => format!("above {}", number(low)),
            [None, Some(high)] => format!("below {}", number(high)),
            [None, None] => "no bound".to_owned(),
        };
        let value = format!("{} {}", number(at.value), self.unit);
        format!(
            "{} % at {} ({between})",
            percent(at.probability),
            value.trim_end()
        )
    }

    /// Sentences on what makes the curves less certain than they look.
    pub(crate) fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        for case in &self.cases {
            let Some(fit) = &case.fit else { continue };
            let of_case = match case.settings.as_str() {
                "" => String::new(),
                settings => format!(" for {settings}"),
            };
            let parameter = &self.parameter;
            if fit.is_separated {
                notes.push(format!("one value of {parameter} separates the runs with the outcome from those without{of_case}: how steep the curve is follows from the distance of the values that were tried; values between them would show it"));
            } else if !fit.depends {
                notes.push(format!("the runs do not show that the probability depends on {parameter}{of_case}, with a confidence of 95 %: its values are only loosely bounded, or not at all"));
            }
        }
        notes
    }

    /// The parameter with its unit.
    pub(crate) fn heading(&self) -> String {
        with_unit(&self.parameter, &self.unit)
    }
}

/// A probability in per cent.
pub(crate) fn percent(probability: f64) -> String {
    significant(100.0 * probability, 3)
}

/// The values of the other axes on one line.
fn settings(study: &Study, over: usize, choice: &[usize]) -> String {
    let others = (0..study.axes.len()).filter(|at| *at != over && Some(*at) != study.average_over);
    let named = others.map(|at| {
        let axis = &study.axes[at];
        format!("{} {}", axis.name, axis.values[choice[at]].label)
    });
    named.collect::<Vec<String>>().join(", ")
}

/// The runs at each value of the parameter, ascending.
fn points(
    wanted: &study::Probability,
    limit: f64,
    numbers: &[f64],
    rows: &[&Row],
) -> Vec<ProbabilityPoint> {
    let mut points: Vec<ProbabilityPoint> = Vec::new();
    for (choice, value) in numbers.iter().enumerate() {
        let at_value = rows.iter().filter(|row| row.choice[wanted.over] == choice);
        let with_value = at_value.filter_map(|row| {
            let value = row.results.get(wanted.measure)?.value;
            value.is_finite().then_some((*row, value))
        });
        let with_value: Vec<(&Row, f64)> = with_value.collect();
        let has_outcome = |value: f64| match wanted.is_below {
            true => value < limit,
            false => value > limit,
        };
        let runs = with_value.len();
        let with_outcome = with_value.iter().filter(|(_, value)| has_outcome(*value));
        let with_outcome = with_outcome.count();
        if runs == 0 {
            continue;
        }
        points.push(ProbabilityPoint {
            choice,
            value: *value,
            runs,
            with_outcome,
            doubtful: with_value
                .iter()
                .filter(|(row, _)| !row.doubts.is_empty())
                .count(),
            fraction: with_outcome as f64 / runs as f64,
            between: wilson(runs, with_outcome),
            fitted: None,
        });
    }
    points.sort_by(|a, b| a.value.total_cmp(&b.value));
    points
}

impl ProbabilityCase {
    /// The case of these points, without its place among the others.
    fn of(mut points: Vec<ProbabilityPoint>, wanted: &study::Probability) -> Self {
        let is_log = wanted.is_log;
        let is_possible = |value: f64| value > 0.0 || !wanted.is_never_negative;
        let x = |value: f64| if is_log { value.ln() } else { value };
        let trials = points.iter().map(|point| Trials {
            x: x(point.value),
            runs: point.runs,
            with_outcome: point.with_outcome,
        });
        let logistic = Logistic::fit(&trials.collect::<Vec<_>>());
        let at = |logistic: &Logistic, value: f64| {
            let [low, high] = logistic.band(x(value));
            [logistic.probability(x(value)), low, high]
        };
        for point in &mut points {
            point.fitted = logistic.as_ref().map(|logistic| at(logistic, point.value));
        }
        let (first, last) = (
            points.first().map_or(0.0, |p| p.value),
            points.last().map_or(0.0, |p| p.value),
        );
        let fit = logistic.map(|logistic| {
            let value = |x: f64| if is_log { x.exp() } else { x };
            let in_unit = |at: ValueAt| ValueAt {
                value: value(at.value),
                between: at
                    .between
                    .map(|end| end.map(value).filter(|end| is_possible(*end))),
                ..at
            };
            let [a, b] = logistic.coefficients();
            let curve = (0..CURVE).map(|k| {
                let part = k as f64 / (CURVE - 1) as f64;
                let value = value(x(first) + part * (x(last) - x(first)));
                let [p, low, high] = at(&logistic, value);
                [value, p, low, high]
            });
            let values = SHOWN.iter().filter_map(|p| logistic.value_at(*p));
            let (values, others): (Vec<ValueAt>, Vec<ValueAt>) =
                values.map(in_unit).partition(|at| is_possible(at.value));
            ProbabilityFit {
                a,
                b,
                values,
                at_none: others.iter().map(|at| at.probability).collect(),
                depends: logistic.depends(),
                is_separated: logistic.is_separated(),
                curve: curve.collect(),
            }
        });
        let mut case = Self {
            choice: Vec::new(),
            settings: String::new(),
            points,
            fit,
            bound: None,
        };
        case.bound = match case.counts() {
            (0, _) => None,
            (runs, 0) => Some(bound_of_none(runs)),
            (runs, with_outcome) if with_outcome == runs => Some(1.0 - bound_of_none(runs)),
            _ => None,
        };
        case
    }

    /// Numbers of runs, and of runs with the outcome.
    pub fn counts(&self) -> (usize, usize) {
        let sums = self
            .points
            .iter()
            .map(|point| (point.runs, point.with_outcome));
        sums.fold((0, 0), |(runs, with), one| (runs + one.0, with + one.1))
    }
}
