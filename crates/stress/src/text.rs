//! The suite as a human-readable table in Markdown: for each case, the run with the largest
//! deviation.

use std::fmt::Write;

use dem_io::units::significant;

use super::prediction::{Prediction, Shown};
use super::verdict::{CaseResult, Judged, Observation};

/// Deviations above this fraction of the largest count as equal to it.
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

/// Predicted and observed values of the run with the largest deviation, and the number of refused
/// and stopped runs.
fn cells(result: &CaseResult) -> [String; 2] {
    let ends = |m: &&Judged| matches!(m.predicted, Prediction::Ends(_));
    let ended: Vec<&Judged> = result.members.iter().filter(ends).collect();
    let off = ended.iter();
    let off = off.filter_map(|member| Some((member, worst_of(member)?)));
    let off: Vec<_> = off.collect();
    let farthest = off.iter().map(|(_, (.., deviation))| *deviation);
    let farthest = farthest.fold(0.0, f64::max);
    // The first of those with equal deviations, except for rounding.
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

/// The value of a run with the largest deviation, and that deviation in tolerances.
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
