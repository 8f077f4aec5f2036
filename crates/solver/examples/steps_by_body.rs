//! The table of doc/performance.md, "Steps by body", made by running its study. From the folder of
//! the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example steps_by_body
//! ```
//!
//! Builds the program, runs `steps-by-body.toml`, four minutes, and writes the table into the
//! page. Results are in `target/steps-by-body`; `--resume` keeps the complete runs.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints a table, and how far it is"
)]

mod programs;

use dem_io::units::significant;

use programs::study::{Run, Table, measured, runs};
use programs::{Failed, results};

fn main() -> Result<(), Failed> {
    let resume = std::env::args()
        .nth(1)
        .is_some_and(|word| word == "--resume");
    let study = "steps-by-body";
    let runs = runs(study, &results(study)?.join(study), resume)?;
    let mut table = Table::new(&[
        "placed",
        "safety factor",
        "steps by body",
        "processor time",
        "gain",
        "error of soft height",
        "of hard height",
        "energy error",
        "particle updates skipped",
    ]);
    for placed in ["apart", "stacked", "clumps"] {
        for safety in ["0.9", "0.45"] {
            let without = find(&runs, "false", safety, placed)?;
            // The smallest step, the same for all bodies.
            let finest = find(&runs, "false", "0.45", placed)?;
            for by_body in ["false", "true"] {
                let run = find(&runs, by_body, safety, placed)?;
                let is_asked_for = if by_body == "true" { "yes" } else { "no" };
                table.row(&[
                    placed.to_owned(),
                    safety.to_owned(),
                    is_asked_for.to_owned(),
                    format!("{} s", significant(run.time_s, 2)),
                    format!("{:.1}", without.time_s / run.time_s),
                    error(run, finest, "soft_height")?,
                    error(run, finest, "hard_height")?,
                    format!("{:.0e}", energy_error(run)),
                    format!("{:.0} %", 100.0 * skipped(run)),
                ]);
            }
        }
    }
    table.write("doc/performance.md", "steps_by_body")
}

fn find<'a>(runs: &'a [Run], by_body: &str, safety: &str, placed: &str) -> Result<&'a Run, Failed> {
    let mut runs = runs.iter();
    let run = runs.find(|run| run.settings == [by_body, safety, placed]);
    run.ok_or_else(|| "the study lacks a run".into())
}

/// Relative difference of a measure from that of the finest run; nothing for that run itself.
fn error(run: &Run, finest: &Run, measure: &str) -> Result<String, Failed> {
    if run.settings == finest.settings {
        return Ok("compared with".to_owned());
    }
    let [value, reference] = [run, finest].map(|run| measured(&run.summary, measure));
    let reference = reference?;
    Ok(format!("{:.0e}", ((value? - reference) / reference).abs()))
}

fn energy_error(run: &Run) -> f64 {
    let error = run.summary["energy_error"].as_f64();
    error.map_or(f64::NAN, f64::abs)
}

/// Fraction of particle updates that longer steps saved.
fn skipped(run: &Run) -> f64 {
    let skipped = run.summary["updates_skipped_by_longer_steps"].as_f64();
    skipped.unwrap_or(0.0)
}
