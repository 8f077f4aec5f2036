//! Error against run time: both axes logarithmic, series distinguished by colour and shape, the
//! front filled and joined.

use dem_io::units::significant;
use dem_plots::{Axis, Marks, Plot, Point};

use super::row::Row;
use super::sweep_table::SweepTable;
use super::words::in_words;

/// A run in the plot.
struct Mark<'a> {
    row: &'a Row,
    time_s: f64,
    spread_s: f64,
    error: f64,
    is_on_front: bool,
    series: usize,
}

/// The plot of one measure.
pub fn plot(table: &SweepTable, measure: usize) -> Plot {
    let column = &table.measures[measure];
    let marks = marks(table, measure);
    let is_difference = marks.iter().any(|mark| {
        let judged = &mark.row.results[measure];
        judged.reference == Some(0.0) && !column.unit.is_empty()
    });
    let unit = if is_difference { &column.unit } else { "share" };
    let repeats = match table.repeats {
        1 => String::new(),
        repeats => format!(", median of {repeats} or more"),
    };
    let name = column.name.replace('_', " ");
    let axis = table.series.map(|at| &table.axes[at]);
    let of_series = |series: usize| Marks {
        name: axis.map_or(String::new(), |axis| axis.values[series].clone()),
        points: (marks.iter().filter(|mark| mark.series == series))
            .map(|mark| point(table, mark))
            .collect(),
        chains: chains(table, &marks, series),
    };
    let meaning = ["on the Pareto front", "another is as fast and as exact"];
    Plot {
        title: format!("{name}: error against {}", table.time),
        x: Axis::log(&format!("{} (s){repeats}", table.time)),
        y: Axis::log(&format!("error ({unit})")),
        marks: (0..axis.map_or(1, |axis| axis.values.len()))
            .map(of_series)
            .collect(),
        kinds: axis.map_or(String::new(), |axis| in_words(&axis.name)),
        filled: (!marks.is_empty()).then(|| meaning.map(str::to_owned)),
        front: front(&marks),
        if_empty: "no run has an error that is known".to_owned(),
        ..Plot::default()
    }
}

fn marks(table: &SweepTable, measure: usize) -> Vec<Mark<'_>> {
    let of_row = |row| {
        let row: &Row = row;
        let judged = row.results.get(measure)?;
        Some(Mark {
            time_s: row.time_s?,
            spread_s: row.spread_s?,
            error: judged.sure_error()?,
            is_on_front: judged.is_on_front,
            series: table.series.map_or(0, |axis| row.choice[axis]),
            row,
        })
    };
    table.runs.iter().filter_map(of_row).collect()
}

fn point(table: &SweepTable, mark: &Mark<'_>) -> Point {
    let [time, error] = [mark.time_s, mark.error].map(|value| significant(value, 3));
    let (number, settings) = (mark.row.number, table.named(mark.row));
    Point {
        at: [mark.time_s, mark.error],
        x_spread: mark.spread_s,
        y_spread: 0.0,
        filled: mark.is_on_front,
        title: format!("run {number}: {settings}; {time} s, error {error}"),
    }
}

/// Lines through runs of a series that differ along one axis with sizes only.
fn chains(table: &SweepTable, marks: &[Mark<'_>], series: usize) -> Vec<Vec<[f64; 2]>> {
    let along = (table.axes.iter().rposition(|axis| axis.sizes.is_some()))
        .filter(|along| Some(*along) != table.series);
    let Some((along, sizes)) = along.and_then(|at| Some((at, table.axes[at].sizes.as_ref()?)))
    else {
        return Vec::new();
    };
    let others = |mark: &Mark<'_>| {
        let mut others = mark.row.choice.clone();
        others[along] = 0;
        others
    };
    let of_series = marks.iter().filter(|mark| mark.series == series);
    let mut sorted: Vec<&Mark<'_>> = of_series.collect();
    sorted.sort_by(|a, b| {
        let size = |mark: &Mark<'_>| sizes[mark.row.choice[along]];
        others(a).cmp(&others(b)).then(size(a).total_cmp(&size(b)))
    });
    (sorted.chunk_by(|a, b| others(a) == others(b)))
        .filter(|chain| chain.len() > 1)
        .map(|chain| (chain.iter().map(|mark| [mark.time_s, mark.error])).collect())
        .collect()
}

/// Corners of the front, the fastest first.
fn front(marks: &[Mark<'_>]) -> Vec<[f64; 2]> {
    let on_front = marks.iter().filter(|mark| mark.is_on_front);
    let mut front: Vec<[f64; 2]> = on_front.map(|mark| [mark.time_s, mark.error]).collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut least = f64::INFINITY;
    front.retain(|[_, error]| {
        let is_lower = *error < least;
        least = least.min(*error);
        is_lower
    });
    front
}
