//! Probabilities on the page of a sweep, in its plots and CSV files.

use dem_plots::{Axis, Column, Line, Marks, Page, Plot, Point, Row, Table};

use super::csv_line::{line, number};
use super::probability::{Probability, ProbabilityCase, SHOWN, percent};
use super::response_plot::{horizontal, shown_axes};
use super::sweep_table::SweepTable;
use super::text::{cell, heading};
use super::words::{in_words, with_unit};

/// Largest number of cases with plots, and of points in the table; the CSV has all of them.
const MOST_PLOTS: usize = 20;
const MOST_POINTS: usize = 500;

/// The plots of the first cases.
pub fn probability_plots(table: &SweepTable, of: &Probability) -> Vec<Plot> {
    let cases = of.cases.iter().take(MOST_PLOTS);
    cases.map(|case| plot(table, of, case)).collect()
}

fn plot(table: &SweepTable, of: &Probability, case: &ProbabilityCase) -> Plot {
    let outcome = of.outcome(&table.measures[of.measure].name.replace('_', " "));
    let mut lines = Vec::new();
    if let Some(fit) = &case.fit {
        let part = |k: usize| fit.curve.iter().map(move |point| [point[0], point[k]]);
        // A gap between the two ends of the band.
        let band = part(2).chain([[f64::NAN; 2]]).chain(part(3));
        lines.push(Line::new("logistic curve", part(1).collect()));
        lines.push(Line::dashed("its 95 % confidence band", band.collect()));
    }
    let mark = |point: &super::probability::ProbabilityPoint| Point {
        at: [point.value, point.fraction],
        filled: point.doubtful == 0,
        title: format!("{} of {} runs", point.with_outcome, point.runs),
        ..Point::default()
    };
    let bar = |point: &super::probability::ProbabilityPoint| {
        point.between.map(|end| [point.value, end]).into()
    };
    let axis = horizontal(&table.axes[of.over]);
    Plot {
        title: match case.settings.as_str() {
            "" => outcome,
            settings => format!("{outcome}: {settings}"),
        },
        x: Axis {
            log: of.is_log,
            ..axis
        },
        y: Axis::of("fraction of the runs"),
        lines,
        marks: vec![Marks {
            name: "runs, with 95 % confidence".to_owned(),
            points: case.points.iter().map(mark).collect(),
            chains: case.points.iter().map(bar).collect(),
        }],
        filled: (case.points.iter().any(|point| point.doubtful > 0))
            .then(|| ["sound or coarse", "doubtful"].map(str::to_owned)),
        if_empty: "no run has a value".to_owned(),
        ..Plot::default()
    }
}

/// The results, plots and points.
pub(crate) fn add_probability(page: &mut Page, table: &SweepTable) {
    let Some(of) = &table.probability else {
        return;
    };
    let measure = &table.measures[of.measure];
    page.heading("Probability");
    for case in &of.cases {
        page.paragraph(&format!("Result: {}.", of.in_words(case, &measure.name)));
    }
    for plot in probability_plots(table, of) {
        page.figure(&plot.svg());
    }
    page.small("Curve: logistic, by the largest likelihood with Firth's penalty; its intervals are those of the profile of that likelihood. Bars: Wilson's intervals of the runs at each value. All with a confidence of 95 %.");
    let axes: Vec<usize> = shown_axes(table).filter(|at| *at != of.over).collect();
    let mut columns: Vec<Column> = (axes.iter())
        .map(|at| Column::text(&in_words(&table.axes[*at].name)))
        .collect();
    columns.push(Column::number(&with_unit(
        &in_words(&of.parameter),
        &of.unit,
    )));
    let names = [
        "runs",
        "with the outcome",
        "fraction (%)",
        "from (%)",
        "to (%)",
        "curve (%)",
        "from (%)",
        "to (%)",
    ];
    columns.extend(names.map(Column::number));
    let rows = of.cases.iter().flat_map(|case| {
        let settings = axes
            .iter()
            .map(|at| table.axes[*at].values[case.choice[*at]].clone());
        let settings: Vec<String> = settings.collect();
        case.points.iter().map(move |point| {
            let mut cells = settings.clone();
            cells.push(super::words::number(Some(point.value), 6));
            cells.extend([point.runs, point.with_outcome].map(|count| count.to_string()));
            cells.push(percent(point.fraction));
            cells.extend(point.between.map(percent));
            let fitted = point
                .fitted
                .map(|fitted| fitted.map(Some))
                .unwrap_or_default();
            cells.extend(fitted.map(|value| value.map_or(String::new(), percent)));
            Row::from(cells)
        })
    });
    page.table(&Table {
        columns,
        rows: rows.take(MOST_POINTS).collect(),
    });
}

/// The points with one line for each case and value of the parameter: fractions and probabilities
/// from 0 to 1.
pub fn probability_csv(table: &SweepTable, of: &Probability) -> String {
    let axes: Vec<usize> = shown_axes(table).filter(|at| *at != of.over).collect();
    let mut columns: Vec<String> = axes.iter().map(|at| heading(&table.axes[*at])).collect();
    columns.push(of.heading());
    let names = [
        "runs",
        "with_outcome",
        "doubtful",
        "fraction",
        "fraction_from",
        "fraction_to",
        "fitted",
        "fitted_from",
        "fitted_to",
    ];
    columns.extend(names.map(str::to_owned));
    let mut out = line(&columns);
    for case in &of.cases {
        for point in &case.points {
            let mut cells: Vec<String> = (axes.iter())
                .map(|at| cell(table, *at, case.choice[*at]))
                .collect();
            cells.push(number(Some(point.value)));
            cells.extend([point.runs, point.with_outcome, point.doubtful].map(|n| n.to_string()));
            cells.push(number(Some(point.fraction)));
            cells.extend(point.between.map(|end| number(Some(end))));
            cells.extend([0, 1, 2].map(|k| number(point.fitted.map(|fitted| fitted[k]))));
            out += &line(&cells);
        }
    }
    out
}

/// The curves with one line for each case: coefficients, and the values of the parameter at 10, 50
/// and 90 % with the ends of their intervals.
pub fn probability_fit_csv(table: &SweepTable, of: &Probability) -> String {
    let axes: Vec<usize> = shown_axes(table).filter(|at| *at != of.over).collect();
    let mut columns: Vec<String> = axes.iter().map(|at| heading(&table.axes[*at])).collect();
    columns.extend(["runs", "with_outcome", "a", "b"].map(str::to_owned));
    for name in ["at_10", "at_50", "at_90"] {
        let named = ["", "_from", "_to"].map(|end| with_unit(&format!("{name}{end}"), &of.unit));
        columns.extend(named);
    }
    let mut out = line(&columns);
    for case in &of.cases {
        let mut cells: Vec<String> = (axes.iter())
            .map(|at| cell(table, *at, case.choice[*at]))
            .collect();
        let (runs, with_outcome) = case.counts();
        cells.extend([runs, with_outcome].map(|count| count.to_string()));
        let fit = case.fit.as_ref();
        cells.extend([fit.map(|fit| fit.a), fit.map(|fit| fit.b)].map(number));
        for shown in SHOWN {
            let at = fit.and_then(|fit| fit.values.iter().find(|at| at.probability == shown));
            cells.push(number(at.map(|at| at.value)));
            let ends = at.map_or([None; 2], |at| at.between);
            cells.extend(ends.map(number));
        }
        out += &line(&cells);
    }
    out
}
