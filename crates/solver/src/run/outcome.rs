//! How a run ended.

use dem_io::Diagnostic;

use crate::output::summary::Summary;

/// How a run ended.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// What came of it, as far as it went.
    pub summary: Summary,
    /// Why it did not come to its end. None: it did.
    pub problem: Option<Diagnostic>,
}
