//! `[find]`: the value of a parameter at which the mean or median of a measure has a given value,
//! by bisection, once for each case.

use dem_io::units::significant;
use dem_scene::study::{Average, Find, Study};
use serde::Serialize;

use super::response::{Response, ResponsePoint};

/// A mean that is nearer to the value than this many standard deviations of the mean may lie on its
/// other side; so may a median from which the number of values on one side differs by no more than
/// this many standard deviations of that number.
const SURE: f64 = 2.0;

/// The searches of a study, one for each case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Search {
    /// Path of the parameter.
    pub parameter: String,
    /// Unit of the parameter; empty for plain numbers.
    pub unit: String,
    /// Index of the measure.
    pub measure: usize,
    /// What of the measure has the value.
    pub statistic: Average,
    /// The value that is looked for, in the unit of the measure.
    pub value: f64,
    /// The same as written.
    pub value_as_written: String,
    /// Largest width of the interval, in `unit`.
    pub tolerance: f64,
    /// The cases, in the order of the values of their axes: one if nothing varies but the parameter
    /// and the averaged axis.
    pub cases: Vec<SearchCase>,
}

/// The search of one case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SearchCase {
    /// Index of its value on each axis, from 0; 0 for the parameter and for the averaged axis.
    pub choice: Vec<usize>,
    /// Its values in words: `bonds.cake.model parallel`. Empty for the only case.
    pub settings: String,
    /// Points tried, ascending, in the unit of the parameter, with the mean or median of the
    /// measure there.
    pub tried: Vec<[f64; 2]>,
    /// The result.
    pub result: SearchResult,
}

/// The result of a search.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SearchResult {
    /// Found to the tolerance.
    Found {
        /// The middle of the interval, in the unit of the parameter.
        at: f64,
        /// The ends of the interval: the mean or median is below the value at one and above it at
        /// the other.
        between: [f64; 2],
        /// True if, at an end, the mean or median may lie on the other side of the value.
        is_uncertain: bool,
        /// The nearest points tried on both sides whose mean or median is surely on theirs, by
        /// twice its standard error; None on a side without any. None: single runs show no scatter.
        sure_between: Option<[Option<f64>; 2]>,
    },
    /// The means or medians at both ends of the range are on the same side of the value.
    NotBracketed,
    /// Points are missing or have failed.
    Unfinished,
}

/// The next step of a search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// This point is to be tried, in the unit of the parameter.
    Try(f64),
    /// The interval is narrow enough: its ends.
    Found([f64; 2]),
    /// The ends of the range do not bracket the value.
    NotBracketed,
    /// A point has no value yet.
    Wait,
}

/// The step after the points tried so far, `[place, mean or median - value]`, the two ends first
/// and then in the order of trial; None for a point without values.
pub fn next_step(find: &Find, points: &[Option<[f64; 2]>]) -> Step {
    let Some(points) = points.iter().copied().collect::<Option<Vec<[f64; 2]>>>() else {
        return Step::Wait;
    };
    let [low, high, tried @ ..] = points.as_slice() else {
        return Step::Wait;
    };
    let (mut low, mut high) = (*low, *high);
    // No point is tried after an exact one.
    if let Some(exact) = points.iter().find(|point| point[1] == 0.0) {
        return Step::Found([exact[0]; 2]);
    }
    let is_above = |point: [f64; 2]| point[1] > 0.0;
    if is_above(low) == is_above(high) {
        return Step::NotBracketed;
    }
    for middle in tried {
        if is_above(*middle) == is_above(low) {
            low = *middle;
        } else {
            high = *middle;
        }
    }
    if high[0] - low[0] <= find.tolerance {
        Step::Found([low[0], high[0]])
    } else {
        Step::Try(Find::middle(low[0], high[0]))
    }
}

/// The step of a case, by its number in [`Study::cases`], after the points of the response so far.
/// `value` is the one that is looked for.
pub fn next_of(study: &Study, find: &Find, response: &Response, value: f64, case: usize) -> Step {
    let points = study.points();
    let cases = study.cases();
    let (Some(choice), Some(tried)) = (cases.get(case), find.tried.get(case)) else {
        return Step::Wait;
    };
    let offset = |at: &usize| {
        let point = complete_point(study, response, choice, *at)?;
        Some([points[*at], point.average(find.statistic) - value])
    };
    let offsets: Vec<_> = tried.iter().map(offset).collect();
    next_step(find, &offsets)
}

/// The point of the response of a case with this index on the first axis, if all its runs have
/// values.
fn complete_point<'a>(
    study: &Study,
    response: &'a Response,
    case: &[usize],
    at: usize,
) -> Option<&'a ResponsePoint> {
    let averaged = study.average_over.map(|axis| study.axes[axis].values.len());
    let mut points = response.points.iter();
    let found = points.find(|point| point.choice[0] == at && point.choice[1..] == case[1..]);
    found.filter(|point| point.values.len() == averaged.unwrap_or(1))
}

/// The searches of a study as its page shows them, and notes on their results.
pub(crate) fn search(
    study: &Study,
    response: &Response,
    value: f64,
) -> Option<(Search, Vec<String>)> {
    let find = study.find.as_ref()?;
    let axis = study.axes.first()?;
    let mut search = Search {
        parameter: axis.name.clone(),
        unit: find.unit.clone(),
        measure: find.measure,
        statistic: find.statistic,
        value,
        value_as_written: find.value.clone(),
        tolerance: find.tolerance,
        cases: Vec::new(),
    };
    let name = &study.measures[find.measure].name;
    let mut notes = Vec::new();
    for (number, choice) in study.cases().into_iter().enumerate() {
        let case = search_case(study, find, response, value, (number, choice));
        let of_case = case.of_case();
        let crossings = case.crossings(value);
        if crossings > 1 {
            notes.push(format!(
                "{name} passes {} {crossings} times between the points tried{of_case}: the value found is one of them",
                find.value
            ));
        }
        if let SearchResult::Found {
            is_uncertain: true, ..
        } = case.result
        {
            let statistic = find.statistic.word();
            notes.push(format!(
                "the {statistic} of {name} at an end of the interval found{of_case} is within twice its standard error of {}: more values of the averaged axis make the result surer",
                find.value
            ));
        }
        search.cases.push(case);
    }
    Some((search, notes))
}

/// The search of one case: its number in [`Study::cases`] and its choice.
fn search_case(
    study: &Study,
    find: &Find,
    response: &Response,
    value: f64,
    (number, choice): (usize, Vec<usize>),
) -> SearchCase {
    let points = study.points();
    let own: Vec<&ResponsePoint> = (response.points.iter())
        .filter(|point| point.choice[1..] == choice[1..])
        .collect();
    let result = match next_of(study, find, response, value, number) {
        Step::Found(between) => {
            let is_end = |point: &&&ResponsePoint| between.contains(&points[point.choice[0]]);
            let is_uncertain = |point: &&ResponsePoint| is_uncertain(point, find.statistic, value);
            SearchResult::Found {
                at: f64::midpoint(between[0], between[1]),
                between,
                is_uncertain: own.iter().filter(is_end).any(is_uncertain),
                sure_between: sure_between(&own, &points, find.statistic, value, between),
            }
        }
        Step::NotBracketed => SearchResult::NotBracketed,
        Step::Try(_) | Step::Wait => SearchResult::Unfinished,
    };
    let place = |point: &&ResponsePoint| [points[point.choice[0]], point.average(find.statistic)];
    let mut tried: Vec<[f64; 2]> = own.iter().map(place).collect();
    tried.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let others = (1..choice.len()).filter(|at| Some(*at) != study.average_over);
    let words = others.map(|at| {
        let axis = &study.axes[at];
        format!("{} {}", axis.name, axis.values[choice[at]].label)
    });
    SearchCase {
        settings: words.collect::<Vec<String>>().join(", "),
        choice,
        tried,
        result,
    }
}

/// The nearest points on both sides of an interval from which on the mean or median is surely on
/// the side of that end. None: no point has several values.
fn sure_between(
    own: &[&ResponsePoint],
    places: &[f64],
    statistic: Average,
    value: f64,
    between: [f64; 2],
) -> Option<[Option<f64>; 2]> {
    if own.iter().all(|point| point.values.len() < 2) {
        return None;
    }
    let place = |point: &ResponsePoint| places[point.choice[0]];
    let sure = || {
        own.iter()
            .filter(|point| !is_uncertain(point, statistic, value))
    };
    let below = sure()
        .map(|point| place(point))
        .filter(|at| *at <= between[0]);
    let above = sure()
        .map(|point| place(point))
        .filter(|at| *at >= between[1]);
    Some([below.reduce(f64::max), above.reduce(f64::min)])
}

/// Whether the mean or median of a point may lie on the other side of a value: the mean by its
/// standard error, the median by the number of values below it, which scatters by chance as that of
/// heads in as many tosses of a coin.
fn is_uncertain(point: &ResponsePoint, statistic: Average, value: f64) -> bool {
    match statistic {
        Average::Mean => {
            let error = point.standard_error();
            error.is_some_and(|error| (point.mean - value).abs() < SURE * error)
        }
        Average::Median => {
            let count = point.values.len() as f64;
            let below = point.values.iter().filter(|own| **own < value).count() as f64;
            count > 1.0 && (below - 0.5 * count).abs() < SURE * 0.5 * count.sqrt()
        }
    }
}

impl SearchCase {
    /// How often the means or medians of neighbouring points lie on different sides of the value.
    fn crossings(&self, value: f64) -> usize {
        let above = self.tried.iter().map(|[_, found]| *found > value);
        let above: Vec<bool> = above.collect();
        above.windows(2).filter(|two| two[0] != two[1]).count()
    }

    /// ` for bonds.cake.model parallel`; nothing for the only case.
    fn of_case(&self) -> String {
        match self.settings.as_str() {
            "" => String::new(),
            settings => format!(" for {settings}"),
        }
    }
}

impl Search {
    /// A value of the parameter with its unit.
    pub fn shown(&self, number: f64) -> String {
        format!("{} {}", significant(number, 4), self.unit)
            .trim_end()
            .to_owned()
    }

    /// The result of a case in one sentence; `measure` is the name of the measure.
    pub fn in_words(&self, case: &SearchCase, measure: &str) -> String {
        let Self { parameter, .. } = self;
        let measure = &match self.statistic {
            Average::Mean => measure.to_owned(),
            Average::Median => format!("the median of {measure}"),
        };
        let value = &self.value_as_written;
        let of_case = case.of_case();
        match &case.result {
            SearchResult::Found {
                at,
                between: [low, high],
                ..
            } if low == high => {
                format!(
                    "{measure} is {value} at {parameter} = {}{of_case}",
                    self.shown(*at)
                )
            }
            SearchResult::Found {
                at,
                between: [low, high],
                sure_between,
                ..
            } => format!(
                "{measure} passes {value} between {parameter} = {} and {}, middle {}{of_case} (resolution of the search; {})",
                self.shown(*low),
                self.shown(*high),
                self.shown(*at),
                self.certainty(*sure_between)
            ),
            SearchResult::NotBracketed => format!(
                "{value} does not lie between the values of {measure} at the ends{of_case}: {}",
                self.ends(case)
            ),
            SearchResult::Unfinished => format!(
                "the search for {measure} = {value}{of_case} is not finished: {} points have values",
                case.tried.len()
            ),
        }
    }

    /// What the scatter of the runs says of a result.
    fn certainty(&self, sure_between: Option<[Option<f64>; 2]>) -> String {
        match sure_between {
            None => "one run at each point: its uncertainty is not known".to_owned(),
            Some([Some(low), Some(high)]) => format!(
                "with 95 % confidence between {} and {}",
                self.shown(low),
                self.shown(high)
            ),
            Some(_) => "no point tried is surely on one of its sides".to_owned(),
        }
    }

    /// The values at the ends of the range.
    fn ends(&self, case: &SearchCase) -> String {
        let ends = [case.tried.first(), case.tried.last()]
            .into_iter()
            .flatten();
        let texts =
            ends.map(|[x, found]| format!("{} at {}", significant(*found, 4), self.shown(*x)));
        texts.collect::<Vec<String>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn find(ends: [f64; 2], tolerance: f64) -> Find {
        Find {
            measure: 0,
            value: "0".to_owned(),
            statistic: Average::Mean,
            ends,
            tolerance,
            unit: "m".to_owned(),
            tried: vec![vec![0, 1]],
            place: "here".to_owned(),
        }
    }

    /// The points that are tried for a function, and the last step.
    fn tried(find: &Find, function: impl Fn(f64) -> f64) -> (Vec<f64>, Step) {
        let mut points = find.ends.to_vec();
        loop {
            let values: Vec<_> = points.iter().map(|x| Some([*x, function(*x)])).collect();
            match next_step(find, &values) {
                Step::Try(point) => points.push(point),
                last => return (points, last),
            }
        }
    }

    #[test]
    fn a_step_function_is_found_by_halves() {
        let find = find([0.0, 16.0], 1.0);
        let (points, last) = tried(&find, |x| if x < 5.5 { 1.0 } else { -1.0 });
        assert_eq!(points, [0.0, 16.0, 8.0, 4.0, 6.0, 5.0]);
        assert_eq!(last, Step::Found([5.0, 6.0]));
        let (points, last) = tried(&find, |x| x - 4.0);
        assert_eq!(points, [0.0, 16.0, 8.0, 4.0]);
        assert_eq!(last, Step::Found([4.0; 2]), "exact");
        assert_eq!(tried(&find, |x| x).1, Step::Found([0.0; 2]), "an end");
        assert_eq!(tried(&find, |x| x + 1.0).1, Step::NotBracketed);
        let missing = [Some([0.0, 1.0]), None];
        assert_eq!(next_step(&find, &missing), Step::Wait);
    }

    #[test]
    fn a_median_is_sure_when_nearly_all_values_lie_on_one_side() {
        let point = |below: usize| {
            let values = (0..9).map(|at| if at < below { 0.1 } else { 1.0 });
            ResponsePoint::new(Vec::new(), Vec::new(), values.collect())
        };
        // Nine values: 4.5 on each side, give or take twice 1.5.
        let uncertain = (0..=9).map(|below| is_uncertain(&point(below), Average::Median, 0.9));
        let uncertain: Vec<bool> = uncertain.collect();
        assert_eq!(
            uncertain,
            [0, 0, 1, 1, 1, 1, 1, 1, 0, 0].map(|sign| sign == 1)
        );
        let lone = ResponsePoint::new(Vec::new(), Vec::new(), vec![0.5]);
        assert!(!is_uncertain(&lone, Average::Median, 0.9));
    }

    proptest! {
        /// Whatever the function, the interval is narrow enough, lies within the ends, and the
        /// function has different signs at its ends.
        #[test]
        fn the_interval_brackets_the_value(
            low in -10.0..10.0_f64, width in 0.1..10.0_f64, fraction in 0.001..0.5_f64,
            root in 0.0..1.0_f64, waves in 0.0..40.0_f64, scale in -1e-200..1e-200_f64,
        ) {
            let find = find([low, low + width], fraction * width);
            let function = |x: f64| scale * ((x - low) / width - root + 0.3 * (waves * x).sin());
            let (points, last) = tried(&find, function);
            match last {
                Step::Found([a, b]) => {
                    prop_assert!(b - a <= find.tolerance && a >= low && b <= low + width);
                    prop_assert!(function(a) == 0.0 || (function(a) > 0.0) != (function(b) > 0.0));
                    prop_assert!(points.contains(&a) && points.contains(&b));
                }
                Step::NotBracketed => {
                    prop_assert_eq!(function(low) > 0.0, function(low + width) > 0.0);
                }
                other => prop_assert!(false, "{:?}", other),
            }
        }
    }
}
