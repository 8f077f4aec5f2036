//! The threads of a command.

use dem_io::{Diagnostic, Result};
use rayon::{ThreadPool, ThreadPoolBuilder};

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
    let pool = pool_of(wanted.unwrap_or(0))?;
    let threads = pool.current_num_threads();
    pool.install(|| work(threads))
}

/// A pool of this number of threads, 0 for all cores, each with the stack that a run needs.
pub(crate) fn pool_of(threads: usize) -> Result<ThreadPool> {
    ThreadPoolBuilder::new()
        .num_threads(threads)
        .stack_size(STACK_BYTES)
        .build()
        .map_err(|error| {
            Diagnostic::failed(
                "--threads",
                format!("the threads cannot be started: {error}"),
                "ask for fewer",
            )
        })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Uses 4 MiB of stack of the thread that calls it.
    #[inline(never)]
    fn uses_much(byte: u8) -> bool {
        let room = [byte; 4 << 20];
        std::hint::black_box(&room)[1 << 20] == byte
    }

    /// A thread of a pool holds what overflows the usual stack of 2 MiB.
    #[test]
    fn a_pool_has_room_for_unoptimised_loops() {
        assert!(pool_of(1).unwrap().install(|| uses_much(1)));
    }
}
