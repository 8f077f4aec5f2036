//! Specimens that differ from the others of their series.

use crate::statistic::Statistic;

/// Critical values of the test of Grubbs for 3 to 20 specimens, two-sided, at 5 % (Grubbs and Beck
/// 1972).
const GRUBBS: [f64; 18] = [
    1.1543, 1.4812, 1.7150, 1.8871, 2.0200, 2.1266, 2.2150, 2.2900, 2.3547, 2.4116, 2.4620, 2.5073,
    2.5483, 2.5857, 2.6200, 2.6516, 2.6809, 2.7082,
];
/// Smallest deviation from the mean of the others at which the test of Grubbs is of interest.
const SMALL: f64 = 0.1;
/// Deviation from the mean of the others that is named whatever the test says, if it is this many
/// of their standard deviations: with three specimens the test finds hardly anything.
const LARGE: f64 = 0.25;
const MANY: f64 = 4.0;

/// What makes one of several values, of one quantity, an outlier: a sentence. None: nothing does.
pub(crate) fn outlier(values: &[f64], at: usize, what: &str) -> Option<String> {
    let mut others = values.to_vec();
    let value = others.remove(at);
    if others.is_empty() {
        return None;
    }
    let other = Statistic::of(&others);
    let deviation = (value - other.mean) / other.mean;
    let percent = 100.0 * deviation.abs();
    let way = if deviation < 0.0 { "below" } else { "above" };
    if let [only] = others[..] {
        let apart = (value - only).abs() / value.max(only);
        return (apart > LARGE).then(|| {
            format!(
                "its {what} is {percent:.0} % {way} that of the other specimen: two do not show which is usual"
            )
        });
    }
    let all = Statistic::of(values);
    let grubbs = (value - all.mean).abs() / all.standard_deviation;
    let is_found = deviation.abs() > SMALL && grubbs > critical(values.len());
    let is_far =
        deviation.abs() > LARGE && (value - other.mean).abs() > MANY * other.standard_deviation;
    (is_found || is_far).then(|| {
        format!(
            "its {what} is {percent:.0} % {way} the mean of the others, an outlier, and counts: leave its file out if the test was not valid"
        )
    })
}

/// Critical value of the test of Grubbs for a number of specimens from 3 on.
fn critical(count: usize) -> f64 {
    let last = GRUBBS[GRUBBS.len() - 1];
    let more = || last + 0.5 * (count as f64 / 20.0).ln();
    GRUBBS.get(count - 3).copied().unwrap_or_else(more)
}
