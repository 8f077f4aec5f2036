//! A run: steps a plan to its end, monitors it, measures and writes results.

mod begin;
mod breaks;
mod changes;
mod doubts;
mod end;
pub mod last_files;
mod last_tenth;
mod limits;
pub(crate) mod machine;
mod monitors;
mod new_step;
mod nothing_happened;
mod observe;
mod outcome;
pub mod outputs;
pub mod pictures;
mod progress;
mod rigid_hits;
mod schedule;
mod settings;
pub mod snapshot;
pub mod statics;
mod sums;
mod taken_in;
mod wall_patches;

use dem_io::Result;
use dem_scene::{Integrator, Scene};

use dem_engine::step::{advance, interact};
use dem_plan::Plan;
use dem_results::Summary;

use self::begin::Run;
pub use self::last_files::{Finished, finish};
pub use self::observe::INTERRUPTION;
pub use self::outcome::Outcome;
pub use self::progress::Progress;
pub use self::settings::{RunSettings, SoFar};

/// Steps a plan to its end, or solves for its static equilibrium, as the scene says. `tell` is
/// called from time to time with how far it has come.
///
/// # Errors
/// The run goes unstable (exit code 3), is interrupted (130), or cannot write its files (1).
pub fn run(
    plan: Plan,
    scene: &Scene,
    settings: RunSettings<'_>,
    tell: &dyn Fn(&SoFar),
) -> Result<Summary> {
    let outcome = run_as_far_as_it_goes(plan, scene, settings, tell)?;
    outcome.problem.map_or(Ok(outcome.summary), Err)
}

/// As [`run`], but a run that goes unstable or is interrupted has a summary too, also in its
/// folder.
pub fn run_as_far_as_it_goes(
    plan: Plan,
    scene: &Scene,
    settings: RunSettings<'_>,
    tell: &dyn Fn(&SoFar),
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
