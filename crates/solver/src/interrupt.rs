//! Ctrl-C: a run ends by itself and keeps its state; anything else ends at once.

use std::sync::atomic::{AtomicBool, Ordering};

/// Who listens to Ctrl-C, and whether it was heard.
#[derive(Debug, Default)]
pub struct Interrupt {
    asked: AtomicBool,
    heeded: AtomicBool,
}

impl Interrupt {
    /// Asks to stop. False if the program has to be ended from outside: nothing listens, or this is
    /// not the first time.
    pub fn ask(&self) -> bool {
        let again = self.asked.swap(true, Ordering::Relaxed);
        !again && self.heeded.load(Ordering::Relaxed)
    }

    /// Does work that ends by itself when the flag is set. What comes after it is soon done, and is
    /// waited for as well.
    pub fn run_interruptible<T>(&self, work: impl FnOnce(&AtomicBool) -> T) -> T {
        self.heeded.store(true, Ordering::Relaxed);
        work(&self.asked)
    }
}
