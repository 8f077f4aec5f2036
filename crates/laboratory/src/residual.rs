//! The stress that is left behind the peak, by one rule for measured and for simulated curves.

/// Share of the travel at its end over which the residual force is averaged.
const LAST: f64 = 0.1;
/// The force has passed its peak if it ends below this fraction of it.
const PASSED: f64 = 0.95;

/// Mean force over the last tenth of the travel, N, of rows of travel, m, and force, N. None: no
/// rows.
pub fn residual_n(travel_m: &[f64], force_n: &[f64]) -> Option<f64> {
    let end_m = *travel_m.last()?;
    let from = travel_m.partition_point(|travel| *travel < (1.0 - LAST) * end_m);
    let loads = force_n[from..].iter();
    Some(loads.sum::<f64>() / (force_n.len() - from) as f64)
}

/// Whether a force that ends with this residual has passed its largest value, N.
pub fn has_passed_its_peak(residual_n: f64, largest_n: f64) -> bool {
    residual_n < PASSED * largest_n
}
