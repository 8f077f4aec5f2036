//! Progress bars on standard error.

use std::io::IsTerminal;

pub use indicatif::ProgressBar;
use indicatif::ProgressStyle;

/// A bar of this number of steps, drawn by a template of `indicatif`; hidden if `quiet`, and where
/// standard error is not a terminal.
pub fn progress_bar(quiet: bool, steps: usize, template: &str) -> ProgressBar {
    if quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(steps as u64);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}
