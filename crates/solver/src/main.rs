//! dem-run: see [`dem_run::cli`].

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Parser;
use dem_run::cli::{Arguments, run};

#[expect(clippy::print_stderr, reason = "the one place that speaks to a person")]
fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    let at_interrupt = move || {
        // The first time the run ends by itself and keeps its state; the second time it is not waited for.
        if flag.swap(true, Ordering::Relaxed) {
            dem_io::safe_write::remove_unfinished();
            std::process::exit(130);
        }
    };
    // Without the handler an interrupted run would leave no checkpoint, no more.
    let _ = ctrlc::set_handler(at_interrupt);
    match run(&arguments, &interrupted) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
