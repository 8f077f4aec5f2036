//! dem-pack: see [`dem_pack::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(dem_pack::cli::program(std::env::args_os()))
}
