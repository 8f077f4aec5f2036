//! Confidence intervals of means.

use crate::statistic::Statistic;
use crate::student::student_95;

/// Half the width of the 95 % confidence interval of a mean, in its unit. None for a single value.
pub fn half_width(statistic: &Statistic) -> Option<f64> {
    let count = statistic.count;
    (count > 1)
        .then(|| student_95(count - 1) * statistic.standard_deviation / (count as f64).sqrt())
}
