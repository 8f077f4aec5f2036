//! `dem-run stress`: the suite of stiff and extreme scenes.

use clap::Args;
use dem_io::{Diagnostic, Result};
use dem_terminal::progress::progress_bar;
use dem_terminal::standard_output::{write_standard_json, write_standard_output};

use super::pool::in_pool;
use crate::interrupt::Interrupt;
use dem_stress::cases::chosen;
use dem_stress::text::{HEAD, row};
use dem_stress::verdict::{CaseResult, run_case};

#[derive(Debug, Args)]
pub(super) struct StressArguments {
    /// Cases to run; all unless given
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Number of threads; all cores unless given. The results are the same for any number
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Print all runs as JSON
    #[arg(long)]
    json: bool,
    /// Only print errors: no progress, no table; --json is still printed
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the cases and prints their table. Cases that differ from their prediction are an error,
/// once the table is printed.
pub(super) fn stress(options: &StressArguments, interrupt: &Interrupt) -> Result<()> {
    let cases = chosen(&options.cases)?;
    let template = "stress [{bar:40}] {pos}/{len}  {msg}";
    let bar = progress_bar(options.quiet, cases.len(), template);
    let mut results: Vec<CaseResult> = Vec::new();
    let tried = in_pool(options.threads, |_| {
        interrupt.run_interruptible(|interrupted| {
            for case in &cases {
                bar.set_message(case.name);
                results.push(run_case(case, interrupted)?);
                bar.inc(1);
            }
            Ok(())
        })
    });
    bar.finish_and_clear();
    tried?;
    if options.json {
        write_standard_json(&results)?;
    } else if !options.quiet {
        write_standard_output(|out| {
            write!(out, "{HEAD}")?;
            results
                .iter()
                .try_for_each(|one| write!(out, "{}", row(one)))
        })?;
    }
    let wrong = results.iter().filter(|one| one.wrong().next().is_some());
    let wrong: Vec<&str> = wrong.map(|one| one.name).collect();
    if wrong.is_empty() {
        return Ok(());
    }
    Err(Diagnostic::failed(
        "dem-run stress",
        format!(
            "{} of {} cases did not do as predicted: {}",
            wrong.len(),
            results.len(),
            wrong.join(", ")
        ),
        "--json says of every run what was predicted and what was observed",
    ))
}
