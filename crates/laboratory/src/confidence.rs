//! Confidence intervals of means.

use crate::statistic::Statistic;

/// 97.5 % quantiles of Student's t distribution for 1 to 30 degrees of freedom.
const STUDENT: [f64; 30] = [
    12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060, 2.2622, 2.2281, 2.2010,
    2.1788, 2.1604, 2.1448, 2.1314, 2.1199, 2.1098, 2.1009, 2.0930, 2.0860, 2.0796, 2.0739, 2.0687,
    2.0639, 2.0595, 2.0555, 2.0518, 2.0484, 2.0452, 2.0423,
];
/// 97.5 % quantile of the normal distribution.
const NORMAL: f64 = 1.959_964;

/// The 97.5 % quantile of Student's t distribution for `degrees` of freedom, at least 1. Above 30
/// by the first two terms of its expansion around the normal distribution, to 1e-5.
pub fn student_95(degrees: usize) -> f64 {
    match STUDENT.get(degrees.saturating_sub(1)) {
        Some(value) => *value,
        None => {
            let (z, nu) = (NORMAL, degrees as f64);
            let second = 5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z;
            z + (z.powi(3) + z) / (4.0 * nu) + second / (96.0 * nu * nu)
        }
    }
}

/// Half the width of the 95 % confidence interval of a mean, in its unit. None for a single value.
pub fn half_width(statistic: &Statistic) -> Option<f64> {
    let count = statistic.count;
    (count > 1)
        .then(|| student_95(count - 1) * statistic.standard_deviation / (count as f64).sqrt())
}
