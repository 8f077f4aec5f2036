//! Mean and scatter.

use serde::{Deserialize, Serialize};

use crate::fit::mean;

/// Mean and scatter of a number over specimens.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Statistic {
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation of single specimens (n - 1); 0 for one.
    pub standard_deviation: f64,
    /// Number of specimens.
    pub count: usize,
}

impl Statistic {
    /// Of values; at least one.
    pub fn of(values: &[f64]) -> Self {
        let mean = mean(values);
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let count = values.len();
        let standard_deviation = (squares / (count as f64 - 1.0).max(1.0)).sqrt();
        Self {
            mean,
            standard_deviation,
            count,
        }
    }
}
