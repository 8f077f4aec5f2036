//! The limit of the time step during a run: it falls as bonds stretch, contact forces rise, and
//! particles become fast.

use dem_io::{Diagnostic, Result};
use dem_scene::Scene;

use super::new_step::{NewStep, change, look_anew_for_near};
use super::progress::Progress;
use dem_engine::check::limit::{Bound, bound_near, damping_bound_1_s, limit};
use dem_engine::check::linearised_contacts::{
    StiffestContacts, contact_rates, largest_contact_rate_1_s2,
};
use dem_engine::stages::bonds::damping::WEAK;
use dem_engine::stages::bonds::forces::largest_strain;
use dem_engine::stages::ledger::totals::kinetic_energy;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::bodies::called;
use dem_engine::state::particles::Pose;
use dem_plan::time_step::{FARTHEST, StepBasis, StepChoice, arriving, impact_step_s};

/// Interval between checks of the bond strains, in steps.
const STRAIN_EVERY: u64 = 64;
/// The limit is computed again when the largest strain has grown by this: a longer bond has longer
/// levers and a higher transverse stiffness.
const MORE_STRAIN: f64 = 0.02;
/// Interval between checks of the contacts, in steps: a collision takes longer. All other intervals
/// are multiples of it.
pub(super) const CHECK_EVERY_STEPS: u64 = 8;
/// The limit is computed again when the stiffest contact has become stiffer by this factor.
const STIFFER: f64 = 1.2;
/// The step is checked again when the mass-averaged speed of bodies exceeds the impact speed that
/// the step allows for by this factor.
const FASTER: f64 = 1.2;

/// An adaptive step is checked again after this many steps for each iteration of the last check, so
/// that checks take less than a hundredth of the time; and after this many steps at least.
const STEPS_PER_ITERATION: u64 = 256;
const LOOK_EVERY: u64 = 512;
/// Smallest factor by which it is increased: a step that changes all the time conserves energy less
/// well.
const LARGER: f64 = 1.2;
/// Smallest factor by which it is reduced if only impacts require it.
const SMALLER: f64 = 1.05;

/// Limits on the time step of a run.
#[derive(Debug)]
pub(super) struct Limits<'a> {
    smallest_radius_m: f64,
    /// Largest radius, m, and largest inverse mass, 1/kg; none if bodies may be added or clumps
    /// become clusters.
    extremes: Option<[f64; 2]>,
    /// None: the step is given by the scene, and kept.
    safety: Option<f64>,
    impact_accuracy: f64,
    end_s: f64,
    /// None: the step only decreases.
    adaptive: Option<Adaptive<'a>>,
    /// New steps of the last step.
    pub(super) new_steps: Vec<NewStep>,
}

/// Basis of an adaptive step.
#[derive(Debug)]
struct Adaptive<'a> {
    scene: &'a Scene,
    arriving: Option<State>,
    /// Requirements once clumps have become clusters.
    replaced: StepBasis,
}

/// Raises the bound of damping, since bonds have become longer. Where damping is not weak by its
/// bound, finds how fast it is in whole bodies, which saves passes over the bonds.
fn renew_damping(state: &mut State) {
    let [before_1_s, most_1_s] = [state.damping_rate_1_s, state.most_damping_rate_1_s];
    state.renew_damping_rate();
    if state.time_step_s * state.damping_rate_1_s <= WEAK {
        return;
    }
    let largest_1_s = damping_bound_1_s(state).max(before_1_s);
    state.damping_rate_1_s = state.damping_rate_1_s.min(largest_1_s);
    // It counts what is asleep or still to come, if it is known.
    if most_1_s.is_finite() {
        state.most_damping_rate_1_s = most_1_s.max(largest_1_s);
    }
}

impl<'a> Limits<'a> {
    pub(super) fn of(scene: &'a Scene, state: &State, choice: &StepChoice) -> Self {
        Self {
            smallest_radius_m: state.smallest_radius_m(),
            extremes: extremes(state),
            safety: scene
                .run
                .time_step_s
                .is_none()
                .then_some(scene.run.safety_factor),
            impact_accuracy: scene.run.impact_accuracy,
            end_s: scene.run.end_time_s,
            adaptive: scene.run.adaptive.then(|| Adaptive {
                scene,
                arriving: arriving(state),
                replaced: choice.replaced,
            }),
            new_steps: Vec::new(),
        }
    }

    /// Checks after a step whether the limit has fallen, and reduces the step if it has; increases
    /// an adaptive step if possible. `replaced`: clumps have just become clusters. Refuses a step
    /// set by the scene in which a particle moves so far that contacts would miss it.
    pub(super) fn follow(
        &mut self,
        state: &mut State,
        replaced: bool,
        progress: &mut Progress,
        bodies: &[PlacedBody],
    ) -> Result<()> {
        self.follow_adaptive(state, replaced, progress);
        let mut may_be_less = false;
        if state.steps.is_multiple_of(STRAIN_EVERY) {
            let strain = progress.monitors.look_at_bonds(state, bodies);
            if strain > progress.strain + MORE_STRAIN {
                progress.strain = strain;
                renew_damping(state);
                may_be_less = true;
            }
        }
        let touches = state.contacts.is_some();
        let look_at_contacts = touches && state.steps.is_multiple_of(CHECK_EVERY_STEPS);
        if look_at_contacts {
            let above_1_s2 = STIFFER * progress.contact_rate_1_s2;
            let matters = StiffestContacts {
                above_1_s2,
                extremes: self.extremes,
            };
            let rate = largest_contact_rate_1_s2(state, matters);
            if rate > above_1_s2 {
                progress.contact_rate_1_s2 = rate;
                may_be_less = true;
            }
        }
        // Usually the step is still small enough: the last result shows it at once, a bound near
        // the step in a fraction of the time that the limit itself takes.
        let needed_s = state.time_step_s / self.safety.unwrap_or(1.0);
        let rates = may_be_less.then(|| contact_rates(state));
        if let Some(rates) = rates
            && needed_s > bound_s(rates, progress)
        {
            let mut bound = bound_near(state, needed_s);
            if bound.step_s < needed_s {
                bound = limit(state).bound();
                progress.limit_s = progress.limit_s.min(bound.step_s);
            }
            progress.bound = bound;
            progress.bound_strain = progress.strain;
            progress.bound_rates = rates;
            if let Some(safety) = self.safety {
                let largest_s = safety * progress.limit_s;
                self.take(state, largest_s, "limit", progress);
            }
        }
        if let (true, Some(safety)) = (look_at_contacts, self.safety) {
            // Loads or supports may have made bodies faster than predicted. Not the fastest
            // particle: when a bond breaks, a few particles snap back.
            let p = &state.particles;
            let kinetic_j = kinetic_energy(p, |i| p.motions[i]) + state.clumps.kinetic_j();
            let speed_m_s = (2.0 * kinetic_j / state.ledger.mass_kg()).sqrt();
            if speed_m_s > FASTER * progress.impact_speed_m_s {
                progress.impact_speed_m_s = speed_m_s;
                let largest_s = impact_step_s(state, speed_m_s, safety, self.impact_accuracy);
                progress.plain.allow_for(speed_m_s, largest_s, FASTER);
                self.take(
                    state,
                    largest_s.max(progress.plain.step_s),
                    "speed",
                    progress,
                );
            }
        }
        let farthest_m = FARTHEST * self.smallest_radius_m;
        if touches && state.fastest_m_s * state.time_step_s > farthest_m {
            let Some(safety) = self.safety else {
                return too_fast(state, bodies);
            };
            let largest_s = safety * farthest_m / state.fastest_m_s;
            self.take(state, largest_s, "speed", progress);
        }
        Ok(())
    }

    /// Chooses an adaptive step again once clumps have become clusters, at intervals, and once
    /// there are no bonds left.
    fn follow_adaptive(&mut self, state: &mut State, replaced: bool, progress: &mut Progress) {
        let Some(adaptive) = &mut self.adaptive else {
            return;
        };
        let has_lost_all_bonds = progress.had_bonds && state.bonds.is_empty();
        if replaced {
            let basis = adaptive.replaced;
            progress.allow_as_well_for(&basis);
            progress.had_bonds = true;
            self.take(state, basis.step_s, "replacement", progress);
        } else if state.steps >= progress.next_check || has_lost_all_bonds {
            let basis = StepBasis::of(adaptive.scene, state, adaptive.arriving.as_mut());
            let iterations = basis.limit.all_iterations as u64;
            let pause = LOOK_EVERY.max(STEPS_PER_ITERATION * iterations);
            progress.next_check = (state.steps + pause).next_multiple_of(CHECK_EVERY_STEPS);
            progress.had_bonds = !state.bonds.is_empty();
            progress.allow_for(&basis);
            progress.bound_strain = largest_strain(&state.bonds, &state.particles.poses);
            progress.strain = progress.bound_strain;
            let safety = adaptive.scene.run.safety_factor;
            let step_s = basis.step_s_beside(progress.plain.step_s, safety);
            let is_larger = step_s >= LARGER * state.time_step_s;
            let is_unstable = state.time_step_s > safety * basis.foreseen_s;
            if is_larger || is_unstable || state.time_step_s > SMALLER * step_s {
                let limited_by = match step_s > basis.step_s {
                    true => "the step without adaptive",
                    false => basis.limited_by[0].reason,
                };
                self.set(state, step_s, ("adaptive", Some(limited_by)), progress);
            }
        }
    }

    /// Reduces the step to this one, if the present one is larger, and records it.
    fn take(
        &mut self,
        state: &mut State,
        largest_s: f64,
        cause: &'static str,
        progress: &mut Progress,
    ) {
        progress.plain.step_s = progress.plain.step_s.min(largest_s);
        if state.time_step_s > largest_s {
            self.set(state, largest_s, (cause, None), progress);
        }
    }

    /// Sets this step, or one slightly smaller, and records it with its cause and what limits it.
    fn set(
        &mut self,
        state: &mut State,
        largest_s: f64,
        (cause, limited_by): (&'static str, Option<&str>),
        progress: &mut Progress,
    ) {
        // So that the end time is met.
        let left_s = self.end_s - state.time_s;
        let step_s = if left_s > 0.0 {
            left_s / (left_s / largest_s).ceil()
        } else {
            largest_s
        };
        let mut detail = change(state.time_step_s, step_s);
        if let Some(limited_by) = limited_by {
            detail += &format!(", limited by {limited_by}");
        }
        if step_s > state.time_step_s {
            look_anew_for_near(state);
        }
        state.time_step_s = step_s;
        progress.note_step(step_s);
        self.new_steps.push(NewStep { cause, detail });
    }
}

/// See [`Limits::extremes`].
fn extremes(state: &State) -> Option<[f64; 2]> {
    if !state.clumps.templates.is_empty() {
        return None;
    }
    let p = &state.particles;
    let radii = p.poses.iter().map(Pose::radius_m);
    let inverse_masses = p.motions.iter().map(|motion| motion.inverse_mass);
    Some([
        radii.fold(0.0, f64::max),
        inverse_masses.fold(0.0, f64::max),
    ])
}

/// A stable step from the last result, s, for bonds that have become longer since and contacts with
/// these [rates](contact_rates). The larger of two bounds: one adds all present contacts, which is
/// always safe; the other assumes that all bonds and contacts have become stiffer by the factor of
/// the stiffest particle's contacts, by their sum.
fn bound_s(rates: [f64; 2], progress: &Progress) -> f64 {
    // Transverse stiffness of a bond grows with the square of its levers.
    let longer = (1.0 + progress.strain) / (1.0 + progress.bound_strain);
    let of_bonds = Bound {
        step_s: progress.bound.step_s / (longer * longer),
        ..progress.bound
    };
    let with_all_s = of_bonds.with_more(rates);
    let stiffer = |n: usize| {
        if rates[n] <= progress.bound_rates[n] {
            1.0
        } else {
            rates[n] / progress.bound_rates[n]
        }
    };
    let all_stiffer_s = of_bonds.step_s / stiffer(0).max(stiffer(1)).sqrt();
    with_all_s.max(all_stiffer_s)
}

/// Stops a run in which a particle moves farther in a step than contacts can resolve.
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

/// The diagnostic that stops a run: a particle has gone through a wall, or two overlap so deeply
/// that they would pass through each other.
pub(super) fn tunnelling(
    state: &State,
    scene: &Scene,
    bodies: &[PlacedBody],
) -> Option<Diagnostic> {
    if let Some(pair) = state
        .contacts
        .as_ref()
        .and_then(|c| c.scratch.excessive_overlap)
    {
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
        .find_map(|(n, wall)| wall.scratch.crossed.map(|particle| (n, particle)))?;
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
