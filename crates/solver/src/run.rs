//! A run: a plan is stepped to its end, watched, measured and written down.

mod begin;
mod end;
mod events;
mod files;
mod finish;
mod fragments;
mod limits;
mod observe;
mod pictures;
mod progress;
mod seen;

use std::sync::atomic::AtomicBool;

use dem_io::results::ResultsFolder;
use dem_io::scene::{Integrator, Scene};
use dem_io::{Diagnostic, Result};

use crate::laboratory::watch::TestSettings;
use crate::output::summary::Summary;
use crate::plan::Plan;
use crate::snapshot::Snapshot;
use crate::step::{advance, interact};

use self::begin::Run;
pub use self::finish::{Finished, finish};
pub use self::progress::Progress;

/// How a run is told to go.
#[derive(Debug)]
pub struct RunSettings<'a> {
    /// Where results go. None: nowhere.
    pub folder: Option<&'a ResultsFolder>,
    /// Where to go on from. None: from the start.
    pub resume: Option<Snapshot>,
    /// Threads, as said in the summary.
    pub threads: usize,
    /// Set when the run is to stop.
    pub interrupted: &'a AtomicBool,
    /// What is known of the scene's laboratory test, for which it has been arranged. None: it is
    /// not evaluated.
    pub test: Option<TestSettings>,
}

/// How a run ended.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// What came of it, as far as it went.
    pub summary: Summary,
    /// Why it did not come to its end. None: it did.
    pub problem: Option<Diagnostic>,
}

/// Steps a plan to its end, or brings it into its equilibrium at once, as the scene says. `tell` is
/// called now and then with the fraction of the end time reached, in 0..1.
///
/// # Errors
/// The run goes unstable (exit code 3), is interrupted (130), or its files cannot be written (1).
pub fn run(
    plan: Plan,
    scene: &Scene,
    settings: RunSettings<'_>,
    tell: &dyn Fn(f64),
) -> Result<Summary> {
    let outcome = run_as_far_as_it_goes(plan, scene, settings, tell)?;
    outcome.problem.map_or(Ok(outcome.summary), Err)
}

/// The same. A run that goes unstable or is interrupted has a summary as well, in its folder too.
///
/// # Errors
/// Its files cannot be written, or there is no equilibrium to go to.
pub fn run_as_far_as_it_goes(
    plan: Plan,
    scene: &Scene,
    settings: RunSettings<'_>,
    tell: &dyn Fn(f64),
) -> Result<Outcome> {
    if scene.run.integrator == Integrator::Static {
        let summary = crate::statics::run(plan, scene, &settings, tell)?;
        return Ok(Outcome {
            summary,
            problem: None,
        });
    }
    let mut run = Run::begin(plan, scene, settings)?;
    let ended = loop {
        interact(&mut run.state);
        if let Some(ended) = run.observe(tell)? {
            break ended;
        }
        advance(&mut run.state);
        if let Some(ended) = run.follow()? {
            break ended;
        }
    };
    run.end(ended)
}
