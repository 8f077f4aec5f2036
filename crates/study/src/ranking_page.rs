//! The ranking of parameters on the page of a sweep.

use dem_io::units::significant;
use dem_plots::{Column, Page, Row, Table};

use super::ranking::{DesignTable, MorrisRanking, OneAtATimeRanking, RangedParameter, Rankings};
use super::ranking_plot::{change_bars, morris_bars, sigma_plot};
use super::ranking_text::{change_text, percent_text, verdict};
use super::sweep_table::SweepTable;
use super::words::{in_words, number, with_unit};

/// The design, and for all measures at a glance what each parameter changes.
pub(crate) fn add_design(page: &mut Page, table: &SweepTable, design: &DesignTable) {
    page.heading("Which parameters matter");
    page.paragraph(&format!("{}.", design.words));
    page.small(match design.rankings {
        Rankings::Morris(_) => {
            "Elementary effects (Morris 1991): the change of a measure over the step of one parameter that causes it, times the whole range. mu*: mean of their magnitudes \
             (Campolongo et al. 2007), with its 95 % confidence interval; mu: mean with signs; sigma: standard deviation, large if the effect is curved or depends on the other parameters. \
             Here mu* as per cent of the mean of each measure; in brackets what chance alone may give."
        }
        Rankings::OneAtATime(_) => {
            "Changes of each measure from the base to the lower and to the upper end of each range, as per cent of its value at the base; in brackets what chance alone may give. \
             ±: 95 % confidence interval by chance."
        }
    });
    let mut columns = vec![Column::text("parameter"), Column::text("range")];
    let measures = table.measures.iter();
    columns.extend(measures.map(|measure| Column::number(&in_words(&measure.name))));
    let rows = design.parameters.iter().enumerate().map(|(parameter, of)| {
        let mut cells = vec![of.name.clone(), range_text(of)];
        cells.extend((0..table.measures.len()).map(|measure| share(design, measure, parameter)));
        Row::from(cells)
    });
    page.table(&Table {
        columns,
        rows: rows.collect(),
    });
}

/// `20 to 60 MPa`.
pub(crate) fn range_text(of: &RangedParameter) -> String {
    let [low, high] = of.ends.map(|end| significant(end, 4));
    let log = if of.is_log { ", logarithmic" } else { "" };
    let base = of.base.map_or(String::new(), |base| {
        format!(", base {}", significant(base, 4))
    });
    format!("{low} to {high} {}", of.unit).trim_end().to_owned() + log + &base
}

/// What a parameter changes of a measure, in per cent; in brackets if chance may give as much.
fn share(design: &DesignTable, measure: usize, parameter: usize) -> String {
    let (text, is_above_chance) = match &design.rankings {
        Rankings::Morris(rankings) => {
            let ranking = &rankings[measure];
            let of = ranking
                .parameters
                .iter()
                .find(|of| of.parameter == parameter);
            let text = of
                .and_then(|of| of.statistics.as_ref())
                .map(|of| percent_text(of.mu_star, ranking.mean));
            (
                text.unwrap_or_default(),
                of.and_then(|of| of.is_above_chance),
            )
        }
        Rankings::OneAtATime(rankings) => {
            let ranking = &rankings[measure];
            let of = ranking
                .parameters
                .iter()
                .find(|of| of.parameter == parameter);
            let changes = of.map_or([None, None], |of| [of.low.as_ref(), of.high.as_ref()]);
            let texts = changes
                .into_iter()
                .flatten()
                .map(|of| percent_text(of.change, ranking.base));
            let texts: Vec<String> = texts.collect();
            (texts.join(", "), of.and_then(|of| of.is_above_chance))
        }
    };
    match is_above_chance {
        Some(false) if !text.is_empty() => format!("({text})"),
        _ => text,
    }
}

/// The plots and the table of a measure.
pub(crate) fn add_ranking(
    page: &mut Page,
    table: &SweepTable,
    design: &DesignTable,
    measure: usize,
) {
    match &design.rankings {
        Rankings::Morris(rankings) => {
            let ranking = &rankings[measure];
            page.figure(&morris_bars(table, design, ranking).svg());
            page.figure(&sigma_plot(table, design, ranking).svg());
            page.table(&morris_table(table, design, ranking));
        }
        Rankings::OneAtATime(rankings) => {
            let ranking = &rankings[measure];
            page.figure(&change_bars(table, design, ranking).svg());
            page.table(&change_table(table, design, ranking));
        }
    }
}

fn morris_table(table: &SweepTable, design: &DesignTable, ranking: &MorrisRanking) -> Table {
    let unit = &table.measures[ranking.measure].unit;
    let mut columns = vec![Column::number("rank"), Column::text("parameter")];
    columns.push(Column::number(&with_unit("mu*", unit)));
    columns.push(Column::text("95 % interval"));
    let others = ["of the mean", "mu", "sigma", "chance", "effects"];
    columns.extend(others.map(Column::number));
    columns.push(Column::text("verdict"));
    let rows = (1..)
        .zip(&ranking.parameters)
        .map(|(rank, of): (usize, _)| {
            let statistics = of.statistics.as_ref();
            let interval = statistics.map_or(String::new(), |of| {
                let [low, high] = of.interval.map(|end| significant(end, 3));
                format!("{low} to {high}")
            });
            let percent = statistics.map(|of| percent_text(of.mu_star, ranking.mean));
            Row::from(vec![
                rank.to_string(),
                design.parameters[of.parameter].name.clone(),
                number(statistics.map(|of| of.mu_star), 3),
                interval,
                percent.unwrap_or_default(),
                number(statistics.map(|of| of.mu), 3),
                number(statistics.and_then(|of| of.sigma), 3),
                number(statistics.and_then(|of| of.chance), 2),
                statistics.map_or(0, |of| of.effects).to_string(),
                verdict(statistics.is_some(), of.is_above_chance).to_owned(),
            ])
        });
    Table {
        rows: rows.collect(),
        columns,
    }
}

fn change_table(table: &SweepTable, design: &DesignTable, ranking: &OneAtATimeRanking) -> Table {
    let unit = &table.measures[ranking.measure].unit;
    let columns = vec![
        Column::number("rank"),
        Column::text("parameter"),
        Column::number(&with_unit("at the lower end", unit)),
        Column::number("of the base"),
        Column::number(&with_unit("at the upper end", unit)),
        Column::number("of the base"),
        Column::number("elasticity"),
        Column::text("verdict"),
    ];
    let rows = (1..)
        .zip(&ranking.parameters)
        .map(|(rank, of): (usize, _)| {
            let mut cells = vec![
                rank.to_string(),
                design.parameters[of.parameter].name.clone(),
            ];
            for change in [&of.low, &of.high] {
                let percent = change
                    .as_ref()
                    .map(|of| percent_text(of.change, ranking.base));
                cells.push(change_text(change.as_ref()));
                cells.push(percent.unwrap_or_default());
            }
            cells.push(number(of.elasticity, 2));
            cells.push(verdict(of.largest().is_some(), of.is_above_chance).to_owned());
            Row::from(cells)
        });
    Table {
        rows: rows.collect(),
        columns,
    }
}
