//! How a run is told to go.

use std::sync::atomic::AtomicBool;

use dem_results::ResultsFolder;

use super::snapshot::Snapshot;
use crate::laboratory::watch::TestSettings;

/// How a run is told to go.
#[derive(Debug)]
pub struct RunSettings<'a> {
    /// Where results go. None: nowhere.
    pub folder: Option<&'a ResultsFolder>,
    /// Where to go on from. None: from the start.
    pub resume: Option<Snapshot<'static>>,
    /// Threads, as said in the summary.
    pub threads: usize,
    /// Set when the run is to stop.
    pub interrupted: &'a AtomicBool,
    /// What is known of the scene's laboratory test, for which it has been arranged. None: it is
    /// not evaluated.
    pub test: Option<TestSettings>,
}
