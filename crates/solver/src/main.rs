//! dem-run: see [`dem_run::cli`].

use std::process::ExitCode;
use std::sync::Arc;

use dem_io::Diagnostic;
use dem_io::program::take_size_limits_as_errors;
use dem_io::safe_write::{remove_unfinished, write_standard_error};
use dem_run::cli::{Arguments, run};
use dem_run::interrupt::Interrupt;

fn main() -> ExitCode {
    let arguments = match Arguments::parsed(std::env::args_os()) {
        Ok(arguments) => arguments,
        Err(error) => {
            write_standard_error(&error);
            return ExitCode::from(error.exit_code());
        }
    };
    let interrupt = Arc::new(Interrupt::default());
    let asked = Arc::clone(&interrupt);
    let at_interrupt = move || {
        if !asked.ask() {
            remove_unfinished();
            let problem = Diagnostic::interrupted("interrupted", "");
            write_standard_error(&problem);
            std::process::exit(i32::from(problem.exit_code()));
        }
    };
    take_size_limits_as_errors();
    // Without the handler, the only loss is the checkpoint of an interrupted run.
    let _ = ctrlc::set_handler(at_interrupt);
    match run(&arguments, &interrupt) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            write_standard_error(&error);
            ExitCode::from(error.exit_code())
        }
    }
}
