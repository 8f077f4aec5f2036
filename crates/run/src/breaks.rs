//! Broken bonds over the time of a run.

use serde::{Deserialize, Serialize};

/// Number of bins; their width doubles when they are full.
const BINS: usize = 64;

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
}
