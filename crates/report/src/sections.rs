//! The sections of the page.

mod inputs;
mod results;
mod time;
mod values;

use dem_io::Result;
use dem_io::text::counted;
use dem_io::units::show_quantity;
use dem_plots::Page;
use serde_json::Value;

use crate::folder::Folder;

pub(crate) use inputs::add_inputs;
pub(crate) use results::{add_results, add_test};
pub(crate) use time::add_time;

use values::{number, text, texts};

/// Plots that come first, in this order.
const FIRST_PLOTS: [&str; 12] = [
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
    "energy",
];

/// Whether the result can be trusted, and how the run ended.
pub(crate) fn add_verdict(page: &mut Page, summary: &Value) {
    let mut warnings = texts(&summary["verdict"]["warnings"]);
    if let (true, Some(problem)) = (warnings.is_empty(), summary["problem"].as_str()) {
        // A run that failed at its start has no verdict.
        warnings.push(problem.to_owned());
    }
    let is_sound = summary["verdict"]["sound"] == true;
    let headline = if is_sound {
        "Checks passed, no warnings.".to_owned()
    } else {
        format!("Doubtful: {}.", counted(warnings.len(), "warning"))
    };
    page.verdict(&headline, is_sound, &warnings);
    if !summary["steps"].is_number() {
        return;
    }
    let quantity = |name: &str, unit: &str| show_quantity(number(&summary[name]), unit);
    let part = match summary["resumed_at_s"].as_f64() {
        Some(at_s) => {
            let last_s = number(&summary["simulated_s"]) - at_s;
            format!(", the last {} of it", show_quantity(last_s, "s"))
        }
        None => String::new(),
    };
    let mut ended = format!(
        "{} simulated{part} in {} on {}, ended by {}; {}.",
        quantity("simulated_s", "s"),
        quantity("wall_s", "s"),
        counted(number(&summary["threads"]) as usize, "thread"),
        text(&summary["ended_by"]),
        text(&summary["program"]),
    );
    if let Some(notes) = Some(texts(&summary["notes"])).filter(|notes| !notes.is_empty()) {
        ended += &format!(" {}.", notes.join(". "));
    }
    page.paragraph(&ended);
}

/// The plots of the folder.
///
/// # Errors
/// One of them cannot be read (exit code 2).
pub(crate) fn add_curves(page: &mut Page, folder: &Folder) -> Result<()> {
    let plots = folder.plots(&FIRST_PLOTS)?;
    if !plots.is_empty() {
        page.heading("Curves");
        page.gallery(&plots);
    }
    Ok(())
}
