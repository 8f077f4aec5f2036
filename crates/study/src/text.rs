//! The table of a sweep as CSV and as human-readable text.

use std::fmt;

use dem_io::text::visible;
use dem_io::units::significant;
use dem_scene::study::Average;

use super::csv_line::{line, number};
use super::probability::Probability;
use super::ranking_text::write_design;
use super::response::Response;
use super::response_plot::{average, named, shown_axes};
use super::row::{Judged, Row};
use super::search::{Search, SearchResult};
use super::sweep_table::{AxisColumn, Order, SweepTable};
use super::words::with_unit;

/// Largest number of lines of a part of the text.
const MOST_LINES: usize = 20;

/// The table with one line for each run: comma-separated, texts in quotes where needed. A parameter
/// whose values are numbers in one unit, and have no names, is a number, with the unit in the name
/// of its column; so are values and references of measures.
pub fn csv(table: &SweepTable) -> String {
    let mut columns = vec!["run".to_owned()];
    columns.extend(table.axes.iter().map(heading));
    for name in ["time_s", "spread_s", "repeats", "steps", "time_step_s"] {
        columns.push(name.to_owned());
    }
    for measure in &table.measures {
        let named = |part: &str| format!("{}_{part}", measure.name);
        columns.push(with_unit(&named("value"), &measure.unit));
        if measure.reference.is_some() {
            let [reference, others @ ..] = OF_ERROR.map(named);
            columns.push(with_unit(&reference, &measure.unit));
            columns.extend(others);
        }
    }
    columns.extend(["verdict", "failed"].map(str::to_owned));
    let mut out = line(&columns);
    for row in &table.runs {
        let mut cells = vec![row.number.to_string()];
        cells.extend((0..table.axes.len()).map(|at| cell(table, at, row.choice[at])));
        cells.push(number(row.time_s));
        cells.push(number(row.spread_s));
        cells.push(row.times_s.len().to_string());
        cells.push(row.steps.map_or(String::new(), |steps| steps.to_string()));
        cells.push(number(row.time_step_s));
        for (at, measure) in table.measures.iter().enumerate() {
            let judged = row.results.get(at);
            cells.push(number(judged.map(|judged| judged.value)));
            if measure.reference.is_some() {
                cells.extend(judged.map_or_else(Default::default, of_error));
            }
        }
        cells.push(row.verdict().to_owned());
        cells.push(row.failed.clone().unwrap_or_default());
        out += &line(&cells);
    }
    out
}

/// Columns of a measure with a reference, besides its value.
const OF_ERROR: [&str; 5] = [
    "reference",
    "error",
    "uncertainty",
    "front",
    "times_as_fast",
];

fn of_error(judged: &Judged) -> [String; 5] {
    [
        number(judged.reference),
        number(judged.error),
        number(judged.uncertainty),
        u8::from(judged.is_on_front).to_string(),
        number(judged.times_as_fast),
    ]
}

/// The responses with one line for each measure and setting, with parameters as in [`csv`].
pub fn response_csv(table: &SweepTable) -> String {
    let axes: Vec<usize> = shown_axes(table).collect();
    let mut columns = vec!["measure".to_owned(), "unit".to_owned()];
    columns.extend(axes.iter().map(|at| heading(&table.axes[*at])));
    for name in [
        "runs",
        "mean",
        "standard_deviation",
        "smallest",
        "median",
        "largest",
        "doubtful",
    ] {
        columns.push(name.to_owned());
    }
    let mut out = line(&columns);
    for response in &table.responses {
        let measure = &table.measures[response.measure];
        for point in &response.points {
            let mut cells = vec![measure.name.clone(), measure.unit.clone()];
            for &at in &axes {
                cells.push(cell(table, at, point.choice[at]));
            }
            let [smallest, largest] = point.range();
            cells.push(point.values.len().to_string());
            cells.push(number(Some(point.mean)));
            cells.push(number(point.standard_deviation));
            let ends = [smallest, point.median, largest];
            cells.extend(ends.map(|value| number(Some(value))));
            cells.push(point.doubtful.to_string());
            out += &line(&cells);
        }
    }
    out
}

/// The results of `[find]` with one line for each case: the values of the other axes as in [`csv`],
/// the value found and the ends of its interval.
pub fn find_csv(table: &SweepTable, search: &Search) -> String {
    let axes: Vec<usize> = shown_axes(table).filter(|at| *at > 0).collect();
    let mut columns: Vec<String> = axes.iter().map(|at| heading(&table.axes[*at])).collect();
    columns.push(with_unit(&search.parameter, &search.unit));
    columns.extend(["from", "to", "result"].map(str::to_owned));
    let mut out = line(&columns);
    for case in &search.cases {
        let mut cells: Vec<String> = axes
            .iter()
            .map(|at| cell(table, *at, case.choice[*at]))
            .collect();
        let (found, word) = match &case.result {
            SearchResult::Found { at, between, .. } => {
                (Some([*at, between[0], between[1]]), "found")
            }
            SearchResult::NotBracketed => (None, "not bracketed"),
            SearchResult::Unfinished => (None, "unfinished"),
        };
        cells.extend([0, 1, 2].map(|k| number(found.map(|found| found[k]))));
        cells.push(word.to_owned());
        out += &line(&cells);
    }
    out
}

/// The heading of a parameter in a table.
pub(crate) fn heading(axis: &AxisColumn) -> String {
    match axis.numbers_in_tables() {
        Some(_) => with_unit(&axis.name, &axis.unit),
        None => axis.name.clone(),
    }
}

/// A value of a parameter in a table: a number in the unit of its heading, or as written.
pub(crate) fn cell(table: &SweepTable, axis: usize, at: usize) -> String {
    let column = &table.axes[axis];
    match column.numbers_in_tables() {
        Some(numbers) => number(numbers.get(at).copied()),
        None => column.values.get(at).cloned().unwrap_or_default(),
    }
}

/// The runs on the front of a measure, the fastest first.
pub(crate) fn front_of(table: &SweepTable, measure: usize) -> Vec<&Row> {
    let on = |row: &&Row| row.results.get(measure).is_some_and(|j| j.is_on_front);
    let mut rows: Vec<&Row> = table.runs.iter().filter(on).collect();
    rows.sort_by(|a, b| {
        let time = |row: &Row| row.time_s.unwrap_or(f64::INFINITY);
        time(a).total_cmp(&time(b))
    });
    rows
}

/// Prints lines, of which only the first are shown.
fn cut(f: &mut fmt::Formatter<'_>, mut lines: impl Iterator<Item = String>) -> fmt::Result {
    for line in lines.by_ref().take(MOST_LINES) {
        writeln!(f, "{line}")?;
    }
    match lines.count() {
        0 => Ok(()),
        more => writeln!(f, "  and {more} more"),
    }
}

fn write_response(
    f: &mut fmt::Formatter<'_>,
    table: &SweepTable,
    response: &Response,
) -> fmt::Result {
    let measure = &table.measures[response.measure];
    let average = average(table, response);
    let averaged = table.average_over.map_or(String::new(), |at| {
        let scatter = match average {
            Average::Mean => "standard deviation",
            Average::Median => "range",
        };
        format!(
            ", {} and {scatter} over {}",
            average.word(),
            table.axes[at].name
        )
    });
    let name = with_unit(&measure.name, &measure.unit);
    writeln!(f, "response     {name}{}", visible(&averaged))?;
    let lines = response.points.iter().map(|point| {
        let scatter = point.scatter_text(average);
        let value = significant(point.average(average), 4);
        let value = format!("{value}{scatter}{}", point.verdict_text());
        format!("  {value:<20} {}", visible(&named(table, point)))
    });
    cut(f, lines)
}

fn write_head(f: &mut fmt::Formatter<'_>, table: &SweepTable) -> fmt::Result {
    writeln!(
        f,
        "{}: {} runs of {}, {} each, on {} thread{}",
        visible(&table.study),
        table.runs.len(),
        visible(&table.scene),
        table.times(),
        table.threads,
        if table.threads == 1 { "" } else { "s" },
    )?;
    writeln!(f, "machine      {}", visible(&table.machines.join("; ")))
}

fn write_search(f: &mut fmt::Formatter<'_>, table: &SweepTable, search: &Search) -> fmt::Result {
    let measure = &table.measures[search.measure].name;
    let lines = search.cases.iter().map(|case| {
        let words = search.in_words(case, measure);
        format!("find         {}", visible(&words))
    });
    cut(f, lines)
}

fn write_probability(
    f: &mut fmt::Formatter<'_>,
    table: &SweepTable,
    of: &Probability,
) -> fmt::Result {
    let measure = &table.measures[of.measure].name;
    let lines = of.cases.iter().map(|case| {
        let words = of.in_words(case, measure);
        format!("probability  {}", visible(&words))
    });
    cut(f, lines)
}

/// The front of a measure with this reference.
fn write_front(
    f: &mut fmt::Formatter<'_>,
    table: &SweepTable,
    measure: usize,
    reference: &str,
) -> fmt::Result {
    let front = front_of(table, measure);
    writeln!(
        f,
        "front        {}: against {reference}, {} of {} runs",
        table.measures[measure].name,
        front.len(),
        table.runs.len()
    )?;
    let lines = front.iter().map(|row| {
        let judged = &row.results[measure];
        let faster = judged.times_as_fast.map_or(String::new(), |times| {
            format!(", {} times as fast as the finest", significant(times, 3))
        });
        format!(
            "  {:>9} s  error {:<9} {}{faster}",
            significant(row.time_s.unwrap_or(f64::NAN), 3),
            significant(judged.sure_error().unwrap_or(f64::NAN), 2),
            visible(&table.named(row))
        )
    });
    cut(f, lines)
}

fn order_text(order: &Order) -> String {
    let of = match order.of.join(", ") {
        of if of.is_empty() => of,
        of => format!(" ({})", visible(&of)),
    };
    format!(
        "order        {} along {}{of}: {:.2} from {} runs",
        order.measure, order.along, order.order, order.runs
    )
}

fn failed_text(table: &SweepTable, row: &Row) -> String {
    let named = table.named(row);
    let why = row.failed.as_deref().unwrap_or_default();
    format!(
        "failed       run {}, {}: {}",
        row.number,
        visible(&named),
        visible(why)
    )
}

impl fmt::Display for SweepTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_head(f, self)?;
        match &self.design {
            Some(design) => write_design(f, self, design)?,
            None => {
                for response in &self.responses {
                    write_response(f, self, response)?;
                }
            }
        }
        if let Some(search) = &self.find {
            write_search(f, self, search)?;
        }
        if let Some(of) = &self.probability {
            write_probability(f, self, of)?;
        }
        for (at, measure) in self.measures.iter().enumerate() {
            if let Some(reference) = &measure.reference {
                write_front(f, self, at, reference)?;
            }
        }
        cut(f, self.orders.iter().map(order_text))?;
        cut(f, self.failed().map(|row| failed_text(self, row)))?;
        let notes = self.notes.iter();
        cut(
            f,
            notes.map(|note| format!("note         {}", visible(note))),
        )
    }
}
