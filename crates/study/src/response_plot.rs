//! Plots of a response over each varied parameter.

use std::collections::BTreeMap;

use dem_io::units::significant;
use dem_plots::{Axis, Line, MOST_LINES, Marks, Plot, Point};
use dem_scene::study::Average;

use super::response::{Response, ResponsePoint};
use super::search::{Search, SearchCase, SearchResult};
use super::sweep_table::{AxisColumn, SweepTable};
use super::words::{in_words, with_unit};

/// A logarithmic axis is used from this ratio of the largest to the smallest value on.
const LOG_FROM: f64 = 30.0;

/// The plots of a response: one over each axis with several values, except the averaged one.
pub fn plots(table: &SweepTable, response: &Response) -> Vec<Plot> {
    let over = shown_axes(table).filter(|at| table.axes[*at].values.len() > 1);
    over.map(|at| plot(table, response, at)).collect()
}

/// The plots of the values that `[find]` found, over each of the other axes; bars show the
/// interval.
pub fn found_plots(table: &SweepTable, search: &Search) -> Vec<Plot> {
    let over = shown_axes(table).filter(|at| *at > 0 && table.axes[*at].values.len() > 1);
    over.map(|at| found_plot(table, search, at)).collect()
}

fn found_plot(table: &SweepTable, search: &Search, over: usize) -> Plot {
    let axis = &table.axes[over];
    let series = series(table, over).filter(|at| *at > 0);
    let cases = search.cases.iter();
    let found: Vec<(ResponsePoint, &SearchCase)> = cases
        .filter_map(|case| Some((found_point(case)?, case)))
        .collect();
    let marks = |kind: usize| {
        let is_of = |(_, case): &&(_, &SearchCase)| series.is_none_or(|at| case.choice[at] == kind);
        let of_kind: Vec<_> = found.iter().filter(is_of).collect();
        let points: Vec<&ResponsePoint> = of_kind.iter().map(|(point, _)| point).collect();
        let mark = |(point, case): &&(ResponsePoint, &SearchCase)| Point {
            at: place(axis, over, point, Average::Mean),
            y_spread: 2.0 * point.standard_deviation.unwrap_or(0.0),
            filled: true,
            title: format!("{}: {}", case.settings, search.shown(point.mean)),
            ..Point::default()
        };
        Marks {
            name: series.map_or(String::new(), |at| table.axes[at].values[kind].clone()),
            points: of_kind.iter().map(mark).collect(),
            chains: chains(axis, over, &points, Average::Mean),
        }
    };
    let kinds = series.map_or(1, |at| table.axes[at].values.len());
    let measure = table.measures[search.measure].name.replace('_', " ");
    Plot {
        title: format!("where {measure} is {}", search.value_as_written),
        x: horizontal(axis),
        y: Axis::of(&with_unit(&in_words(&search.parameter), &search.unit)),
        marks: (0..kinds).map(marks).collect(),
        kinds: series.map_or(String::new(), |at| in_words(&table.axes[at].name)),
        if_empty: "no value was found".to_owned(),
        ..Plot::default()
    }
}

/// The value found in a case, with the half of its interval as its scatter.
fn found_point(case: &SearchCase) -> Option<ResponsePoint> {
    let SearchResult::Found { at, between, .. } = &case.result else {
        return None;
    };
    let half = 0.5 * (between[1] - between[0]);
    Some(ResponsePoint {
        choice: case.choice.clone(),
        settings: Vec::new(),
        values: vec![*at],
        mean: *at,
        median: *at,
        standard_deviation: Some(half),
        doubtful: 0,
    })
}

/// All axes except the averaged one.
pub(crate) fn shown_axes(table: &SweepTable) -> impl Iterator<Item = usize> {
    (0..table.axes.len()).filter(|at| Some(*at) != table.average_over)
}

fn plot(table: &SweepTable, response: &Response, over: usize) -> Plot {
    let measure = &table.measures[response.measure];
    let name = measure.name.replace('_', " ");
    let axis = &table.axes[over];
    let series = series(table, over);
    let wanted = wanted(table, response);
    let average = average(table, response);
    let is_of =
        |point: &&ResponsePoint, kind: usize| series.is_none_or(|at| point.choice[at] == kind);
    let marks = |kind: usize| {
        let points = response.points.iter().filter(|point| is_of(point, kind));
        let points: Vec<&ResponsePoint> = points.collect();
        Marks {
            name: match series {
                Some(at) => table.axes[at].values[kind].clone(),
                // For the legend, next to the value that is looked for.
                None if wanted.is_some() => average.word().to_owned(),
                None => String::new(),
            },
            points: (points.iter())
                .map(|point| mark(table, over, point, average))
                .collect(),
            chains: [
                chains(axis, over, &points, average),
                ranges(axis, over, &points, average),
            ]
            .concat(),
        }
    };
    let kinds = series.map_or(1, |at| table.axes[at].values.len());
    Plot {
        lines: found_lines(table, response, over),
        title: title(table, response, &name),
        x: horizontal(axis),
        y: Axis::of(&with_unit(&name, &measure.unit)),
        marks: (0..kinds).map(marks).collect(),
        kinds: series.map_or(String::new(), |at| in_words(&table.axes[at].name)),
        filled: (response.points.iter().any(|point| point.doubtful > 0))
            .then(|| ["sound or coarse", "doubtful"].map(str::to_owned)),
        reference: wanted.clone(),
        if_empty: "no run has a value".to_owned(),
        ..Plot::default()
    }
}

fn title(table: &SweepTable, response: &Response, name: &str) -> String {
    match &table.average_over {
        Some(averaged) if response.points.iter().any(|point| point.values.len() > 1) => {
            let average = average(table, response);
            let scatter = match average {
                Average::Mean => "standard deviation",
                Average::Median => "range",
            };
            format!(
                "{name}: {} and {scatter} over {}",
                average.word(),
                in_words(&table.axes[*averaged].name)
            )
        }
        _ => name.to_owned(),
    }
}

/// The intervals that `[find]` has found, at the height of the value that it looks for: one for
/// each case, over the parameter.
fn found_lines(table: &SweepTable, response: &Response, over: usize) -> Vec<Line> {
    let search = table.find.as_ref();
    let Some(search) = search.filter(|search| over == 0 && search.measure == response.measure)
    else {
        return Vec::new();
    };
    let line = |case: &SearchCase| {
        let SearchResult::Found { between, .. } = &case.result else {
            return None;
        };
        Some(Line::new(
            match case.settings.as_str() {
                "" => "found".to_owned(),
                settings => format!("found for {settings}"),
            },
            between.map(|x| [x, search.value]).into(),
        ))
    };
    search
        .cases
        .iter()
        .filter_map(line)
        .take(MOST_LINES)
        .collect()
}

/// The value that `[find]` looks for, if it does so in this response.
fn wanted(table: &SweepTable, response: &Response) -> Option<(f64, String)> {
    let search = table.find.as_ref()?;
    let text = format!("looked for: {}", search.value_as_written);
    (search.measure == response.measure).then_some((search.value, text))
}

/// What is shown of the values along the averaged axis: that in which `[find]` looks for a value,
/// if it does so in this response, else that of the study.
pub(crate) fn average(table: &SweepTable, response: &Response) -> Average {
    let search = table.find.as_ref();
    let search = search.filter(|search| search.measure == response.measure);
    search.map_or(table.statistic, |search| search.statistic)
}

/// The axis shown by colours: that of the page, or the first other one.
fn series(table: &SweepTable, over: usize) -> Option<usize> {
    let varies = |at: &usize| *at != over && table.axes[*at].values.len() > 1;
    let others: Vec<usize> = shown_axes(table).filter(varies).collect();
    let of_page = table.series.filter(|at| others.contains(at));
    of_page.or(others.first().copied())
}

pub(crate) fn horizontal(axis: &AxisColumn) -> Axis {
    let Some(numbers) = &axis.numbers else {
        return Axis::named(&in_words(&axis.name), axis.values.clone());
    };
    let label = with_unit(&in_words(&axis.name), &axis.unit);
    let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if low > 0.0 && high >= LOG_FROM * low {
        Axis::log(&label)
    } else {
        Axis::of(&label)
    }
}

fn place(axis: &AxisColumn, over: usize, point: &ResponsePoint, average: Average) -> [f64; 2] {
    let at = point.choice[over];
    let x = (axis.numbers.as_ref()).map_or(at as f64, |numbers| numbers[at]);
    [x, point.average(average)]
}

fn mark(table: &SweepTable, over: usize, point: &ResponsePoint, average: Average) -> Point {
    let deviation = match average {
        Average::Mean => point.standard_deviation.unwrap_or(0.0),
        // Its range is drawn instead.
        Average::Median => 0.0,
    };
    let runs = match point.values.len() {
        1 => String::new(),
        runs => format!(", {runs} runs"),
    };
    Point {
        at: place(&table.axes[over], over, point, average),
        y_spread: 2.0 * deviation,
        filled: point.doubtful == 0,
        title: format!(
            "{}: {}{}{runs}{}",
            named(table, point),
            significant(point.average(average), 4),
            point.scatter_text(average),
            point.verdict_text()
        ),
        ..Point::default()
    }
}

/// The settings of a point on one line.
pub(crate) fn named(table: &SweepTable, point: &ResponsePoint) -> String {
    let shown =
        shown_axes(table).map(|at| format!("{} {}", table.axes[at].name, point.settings[at]));
    shown.collect::<Vec<String>>().join(", ")
}

/// For medians: a line from the smallest to the largest value of each point.
fn ranges(
    axis: &AxisColumn,
    over: usize,
    points: &[&ResponsePoint],
    average: Average,
) -> Vec<Vec<[f64; 2]>> {
    let several = points.iter().filter(|point| point.values.len() > 1);
    let range = |point: &&ResponsePoint| {
        let [x, _] = place(axis, over, point, average);
        point.range().map(|y| [x, y]).into()
    };
    match average {
        Average::Mean => Vec::new(),
        Average::Median => several.map(range).collect(),
    }
}

/// Lines through points that differ along this axis only, ascending along it.
fn chains(
    axis: &AxisColumn,
    over: usize,
    points: &[&ResponsePoint],
    average: Average,
) -> Vec<Vec<[f64; 2]>> {
    let mut groups: BTreeMap<Vec<usize>, Vec<[f64; 2]>> = BTreeMap::new();
    for point in points {
        let mut others = point.choice.clone();
        others[over] = 0;
        let chain = groups.entry(others).or_default();
        chain.push(place(axis, over, point, average));
    }
    let mut chains: Vec<Vec<[f64; 2]>> = groups.into_values().collect();
    for chain in &mut chains {
        chain.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    chains.retain(|chain| chain.len() > 1 && axis.numbers.is_some());
    chains
}
