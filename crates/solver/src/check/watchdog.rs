//! Stops a run that goes unstable.

use crate::check::ledger::Balance;

/// Largest energy error over energy that a stable run can show when its step is this share of the limit.
///
/// Leapfrog keeps an energy close to the true one; for the fastest mode the two differ by a factor of up to 1/(1 - share^2). Twice that is allowed.
pub fn allowed_energy_error(share_of_limit: f64) -> f64 {
    if share_of_limit < 1.0 {
        2.0 / (1.0 - share_of_limit * share_of_limit)
    } else {
        1.0
    }
}

/// Whether a run has gone unstable: its energy is no number, or more than `allowed` times what was put in has appeared.
pub fn is_unstable(balance: &Balance, put_in_j: f64, allowed: f64) -> bool {
    !balance.energy_error_j.is_finite() || balance.energy_error_j > allowed * put_in_j
}
