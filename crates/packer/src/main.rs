//! dem-pack: see [`dem_pack::cli`].

use dem_pack::cli::{Arguments, run};
use std::process::ExitCode;

fn main() -> ExitCode {
    let at_interrupt = || {
        dem_io::safe_write::remove_unfinished();
        std::process::exit(130);
    };
    dem_io::program::take_size_limits_as_errors();
    // Without the handler an interrupted run could leave a temporary file behind, nothing worse.
    let _ = ctrlc::set_handler(at_interrupt);
    match Arguments::parsed().and_then(|arguments| run(&arguments)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            dem_io::safe_write::write_standard_error(&error);
            ExitCode::from(error.exit_code())
        }
    }
}
