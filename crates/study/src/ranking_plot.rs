//! Plots of the effects of parameters: ranked bars, and sigma over mu*.

use dem_io::units::significant;
use dem_plots::{Axis, Bar, BarRow, Bars, Line, Marks, Plot, Point};

use super::one_at_a_time::Change;
use super::ranking::{DesignTable, MorrisRanking, OneAtATimeRanking};
use super::ranking_text::percent_text;
use super::sweep_table::SweepTable;
use super::words::{in_words, with_unit};

/// Meaning of a hollow bar or mark.
const HOLLOW: &str = "not above chance";

/// mu* of the parameters with its interval, by rank.
pub fn morris_bars(table: &SweepTable, design: &DesignTable, ranking: &MorrisRanking) -> Bars {
    let measure = &table.measures[ranking.measure];
    let row = |of: &super::ranking::MorrisParameter| BarRow {
        name: in_words(&design.parameters[of.parameter].name),
        bars: vec![of.statistics.as_ref().map(|statistics| Bar {
            end: statistics.mu_star,
            interval: Some(statistics.interval),
            is_hollow: of.is_above_chance == Some(false),
            title: format!(
                "{}: {} {}",
                design.parameters[of.parameter].name,
                significant(statistics.mu_star, 3),
                percent_text(statistics.mu_star, ranking.mean)
            ),
        })],
    };
    Bars {
        title: format!("{}: what changes it", measure.name.replace('_', " ")),
        label: with_unit("mean change over the range", &measure.unit),
        kinds: Vec::new(),
        hollow: HOLLOW.to_owned(),
        rows: ranking.parameters.iter().map(row).collect(),
    }
}

/// sigma over mu* of each parameter (figure 1 of Morris 1991, with mu* in place of mu). On the line
/// sigma = mu* and above it, signs differ or the effect depends on the other parameters.
pub fn sigma_plot(table: &SweepTable, design: &DesignTable, ranking: &MorrisRanking) -> Plot {
    let measure = &table.measures[ranking.measure];
    let known = ranking.parameters.iter().filter_map(|of| {
        let statistics = of.statistics.as_ref()?;
        Some((of, statistics, statistics.sigma?))
    });
    let marks = known.map(|(of, statistics, sigma)| {
        let [low, high] = statistics.interval;
        let path = &design.parameters[of.parameter].name;
        Marks {
            name: in_words(path),
            points: vec![Point {
                at: [statistics.mu_star, sigma],
                filled: of.is_above_chance != Some(false),
                title: format!(
                    "{path}: mu* {}, sigma {}",
                    significant(statistics.mu_star, 3),
                    significant(sigma, 3)
                ),
                ..Point::default()
            }],
            chains: vec![vec![[low, sigma], [high, sigma]]],
        }
    });
    let marks: Vec<Marks> = marks.collect();
    let ends = marks.iter().flat_map(|one| one.chains.iter().flatten());
    let largest = ends.map(|[mu_star, _]| *mu_star).fold(0.0, f64::max);
    let has_hollow = ranking
        .parameters
        .iter()
        .any(|of| of.is_above_chance == Some(false));
    Plot {
        title: format!(
            "{}: curvature and interaction",
            measure.name.replace('_', " ")
        ),
        x: Axis::of(&with_unit("mu*", &measure.unit)),
        y: Axis::of(&with_unit("sigma", &measure.unit)),
        lines: vec![Line::dashed("sigma = mu*", vec![[0.0, 0.0], [largest; 2]])],
        marks,
        filled: has_hollow.then(|| ["above chance", HOLLOW].map(str::to_owned)),
        if_empty: "no effect is known".to_owned(),
        ..Plot::default()
    }
}

/// The changes at both ends of each range, by rank.
pub fn change_bars(table: &SweepTable, design: &DesignTable, ranking: &OneAtATimeRanking) -> Bars {
    let measure = &table.measures[ranking.measure];
    let row = |of: &super::ranking::ChangedParameter| {
        let parameter = &design.parameters[of.parameter];
        let bar = |change: &Option<Change>, end: f64| {
            change.as_ref().map(|change| Bar {
                end: change.change,
                interval: (change.half_width)
                    .map(|half| [change.change - half, change.change + half]),
                is_hollow: change.is_above_chance() == Some(false),
                title: format!(
                    "{} {} {}: {} {}",
                    parameter.name,
                    significant(end, 4),
                    parameter.unit,
                    significant(change.change, 3),
                    percent_text(change.change, ranking.base)
                ),
            })
        };
        BarRow {
            name: in_words(&parameter.name),
            bars: vec![
                bar(&of.low, parameter.ends[0]),
                bar(&of.high, parameter.ends[1]),
            ],
        }
    };
    Bars {
        title: format!("{}: what changes it", measure.name.replace('_', " ")),
        label: with_unit("change from the base", &measure.unit),
        kinds: ["at the lower end", "at the upper end"]
            .map(str::to_owned)
            .into(),
        hollow: HOLLOW.to_owned(),
        rows: ranking.parameters.iter().map(row).collect(),
    }
}
