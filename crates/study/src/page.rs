//! The page of a sweep: plots, fronts, orders and all runs in one self-contained file.

use dem_io::units::significant;
use dem_plots::{Column, Page, Table};

use super::curves;
use super::plot::plot;
use super::probability_page;
use super::ranking_page;
use super::response_page;
use super::row::{Judged, Row};
use super::sweep_table::SweepTable;
use super::text::front_of;
use super::words::{in_words, number, with_unit};

/// Largest number of runs in the table; the CSV has all of them.
const MOST_ROWS: usize = 2000;

/// The complete page as HTML.
pub fn page(table: &SweepTable) -> String {
    let mut page = Page::new(&format!("{}: {}", subject(table), table.scene));
    page.paragraph(&format!(
        "{}: {} runs, {} each, on {} thread{}. {}; {}.",
        table.study,
        table.runs.len(),
        table.times(),
        table.threads,
        if table.threads == 1 { "" } else { "s" },
        table.machines.join("; "),
        table.program
    ));
    if table.has_errors() {
        page.small(
            "Times are medians of the repeats, without start-up; lines across the marks show by how much times scatter. \
             Short runs are repeated more often. From the most exact run on, one is on the Pareto front if it is faster by more than that than all more exact \
             ones, errors counted with two digits. \
             Times hold for this sweep on this machine.",
        );
    }
    response_page::add_search(&mut page, table);
    probability_page::add_probability(&mut page, table);
    if let Some(design) = &table.design {
        ranking_page::add_design(&mut page, table, design);
    }
    for (at, measure) in table.measures.iter().enumerate() {
        page.heading(&measure.name.replace('_', " "));
        match (
            &table.design,
            table.responses.iter().find(|r| r.measure == at),
        ) {
            (Some(design), _) => ranking_page::add_ranking(&mut page, table, design, at),
            (None, Some(response)) => response_page::add_response(&mut page, table, response),
            (None, None) => {}
        }
        if let Some(reference) = &measure.reference {
            page.paragraph(&format!("Against {reference}."));
            page.figure(&plot(table, at).svg());
        }
        if let Some(plot) = curves::plot(table, at) {
            page.figure(&plot.svg());
        }
        add_front(&mut page, table, at);
    }
    add_orders(&mut page, table);
    add_failed(&mut page, table);
    if !table.notes.is_empty() {
        page.heading("Notes");
        page.list(&table.notes);
    }
    add_all(&mut page, table);
    page.html()
}

/// What the page shows.
fn subject(table: &SweepTable) -> &'static str {
    match (table.has_errors(), table.responses.is_empty()) {
        _ if table.design.is_some() => "Which parameters matter",
        (true, true) => "Error against run time",
        (true, false) => "Response, and error against run time",
        (false, _) => "Response",
    }
}

fn of_axes(table: &SweepTable) -> impl Iterator<Item = Column> {
    table
        .axes
        .iter()
        .map(|axis| Column::text(&in_words(&axis.name)))
}

fn add_front(page: &mut Page, table: &SweepTable, measure: usize) {
    let front = front_of(table, measure);
    if front.is_empty() {
        return;
    }
    page.paragraph("On the Pareto front, the fastest first:");
    let mut columns = ["run", "time (s)", "error"].map(Column::number).to_vec();
    let is_timed = |row: &&Row| row.results[measure].times_as_fast.is_some();
    let with_ratio = front.iter().any(is_timed);
    if with_ratio {
        columns.push(Column::number("times as fast as the finest"));
    }
    columns.extend(of_axes(table));
    let cells = |row: &Row| {
        let judged = &row.results[measure];
        let error = number(judged.sure_error(), 2);
        let mut cells = vec![row.number.to_string(), number(row.time_s, 3), error];
        if with_ratio {
            cells.push(number(judged.times_as_fast, 3));
        }
        cells.extend(row.settings.iter().cloned());
        cells
    };
    let rows = front.into_iter().map(|row| cells(row).into()).collect();
    page.table(&Table { columns, rows });
}

fn add_orders(page: &mut Page, table: &SweepTable) {
    if table.orders.is_empty() {
        return;
    }
    page.heading("Observed order");
    page.paragraph(
        "By which power of the size the error falls: the slope of the errors, or that of the values by Richardson extrapolation. \
         About 0: the error comes from something else.",
    );
    let [measure, along, of, by] = ["measure", "along", "of", "from"].map(Column::text);
    let [order, runs] = ["order", "runs"].map(Column::number);
    let rows = (table.orders.iter().take(MOST_ROWS)).map(|order| {
        let [size, runs] = [format!("{:.2}", order.order), order.runs.to_string()];
        let [measure, along, by] = [&order.measure, &order.along, &order.by].map(String::clone);
        vec![measure, along, order.of.join(", "), size, runs, by].into()
    });
    page.table(&Table {
        columns: vec![measure, along, of, order, runs, by],
        rows: rows.collect(),
    });
}

fn add_failed(page: &mut Page, table: &SweepTable) {
    if table.failed().next().is_none() {
        return;
    }
    page.heading("Failed");
    let mut columns = vec![Column::number("run")];
    columns.extend(of_axes(table));
    columns.push(Column::text("why"));
    let rows = table.failed().take(MOST_ROWS).map(|row| {
        let mut cells = vec![row.number.to_string()];
        cells.extend(row.settings.iter().cloned());
        cells.push(row.failed.clone().unwrap_or_default());
        dem_plots::Row {
            cells,
            is_bad: true,
            link: None,
        }
    });
    page.table(&Table {
        columns,
        rows: rows.collect(),
    });
}

fn add_all(page: &mut Page, table: &SweepTable) {
    page.heading("All runs");
    if table.runs.iter().any(|row| row.report.is_some()) {
        page.small("The number of a run leads to its page, with its view in three dimensions if the scene has output.frames.");
    }
    let mut columns = vec![Column::number("run")];
    columns.extend(of_axes(table));
    columns.extend(["time (s)", "scatter (s)", "steps"].map(Column::number));
    for measure in &table.measures {
        columns.push(Column::number(&with_unit(
            &in_words(&measure.name),
            &measure.unit,
        )));
        columns.extend(measure.reference.as_ref().map(|_| Column::number("error")));
    }
    columns.push(Column::text("verdict"));
    let rows = table.runs.iter().take(MOST_ROWS);
    let rows = rows.map(|row| of_run(table, row)).collect();
    page.table(&Table { columns, rows });
    if table.runs.len() > MOST_ROWS {
        let more = table.runs.len() - MOST_ROWS;
        page.paragraph(&format!("And {more} more, in the CSV file."));
    }
}

fn of_run(table: &SweepTable, row: &Row) -> dem_plots::Row {
    let mut cells = vec![row.number.to_string()];
    cells.extend(row.settings.iter().cloned());
    if row.failed.is_some() {
        cells.push("failed".to_owned());
        return dem_plots::Row {
            cells,
            is_bad: true,
            link: None,
        };
    }
    cells.push(number(row.time_s, 3));
    cells.push(number(row.spread_s, 2));
    cells.push(number(row.steps.map(|steps| steps as f64), 12));
    for (judged, measure) in row.results.iter().zip(&table.measures) {
        cells.push(number(Some(judged.value), 4));
        cells.extend(measure.reference.as_ref().map(|_| error_text(judged)));
    }
    cells.push(row.verdict().to_owned());
    dem_plots::Row {
        cells,
        is_bad: false,
        link: row.report.clone(),
    }
}

fn error_text(judged: &Judged) -> String {
    match (judged.is_reference, judged.error, judged.uncertainty) {
        (true, ..) => "reference".to_owned(),
        (_, None, _) => String::new(),
        (_, Some(error), None) => significant(error, 2),
        (_, Some(error), Some(uncertainty)) => {
            format!(
                "{} ± {}",
                significant(error, 2),
                significant(uncertainty, 1)
            )
        }
    }
}
