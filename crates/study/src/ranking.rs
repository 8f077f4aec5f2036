//! Which parameters matter: the effects of the parameters of a design on each measure, ranked.

use dem_io::text::counted;
use dem_laboratory::Statistic;
use dem_scene::study::{Axis, Design, DesignKind, DesignRange, Study};
use serde::Serialize;

use super::design::{in_words, seeds, trajectories};
use super::morris::{EffectStatistics, ElementaryEffect};
use super::one_at_a_time::{Change, elasticity};
use super::row::Row;

/// Largest number of failed runs that a note names.
const MOST_NAMED: usize = 10;

/// The design of a study, and the effects that its runs show.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DesignTable {
    /// The design in words, with the number of its runs.
    pub words: String,
    /// The parameters, in the order of the study.
    pub parameters: Vec<RangedParameter>,
    /// Their effects on each measure.
    #[serde(flatten)]
    pub rankings: Rankings,
}

/// A parameter and its range.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RangedParameter {
    /// Its path.
    pub name: String,
    /// Ends of the range in `unit`, ascending.
    pub ends: [f64; 2],
    /// Unit as written; empty for plain numbers.
    pub unit: String,
    /// True if levels have equal ratios.
    pub is_log: bool,
    /// Value from which it changes, one at a time.
    pub base: Option<f64>,
}

/// The effects on each measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Rankings {
    /// Statistics of elementary effects.
    Morris(Vec<MorrisRanking>),
    /// Changes from the base.
    OneAtATime(Vec<OneAtATimeRanking>),
}

/// The elementary effects on one measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MorrisRanking {
    /// Index of the measure.
    pub measure: usize,
    /// Mean magnitude of its values in all runs, in its unit. None: no run has a value.
    pub mean: Option<f64>,
    /// The parameters by falling mu*, those without effects last.
    pub parameters: Vec<MorrisParameter>,
}

/// The elementary effects of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MorrisParameter {
    /// Its index among the parameters.
    pub parameter: usize,
    /// Their statistics. None: no step of it has values at both ends.
    pub statistics: Option<EffectStatistics>,
    /// Whether mu* is more than chance would give. None: that is not known.
    pub is_above_chance: Option<bool>,
}

/// The changes of one measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OneAtATimeRanking {
    /// Index of the measure.
    pub measure: usize,
    /// Its value at the base, in its unit: the mean over the seeds. None: no such run has a value.
    pub base: Option<f64>,
    /// Standard deviation over the seeds at the base. None for a single value.
    pub base_deviation: Option<f64>,
    /// The parameters by falling larger change, those without changes last.
    pub parameters: Vec<ChangedParameter>,
}

/// What one parameter changes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChangedParameter {
    /// Its index among the parameters.
    pub parameter: usize,
    /// Change from the base to the lower end. None: the base is there, or values are missing.
    pub low: Option<Change>,
    /// Change from the base to the upper end.
    pub high: Option<Change>,
    /// d ln y/d ln x between the outermost values; see [`elasticity`].
    pub elasticity: Option<f64>,
    /// Whether one of the changes is more than chance. None: that is not known.
    pub is_above_chance: Option<bool>,
}

impl ChangedParameter {
    /// The larger magnitude of its changes.
    pub fn largest(&self) -> Option<f64> {
        let both = [&self.low, &self.high].into_iter().flatten();
        both.map(|change| change.change.abs()).reduce(f64::max)
    }
}

/// The values of one measure: for each point of the design those of the seeds. None: that run has
/// no value.
struct Values(Vec<Vec<Option<f64>>>);

impl Values {
    fn of(rows: &[Row], seeds: usize, measure: usize) -> Self {
        let value = |row: &Row| row.results.get(measure).map(|judged| judged.value);
        let points = rows.chunks(seeds.max(1));
        Self(
            points
                .map(|rows| rows.iter().map(value).collect())
                .collect(),
        )
    }

    fn at(&self, point: usize) -> &[Option<f64>] {
        self.0.get(point).map_or(&[], Vec::as_slice)
    }

    fn known(&self, point: usize) -> Vec<f64> {
        self.at(point).iter().copied().flatten().collect()
    }
}

/// The effects in a study with a design, and notes on them. `rows`: its runs in their order. None:
/// the study has no design.
pub(crate) fn design_table(study: &Study, rows: &[Row]) -> Option<(DesignTable, Vec<String>)> {
    let design = study.design.as_ref()?;
    let count = design.ranges.len();
    let seeds = seeds(study);
    let measures = 0..study.measures.len();
    let values = measures.map(|measure| (measure, Values::of(rows, seeds, measure)));
    let rankings = match design.kind {
        DesignKind::Morris { levels, .. } => Rankings::Morris(
            values
                .map(|(at, of)| morris(design, levels, at, &of))
                .collect(),
        ),
        DesignKind::OneAtATime => Rankings::OneAtATime(
            values
                .map(|(at, of)| one_at_a_time(design, at, &of))
                .collect(),
        ),
    };
    let axes = study.axes.iter().take(count);
    let table = DesignTable {
        words: in_words(study, design),
        parameters: axes.zip(&design.ranges).map(parameter).collect(),
        rankings,
    };
    let notes = notes(&table, rows, seeds);
    Some((table, notes))
}

fn parameter((axis, range): (&Axis, &DesignRange)) -> RangedParameter {
    RangedParameter {
        name: axis.name.clone(),
        ends: range.ends,
        unit: range.unit.clone(),
        is_log: range.is_log,
        base: range.base,
    }
}

fn morris(design: &Design, levels: usize, measure: usize, values: &Values) -> MorrisRanking {
    let trajectories = trajectories(design);
    let parameters = 0..design.ranges.len();
    let of_parameter = parameters.map(|parameter| {
        let effects = trajectories.iter().enumerate().filter_map(|(number, one)| {
            let (points, step) = one.step(parameter, levels)?;
            let first = number * one.points.len();
            let [before, after] = points.map(|point| values.at(first + point));
            ElementaryEffect::of(before, after, step)
        });
        let statistics = EffectStatistics::of(&effects.collect::<Vec<_>>());
        let is_above_chance = statistics
            .as_ref()
            .and_then(EffectStatistics::is_above_chance);
        MorrisParameter {
            parameter,
            statistics,
            is_above_chance,
        }
    });
    let mut parameters: Vec<MorrisParameter> = of_parameter.collect();
    let size = |one: &MorrisParameter| one.statistics.as_ref().map(|of| of.mu_star);
    parameters.sort_by(|a, b| falling(size(a), size(b)));
    let all = values.0.iter().flatten().flatten();
    let magnitudes: Vec<f64> = all.map(|value| value.abs()).collect();
    MorrisRanking {
        measure,
        mean: (!magnitudes.is_empty()).then(|| Statistic::of(&magnitudes).mean),
        parameters,
    }
}

fn one_at_a_time(design: &Design, measure: usize, values: &Values) -> OneAtATimeRanking {
    let mut point = 0;
    let mut parameters = Vec::new();
    for (parameter, range) in design.ranges.iter().enumerate() {
        let base = range.base_index();
        let [mut low, mut high] = [None, None];
        let numbers = range.around_base();
        // The points in x and y through which the elasticity goes.
        let mut through = vec![(numbers[base], 0)];
        for (at, number) in numbers.iter().enumerate().filter(|(at, _)| *at != base) {
            point += 1;
            let change = Change::of(values.at(0), values.at(point));
            *(if at < base { &mut low } else { &mut high }) = change;
            through.push((*number, point));
        }
        through.retain(|(_, point)| !values.known(*point).is_empty());
        through.sort_by(|a, b| a.0.total_cmp(&b.0));
        let ends = [through.first(), through.last()]
            .map(|end| end.map(|(x, point)| [*x, Statistic::of(&values.known(*point)).mean]));
        let known = || [&low, &high].into_iter().flatten();
        let chances: Vec<bool> = known().filter_map(Change::is_above_chance).collect();
        parameters.push(ChangedParameter {
            parameter,
            elasticity: match ends {
                [Some(first), Some(last)] => elasticity(first, last),
                _ => None,
            },
            is_above_chance: (!chances.is_empty()).then(|| chances.contains(&true)),
            low,
            high,
        });
    }
    parameters.sort_by(|a, b| falling(a.largest(), b.largest()));
    let at_base = values.known(0);
    let statistic = (!at_base.is_empty()).then(|| Statistic::of(&at_base));
    OneAtATimeRanking {
        measure,
        base: statistic.map(|of| of.mean),
        base_deviation: statistic
            .filter(|of| of.count > 1)
            .map(|of| of.standard_deviation),
        parameters,
    }
}

/// The order of falling sizes, unknown ones last.
fn falling(one: Option<f64>, other: Option<f64>) -> std::cmp::Ordering {
    let key = |size: Option<f64>| size.unwrap_or(f64::NEG_INFINITY);
    key(other).total_cmp(&key(one))
}

/// What reduces the worth of a ranking: effects that are left out, and chance that is not known.
fn notes(table: &DesignTable, rows: &[Row], seeds: usize) -> Vec<String> {
    let mut notes = Vec::new();
    let failed: Vec<usize> = (rows.iter().filter(|row| row.failed.is_some()))
        .map(|row| row.number)
        .collect();
    if !failed.is_empty() {
        let mut named: Vec<String> = failed.iter().map(usize::to_string).collect();
        if named.len() > MOST_NAMED {
            named.truncate(MOST_NAMED);
            named.push("...".to_owned());
        }
        notes.push(format!(
            "{} without values ({}): {}",
            counted(failed.len(), "run"),
            named.join(", "),
            left_out(table)
        ));
    }
    if seeds == 1 {
        notes.push(
            "each point was run with one seed: how much of an effect is chance is not known; list seeds in [vary] to see it"
                .to_owned(),
        );
    }
    notes
}

/// How many effects are missing: of the first measure, as a run without values lacks all of them.
fn left_out(table: &DesignTable) -> String {
    let parameters = table.parameters.len();
    match &table.rankings {
        Rankings::Morris(rankings) => {
            let of_parameter =
                |one: &MorrisParameter| one.statistics.as_ref().map_or(0, |of| of.effects);
            let first = rankings.first().map_or(&[][..], |one| &one.parameters);
            let counts: Vec<usize> = first.iter().map(of_parameter).collect();
            let [least, most] = [counts.iter().min(), counts.iter().max()];
            format!(
                "the steps that they end are left out; parameters keep {} to {} effects",
                least.unwrap_or(&0),
                most.unwrap_or(&0)
            )
        }
        Rankings::OneAtATime(rankings) => {
            let is_lost = |one: &&ChangedParameter| one.low.is_none() && one.high.is_none();
            let first = rankings.first().map_or(&[][..], |one| &one.parameters);
            let lost = first.iter().filter(is_lost).count();
            format!("their changes are left out; {lost} of {parameters} parameters have none left")
        }
    }
}
