//! Ctrl-C: a run stops by itself and keeps its state; anything else ends at once.

use std::sync::atomic::{AtomicBool, Ordering};

/// Requested interruption, and whether any work reacts to it.
#[derive(Debug, Default)]
pub struct Interrupt {
    asked: AtomicBool,
    heeded: AtomicBool,
}

impl Interrupt {
    /// Requests a stop. False if the program must be ended from outside: no work reacts, or this is
    /// not the first request.
    pub fn ask(&self) -> bool {
        let again = self.asked.swap(true, Ordering::Relaxed);
        !again && self.heeded.load(Ordering::Relaxed)
    }

    /// Does work that stops by itself when the flag is set. Whatever follows it is short, and is
    /// completed as well.
    pub(crate) fn run_interruptible<T>(&self, work: impl FnOnce(&AtomicBool) -> T) -> T {
        self.heeded.store(true, Ordering::Relaxed);
        work(&self.asked)
    }
}
