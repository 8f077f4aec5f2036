//! The median.

/// Of ascending values; of an even number the mean of the middle two. None: there are none.
pub(crate) fn median(rising: &[f64]) -> Option<f64> {
    let middle = rising.len() / 2;
    match rising.len() {
        0 => None,
        even if even % 2 == 0 => Some(f64::midpoint(rising[middle - 1], rising[middle])),
        _ => Some(rising[middle]),
    }
}
