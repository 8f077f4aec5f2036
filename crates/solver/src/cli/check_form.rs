//! What `dem-run check` prints: a few lines, everything, or JSON; and the verdict as far as it is
//! known.

use dem_io::text::visible;
use dem_plan::Plan;
use dem_results::summary::Verdict;

/// Where the rest is.
pub(super) const VERBOSE: &str = "--verbose prints all values, estimates and stages";

/// What `check` prints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Nothing,
    Short,
    Whole,
    Json,
}

impl Form {
    pub(super) fn of(as_json: bool, verbose: bool, quiet: bool) -> Self {
        match (as_json, verbose, quiet) {
            (true, ..) => Self::Json,
            (_, true, _) => Self::Whole,
            (.., true) => Self::Nothing,
            (.., false) => Self::Short,
        }
    }
}

/// The verdict as far as it is known before the run, with its reasons.
pub(super) fn expected_verdict(plan: &Plan) -> String {
    let warnings = plan.warnings.iter().chain(&plan.forecast.warnings);
    let verdict = Verdict::new(warnings.cloned().collect(), plan.coarse.clone());
    let (name, reasons) = verdict.reasons();
    let mut text = String::new();
    for reason in reasons {
        text += &format!("{name:14} {}\n", visible(reason));
    }
    let word = verdict.word.word();
    text + &format!("{:14} {word} as far as known before the run\n", "verdict")
}
