//! The tables of doc/performance.md, "Steps by body", made by running their studies. From the
//! folder of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example steps_by_body
//! ```
//!
//! Builds the program, runs `steps-by-body.toml`, four minutes, and `steps-by-body-fed.toml`, one
//! minute, and writes the tables into the page. Results are in `target/steps-by-body` and
//! `target/steps-by-body-fed`; `--resume` keeps the complete runs.
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
    let heights = [
        ("soft_height", "error of soft height"),
        ("hard_height", "of hard height"),
    ];
    let placed = ["apart", "stacked", "clumps"];
    write_table("steps-by-body", &placed, heights, resume)?;
    let of_belt = [
        ("push", "error of mean push"),
        ("kinetic_energy", "of kinetic energy"),
    ];
    write_table("steps-by-body-fed", &[], of_belt, resume)
}

/// Runs a study and writes its table, with a row for each run: those of each placement, if it has
/// several. `measures`: whose errors are shown, and the heads of their columns.
fn write_table(
    study: &str,
    placements: &[&str],
    measures: [(&str, &str); 2],
    resume: bool,
) -> Result<(), Failed> {
    let runs = runs(study, &results(study)?.join(study), resume)?;
    let mut heads = vec!["safety factor", "steps by body", "processor time", "gain"];
    heads.extend(measures.map(|(_, head)| head));
    heads.extend(["energy error", "particle updates skipped"]);
    if !placements.is_empty() {
        heads.insert(0, "placed");
    }
    let mut table = Table::new(&heads);
    let of_placement = |placed: Option<&str>, table: &mut Table| -> Result<(), Failed> {
        for safety in ["0.9", "0.45"] {
            let without = find(&runs, "false", safety, placed)?;
            // The smallest step, the same for all bodies.
            let finest = find(&runs, "false", "0.45", placed)?;
            for by_body in ["false", "true"] {
                let run = find(&runs, by_body, safety, placed)?;
                let is_asked_for = if by_body == "true" { "yes" } else { "no" };
                let mut row: Vec<String> = placed.map(str::to_owned).into_iter().collect();
                row.extend([
                    safety.to_owned(),
                    is_asked_for.to_owned(),
                    format!("{} s", significant(run.time_s, 2)),
                    format!("{:.1}", without.time_s / run.time_s),
                ]);
                for (measure, _) in measures {
                    row.push(error(run, finest, measure)?);
                }
                row.extend([
                    format!("{:.0e}", energy_error(run)),
                    format!("{:.0} %", 100.0 * skipped(run)),
                ]);
                table.row(&row);
            }
        }
        Ok(())
    };
    if placements.is_empty() {
        of_placement(None, &mut table)?;
    }
    for placed in placements {
        of_placement(Some(placed), &mut table)?;
    }
    table.write("doc/performance.md", &study.replace('-', "_"))
}

fn find<'a>(
    runs: &'a [Run],
    by_body: &str,
    safety: &str,
    placed: Option<&str>,
) -> Result<&'a Run, Failed> {
    let settings = [Some(by_body), Some(safety), placed];
    let settings: Vec<&str> = settings.into_iter().flatten().collect();
    let mut runs = runs.iter();
    let run = runs.find(|run| run.settings == settings);
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
