//! Broken bonds over the time of a run.

use serde::{Deserialize, Serialize};

/// Number of bins; their width doubles when they are full.
const BINS: usize = 64;

/// Share of all broken bonds that break in the last part of a run, over this part of the run, up to
/// which breakage is over: if it went on so, a run twice as long would break 4 % more.
const SLOW: f64 = 0.04;

/// Numbers of broken bonds in bins of equal width.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Breaks {
    /// Width of a bin, s. 0: none has broken yet.
    bin_s: f64,
    bins: Vec<u32>,
}

impl Breaks {
    /// Counts bonds that broke at this time, s, which does not decrease.
    pub(super) fn note(&mut self, time_s: f64, bonds: usize) {
        if self.bin_s == 0.0 {
            self.bin_s = (time_s / BINS as f64).max(f64::MIN_POSITIVE);
        }
        while time_s >= self.bin_s * BINS as f64 {
            self.bin_s *= 2.0;
            self.bins = self.bins.chunks(2).map(|pair| pair.iter().sum()).collect();
        }
        let bin = (time_s / self.bin_s) as usize;
        if self.bins.len() <= bin {
            self.bins.resize(bin + 1, 0);
        }
        self.bins[bin] += bonds as u32;
    }

    /// All broken bonds, and those since this time, s, or since at most the width of a bin before.
    pub(super) fn all_and_since(&self, time_s: f64) -> [u32; 2] {
        let first = (time_s / self.bin_s) as usize;
        let late = self.bins.get(first..).unwrap_or_default();
        [self.bins.iter().sum(), late.iter().sum()]
    }

    /// Whether more than a few of all broken bonds broke in the last part of a run that ends at
    /// this time, s.
    pub(super) fn go_on(&self, part: f64, end_s: f64) -> bool {
        let [all, late] = self.all_and_since((1.0 - part) * end_s);
        f64::from(late) > SLOW * part * f64::from(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_keep_the_number_and_the_time_of_breaks() {
        let mut breaks = Breaks::default();
        assert_eq!(breaks.all_and_since(1.0), [0, 0]);
        breaks.note(1e-3, 3);
        for step in 1..=1000 {
            breaks.note(1e-3 * f64::from(step), 1);
        }
        assert!(breaks.bins.len() <= BINS);
        let [all, late] = breaks.all_and_since(0.9);
        assert_eq!(all, 1003);
        let width = (1000.0 * breaks.bin_s).ceil() as u32;
        assert!((101..=101 + width).contains(&late), "{late} {width}");
        assert_eq!(breaks.all_and_since(0.0), [1003, 1003]);
        assert_eq!(breaks.all_and_since(2.0), [1003, 0]);
    }

    /// Of 4449 bonds 5 in the last twentieth of a run are its last chips, 20 are not, nor is one of
    /// a hundred.
    #[test]
    fn a_few_late_chips_are_no_breakage() {
        let goes_on = |early: usize, late: usize| {
            let mut breaks = Breaks::default();
            breaks.note(0.1, early);
            if late > 0 {
                breaks.note(0.97, late);
            }
            breaks.go_on(0.05, 1.0)
        };
        assert!(!goes_on(4444, 5));
        assert!(goes_on(4429, 20));
        assert!(goes_on(99, 1));
        assert!(!goes_on(100, 0));
    }
}
