//! The limit of the time step while a run goes on: it falls as bonds stretch, as contacts are pressed, as particles become fast.

use dem_io::scene::Scene;
use dem_io::{Diagnostic, Result};

use super::Files;
use super::events::{change, new_step};
use super::progress::Progress;
use crate::check::ledger::kinetic_energy;
use crate::check::limit::limit;
use crate::check::linear::largest_contact_rate_1_s2;
use crate::plan::bodies::{PlacedBody, called};
use crate::plan::time_step::{FARTHEST, impact_step_s};
use crate::stages::bonds::largest_strain;
use crate::state::State;

/// Steps between two looks at the strains of the bonds.
const STRAIN_EVERY: u64 = 64;
/// The limit of the step is looked for again when the largest strain has grown by this since: a bond that is longer has longer levers and is
/// stiffer across.
const MORE_STRAIN: f64 = 0.02;
/// Steps between two looks at the contacts: a collision takes more.
const CONTACTS_EVERY: u64 = 8;
/// The limit is looked for again when the stiffest contact has become stiffer by this factor since.
const STIFFER: f64 = 1.2;
/// The step is looked at again when bodies are faster by this factor, on the mean of their mass, than the impacts that it allows for.
const FASTER: f64 = 1.2;

/// What the step of a run has to keep to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    smallest_radius_m: f64,
    /// None: the scene names a step, which is kept.
    safety: Option<f64>,
    end_s: f64,
}

impl Limits {
    pub(super) fn of(scene: &Scene, state: &State) -> Self {
        Self {
            smallest_radius_m: state.smallest_radius_m(),
            safety: scene.run.time_step_s.is_none().then_some(scene.run.safety),
            end_s: scene.run.end_time_s,
        }
    }

    /// Looks whether the limit has fallen, after a step, and takes a smaller step if it has.
    ///
    /// # Errors
    /// A particle moves so far in a step that contacts would miss it, and the scene names the step; those of the files.
    pub(super) fn follow(
        &self,
        state: &mut State,
        progress: &mut Progress,
        bodies: &[PlacedBody],
        mut files: Option<&mut Files<'_>>,
    ) -> Result<()> {
        let mut look = false;
        if state.steps.is_multiple_of(STRAIN_EVERY) {
            let strain = largest_strain(&state.bonds, &state.particles.poses);
            if strain > progress.limit_strain + MORE_STRAIN {
                progress.limit_strain = strain;
                look = true;
            }
        }
        let touches = state.contacts.is_some();
        let look_at_contacts = touches && state.steps.is_multiple_of(CONTACTS_EVERY);
        if look_at_contacts {
            let rate = largest_contact_rate_1_s2(state);
            if rate > STIFFER * progress.contact_rate_1_s2 {
                progress.contact_rate_1_s2 = rate;
                look = true;
            }
        }
        if look {
            progress.limit_s = progress.limit_s.min(limit(state).step_s);
            if let Some(safety) = self.safety {
                let largest_s = safety * progress.limit_s;
                self.take(state, largest_s, "limit", files.as_deref_mut())?;
            }
        }
        if let (true, Some(_)) = (look_at_contacts, self.safety) {
            // Loads or supports may have made bodies faster than was foreseen. Not the fastest particle: a bond that breaks lets a few snap back.
            let p = &state.particles;
            let kinetic_j = kinetic_energy(p, |i| p.motions[i]) + state.clumps.kinetic_j();
            let speed_m_s = (2.0 * kinetic_j / state.ledger.mass_kg()).sqrt();
            if speed_m_s > FASTER * progress.impact_speed_m_s {
                progress.impact_speed_m_s = speed_m_s;
                let largest_s = impact_step_s(state, speed_m_s);
                self.take(state, largest_s, "speed", files.as_deref_mut())?;
            }
        }
        let farthest_m = FARTHEST * self.smallest_radius_m;
        if touches && state.fastest_m_s * state.time_step_s > farthest_m {
            let Some(safety) = self.safety else {
                return too_fast(state, bodies);
            };
            let largest_s = safety * farthest_m / state.fastest_m_s;
            self.take(state, largest_s, "speed", files)?;
        }
        Ok(())
    }

    /// Takes a step that is no larger than this, if the present one is, and notes it.
    fn take(
        &self,
        state: &mut State,
        largest_s: f64,
        cause: &str,
        files: Option<&mut Files<'_>>,
    ) -> Result<()> {
        if state.time_step_s <= largest_s {
            return Ok(());
        }
        // So that the end time is met.
        let left_s = self.end_s - state.time_s;
        let step_s = if left_s > 0.0 {
            left_s / (left_s / largest_s).ceil()
        } else {
            largest_s
        };
        let detail = change(state.time_step_s, step_s);
        state.time_step_s = step_s;
        match files {
            Some(files) => files.events.append(&[new_step(state, cause, &detail)]),
            None => Ok(()),
        }
    }
}

/// Stops a run in which a particle moves farther in a step than contacts can follow.
fn too_fast(state: &State, bodies: &[PlacedBody]) -> Result<()> {
    let p = &state.particles;
    let moved_m = |i: usize| {
        let [x, y, z] = p.motions[i].velocity_m_s;
        state.time_step_s * (x * x + y * y + z * z).sqrt()
    };
    let found = (0..p.len()).find(|&i| moved_m(i) > FARTHEST * p.poses[i].radius_m());
    let Some(i) = found else {
        return Ok(());
    };
    Err(Diagnostic::unstable(
        "",
        format!(
            "at {:.6e} s {} moves by {:.3e} m in a step, more than {FARTHEST} of its radius of {:.3e} m: contacts would miss it",
            state.time_s,
            called(bodies, &state.clumps, i as u32),
            moved_m(i),
            p.poses[i].radius_m()
        ),
        "take a smaller run.time_step, or \"auto\"",
    ))
}

/// A particle that has gone through a wall, or two that are pressed into each other so far that they would go through each other, as a reason to stop.
pub(super) fn went_through(
    state: &State,
    scene: &Scene,
    bodies: &[PlacedBody],
) -> Option<Diagnostic> {
    if let Some(pair) = state.contacts.as_ref().and_then(|c| c.swallowed) {
        let [a, b] = pair.map(|particle| called(bodies, &state.clumps, particle));
        let radii = pair.map(|particle| state.particles.poses[particle as usize].radius_m());
        return Some(Diagnostic::unstable(
            "",
            format!(
                "at {:.6e} s {a} and {b} are pressed into each other by more than the radius of the smaller, {:.3e} m",
                state.time_s,
                radii[0].min(radii[1])
            ),
            "make their contact stiffer, push less hard, or take a smaller run.time_step",
        ));
    }
    let (n, particle) = (state.walls.iter().enumerate())
        .find_map(|(n, wall)| wall.crossed.map(|particle| (n, particle)))?;
    Some(Diagnostic::unstable(
        "",
        format!(
            "at {:.6e} s the centre of {} has gone through the wall '{}'",
            state.time_s,
            called(bodies, &state.clumps, particle),
            scene.walls.keys().nth(n).map_or("", String::as_str),
        ),
        "make its contact stiffer, push less hard, or take a smaller run.time_step",
    ))
}
