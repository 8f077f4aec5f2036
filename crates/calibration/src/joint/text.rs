//! The result of a calibration by several tests in words.

use dem_io::units::{show_length, show_quantity, significant};
use dem_laboratory::{FailureLine, TestType};

use super::state::{Aim, Joint};
use crate::case::End;
use crate::text::{change_text, line, number_rows, prediction, rate_doubt, result_row, verdict};

/// The result for a terminal: some lines for each test, the numbers, cost and warnings.
pub fn joint_report(joint: &Joint) -> String {
    let mut text = String::new();
    for (at, test) in joint.tests.iter().enumerate() {
        line(&mut text, "test", &test.scene);
        for row in results(joint, at) {
            let [name, mean, interval, target, off, scatter] = row;
            let value = match scatter.as_str() {
                "" => format!("{mean}, target {target}, {off}"),
                _ => format!(
                    "{mean} ({interval}), target {target}, {off}, scatter of packings {scatter}"
                ),
            };
            line(&mut text, &name, &value);
        }
        for (name, value) in more(joint, at) {
            line(&mut text, name, &value);
        }
    }
    for sentence in failure_lines(joint) {
        line(&mut text, "failure line", &sentence);
    }
    for [path, new, old] in numbers(joint) {
        line(&mut text, &path, &format!("{new} (scenes: {old})"));
    }
    let (wall_s, tests) = joint.cost();
    let rounds = joint.rounds.len();
    let mut cost = format!(
        "{tests} tests in {rounds} rounds, {} s",
        significant(wall_s, 3)
    );
    if let Some(start) = joint.start.as_ref().filter(|start| start.tests > 0) {
        let wall_s = significant(start.wall_s, 3);
        let tests = start.tests;
        cost.push_str(&format!(
            "; {tests} tests without steps before them, {wall_s} s"
        ));
    }
    line(&mut text, "cost", &cost);
    let warnings = warnings(joint);
    for warning in &warnings {
        line(&mut text, "warning", warning);
    }
    line(&mut text, "verdict", &verdict(warnings.len()));
    text
}

/// For each result of a test: name, mean, 95 % confidence interval, target, deviation of the mean
/// from it, scatter.
pub(super) fn results(joint: &Joint, test: usize) -> Vec<[String; 6]> {
    let Some(round) = joint.result() else {
        return Vec::new();
    };
    let aims = joint.aims.iter().enumerate();
    let row = |(at, aim): (usize, &Aim)| {
        let Some(statistic) = joint.statistic(round, at) else {
            let [result, missing, target] = [
                aim.result.clone(),
                "not of all packings".to_owned(),
                show_quantity(aim.target, &aim.unit),
            ];
            let none = String::new;
            return [result, missing, none(), target, none(), none()];
        };
        result_row((&aim.result, &aim.unit), aim.target, &statistic)
    };
    aims.filter(|(_, aim)| aim.test == test).map(row).collect()
}

/// What other packings of the body of a test give, and what half the rate changes.
fn more(joint: &Joint, test: usize) -> Vec<(&'static str, String)> {
    let Some(round) = joint.result() else {
        return Vec::new();
    };
    let aims = || {
        let all = joint.aims.iter().enumerate();
        all.filter(|(_, aim)| aim.test == test)
    };
    let others: Vec<String> = aims()
        .filter_map(|(at, aim)| prediction(&aim.result, &joint.statistic(round, at)?))
        .collect();
    let rates: Vec<String> = aims()
        .filter_map(|(at, aim)| {
            let change = joint.rate_change(at)?;
            Some(format!("{} {}", aim.result, change_text(&change)))
        })
        .collect();
    let count = joint.tests[test].packings.len();
    let mut found = Vec::new();
    if !others.is_empty() {
        let means = others.join(", ");
        found.push((
            "others",
            format!("mean of {count} other packings, 95 %: {means}"),
        ));
    }
    if !rates.is_empty() {
        found.push(("half rate", rates.join(", ")));
    }
    found
}

/// Cohesion and friction angle of the peaks of each type of test under pressure, and of their
/// targets, a sentence each.
pub(super) fn failure_lines(joint: &Joint) -> Vec<String> {
    let Some(round) = joint.result() else {
        return Vec::new();
    };
    let of = |line: &FailureLine| {
        format!(
            "cohesion {} and friction angle {} degrees",
            show_quantity(line.cohesion_pa, "Pa"),
            significant(line.friction_angle_deg, 4)
        )
    };
    let kinds = [TestType::TriaxialCompression, TestType::DirectShear];
    let sentence = |kind: TestType| {
        let [targets, means] = joint.failure_lines(round, kind)?;
        let (name, peaks) = (kind.name(), means.peaks);
        Some(format!(
            "{name}, {peaks} strengths: {} (targets: {})",
            of(&means),
            of(&targets)
        ))
    };
    kinds.into_iter().filter_map(sentence).collect()
}

/// Path, new and old value of each number.
pub(super) fn numbers(joint: &Joint) -> Vec<[String; 3]> {
    let Some(round) = joint.result() else {
        return Vec::new();
    };
    let numbers = joint.unknowns.iter().map(|unknown| &unknown.numbers[..]);
    number_rows(numbers, &round.factors)
}

/// Reasons to doubt the result, a sentence each.
pub(super) fn warnings(joint: &Joint) -> Vec<String> {
    let mut warnings = Vec::new();
    match &joint.end {
        Some((_, End::WithinScatter)) => warnings.push(
            "not all means are within their tolerances, but each target is within the 95 % confidence interval of its mean: more packings would tell"
                .to_owned(),
        ),
        Some((_, End::NotMet(problem, remedy))) => warnings.push(format!("{problem}; {remedy}")),
        _ => {}
    }
    let Some(round) = joint.result() else {
        return warnings;
    };
    for (at, test) in joint.tests.iter().enumerate() {
        let named = test.packings.iter().zip(&round.trials[joint.trials_of(at)]);
        let doubts: Vec<String> = named
            .filter_map(|(name, trial)| Some((name, trial.as_ref()?)))
            .flat_map(|(name, trial)| {
                let doubts = trial.doubts.iter();
                doubts.map(move |doubt| format!("{name}: {doubt}"))
            })
            .collect();
        let scene = &test.scene;
        if !doubts.is_empty() {
            warnings.push(format!("{scene}: in doubt: {}", doubts.join("; ")));
        }
        if test.packings.len() == 1 {
            warnings.push(format!(
                "{scene}: there is one packing only: the scatter of others is not known"
            ));
        }
    }
    if let Some(problem) = &joint.rate_problem {
        warnings.push(format!("a test at twice the rate failed: {problem}"));
    }
    for (at, aim) in joint.aims.iter().enumerate() {
        let Some(change) = joint.rate_change(at) else {
            continue;
        };
        let scene = &joint.tests[aim.test].scene;
        let doubt = rate_doubt(&aim.result, &change);
        warnings.extend(doubt.map(|doubt| format!("{scene}: {doubt}")));
    }
    warnings
}

/// The origin of the numbers, as comments of a material file: every test with its packings, and
/// what each of its results is in the end.
pub fn joint_origin(joint: &Joint) -> String {
    let mut lines = Vec::new();
    if let Some((problem, _)) = joint.problem() {
        lines.push(format!("NOT CALIBRATED: {problem}."));
    }
    lines.push(format!(
        "Calibrated on {} by {} with {} tests at once.",
        joint.date,
        joint.program,
        joint.tests.len()
    ));
    for (at, test) in joint.tests.iter().enumerate() {
        lines.push(format!("Test: {}, {}.", test.scene, test.kind.name()));
        let packings = test.packings.join(", ");
        lines.push(match test.packed_with.as_str() {
            "" => format!("Packings: {packings}."),
            pack => format!("Packings: {packings}, of dem-pack {pack}."),
        });
        lines.push(format!(
            "Spheres: {} in the mean, {} across the body.",
            show_length(test.mean_diameter_m),
            significant(test.spheres_across, 3)
        ));
        for [name, mean, interval, target, off, scatter] in results(joint, at) {
            lines.push(match (off.as_str(), scatter.as_str()) {
                ("", _) => format!("{name}: {mean}, target {target}"),
                (_, "") => format!("{name}: {mean}, target {target}, {off}"),
                _ => format!(
                    "{name}: mean {mean}, 95 % confidence interval {interval}, target {target}, {off}, scatter of packings {scatter}"
                ),
            });
        }
        let more = more(joint, at).into_iter();
        lines.extend(more.map(|(name, text)| format!("{name}: {text}")));
    }
    lines.extend(failure_lines(joint));
    for [path, new, old] in numbers(joint) {
        lines.push(format!("{path}: {new}, in the scenes {old}"));
    }
    let visible = |line: &String| format!("# {}\n", dem_io::text::visible(line));
    lines.iter().map(visible).collect()
}
