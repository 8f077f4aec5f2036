//! The result of a calibration in words.

use std::fmt::Write;

use dem_io::units::{show_quantity, significant};

use crate::case::{Case, End};
use crate::confidence::half_width;
use crate::record::Record;
use crate::resolution::{coarsest, curve_error};
use crate::unknown::Number;

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
        for warning in warnings(record, case) {
            line(&mut text, "warning", &warning);
        }
    }
    if let Some(sentence) = coarsest_size(record, most_error) {
        line(&mut text, "resolution", &sentence);
    }
    text
}

fn line(text: &mut String, name: &str, value: &str) {
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
        let show = |value: f64| show_quantity(value, &unknown.unit);
        let interval = match half_width(&statistic) {
            Some(half) => format!(
                "{} to {}",
                show(statistic.mean - half),
                show(statistic.mean + half)
            ),
            None => String::new(),
        };
        let percent = |part: f64| format!("{:.1} %", 100.0 * part);
        rows.push([
            unknown.result.clone(),
            show(statistic.mean),
            interval,
            show(unknown.target),
            format!("{:+.1} %", 100.0 * (statistic.mean / unknown.target - 1.0)),
            match statistic.count {
                1 => String::new(),
                _ => percent(statistic.standard_deviation / statistic.mean),
            },
        ]);
    }
    rows
}

/// Path, new and old value of each number of a case.
pub(crate) fn numbers(record: &Record, case: &Case) -> Vec<[String; 3]> {
    let Some(round) = case.result() else {
        return Vec::new();
    };
    let all = record.unknowns.iter().zip(&round.factors);
    all.flat_map(|(unknown, factor)| {
        let of = |number: &Number| [number.path.clone(), number.text(*factor), number.text(1.0)];
        unknown.numbers.iter().map(of).collect::<Vec<_>>()
    })
    .collect()
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
    if let (Some(fast), Some(Some(slow))) = (&case.at_twice_the_rate, round.trials.first()) {
        let pairs = slow.results.iter().zip(&fast.results);
        for (unknown, (slow, fast)) in record.unknowns.iter().zip(pairs) {
            let (Some(slow), Some(fast)) = (slow, fast) else {
                continue;
            };
            let change = slow / fast - 1.0;
            if change.abs() > RATE_MATTERS {
                warnings.push(format!(
                    "half the rate changes the {} by {:.1} %: raise test.periods",
                    unknown.result,
                    100.0 * change
                ));
            }
        }
    }
    warnings
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
    let mut lines = vec![
        format!(
            "Calibrated on {} by {} with {}.",
            record.date, record.program, record.scene
        ),
        format!("Packings: {}.", record.packings.join(", ")),
    ];
    if !case.name.is_empty() {
        lines.push(format!("Spheres: {}.", case.name));
    }
    for [name, mean, interval, target, _, scatter] in results(record, case) {
        lines.push(match scatter.as_str() {
            "" => format!("{name}: {mean}, target {target}"),
            _ => format!(
                "{name}: mean {mean}, 95 % confidence interval {interval}, target {target}, scatter of packings {scatter}"
            ),
        });
    }
    for [path, new, old] in numbers(record, case) {
        lines.push(format!("{path}: {new}, in the scene {old}"));
    }
    let visible = |line: &String| format!("# {}\n", dem_io::text::visible(line));
    lines.iter().map(visible).collect()
}
