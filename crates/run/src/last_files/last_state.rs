//! The end of a run, for its last files.

use dem_engine::state::State;
use dem_plan::measure::Probe;
use dem_plan::measure::sizes::Fragments;
use dem_results::ResultsFolder;
use dem_scene::Scene;

/// The state in which a run has ended.
pub(crate) struct LastState<'a> {
    pub(crate) folder: &'a ResultsFolder,
    pub(crate) scene: &'a Scene,
    pub(crate) state: &'a State,
    /// None: bodies do not break.
    pub(crate) fragments: Option<Fragments>,
    pub(crate) end_s: f64,
    pub(crate) probes: &'a [Probe],
}
