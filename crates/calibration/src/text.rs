//! The result of a calibration in words.

use std::fmt::Write;

use dem_io::text::counted;
use dem_io::units::{show_length, show_quantity, significant};
use dem_laboratory::Statistic;

use crate::case::{Case, End};
use crate::record::Record;
use crate::resolution::{coarsest, curve_error};
use crate::unknown::{Number, Unknown};
use dem_laboratory::half_width;

/// Change of a result at half the rate above which it is in doubt.
const RATE_MATTERS: f64 = 0.02;

/// The result for a terminal, some lines for each size of spheres; `most_error`: wanted error of
/// the curve, for which the coarsest size is named.
pub fn report(record: &Record, most_error: Option<f64>) -> String {
    let mut text = String::new();
    for case in &record.cases {
        if !case.name.is_empty() {
            line(&mut text, "spheres", &case.name);
        }
        for row in results(record, case) {
            let [name, mean, interval, target, off, scatter] = row;
            let value = match scatter.as_str() {
                "" => format!("{mean}, target {target}, {off}"),
                _ => format!(
                    "{mean} ({interval}), target {target}, {off}, scatter of packings {scatter}"
                ),
            };
            line(&mut text, &name, &value);
        }
        let more = [other_packings(record, case), rate(record, case)];
        for (name, value) in more.into_iter().flatten() {
            line(&mut text, name, &value);
        }
        for [path, new, old] in numbers(record, case) {
            line(&mut text, &path, &format!("{new} (scene: {old})"));
        }
        let (wall_s, tests) = case.cost();
        let mut cost = format!("{tests} tests, {} s", significant(wall_s, 3));
        if let Some(start) = &case.start {
            let elastic = format!(
                "; {} tests without steps before them, {} s",
                start.tests,
                significant(start.wall_s, 3)
            );
            cost.push_str(&elastic);
        }
        line(&mut text, "cost", &cost);
        let warnings = warnings(record, case);
        for warning in &warnings {
            line(&mut text, "warning", warning);
        }
        line(&mut text, "verdict", &verdict(warnings.len()));
    }
    if let Some(sentence) = coarsest_size(record, most_error) {
        line(&mut text, "resolution", &sentence);
    }
    text
}

pub(crate) fn line(text: &mut String, name: &str, value: &str) {
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{name:12} {value}");
}

/// For each result of a case: name, mean, 95 % confidence interval, target, deviation of the mean
/// from it, scatter.
pub(crate) fn results(record: &Record, case: &Case) -> Vec<[String; 6]> {
    let Some(round) = case.result() else {
        return Vec::new();
    };
    let mut rows = Vec::new();
    for (at, unknown) in record.unknowns.iter().enumerate() {
        let Some(statistic) = round.statistic(at) else {
            continue;
        };
        let Unknown {
            result,
            unit,
            target,
            ..
        } = unknown;
        rows.push(result_row((result, unit), *target, &statistic));
    }
    rows
}

/// Name, mean, 95 % confidence interval, target, deviation of the mean from it and scatter of a
/// result, from its name and unit.
pub(crate) fn result_row(
    (name, unit): (&str, &str),
    target: f64,
    statistic: &Statistic,
) -> [String; 6] {
    let show = |value: f64| show_quantity(value, unit);
    let mean = statistic.mean;
    let interval = half_width(statistic).map_or_else(String::new, |half| {
        format!("{} to {}", show(mean - half), show(mean + half))
    });
    [
        name.to_owned(),
        show(mean),
        interval,
        show(target),
        format!("{:+.1} %", 100.0 * (mean / target - 1.0)),
        match statistic.count {
            1 => String::new(),
            _ => format!("{:.1} %", 100.0 * (statistic.standard_deviation / mean)),
        },
    ]
}

/// Path, new and old value of each number of a case.
pub(crate) fn numbers(record: &Record, case: &Case) -> Vec<[String; 3]> {
    let Some(round) = case.result() else {
        return Vec::new();
    };
    let numbers = record.unknowns.iter().map(|unknown| &unknown.numbers[..]);
    number_rows(numbers, &round.factors)
}

/// Path, new and old value of each of the numbers of some unknowns with these factors.
pub(crate) fn number_rows<'a>(
    unknowns: impl Iterator<Item = &'a [Number]>,
    factors: &[f64],
) -> Vec<[String; 3]> {
    unknowns
        .zip(factors)
        .flat_map(|(numbers, factor)| {
            let of = |one: &Number| [one.path.clone(), one.text(*factor), one.text(1.0)];
            numbers.iter().map(of)
        })
        .collect()
}

/// Whether a result can be trusted about which there are so many warnings.
pub(crate) fn verdict(warnings: usize) -> String {
    match warnings {
        0 => "sound".to_owned(),
        many => format!("doubtful: {}", counted(many, "warning")),
    }
}

/// Reasons to doubt the result of a case, a sentence each.
pub(crate) fn warnings(record: &Record, case: &Case) -> Vec<String> {
    let mut warnings = Vec::new();
    match &case.end {
        Some((_, End::WithinScatter)) => warnings.push(
            "the means are not within their tolerances, but their targets are within the 95 % confidence intervals: more packings would tell"
                .to_owned(),
        ),
        Some((_, End::NotMet(problem, remedy))) => warnings.push(format!("{problem}; {remedy}")),
        _ => {}
    }
    let Some(round) = case.result() else {
        return warnings;
    };
    let trials = || round.trials.iter().flatten();
    let doubtful: Vec<String> = (record.packings.iter().zip(&round.trials))
        .filter_map(|(name, trial)| trial.as_ref().map(|trial| (name, trial)))
        .flat_map(|(name, trial)| {
            trial
                .doubts
                .iter()
                .map(move |doubt| format!("{name}: {doubt}"))
        })
        .collect();
    let count = trials().filter(|trial| !trial.doubts.is_empty()).count();
    if count > 0 {
        warnings.push(format!(
            "{count} of {} tests are in doubt: {}",
            round.trials.len(),
            doubtful.join("; ")
        ));
    }
    if round.trials.len() == 1 {
        warnings.push(
            "there is one packing only: the scatter of others is not known; name several"
                .to_owned(),
        );
    }
    if let Some(problem) = &case.rate_problem {
        warnings.push(format!("the test at twice the rate failed: {problem}"));
    }
    for (at, unknown) in record.unknowns.iter().enumerate() {
        let Some(change) = case.rate_change(at) else {
            continue;
        };
        warnings.extend(rate_doubt(&unknown.result, &change));
    }
    warnings
}

/// A sentence on a result that half the rate changes by this. None: by no more than it matters, or
/// than its own scatter.
pub(crate) fn rate_doubt(result: &str, change: &Statistic) -> Option<String> {
    let least = half_width(change).unwrap_or(0.0).max(RATE_MATTERS);
    (change.mean.abs() > least).then(|| {
        let by = change_text(change);
        format!("half the rate changes the {result} by {by}: raise test.periods")
    })
}

/// A relative change with half its 95 % confidence interval.
pub(crate) fn change_text(change: &Statistic) -> String {
    let mean = format!("{:+.1} %", 100.0 * change.mean);
    match half_width(change) {
        Some(half) => format!("{mean} (± {:.1} %)", 100.0 * half),
        None => mean,
    }
}

/// What other packings of the same spheres give with these numbers: the prediction intervals of the
/// result of one and of the mean of as many, which scatter as these do (Student's t).
fn other_packings(record: &Record, case: &Case) -> Option<(&'static str, String)> {
    let round = case.result()?;
    let of = |(at, unknown): (usize, &Unknown)| prediction(&unknown.result, &round.statistic(at)?);
    let all: Vec<String> = (record.unknowns.iter().enumerate())
        .filter_map(of)
        .collect();
    let count = round.trials.len();
    (!all.is_empty()).then(|| {
        let means = all.join(", ");
        (
            "others",
            format!("mean of {count} other packings, 95 %: {means}"),
        )
    })
}

/// Prediction intervals of a result, relative to its mean. None for a single packing.
pub(crate) fn prediction(result: &str, statistic: &Statistic) -> Option<String> {
    let count = statistic.count as f64;
    // half_width has a factor of 1/sqrt(count).
    let half = half_width(statistic)? / statistic.mean;
    let [one, mean] = [(count + 1.0).sqrt(), 2.0_f64.sqrt()].map(|wide| 100.0 * wide * half);
    Some(format!("{result} ± {mean:.0} % (one ± {one:.0} %)"))
}

/// What half the rate changes.
fn rate(record: &Record, case: &Case) -> Option<(&'static str, String)> {
    let of = |(at, unknown): (usize, &Unknown)| {
        let change = case.rate_change(at)?;
        Some(format!("{} {}", unknown.result, change_text(&change)))
    };
    let all: Vec<String> = (record.unknowns.iter().enumerate())
        .filter_map(of)
        .collect();
    (!all.is_empty()).then(|| ("half rate", all.join(", ")))
}

/// The coarsest size whose curve has at most the wanted error.
pub(crate) fn coarsest_size(record: &Record, most_error: Option<f64>) -> Option<String> {
    let most = most_error.filter(|_| record.cases.len() > 1)?;
    let percent = significant(100.0 * most, 3);
    Some(match coarsest(record, most) {
        Some(case) => {
            let error = curve_error(record, case).unwrap_or(f64::NAN);
            format!(
                "{} is the coarsest whose curve is within {percent} %: {:.1} %",
                case.name,
                100.0 * error
            )
        }
        None => format!("no size has a curve within {percent} %: use smaller spheres"),
    })
}

/// The origin of the numbers of a case, as comments of a material file.
pub fn origin(record: &Record, case: &Case) -> String {
    let mut lines = vec![format!(
        "Calibrated on {} by {} with {}.",
        record.date, record.program, record.scene
    )];
    if let Some((problem, _)) = case.problem() {
        lines.insert(0, format!("NOT CALIBRATED: {problem}."));
    }
    lines.push(match record.packed_with.as_str() {
        "" => format!("Packings: {}.", record.packings.join(", ")),
        pack => format!(
            "Packings: {}, of dem-pack {pack}.",
            record.packings.join(", ")
        ),
    });
    let size = match case.name.as_str() {
        "" => String::new(),
        name => format!("{name}, "),
    };
    lines.push(format!(
        "Spheres: {size}{} in the mean, {} across the body.",
        show_length(case.mean_diameter_m),
        significant(case.spheres_across, 3)
    ));
    for [name, mean, interval, target, _, scatter] in results(record, case) {
        lines.push(match scatter.as_str() {
            "" => format!("{name}: {mean}, target {target}"),
            _ => format!(
                "{name}: mean {mean}, 95 % confidence interval {interval}, target {target}, scatter of packings {scatter}"
            ),
        });
    }
    let more = [other_packings(record, case), rate(record, case)];
    lines.extend(
        more.into_iter()
            .flatten()
            .map(|(name, text)| format!("{name}: {text}")),
    );
    for [path, new, old] in numbers(record, case) {
        lines.push(format!("{path}: {new}, in the scene {old}"));
    }
    let visible = |line: &String| format!("# {}\n", dem_io::text::visible(line));
    lines.iter().map(visible).collect()
}
