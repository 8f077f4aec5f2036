//! The page of a sweep: plots, fronts, orders and all runs in one file that needs no other.

use std::fmt::Write;

use dem_io::text::for_page;
use dem_io::units::significant;

use super::curves;
use super::plot::svg;
use super::rows::{Judged, Row, SweepTable};
use super::text::front_of;

/// Most runs in the table of all; the CSV has every one.
const MOST_ROWS: usize = 2000;

const STYLE: &str = "body{font-family:Helvetica,Arial,sans-serif;color:#222;background:#fff;max-width:860px;margin:2em auto;padding:0 1em;line-height:1.4}\
table{border-collapse:collapse;margin:.6em 0 1.6em;font-size:14px}td,th{padding:.2em 1em .2em 0;text-align:left;border-bottom:1px solid #e4e4e4;vertical-align:top}\
td.n,th.n{text-align:right}tr.bad td{color:#a33}.wide{overflow-x:auto}svg{max-width:100%;height:auto}h2{margin-top:1.6em}p.small{color:#555;font-size:14px}";

/// The whole page.
pub fn page(table: &SweepTable) -> String {
    let mut out = String::new();
    // Writing to a text cannot fail.
    let _ = write_page(&mut out, table);
    out
}

fn write_page(out: &mut String, table: &SweepTable) -> std::fmt::Result {
    let title = for_page(&format!("Error against run time: {}", table.scene));
    writeln!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>"
    )?;
    writeln!(
        out,
        "<p>{}: {} runs, {} each, on {} thread{}. {}; {}.</p>",
        for_page(&table.study),
        table.runs.len(),
        table.times(),
        table.threads,
        if table.threads == 1 { "" } else { "s" },
        for_page(&table.machines.join("; ")),
        for_page(&table.program)
    )?;
    writeln!(
        out,
        "<p class=\"small\">Times are medians of the repeats, without start-up; lines across the marks show by how much times scatter. \
         Short runs are repeated more often. From the most exact run on, one is on the Pareto front if it is faster by more than that than all more exact \
         ones, errors counted with two digits. \
         Times hold for this sweep on this machine.</p>"
    )?;
    for (at, measure) in table.measures.iter().enumerate() {
        writeln!(
            out,
            "<h2>{}</h2>",
            for_page(&measure.name.replace('_', " "))
        )?;
        writeln!(out, "<p>Against {}.</p>", for_page(&measure.reference))?;
        writeln!(out, "{}", svg(table, at, false))?;
        if let Some(plot) = curves::plot(table, at) {
            writeln!(out, "{}", dem_io::results::svg(&plot))?;
        }
        write_front(out, table, at)?;
    }
    write_orders(out, table)?;
    write_failed(out, table)?;
    if !table.notes.is_empty() {
        writeln!(out, "<h2>Notes</h2>\n<ul>")?;
        for note in &table.notes {
            writeln!(out, "<li>{}</li>", for_page(note))?;
        }
        writeln!(out, "</ul>")?;
    }
    write_all(out, table)?;
    writeln!(out, "</body>\n</html>")
}

fn heads(out: &mut String, names: &[(&str, bool)]) -> std::fmt::Result {
    write!(out, "<tr>")?;
    for (name, is_number) in names {
        let class = if *is_number { " class=\"n\"" } else { "" };
        write!(out, "<th{class}>{}</th>", for_page(name))?;
    }
    writeln!(out, "</tr>")
}

fn number(out: &mut String, value: Option<f64>, digits: usize) -> std::fmt::Result {
    let text = value.map_or(String::new(), |value| significant(value, digits));
    write!(out, "<td class=\"n\">{text}</td>")
}

fn settings(out: &mut String, row: &Row) -> std::fmt::Result {
    row.settings
        .iter()
        .try_for_each(|value| write!(out, "<td>{}</td>", for_page(value)))
}

fn write_front(out: &mut String, table: &SweepTable, measure: usize) -> std::fmt::Result {
    let front = front_of(table, measure);
    if front.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "<p>On the Pareto front, the fastest first:</p>\n<div class=\"wide\"><table>"
    )?;
    let mut names = vec![("run", true), ("time (s)", true), ("error", true)];
    let is_timed = |row: &&Row| row.results[measure].times_as_fast.is_some();
    let with_ratio = front.iter().any(is_timed);
    if with_ratio {
        names.push(("times as fast as the finest", true));
    }
    names.extend(table.axes.iter().map(|axis| (axis.name.as_str(), false)));
    heads(out, &names)?;
    for row in front {
        write!(out, "<tr><td class=\"n\">{}</td>", row.number)?;
        number(out, row.time_s, 3)?;
        number(out, row.results[measure].sure_error(), 2)?;
        if with_ratio {
            number(out, row.results[measure].times_as_fast, 3)?;
        }
        settings(out, row)?;
        writeln!(out, "</tr>")?;
    }
    writeln!(out, "</table></div>")
}

fn write_orders(out: &mut String, table: &SweepTable) -> std::fmt::Result {
    if table.orders.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "<h2>Observed order</h2>\n<p>By which power of the size the error falls: the slope of the errors, or that of the values by Richardson extrapolation. \
         About 0: the error comes from something else.</p>\n<div class=\"wide\"><table>"
    )?;
    heads(
        out,
        &[
            ("measure", false),
            ("along", false),
            ("of", false),
            ("order", true),
            ("runs", true),
            ("from", false),
        ],
    )?;
    for order in table.orders.iter().take(MOST_ROWS) {
        writeln!(
            out,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"n\">{:.2}</td><td class=\"n\">{}</td><td>{}</td></tr>",
            for_page(&order.measure),
            for_page(&order.along),
            for_page(&order.of.join(", ")),
            order.order,
            order.runs,
            order.by
        )?;
    }
    writeln!(out, "</table></div>")
}

fn write_failed(out: &mut String, table: &SweepTable) -> std::fmt::Result {
    if table.failed().next().is_none() {
        return Ok(());
    }
    writeln!(out, "<h2>Failed</h2>\n<div class=\"wide\"><table>")?;
    let mut names = vec![("run", true)];
    names.extend(table.axes.iter().map(|axis| (axis.name.as_str(), false)));
    names.push(("why", false));
    heads(out, &names)?;
    for row in table.failed().take(MOST_ROWS) {
        write!(out, "<tr class=\"bad\"><td class=\"n\">{}</td>", row.number)?;
        settings(out, row)?;
        let why = row.failed.as_deref().unwrap_or_default();
        writeln!(out, "<td>{}</td></tr>", for_page(why))?;
    }
    writeln!(out, "</table></div>")
}

fn write_all(out: &mut String, table: &SweepTable) -> std::fmt::Result {
    writeln!(out, "<h2>All runs</h2>\n<div class=\"wide\"><table>")?;
    let mut names = vec![("run", true)];
    names.extend(table.axes.iter().map(|axis| (axis.name.as_str(), false)));
    names.extend([("time (s)", true), ("scatter (s)", true), ("steps", true)]);
    let of_measures: Vec<[String; 2]> = table
        .measures
        .iter()
        .map(|measure| {
            let unit = if measure.unit.is_empty() {
                String::new()
            } else {
                format!(" ({})", measure.unit)
            };
            [format!("{}{unit}", measure.name), "error".to_owned()]
        })
        .collect();
    names.extend(
        of_measures
            .iter()
            .flatten()
            .map(|name| (name.as_str(), true)),
    );
    heads(out, &names)?;
    for row in table.runs.iter().take(MOST_ROWS) {
        let class = if row.failed.is_some() {
            " class=\"bad\""
        } else {
            ""
        };
        write!(out, "<tr{class}><td class=\"n\">{}</td>", row.number)?;
        settings(out, row)?;
        if row.failed.is_some() {
            writeln!(out, "<td>failed</td></tr>")?;
            continue;
        }
        number(out, row.time_s, 3)?;
        number(out, row.spread_s, 2)?;
        number(out, row.steps.map(|steps| steps as f64), 12)?;
        for judged in &row.results {
            number(out, Some(judged.value), 8)?;
            write!(out, "<td class=\"n\">{}</td>", error_text(judged))?;
        }
        writeln!(out, "</tr>")?;
    }
    writeln!(out, "</table></div>")?;
    if table.runs.len() > MOST_ROWS {
        let more = table.runs.len() - MOST_ROWS;
        writeln!(out, "<p>And {more} more, in the CSV file.</p>")?;
    }
    Ok(())
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
