//! The suite as a table for a person, in Markdown: of each case the run that is farthest off.

use std::fmt::Write;

use dem_io::units::significant;

use super::prediction::{Prediction, Shown};
use super::verdict::{CaseResult, Judged, Observation};

/// Fraction of the largest deviation from which on runs count as equally far off.
const AS_FAR: f64 = 0.99;

/// The head of the table.
pub const HEAD: &str =
    "| case | what is extreme | predicted | observed | verdict |\n|---|---|---|---|---|\n";

/// The row of a case.
pub fn row(result: &CaseResult) -> String {
    let [predicted, observed] = cells(result);
    format!(
        "| {} | {} | {predicted} | {observed} | {} |\n",
        result.name,
        result.extreme,
        verdict(result)
    )
}

/// What was predicted and observed: in the run that is farthest off, and how many were refused and
/// stopped.
fn cells(result: &CaseResult) -> [String; 2] {
    let ends = |m: &&Judged| matches!(m.predicted, Prediction::Ends(_));
    let ended: Vec<&Judged> = result.members.iter().filter(ends).collect();
    let off = ended.iter();
    let off = off.filter_map(|member| Some((member, worst_of(member)?)));
    let off: Vec<_> = off.collect();
    let farthest = off.iter().map(|(_, (.., deviation))| *deviation);
    let farthest = farthest.fold(0.0, f64::max);
    // The first of those that are as far off, but for rounding.
    let mut off = off.into_iter();
    let worst = off.find(|(_, (.., deviation))| *deviation >= AS_FAR * farthest);
    let mut cells = [String::new(), String::new()];
    if let Some((member, (shown, value, _))) = worst {
        let unit = if shown.unit.is_empty() {
            String::new()
        } else {
            format!(" {}", shown.unit)
        };
        let name = shown.quantity.name().replace('_', " ");
        let limits = if shown.value == 0.0 {
            format!("at most {}{unit}", significant(shown.tolerance, 3))
        } else {
            format!(
                "{}{unit} +- {}",
                significant(shown.value, 5),
                significant(shown.tolerance, 2)
            )
        };
        let of = result.members.len();
        let s = if of == 1 { "" } else { "s" };
        let _ = write!(cells[0], "{of} run{s}; {}: {name} {limits}", member.what);
        let _ = write!(
            cells[1],
            "{}{unit}{}",
            significant(value, 5),
            match shown.value {
                0.0 => String::new(),
                predicted => format!(", off by {}", significant(value - predicted, 2)),
            }
        );
    }
    for name in ["refused", "stopped"] {
        let predicted = result.members.iter().map(|m| end_predicted(&m.predicted));
        let observed = result.members.iter().map(|m| end_observed(&m.observed));
        let numbers = [
            predicted.filter(|end| *end == name).count(),
            observed.filter(|end| *end == name).count(),
        ];
        if numbers != [0, 0] {
            for (cell, number) in cells.iter_mut().zip(numbers) {
                let comma = if cell.is_empty() { "" } else { "; " };
                let _ = write!(cell, "{comma}{number} {name}");
            }
        }
    }
    cells
}

fn end_predicted(prediction: &Prediction) -> &'static str {
    match prediction {
        Prediction::Ends(_) => "ended",
        Prediction::Refused(_) => "refused",
        Prediction::Stopped(_) => "stopped",
    }
}

fn end_observed(observation: &Observation) -> &'static str {
    match observation {
        Observation::Ended(_) => "ended",
        Observation::Refused(_) => "refused",
        Observation::Stopped(_) => "stopped",
    }
}

/// The value of a run that is farthest off, and how far in tolerances.
fn worst_of(member: &Judged) -> Option<(&Shown, f64, f64)> {
    let (Prediction::Ends(all), Observation::Ended(values)) = (&member.predicted, &member.observed)
    else {
        return None;
    };
    let off = all.iter().zip(values);
    let off = off.map(|(shown, value)| (shown, *value, shown.deviation(*value)));
    off.max_by(|a, b| a.2.total_cmp(&b.2))
}

fn verdict(result: &CaseResult) -> String {
    let mut wrong = result.wrong();
    let Some(first) = wrong.next() else {
        return "as predicted".to_owned();
    };
    let more = match wrong.count() {
        0 => String::new(),
        count => format!("; {count} more"),
    };
    let why = first.wrong.as_deref().unwrap_or_default();
    format!("WRONG: {}: {}{more}", first.what, why.replace('|', "/"))
}
