//! Responses and the search on the page of a sweep.

use dem_plots::{Column, Page, Row, Table};
use dem_scene::study::Average;

use super::response::Response;
use super::response_plot::{average, found_plots, plots, shown_axes};
use super::sweep_table::SweepTable;
use super::words::{in_words, number, with_unit};

/// Largest number of points in a table; the CSV has all of them.
const MOST_POINTS: usize = 500;

/// The result of `[find]`, and the points tried.
pub(crate) fn add_search(page: &mut Page, table: &SweepTable) {
    let Some(search) = &table.find else {
        return;
    };
    let measure = &table.measures[search.measure];
    page.heading("Search");
    for case in &search.cases {
        let result = search.in_words(case, &measure.name);
        page.paragraph(&format!("Result: {result}."));
    }
    for plot in found_plots(table, search) {
        page.figure(&plot.svg());
    }
    page.small(&format!(
        "Bisection until the interval is no wider than {}, its resolution; 95 % confidence: between the nearest points whose {} is two standard errors off the value. The points tried, ascending.",
        search.shown(search.tolerance),
        search.statistic.word()
    ));
    let parameter = with_unit(&in_words(&search.parameter), &search.unit);
    let name = match search.statistic {
        Average::Mean => in_words(&measure.name),
        Average::Median => format!("median of {}", in_words(&measure.name)),
    };
    let value = with_unit(&name, &measure.unit);
    let axes: Vec<usize> = shown_axes(table).filter(|at| *at > 0).collect();
    let columns = axes
        .iter()
        .map(|at| Column::text(&in_words(&table.axes[*at].name)));
    let columns = columns.chain([&parameter, &value].map(|name| Column::number(name)));
    let rows = search.cases.iter().flat_map(|case| {
        let settings = axes
            .iter()
            .map(|at| table.axes[*at].values[case.choice[*at]].clone());
        let settings: Vec<String> = settings.collect();
        case.tried.iter().map(move |[x, found]| {
            let cells = [number(Some(*x), 6), number(Some(*found), 4)];
            Row::from([&settings[..], &cells].concat())
        })
    });
    page.table(&Table {
        columns: columns.collect(),
        rows: rows.take(MOST_POINTS).collect(),
    });
}

/// The plots and the table of a response.
pub(crate) fn add_response(page: &mut Page, table: &SweepTable, response: &Response) {
    let averaged = table.average_over.map(|at| &table.axes[at]);
    if let Some(averaged) = averaged {
        let (averages, scatter) = match average(table, response) {
            Average::Mean => ("Means", "bars show one standard deviation to either side"),
            Average::Median => (
                "Medians",
                "thin lines reach from the smallest to the largest value",
            ),
        };
        page.paragraph(&format!(
            "{averages} over {} values of {}; {scatter}.",
            averaged.values.len(),
            in_words(&averaged.name)
        ));
    }
    for plot in plots(table, response) {
        page.figure(&plot.svg());
    }
    let measure = &table.measures[response.measure];
    let axes: Vec<usize> = shown_axes(table).collect();
    let mut columns: Vec<Column> = (axes.iter())
        .map(|at| Column::text(&in_words(&table.axes[*at].name)))
        .collect();
    let shown = average(table, response);
    if averaged.is_some() {
        columns.push(Column::number(&with_unit(shown.word(), &measure.unit)));
        let scatter = match shown {
            Average::Mean => [
                "standard deviation",
                "smallest",
                "median",
                "largest",
                "runs",
            ],
            Average::Median => ["smallest", "largest", "mean", "standard deviation", "runs"],
        };
        columns.extend(scatter.map(Column::number));
    } else {
        columns.push(Column::number(&with_unit(
            &in_words(&measure.name),
            &measure.unit,
        )));
    }
    let rows = response.points.iter().take(MOST_POINTS).map(|point| {
        let mut cells: Vec<String> = axes.iter().map(|at| point.settings[*at].clone()).collect();
        cells.push(number(Some(point.average(shown)), 4));
        if averaged.is_some() {
            let deviation = number(point.standard_deviation, 2);
            let [smallest, largest] = point.range().map(|end| number(Some(end), 4));
            let other = |average| number(Some(point.average(average)), 4);
            cells.extend(match shown {
                Average::Mean => [deviation, smallest, other(Average::Median), largest],
                Average::Median => [smallest, largest, other(Average::Mean), deviation],
            });
            cells.push(point.values.len().to_string());
        }
        Row::from(cells)
    });
    page.table(&Table {
        columns,
        rows: rows.collect(),
    });
    if response.points.len() > MOST_POINTS {
        let more = response.points.len() - MOST_POINTS;
        page.paragraph(&format!("And {more} more, in responses.csv."));
    }
}
