//! The threads of a command.

use dem_io::{Diagnostic, Result};

/// Stack of each thread. Without optimisation, the loops over contacts in AVX-512 need more than
/// the usual 2 MiB.
const STACK_BYTES: usize = 32 << 20;

/// Refuses numbers of threads other than 1 to 1024.
pub(super) fn refuse_threads(threads: usize, remedy: &str) -> Result<()> {
    if (1..=1024).contains(&threads) {
        return Ok(());
    }
    let problem = format!("{threads} is not between 1 and 1024");
    Err(Diagnostic::input("--threads", problem, remedy))
}

/// Does the work on as many threads as wanted, 1 to 1024, or on all cores; it is told their number.
pub(super) fn in_pool(
    wanted: Option<usize>,
    work: impl FnOnce(usize) -> Result<()> + Send,
) -> Result<()> {
    if let Some(threads) = wanted {
        refuse_threads(threads, "leave it out for all cores")?;
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(wanted.unwrap_or(0))
        .stack_size(STACK_BYTES)
        .build()
        .map_err(|error| {
            Diagnostic::failed(
                "--threads",
                format!("the threads cannot be started: {error}"),
                "ask for fewer",
            )
        })?;
    let threads = pool.current_num_threads();
    pool.install(|| work(threads))
}
