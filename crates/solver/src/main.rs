//! dem-run: see [`dem_run::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(dem_run::cli::program(std::env::args_os()))
}
