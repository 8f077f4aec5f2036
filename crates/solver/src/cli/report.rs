//! `dem-run report`: the page of a finished run, again.

use std::path::Path;

use dem_io::safe_write::write_file;
use dem_io::text::visible;
use dem_io::{Result, read_input};
use dem_report::report;
use dem_terminal::standard_output::write_standard_output;

/// Writes `report.html` of a finished run.
pub(super) fn write_report(folder: &Path) -> Result<()> {
    let summary = folder.join("summary.json");
    let summary = read_input(&summary, "the summary of a run")?;
    let page = report(folder, &String::from_utf8_lossy(&summary))?;
    let target = folder.join("report.html");
    write_file(&target, |out| out.write_all(page.as_bytes()))?;
    write_standard_output(|out| writeln!(out, "{}", visible(&target.display().to_string())))
}
