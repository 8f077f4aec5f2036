//! dem-run: see [`dem_run::cli`].

use std::process::ExitCode;

use clap::Parser;
use dem_run::cli::{Arguments, run};

#[expect(clippy::print_stderr, reason = "the one place that speaks to a person")]
fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
