//! Threads that stay ready for the next stage of a step. A step is a sequence of short parallel
//! loops. Between two of them the threads of a pool would go to sleep, and to wake one takes as
//! long as many a loop.

use std::hint::spin_loop;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::{available_parallelism, sleep, yield_now};
use std::time::{Duration, Instant};

use rayon::Yield;

/// Time without work after which a thread looks for it only now and then: files are being written,
/// for example.
const PATIENCE: Duration = Duration::from_millis(2);
/// Time between two such looks.
const BREAK: Duration = Duration::from_micros(200);
/// Number of looks for work between two looks at the clock, when other programs may run.
const LOOKS: usize = 64;

/// Does some work on the threads of the present pool, which stay awake until it is done, unless
/// there are more of them than cores. Nothing else may use the pool meanwhile, nor may this be
/// called in a parallel loop: each of two such calls would wait for the other's end.
pub fn keep_awake<T>(work: impl FnOnce() -> T) -> T {
    let own = rayon::current_thread_index();
    let threads = rayon::current_num_threads();
    let cores = available_parallelism().map_or(1, usize::from);
    if own.is_none() || threads == 1 || threads > cores {
        return work();
    }
    let (arrived, is_done) = (AtomicUsize::new(0), AtomicBool::new(false));
    rayon::in_place_scope(|scope| {
        scope.spawn_broadcast(|_, thread| {
            if Some(thread.index()) != own {
                arrived.fetch_add(1, Ordering::AcqRel);
                help_until(&is_done);
            }
        });
        let _ends = SetAtEnd(&is_done);
        // A thread that took a part of the work first could begin to help while it waits for the
        // rest of that part, which would then never end.
        while arrived.load(Ordering::Acquire) < threads - 1 {
            yield_now();
        }
        work()
    })
}

/// Sets a flag when it is dropped, also in a panic: otherwise the others would wait for ever.
struct SetAtEnd<'a>(&'a AtomicBool);

impl Drop for SetAtEnd<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

/// Does what the pool has to do, until all is done.
fn help_until(is_done: &AtomicBool) {
    let mut idle_since = Instant::now();
    while !is_done.load(Ordering::Acquire) {
        let mut worked = false;
        for _ in 0..LOOKS {
            if rayon::yield_now() == Some(Yield::Executed) {
                worked = true;
                break;
            }
            spin_loop();
        }
        if worked {
            idle_since = Instant::now();
        } else if idle_since.elapsed() < PATIENCE {
            yield_now();
        } else {
            sleep(BREAK);
        }
    }
}

#[cfg(test)]
#[expect(
    clippy::expect_used,
    clippy::panic,
    reason = "a test stops where it fails"
)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use rayon::prelude::*;

    use super::*;

    fn on_two_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
        pool.expect("threads start").install(work)
    }

    fn sum() -> u64 {
        (0..1000_u64).into_par_iter().sum()
    }

    #[test]
    fn the_work_is_done_with_help_and_breaks_and_again() {
        on_two_threads(|| {
            for breaks in [false, true] {
                let sums = keep_awake(|| {
                    let first = sum();
                    if breaks {
                        sleep(3 * PATIENCE);
                    }
                    first + sum()
                });
                assert_eq!(sums, 2 * 499_500);
            }
        });
        assert_eq!(keep_awake(sum), 499_500, "outside a pool");
    }

    #[test]
    fn a_panic_ends_it() {
        on_two_threads(|| {
            let panicked = catch_unwind(AssertUnwindSafe(|| keep_awake(|| panic!("on purpose"))));
            assert!(panicked.is_err());
            assert_eq!(sum(), 499_500);
        });
    }
}
