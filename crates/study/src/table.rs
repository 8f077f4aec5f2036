//! The table of a sweep: the time, values and errors of every run, and the runs on the fronts.

use std::collections::BTreeSet;

use dem_results::summary::{Trust, Verdict};
use dem_scene::study::{Axis, MeasureOf, RunTime, Study};

use super::chance;
use super::expand::Run;
use super::failure_line::failure_line;
use super::front::{Point, front};
use super::increase_table::IncreaseTable;
use super::judge::{in_words, judge};
use super::median::median;
use super::order::orders;
use super::outcome::{Done, Outcome, Reading};
use super::probability::Probability;
use super::ranking::design_table;
use super::response::{Response, responses};
use super::row::{Judged, Row};
use super::search::{Search, search};
use super::sweep_table::{AxisColumn, MeasureColumn, SweepTable};

/// Smallest significant relative difference of run times, however close the repeats are.
const LEAST_SPREAD: f64 = 0.1;

impl SweepTable {
    /// `outcomes`: for each run, those of its repeats. `values`: the reference of each measure, if
    /// the study gives it as a number. `looked_for`: the value of `[find]`, or the limit of
    /// `[probability]`.
    pub fn new(
        study: &Study,
        runs: &[Run],
        outcomes: &[Vec<Outcome>],
        values: &[Option<f64>],
        looked_for: Option<f64>,
    ) -> Self {
        let mut notes = Vec::new();
        let mut machines = BTreeSet::new();
        let mut rows = Vec::new();
        let mut firsts = Vec::new();
        for (run, outcomes) in runs.iter().zip(outcomes) {
            let repeats = finished(outcomes);
            notes.extend(differing(study, run, &repeats));
            notes.extend(lacking(run, repeats.len(), outcomes.len()));
            machines.extend(repeats.iter().map(|done| done.machine.clone()));
            rows.push(row(study, run, outcomes, &repeats));
            firsts.push(repeats.first().copied());
        }
        for (measure, value) in values.iter().enumerate() {
            judge(study, runs, &firsts, measure, *value, &mut rows, &mut notes);
        }
        notes.extend(not_sound(runs, &firsts));
        notes.extend(compare_times(study, machines.len(), &mut rows));
        if study.repeats() == 1 && study.has_errors() {
            notes.push("each run was done once: how far run times scatter is not known".to_owned());
        }
        let responses = responses(study, runs, &rows);
        notes.extend(chance::notes(study, &responses));
        let (find, of_search) = found(study, &responses, looked_for).unzip();
        notes.extend(of_search.unwrap_or_default());
        let probability = Probability::of(study, &rows, looked_for);
        notes.extend(probability.iter().flat_map(Probability::notes));
        let (design, of_design) = design_table(study, &rows).unzip();
        notes.extend(of_design.unwrap_or_default());
        let failure_line = failure_line(study, &rows);
        notes.extend(failure_line.as_ref().map(dem_laboratory::FailureLine::note));
        let increase_tables = IncreaseTable::all_of(study, &rows);
        notes.extend(increase_tables.iter().map(IncreaseTable::note));
        Self {
            study: study.source.clone(),
            scene: study.scene.display().to_string(),
            program: concat!("dem-run ", env!("CARGO_PKG_VERSION")).to_owned(),
            machines: machines.into_iter().collect(),
            repeats: study.repeats(),
            threads: study.threads,
            time: match study.time {
                RunTime::Wall => "run time",
                RunTime::Processor => "processor time",
            }
            .to_owned(),
            axes: study.axes.iter().map(axis_column).collect(),
            series: study.series,
            average_over: study.average_over,
            statistic: study.statistic,
            measures: measure_columns(study, &firsts),
            orders: orders(study, runs, &rows),
            runs: rows,
            responses,
            find,
            probability,
            design,
            failure_line,
            increase_tables,
            notes,
        }
    }

    /// True if measures have references, so that errors and run times are compared.
    pub fn has_errors(&self) -> bool {
        let mut measures = self.measures.iter();
        measures.any(|measure| measure.reference.is_some())
    }

    /// Runs without values.
    pub fn failed(&self) -> impl Iterator<Item = &Row> {
        self.runs.iter().filter(|row| row.failed.is_some())
    }

    /// Number of repeats of the runs: `once`, `3 times`, `3 to 25 times`.
    pub fn times(&self) -> String {
        let most = self.runs.iter().map(|row| row.times_s.len());
        match (self.repeats as usize, most.max().unwrap_or(0)) {
            (1, _) => "once".to_owned(),
            (least, most) if most > least => format!("{least} to {most} times"),
            (least, _) => format!("{least} times"),
        }
    }

    /// The settings of a run on one line: `run.safety 0.5, bonds.beam.model timoshenko`.
    pub fn named(&self, row: &Row) -> String {
        let named = self.axes.iter().zip(&row.settings);
        let named: Vec<String> = named
            .map(|(axis, value)| format!("{} {value}", axis.name))
            .collect();
        named.join(", ")
    }
}

/// The repeats of a run that left results.
fn finished(outcomes: &[Outcome]) -> Vec<&Done> {
    let done = outcomes.iter().filter_map(|outcome| match outcome {
        Outcome::Done(done) => Some(done),
        Outcome::Failed(_) | Outcome::Missing => None,
    });
    done.collect()
}

/// What is to be said of a run whose repeats have different values, apart from run times.
fn differing(study: &Study, run: &Run, repeats: &[&Done]) -> Option<String> {
    let values = |done: &Done| -> Vec<Reading> {
        let all = study.measures.iter().zip(&done.readings);
        let values = all.filter(|(measure, _)| !is_run_time(&measure.of));
        values.map(|(_, reading)| reading.clone()).collect()
    };
    let mut pairs = repeats.windows(2);
    let differ = pairs.any(|two| values(two[0]) != values(two[1]));
    let number = run.number;
    differ.then(|| format!("run {number} gave other values when it was done again"))
}

fn is_run_time(of: &MeasureOf) -> bool {
    matches!(of, MeasureOf::RunTime(_))
}

/// The value of a measure of a run: that of its first repeat, of run times the median of all.
fn value(study: &Study, done: &[&Done], measure: usize) -> f64 {
    let repeats = done.iter().filter_map(|done| done.readings.get(measure));
    let mut values: Vec<f64> = repeats.map(|reading| reading.value).collect();
    if !is_run_time(&study.measures[measure].of) {
        return values.first().copied().unwrap_or(f64::NAN);
    }
    values.sort_by(f64::total_cmp);
    median(&values).unwrap_or(f64::NAN)
}

/// Marks the fronts. Of several machines times are not compared: then there is no front, and the
/// reason is returned.
fn compare_times(study: &Study, machines: usize, rows: &mut [Row]) -> Option<String> {
    if machines > 1 && study.has_errors() {
        for judged in rows.iter_mut().flat_map(|row| &mut row.results) {
            judged.times_as_fast = None;
        }
        let text = "the runs are of several machines, so that their times are not compared";
        return Some(text.to_owned());
    }
    for measure in 0..study.measures.len() {
        mark_front(rows, measure);
    }
    None
}

/// The search for the value of `[find]`, and notes on it.
fn found(
    study: &Study,
    responses: &[Response],
    looked_for: Option<f64>,
) -> Option<(Search, Vec<String>)> {
    let of = study.find.as_ref()?.measure;
    let response = responses.iter().find(|response| response.measure == of)?;
    search(study, response, looked_for?)
}

/// The measures, with the units of the first run that left results.
fn measure_columns(study: &Study, firsts: &[Option<&Done>]) -> Vec<MeasureColumn> {
    let first = firsts.iter().flatten().next();
    let measures = study.measures.iter().enumerate();
    let column = measures.map(|(at, measure)| MeasureColumn {
        name: measure.name.clone(),
        unit: first.map_or(String::new(), |done| done.readings[at].unit.clone()),
        reference: in_words(study, at),
    });
    column.collect()
}

fn axis_column(axis: &Axis) -> AxisColumn {
    // Equal numbers do not tell the values of paths that vary together apart; their names do.
    let differ = |numbers: &[f64]| {
        let before = |at: usize| numbers[..at].contains(&numbers[at]);
        !(0..numbers.len()).any(before)
    };
    let numbers = axis.numbers().filter(|(numbers, _)| differ(numbers));
    let (numbers, unit) = numbers.unzip();
    AxisColumn {
        name: axis.name.clone(),
        values: axis.values.iter().map(|v| v.label.clone()).collect(),
        sizes: axis.sizes(),
        numbers,
        unit: unit.unwrap_or_default(),
        named: axis.named,
    }
}

/// What is to be said of a run of which some repeats left no results.
fn lacking(run: &Run, with: usize, all: usize) -> Option<String> {
    let number = run.number;
    let lacking =
        format!("run {number}: of its {all} repeats {with} left results; its time is theirs");
    (1..all).contains(&with).then_some(lacking)
}

fn row(study: &Study, run: &Run, outcomes: &[Outcome], done: &[&Done]) -> Row {
    let complaint = outcomes.iter().find_map(|outcome| match outcome {
        Outcome::Failed(why) => Some(why.clone()),
        _ => None,
    });
    let failed = match done {
        [] => Some(complaint.unwrap_or_else(|| "it has not been run to its end".to_owned())),
        _ => None,
    };
    let times_s: Vec<f64> = done.iter().map(|done| done.time_s).collect();
    let mut rising_s = times_s.clone();
    rising_s.sort_by(f64::total_cmp);
    let time_s = median(&rising_s);
    let first = done.first();
    Row {
        number: run.number,
        choice: run.choice.clone(),
        settings: run.labels(study),
        failed,
        trust: first.map(|done| done.verdict.word),
        doubts: first.map_or(Vec::new(), |done| done.verdict.warnings.clone()),
        time_s,
        spread_s: time_s.map(|time| range_of_median(&rising_s).max(LEAST_SPREAD * time)),
        times_s,
        steps: first.map(|done| done.steps),
        time_step_s: first.map(|done| done.time_step_s),
        report: first.and_then(|done| done.report.clone()),
        results: first.map_or(Vec::new(), |first| {
            let judged = first
                .readings
                .iter()
                .enumerate()
                .map(|(measure, reading)| Judged {
                    value: value(study, done, measure),
                    reference: None,
                    error: None,
                    uncertainty: None,
                    is_reference: false,
                    is_on_front: false,
                    times_as_fast: None,
                    curve: reading.curve.clone(),
                });
            judged.collect()
        }),
    }
}

/// Width of the range in which the median of many more repeats lies with a probability of 95 %,
/// whatever the distribution of the times: between the values whose ranks are half their number -+
/// its square root. Up to five times, the full range. Of ascending times.
fn range_of_median(rising: &[f64]) -> f64 {
    let count = rising.len() as f64;
    let below = (0.5 * count - 0.98 * count.sqrt()).max(0.0) as usize;
    match (rising.get(below), rising.iter().rev().nth(below)) {
        (Some(low), Some(high)) => high - low,
        _ => 0.0,
    }
}

fn mark_front(rows: &mut [Row], measure: usize) {
    let mut at = Vec::new();
    let mut points = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let error = row.results.get(measure).and_then(Judged::sure_error);
        if let (Some(time_s), Some(spread_s), Some(error)) = (row.time_s, row.spread_s, error) {
            at.push(index);
            points.push(Point {
                time_s,
                spread_s,
                error,
            });
        }
    }
    for (index, is_on) in at.into_iter().zip(front(&points)) {
        if let Some(judged) = rows[index].results.get_mut(measure) {
            judged.is_on_front = is_on;
        }
    }
}

/// Sentences on the runs that are not sound, if there are any: for each verdict their number, and
/// each kind of reason once, with the number of its runs.
fn not_sound(runs: &[Run], of_runs: &[Option<&Done>]) -> Vec<String> {
    let done = runs.iter().zip(of_runs);
    let done: Vec<(usize, &Verdict)> = done
        .filter_map(|(run, done)| Some((run.number, &done.as_ref()?.verdict)))
        .collect();
    let of_word = |word: Trust| {
        let with_word = || done.iter().filter(move |(_, verdict)| verdict.word == word);
        let count = with_word().count();
        // Key of a kind, the number of its runs, and the first of them with its reason.
        let mut kinds: Vec<(String, usize, usize, &str)> = Vec::new();
        for (number, verdict) in with_word() {
            for reason in verdict.reasons().1 {
                let key = kind_of(reason);
                match kinds.iter_mut().find(|kind| kind.0 == key) {
                    Some(kind) => kind.1 += 1,
                    None => kinds.push((key, 1, *number, reason)),
                }
            }
        }
        let told = kinds.into_iter().map(|(_, count, number, reason)| {
            format!("in {count} of them, first in run {number}: {reason}")
        });
        let all = done.len();
        let first = format!(
            "{count} of {all} runs are {} (verdict in their summary.json)",
            word.word()
        );
        let told: Vec<String> = std::iter::once(first).chain(told).collect();
        if count == 0 { Vec::new() } else { told }
    };
    [Trust::Doubtful, Trust::Coarse]
        .into_iter()
        .flat_map(of_word)
        .collect()
}

/// The first words of a warning that contain no digit: the same for all runs with such a warning.
fn kind_of(warning: &str) -> String {
    let words = warning.split_whitespace();
    let words = words.filter(|word| !word.contains(|c: char| c.is_ascii_digit()));
    words.take(5).collect::<Vec<&str>>().join(" ")
}
