//! Progress of a run or a study on standard error: a bar on a terminal, lines in a log.

use std::cell::RefCell;
use std::fmt::Display;
use std::io::{IsTerminal, Write};
use std::time::Instant;

use dem_io::units::significant;
use dem_terminal::progress::{ProgressBar, progress_bar};

use dem_runner::SoFar;

use super::pace::{Pace, left_in_words};

/// Runs that take less have no lines, s; others have the first one by then.
const SHORT_S: f64 = 30.0;

/// Called from time to time with the fraction done, 0 to 1, and a text.
pub type Tell<'a> = &'a (dyn Fn(f64, &dyn Display) + Sync);

/// Shows how far a run has come.
pub(super) struct ShownProgress {
    bar: ProgressBar,
    pace: RefCell<Pace>,
    /// None on a terminal, and if nothing is to be shown.
    log: Option<RefCell<Log>>,
}

/// Whether progress is shown as lines in a log: where standard error is no terminal, unless
/// `quiet`.
pub(super) fn is_logged(quiet: bool) -> bool {
    !quiet && !std::io::stderr().is_terminal()
}

/// The lines in a log.
pub(super) struct Log {
    begun: Instant,
    pace: Pace,
    /// At the begin of each line, such as "run " or "run at twice the rate ".
    prefix: String,
    tenths: Tenths,
}

/// The tenths of a run for which there have been lines.
#[derive(Debug, Default)]
struct Tenths {
    /// Fraction at the first call, which is not 0 for a resumed run.
    first: Option<f64>,
    /// Number of tenths that need no line any more.
    told: u32,
    /// Whether there has been a line.
    has_begun: bool,
}

impl Tenths {
    /// The time left, `left_s`, if a line is due at this fraction of the run, `elapsed_s` after its
    /// begin: at each tenth of a run that will take [`SHORT_S`], and once that time has passed.
    fn due(&mut self, fraction: f64, elapsed_s: f64, left_s: Option<f64>) -> Option<f64> {
        let first = *self.first.get_or_insert(fraction);
        let tenths = (10.0 * fraction + 1e-9) as u32;
        let is_tenth = tenths > self.told.max((10.0 * first) as u32);
        let is_late = !self.has_begun && elapsed_s >= SHORT_S;
        if !is_tenth && !is_late {
            return None;
        }
        self.told = self.told.max(tenths);
        let told = left_s.filter(|left_s| elapsed_s + left_s >= SHORT_S && tenths < 10);
        self.has_begun |= told.is_some();
        told
    }
}

impl ShownProgress {
    /// Shows nothing if `quiet`.
    pub(super) fn new(quiet: bool) -> Self {
        let log = is_logged(quiet).then(|| RefCell::new(Log::new("run ")));
        let template = "run {prefix}[{bar:30}] {percent:>3} %  {msg}";
        Self {
            bar: progress_bar(quiet, 1000, template),
            pace: RefCell::default(),
            log,
        }
    }

    /// Begins another run; `prefix` stands before its progress.
    pub(super) fn begin(&self, prefix: &'static str) {
        self.bar.set_prefix(prefix);
        self.pace.replace(Pace::default());
        if let Some(log) = &self.log {
            *log.borrow_mut() = Log::new(&format!("run {prefix}"));
        }
    }

    /// Shows how far the run has come.
    pub(super) fn tell(&self, so_far: &SoFar) {
        self.bar.set_position((1000.0 * so_far.fraction) as u64);
        let elapsed_s = self.bar.elapsed().as_secs_f64();
        let left_s = self.pace.borrow_mut().left_s(so_far.fraction, elapsed_s);
        let left = left_s.map_or_else(String::new, left_in_words);
        self.bar.set_message(format!("{so_far}  {left}"));
        if let Some(log) = &self.log {
            log.borrow_mut().tell(so_far.fraction, so_far);
        }
    }

    /// Removes the bar.
    pub(super) fn end(&self) {
        self.bar.finish_and_clear();
    }
}

impl Log {
    /// Begins now.
    pub(super) fn new(prefix: &str) -> Self {
        Self {
            begun: Instant::now(),
            pace: Pace::default(),
            prefix: prefix.to_owned(),
            tenths: Tenths::default(),
        }
    }

    /// Writes a line if one is due at this fraction of the whole.
    pub(super) fn tell(&mut self, fraction: f64, what: &dyn Display) {
        let elapsed_s = self.begun.elapsed().as_secs_f64();
        let left_s = self.pace.left_s(fraction, elapsed_s);
        if let Some(left_s) = self.tenths.due(fraction, elapsed_s, left_s) {
            // A closed output is not a reason to stop.
            let _ = writeln!(
                std::io::stderr(),
                "{}{:.0} %: {what}, about {} s left",
                self.prefix,
                100.0 * fraction,
                significant(left_s, 2)
            );
        }
    }
}

/// The lines of a calibration in a log: the number of tests done, at most one in [`SHORT_S`].
pub(super) struct LogOfTests {
    begun: Instant,
    last: Instant,
    prefix: String,
    is_shown: bool,
}

impl LogOfTests {
    /// Begins now; shows nothing if `quiet`, and on a terminal. `size`: that of the spheres, if
    /// several are calibrated.
    pub(super) fn new(quiet: bool, size: &str) -> Self {
        Self {
            begun: Instant::now(),
            last: Instant::now(),
            prefix: format!("calibrate {size}").trim_end().to_owned(),
            is_shown: is_logged(quiet),
        }
    }

    /// Writes a line if one is due.
    pub(super) fn tell(&mut self, tests: usize) {
        if self.is_shown && self.last.elapsed().as_secs_f64() >= SHORT_S {
            self.last = Instant::now();
            // A closed output is not a reason to stop.
            let _ = writeln!(
                std::io::stderr(),
                "{}: {tests} tests done in {} s",
                self.prefix,
                significant(self.begun.elapsed().as_secs_f64(), 2)
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn due((tenths, pace): &mut (Tenths, Pace), fraction: f64, elapsed_s: f64) -> Option<f64> {
        let left_s = pace.left_s(fraction, elapsed_s);
        tenths.due(fraction, elapsed_s, left_s)
    }

    #[test]
    fn a_log_has_a_line_for_each_tenth_of_a_long_run() {
        let mut tenths = (Tenths::default(), Pace::default());
        // 200 s, told every percent.
        let told: Vec<(u32, f64)> = (0..=100)
            .filter_map(|percent| {
                let fraction = f64::from(percent) / 100.0;
                Some((percent, due(&mut tenths, fraction, 200.0 * fraction)?))
            })
            .collect();
        let percents: Vec<u32> = told.iter().map(|(percent, _)| *percent).collect();
        assert_eq!(
            percents,
            [10, 20, 30, 40, 50, 60, 70, 80, 90],
            "the first after 20 s"
        );
        for (percent, left_s) in told {
            assert!((left_s - 2.0 * f64::from(100 - percent)).abs() < 1e-9);
        }
        // 1000 s, told every percent: the first line after 30 s.
        let mut long = (Tenths::default(), Pace::default());
        let lines = (0..=100).filter(|percent| {
            let fraction = f64::from(*percent) / 100.0;
            due(&mut long, fraction, 1000.0 * fraction).is_some()
        });
        assert_eq!(
            lines.collect::<Vec<u32>>(),
            [3, 10, 20, 30, 40, 50, 60, 70, 80, 90]
        );
        let mut short = (Tenths::default(), Pace::default());
        assert!(
            (0..=100).all(|percent| due(&mut short, f64::from(percent) / 100.0, 1.0).is_none())
        );
        // Resumed at 55 %: 45 % in 90 s.
        let mut resumed = (Tenths::default(), Pace::default());
        assert_eq!(due(&mut resumed, 0.55, 0.0), None);
        assert_eq!(due(&mut resumed, 0.6, 31.0).map(f64::round), Some(248.0));
        assert_eq!(due(&mut resumed, 0.65, 40.0), None);
    }

    #[test]
    fn progress_in_words() {
        let so_far = |time_s| SoFar {
            fraction: 0.5,
            time_s,
            broken_bonds: 3,
        };
        assert_eq!(
            so_far(12.5e-3).to_string(),
            "12.5 ms simulated, 3 bonds broken"
        );
        assert_eq!(so_far(2.0).to_string(), "2 s simulated, 3 bonds broken");
    }
}
