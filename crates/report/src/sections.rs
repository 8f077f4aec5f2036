//! The sections of the page.

mod inputs;
mod outlets;
mod percent;
mod results;
mod time;
mod wall_loads;

use dem_io::Result;
use dem_io::text::counted;
use dem_io::units::show_quantity;
use dem_plots::Page;
use dem_results::Summary;
use dem_results::summary::{COARSE, Trust};

use crate::folder::Folder;

pub(crate) use inputs::add_inputs;
pub(crate) use results::{add_results, add_test};
pub(crate) use time::add_time;
pub(crate) use wall_loads::add_wall_loads;

/// Plots that come first, in this order.
const FIRST_PLOTS: [&str; 13] = [
    "bar-signals",
    "gauge-signals",
    "stress-strain",
    "force-time",
    "force-displacement",
    "disc-stress",
    "crack",
    "fragment_sizes",
    "discharged_mass",
    "fragments",
    "broken_bonds",
    "rate_strengthening",
    "energy",
];

/// Whether the result can be trusted, and how the run ended.
pub(crate) fn add_verdict(page: &mut Page, summary: &Summary) {
    let mut warnings = summary.verdict.warnings.clone();
    if let (true, Some(problem)) = (warnings.is_empty(), &summary.problem) {
        // A run that failed at its start has no verdict.
        warnings.push(problem.clone());
    }
    let word = summary.verdict.word;
    let headline = match word {
        Trust::Sound => "Sound: all checks passed.".to_owned(),
        Trust::Coarse => format!("Coarse: {COARSE}."),
        Trust::Doubtful => format!("Doubtful: {}.", counted(warnings.len(), "warning")),
    };
    let mut reasons = warnings;
    reasons.extend(summary.verdict.coarse.iter().cloned());
    page.verdict(&headline, word.word(), &reasons);
    if !summary.has_results() {
        return;
    }
    let part = match summary.resumed_at_s {
        Some(at_s) => {
            let last_s = summary.simulated_s - at_s;
            format!(", the last {} of it", show_quantity(last_s, "s"))
        }
        None => String::new(),
    };
    if let Some(engine) = &summary.engine {
        let simulated = show_quantity(summary.simulated_s, "s");
        let (by, program) = (&summary.ended_by, &summary.program);
        page.paragraph(&format!(
            "{simulated} simulated by {engine}, ended by {by}; exported by {program}."
        ));
        return;
    }
    let ended = format!(
        "{} simulated{part} in {} on {}, ended by {}; {}.",
        show_quantity(summary.simulated_s, "s"),
        show_quantity(summary.wall_s, "s"),
        counted(summary.threads, "thread"),
        summary.ended_by,
        summary.program,
    );
    page.paragraph(&ended);
    if !summary.notes.is_empty() {
        let title = counted(summary.notes.len(), "note");
        page.details(&title, &summary.notes.join("\n"));
    }
}

/// The plots of the folder.
pub(crate) fn add_curves(page: &mut Page, folder: &Folder) -> Result<()> {
    let plots = folder.plots(&FIRST_PLOTS)?;
    if !plots.is_empty() {
        page.heading("Curves");
        page.gallery(&plots);
    }
    Ok(())
}
