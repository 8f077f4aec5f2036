//! Threads that share the loops of a step, and stay ready for the next. A step is a sequence of
//! short loops. Between two of them the threads of a pool would go to sleep, and to wake one takes
//! as long as many a loop; a pool takes a few microseconds to divide a loop even among threads that
//! are awake. Here the one that steps says in one atomic number what there is to do.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::hint::spin_loop;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::ptr::from_ref;
use std::sync::atomic::{AtomicBool, AtomicPtr, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{available_parallelism, sleep, yield_now};
use std::time::{Duration, Instant};

use rayon::Yield;
use rayon::prelude::*;

/// Time without work after which a thread looks for it only now and then: files are being written,
/// for example, or one thread is enough.
const PATIENCE: Duration = Duration::from_millis(2);
/// Time between two such looks.
const BREAK: Duration = Duration::from_micros(200);
/// Number of looks for work between two looks at the clock, when other programs may run.
const LOOKS: usize = 64;
/// Largest number of parts of a loop.
const MOST_PARTS: usize = 0xffff;

thread_local! {
    /// The threads that help this one. None while they do.
    static TEAM: RefCell<Option<Arc<Team>>> = const { RefCell::new(None) };
    /// Whether this one does everything itself.
    static IS_ALONE: Cell<bool> = const { Cell::new(false) };
}

/// Whether loops of this thread are from now on worth sharing.
pub(crate) fn share_loops(are_worth_it: bool) {
    IS_ALONE.set(!are_worth_it);
}

/// Works on each part, on all threads if that is worth it.
pub(crate) fn for_each<T: Send>(parts: impl Iterator<Item = T>, work: impl Fn(T) + Sync + Send) {
    if IS_ALONE.get() || rayon::current_num_threads() == 1 {
        return parts.for_each(work);
    }
    let Some(team) = TEAM.take().map(Lent) else {
        return parts.collect::<Vec<T>>().into_par_iter().for_each(work);
    };
    let parts: Vec<Mutex<Option<T>>> = parts.map(|part| Mutex::new(Some(part))).collect();
    let groups = parts.len().min(MOST_PARTS);
    team.0.share(groups, &|group| {
        let some = [group, group + 1].map(|n| parts.len() * n / groups);
        for part in &parts[some[0]..some[1]] {
            let part = part.lock().unwrap_or_else(PoisonError::into_inner).take();
            part.into_iter().for_each(&work);
        }
    });
}

/// As [`for_each`]. Returns the largest result, at least 0.
pub(crate) fn largest_of<T: Send>(
    parts: impl Iterator<Item = T>,
    work: impl Fn(T) -> f64 + Sync + Send,
) -> f64 {
    // Bits of numbers that are not negative are in the order of the numbers.
    let largest = AtomicU64::new(0);
    for_each(parts, |part| {
        largest.fetch_max(work(part).max(0.0).to_bits(), Ordering::Relaxed);
    });
    f64::from_bits(largest.into_inner())
}

/// The team of this thread, while it works on a loop.
struct Lent(Arc<Team>);

impl Drop for Lent {
    fn drop(&mut self) {
        TEAM.set(Some(Arc::clone(&self.0)));
    }
}

type Work<'a> = &'a (dyn Fn(usize) + Sync);

/// Threads that help another one.
#[derive(Default)]
struct Team {
    /// What is left of the present loop, from the highest bits: 32 of the number of the loop, 16 of
    /// the end of the parts and 16 of their start. The one that steps takes parts from the start,
    /// its helpers from the end: so a thread mostly works on the same particles from loop to loop.
    left: AtomicU64,
    /// The [`Work`] of the present loop.
    work: AtomicPtr<()>,
    /// Number of parts that helpers have done.
    helped: AtomicUsize,
    /// What a helper stopped with.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
    is_done: AtomicBool,
}

/// Which parts a thread takes.
#[derive(Clone, Copy)]
enum Side {
    Start,
    End,
}

/// The start and the end of the parts that are left.
fn parts_of(left: u64) -> [usize; 2] {
    [
        left as usize & MOST_PARTS,
        (left >> 16) as usize & MOST_PARTS,
    ]
}

impl Team {
    /// Calls `work` with each number below `parts`, and returns when all is done.
    fn share(&self, parts: usize, work: Work<'_>) {
        // Alive until all is done: `Rest` waits for that.
        self.work
            .store(from_ref(&work).cast_mut().cast(), Ordering::Relaxed);
        self.helped.store(0, Ordering::Relaxed);
        drop(self.panicked());
        let loops = (self.left.load(Ordering::Relaxed) >> 32) + 1;
        self.left
            .store(loops << 32 | (parts as u64) << 16, Ordering::Release);
        let mut rest = Rest { team: self, parts };
        while let Some(part) = self.take(loops & 0xffff_ffff, Side::Start) {
            rest.parts -= 1;
            work(part);
        }
        drop(rest);
        if let Some(panic) = self.panicked() {
            resume_unwind(panic);
        }
    }

    /// What a helper stopped with in the last loop.
    fn panicked(&self) -> Option<Box<dyn Any + Send>> {
        let mut panic = self.panic.lock().unwrap_or_else(PoisonError::into_inner);
        panic.take()
    }

    /// Takes a part of this loop, if it is still the present one and has any left.
    fn take(&self, of_loop: u64, from: Side) -> Option<usize> {
        let mut left = self.left.load(Ordering::Acquire);
        loop {
            let [start, end] = parts_of(left);
            if left >> 32 != of_loop || start == end {
                return None;
            }
            let (part, then) = match from {
                Side::Start => (start, left + 1),
                Side::End => (end - 1, left - (1 << 16)),
            };
            let (success, failure) = (Ordering::AcqRel, Ordering::Acquire);
            match self
                .left
                .compare_exchange_weak(left, then, success, failure)
            {
                Ok(_) => return Some(part),
                Err(now) => left = now,
            }
        }
    }

    /// Does a part, if any is left. Returns whether it did.
    fn help(&self) -> bool {
        let of_loop = self.left.load(Ordering::Acquire) >> 32;
        let Some(part) = self.take(of_loop, Side::End) else {
            return false;
        };
        let work = self.work.load(Ordering::Relaxed).cast::<Work<'_>>();
        #[expect(
            unsafe_code,
            reason = "a loop borrows from the step, and threads that outlive it cannot"
        )]
        // SAFETY: a part of the present loop has been taken, so its work is still alive: `share`
        // stores it before the parts, and neither returns nor stores another before this one is
        // counted as done below.
        let work = unsafe { *work };
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| work(part))) {
            let mut first = self.panic.lock().unwrap_or_else(PoisonError::into_inner);
            first.get_or_insert(panic);
        }
        self.helped.fetch_add(1, Ordering::Release);
        true
    }
}

/// The parts of a loop that its own thread has not taken. Waits at its end for those that helpers
/// have, and takes the others away, which are none unless a part panicked.
struct Rest<'a> {
    team: &'a Team,
    parts: usize,
}

impl Drop for Rest<'_> {
    fn drop(&mut self) {
        let loop_alone = 0xffff_ffff_0000_0000;
        let left = self.team.left.fetch_and(loop_alone, Ordering::AcqRel);
        let [start, end] = parts_of(left);
        let helped = self.parts - (end - start);
        for looks in 1_usize.. {
            if self.team.helped.load(Ordering::Acquire) == helped {
                break;
            }
            if looks.is_multiple_of(LOOKS * LOOKS) {
                yield_now();
            }
            spin_loop();
        }
    }
}

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
    let team = Arc::new(Team::default());
    let arrived = AtomicUsize::new(0);
    rayon::in_place_scope(|scope| {
        scope.spawn_broadcast(|_, thread| {
            if Some(thread.index()) != own {
                arrived.fetch_add(1, Ordering::AcqRel);
                help_until_done(&team);
            }
        });
        let _ends = SetAtEnd(&team.is_done);
        // A thread that took a part of the work first could begin to help while it waits for the
        // rest of that part, which would then never end.
        while arrived.load(Ordering::Acquire) < threads - 1 {
            yield_now();
        }
        TEAM.set(Some(Arc::clone(&team)));
        work()
    })
}

/// Sets a flag when it is dropped, also in a panic: otherwise the others would wait for ever.
struct SetAtEnd<'a>(&'a AtomicBool);

impl Drop for SetAtEnd<'_> {
    fn drop(&mut self) {
        TEAM.set(None);
        self.0.store(true, Ordering::Release);
    }
}

/// Does what the team and the pool have to do, until all is done.
fn help_until_done(team: &Team) {
    let mut idle_since = Instant::now();
    while !team.is_done.load(Ordering::Acquire) {
        let mut worked = false;
        for _ in 0..LOOKS {
            if team.help() || rayon::yield_now() == Some(Yield::Executed) {
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

#[expect(
    clippy::expect_used,
    clippy::panic,
    reason = "a test stops where it fails"
)]
#[cfg(test)]
mod tests {
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
    fn every_part_is_done_once_whoever_does_it() {
        let squares = |count: usize| {
            let mut all = vec![0; count];
            for_each(all.iter_mut().enumerate(), |(n, square)| *square += n * n);
            all
        };
        let wanted = |count: usize| (0..count).map(|n| n * n).collect::<Vec<usize>>();
        for count in [0, 1, 2, 7, 1000, MOST_PARTS + 2] {
            assert_eq!(squares(count), wanted(count), "outside a pool");
            on_two_threads(|| {
                assert_eq!(squares(count), wanted(count), "with a pool alone");
                keep_awake(|| {
                    for _ in 0..20 {
                        assert_eq!(squares(count), wanted(count));
                    }
                    share_loops(false);
                    assert_eq!(squares(count), wanted(count), "alone");
                    share_loops(true);
                });
            });
        }
    }

    #[test]
    fn threads_meet_a_million_times() {
        on_two_threads(|| {
            keep_awake(|| {
                let mut sums = [0_u64; 2];
                for n in 0..1_000_000 {
                    for_each(sums.iter_mut(), |sum| *sum += n);
                }
                assert_eq!(sums, [499_999_500_000; 2]);
            });
        });
    }

    #[test]
    fn loops_within_loops_are_done() {
        on_two_threads(|| {
            keep_awake(|| {
                let mut rows = [[0; 100]; 40];
                for_each(rows.iter_mut(), |row| {
                    for_each(row.iter_mut(), |number| *number += 1);
                });
                assert_eq!(rows, [[1; 100]; 40]);
            });
        });
    }

    #[test]
    fn a_part_that_panics_stops_the_loop_and_the_next_one_is_whole() {
        on_two_threads(|| {
            keep_awake(|| {
                for bad in 0..50 {
                    let mut done = [0; 50];
                    let panicked = catch_unwind(AssertUnwindSafe(|| {
                        for_each(done.iter_mut().enumerate(), |(n, done)| {
                            assert!(n != bad, "on purpose");
                            *done += 1;
                        });
                    }));
                    assert!(panicked.is_err() && done[bad] == 0);
                    let mut next = [0; 50];
                    for_each(next.iter_mut(), |next| *next += 1);
                    assert_eq!(next, [1; 50]);
                }
            });
        });
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
