//! Threads that stay ready for the next stage of a step. A step is a sequence of short parallel
//! loops. Between two of them the threads of a pool go to sleep, and to wake one takes as long as
//! many a loop.

use std::hint::spin_loop;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{sleep, yield_now};
use std::time::{Duration, Instant};

use rayon::Yield;

/// Time without work after which a thread rests, with breaks of [`BREAK`]: files are being written,
/// for example.
const PATIENCE: Duration = Duration::from_millis(2);
/// Length of a break.
const BREAK: Duration = Duration::from_micros(200);
/// Number of looks for work between two looks at the clock, where other programs may take over.
const LOOKS: usize = 64;

/// Does some work on the threads of the present pool, which stay awake until it is done. Nothing
/// else may use the pool meanwhile: each of two such works would wait for the other's end.
pub fn keep_awake<T>(work: impl FnOnce() -> T) -> T {
    let own = rayon::current_thread_index();
    if own.is_none() || rayon::current_num_threads() == 1 {
        return work();
    }
    let is_done = AtomicBool::new(false);
    rayon::in_place_scope(|scope| {
        scope.spawn_broadcast(|_, thread| {
            if Some(thread.index()) != own {
                help_until(&is_done);
            }
        });
        let _ends = SetAtEnd(&is_done);
        work()
    })
}

/// Sets a flag when it is dropped, also where a thread panics: otherwise others would wait for ever.
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
