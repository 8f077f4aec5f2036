//! Settings of a run.

use std::fmt;
use std::sync::atomic::AtomicBool;

use dem_io::units::significant;
use dem_results::ResultsFolder;

use super::snapshot::Snapshot;
use dem_rig::setup::Setup;
use dem_rig::watch::TestSettings;

/// Settings of a run.
#[derive(Debug)]
pub struct RunSettings<'a> {
    /// Folder of results. None: no results are written.
    pub folder: Option<&'a ResultsFolder>,
    /// Checkpoint to resume from. None: from the start.
    pub resume: Option<Snapshot<'static>>,
    /// Number of threads, as given in the summary.
    pub threads: usize,
    /// Set to stop the run.
    pub interrupted: &'a AtomicBool,
    /// Settings of the scene's laboratory test, for which it has been arranged. None: it is not
    /// evaluated.
    pub test: Option<TestSettings>,
    /// The test in its initial arrangement, from the plan. None: the scene has none, or it is not
    /// evaluated.
    pub setup: Option<Setup>,
}

/// How far a run has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoFar {
    /// Fraction of the end time, or of the load of a static equilibrium, in 0..1.
    pub fraction: f64,
    /// Simulated time, s.
    pub time_s: f64,
    /// Bonds broken since the start.
    pub broken_bonds: u64,
}

/// As in `12.5 ms simulated, 34 bonds broken`.
impl fmt::Display for SoFar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (factor, unit) = match self.time_s {
            short if short < 1e-3 => (1e6, "us"),
            short if short < 1.0 => (1e3, "ms"),
            _ => (1.0, "s"),
        };
        let time = significant(factor * self.time_s, 3);
        let broken = self.broken_bonds;
        write!(f, "{time} {unit} simulated, {broken} bonds broken")
    }
}
