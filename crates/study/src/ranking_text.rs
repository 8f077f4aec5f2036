//! The ranking of parameters as CSV and as human-readable text.

use std::fmt;

use dem_io::text::visible;
use dem_io::units::significant;

use super::csv_line::{line, number};
use super::one_at_a_time::Change;
use super::ranking::{
    ChangedParameter, DesignTable, MorrisParameter, MorrisRanking, OneAtATimeRanking, Rankings,
};
use super::sweep_table::SweepTable;
use super::words::with_unit;

/// `effects.csv`: a line for each measure and parameter, by rank.
pub fn effects_csv(table: &SweepTable, design: &DesignTable) -> String {
    let head = [
        "measure",
        "unit",
        "rank",
        "parameter",
        "parameter_unit",
        "from",
        "to",
    ];
    let own: &[&str] = match design.rankings {
        Rankings::Morris(_) => &[
            "effects",
            "mu_star",
            "mu_star_low",
            "mu_star_high",
            "mu_star_percent",
            "mu",
            "sigma",
            "chance",
        ],
        Rankings::OneAtATime(_) => &[
            "base",
            "low_change",
            "low_half_width",
            "low_percent",
            "high_change",
            "high_half_width",
            "high_percent",
            "elasticity",
        ],
    };
    let columns = head.iter().chain(own).chain(&["verdict"]);
    let mut out = line(&columns.map(|name| (*name).to_owned()).collect::<Vec<_>>());
    let mut add = |measure: usize, rank: usize, parameter: usize, cells: Vec<String>| {
        let measure = &table.measures[measure];
        let of = &design.parameters[parameter];
        let mut all = vec![measure.name.clone(), measure.unit.clone(), rank.to_string()];
        all.extend([of.name.clone(), of.unit.clone()]);
        all.extend(of.ends.map(|end| number(Some(end))));
        all.extend(cells);
        out += &line(&all);
    };
    match &design.rankings {
        Rankings::Morris(rankings) => {
            for one in rankings {
                for (rank, of) in (1..).zip(&one.parameters) {
                    add(one.measure, rank, of.parameter, morris_cells(one, of));
                }
            }
        }
        Rankings::OneAtATime(rankings) => {
            for one in rankings {
                for (rank, of) in (1..).zip(&one.parameters) {
                    let base = design.parameters[of.parameter].base;
                    add(
                        one.measure,
                        rank,
                        of.parameter,
                        changed_cells(one, of, base),
                    );
                }
            }
        }
    }
    out
}

fn morris_cells(ranking: &MorrisRanking, parameter: &MorrisParameter) -> Vec<String> {
    let of = parameter.statistics.as_ref();
    let percent = of.and_then(|of| percent_of(of.mu_star, ranking.mean));
    vec![
        of.map_or(0, |of| of.effects).to_string(),
        number(of.map(|of| of.mu_star)),
        number(of.map(|of| of.interval[0])),
        number(of.map(|of| of.interval[1])),
        number(percent),
        number(of.map(|of| of.mu)),
        number(of.and_then(|of| of.sigma)),
        number(of.and_then(|of| of.chance)),
        verdict(of.is_some(), parameter.is_above_chance).to_owned(),
    ]
}

fn changed_cells(
    ranking: &OneAtATimeRanking,
    parameter: &ChangedParameter,
    base: Option<f64>,
) -> Vec<String> {
    let mut cells = vec![number(base)];
    for change in [&parameter.low, &parameter.high] {
        let change = change.as_ref();
        cells.push(number(change.map(|of| of.change)));
        cells.push(number(change.and_then(|of| of.half_width)));
        let percent = change.and_then(|of| percent_of(of.change, ranking.base));
        cells.push(number(percent));
    }
    cells.push(number(parameter.elasticity));
    let is_known = parameter.largest().is_some();
    cells.push(verdict(is_known, parameter.is_above_chance).to_owned());
    cells
}

/// A change as per cent of the magnitude of a value. None: that is 0 or not known.
pub(crate) fn percent_of(change: f64, value: Option<f64>) -> Option<f64> {
    let value = value.filter(|value| *value != 0.0)?;
    Some(100.0 * change / value.abs())
}

/// `27 %`; empty if it is not known.
pub(crate) fn percent_text(change: f64, value: Option<f64>) -> String {
    percent_of(change, value).map_or(String::new(), |of| format!("{} %", significant(of, 2)))
}

/// Whether an effect is more than chance.
pub(crate) fn verdict(is_known: bool, is_above_chance: Option<bool>) -> &'static str {
    match (is_known, is_above_chance) {
        (false, _) => "no values",
        (true, None) => "chance unknown",
        (true, Some(true)) => "above chance",
        (true, Some(false)) => "within chance",
    }
}

/// `-12 ± 3`; empty if it is not known.
pub(crate) fn change_text(change: Option<&Change>) -> String {
    change.map_or(String::new(), |of| {
        let half = of
            .half_width
            .map(|half| format!(" ± {}", significant(half, 2)));
        significant(of.change, 3) + &half.unwrap_or_default()
    })
}

/// The remark behind a parameter; empty for an effect above chance, or if chance is not known.
fn remark(is_known: bool, is_above_chance: Option<bool>) -> &'static str {
    match (is_known, is_above_chance) {
        (false, _) => "  (no values)",
        (true, Some(false)) => "  (within chance)",
        _ => "",
    }
}

/// The design, and the ranked parameters of each measure.
pub(crate) fn write_design(
    f: &mut fmt::Formatter<'_>,
    table: &SweepTable,
    design: &DesignTable,
) -> fmt::Result {
    writeln!(f, "design       {}", visible(&design.words))?;
    match &design.rankings {
        Rankings::Morris(rankings) => {
            for ranking in rankings {
                write_morris(f, table, design, ranking)?;
            }
        }
        Rankings::OneAtATime(rankings) => {
            for ranking in rankings {
                write_changes(f, table, design, ranking)?;
            }
        }
    }
    Ok(())
}

fn write_morris(
    f: &mut fmt::Formatter<'_>,
    table: &SweepTable,
    design: &DesignTable,
    ranking: &MorrisRanking,
) -> fmt::Result {
    let measure = &table.measures[ranking.measure];
    let mean = ranking.mean.map_or(String::new(), |mean| {
        format!(", mean {}", significant(mean, 3))
    });
    let name = with_unit(&measure.name, &measure.unit);
    writeln!(
        f,
        "effects      {name}{mean}: changes over the whole range of each parameter"
    )?;
    writeln!(
        f,
        "  {:>4} {:>10}  {:<22} {:>8} {:>10} {:>10}  parameter",
        "rank", "mu*", "95 % interval", "of mean", "mu", "sigma"
    )?;
    for (rank, of) in (1..).zip(&ranking.parameters) {
        let path = visible(&design.parameters[of.parameter].name);
        let remark = remark(of.statistics.is_some(), of.is_above_chance);
        let cells = of.statistics.as_ref().map(|of| {
            let [low, high] = of.interval.map(|end| significant(end, 3));
            [
                significant(of.mu_star, 3),
                format!("{low} to {high}"),
                percent_text(of.mu_star, ranking.mean),
                significant(of.mu, 3),
                of.sigma
                    .map_or(String::new(), |sigma| significant(sigma, 3)),
            ]
        });
        let [mu_star, interval, percent, mu, sigma] = cells.unwrap_or_default();
        writeln!(
            f,
            "  {rank:>4} {mu_star:>10}  {interval:<22} {percent:>8} {mu:>10} {sigma:>10}  {path}{remark}"
        )?;
    }
    Ok(())
}

fn write_changes(
    f: &mut fmt::Formatter<'_>,
    table: &SweepTable,
    design: &DesignTable,
    ranking: &OneAtATimeRanking,
) -> fmt::Result {
    let measure = &table.measures[ranking.measure];
    let scatter = ranking.base_deviation;
    let scatter = scatter.map_or(String::new(), |of| format!(" ± {}", significant(of, 2)));
    let base = ranking
        .base
        .map_or("not known".to_owned(), |base| significant(base, 4));
    let name = with_unit(&measure.name, &measure.unit);
    writeln!(
        f,
        "changes      {name} at the base {base}{scatter}; of it at the ends of each range"
    )?;
    writeln!(
        f,
        "  {:>4} {:<20} {:>8}  {:<20} {:>8} {:>10}  parameter",
        "rank", "at the lower end", "", "at the upper end", "", "elasticity"
    )?;
    for (rank, of) in (1..).zip(&ranking.parameters) {
        let parameter = &design.parameters[of.parameter];
        let path = visible(&parameter.name);
        let remark = remark(of.largest().is_some(), of.is_above_chance);
        let [low, high] = [&of.low, &of.high].map(|change| {
            let percent = |of: &Change| percent_text(of.change, ranking.base);
            let percent = change.as_ref().map_or(String::new(), percent);
            (change_text(change.as_ref()), percent)
        });
        let elasticity = of.elasticity.map_or(String::new(), |of| significant(of, 2));
        writeln!(
            f,
            "  {rank:>4} {:<20} {:>8}  {:<20} {:>8} {elasticity:>10}  {path}{remark}",
            low.0, low.1, high.0, high.1
        )?;
    }
    Ok(())
}
