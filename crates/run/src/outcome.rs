//! Outcome of a run.

use dem_io::Diagnostic;

use dem_results::Summary;

/// Outcome of a run.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Its results, as far as it went.
    pub summary: Summary,
    /// Reason why it did not reach its end. None: it did.
    pub problem: Option<Diagnostic>,
}
