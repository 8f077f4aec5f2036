//! Reasons to doubt the result of a run: bodies that nothing touched, laws used beyond their range
//! of validity, breakage that is not over.

pub(super) mod past_outlets;
mod still_flying;

use std::collections::BTreeSet;

use dem_io::units::{show_length, significant};
use dem_scene::{Scene, StartAs};
use nalgebra::Vector3;

use self::still_flying::{Flying, QUIET, still_flying};
use super::monitors::{Extreme, Monitors, stand_n};
use super::taken_in::needed_j_kg;
use dem_engine::check::flight::{FreeBody, Meeting, can_meet, free_bodies, standing_bodies};
use dem_engine::check::validity::{indentation_warning, plastic_strain_warning, strain_warning};
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::clusters::fragments::Fragment;
use dem_engine::state::rules::Outlet;
use dem_engine::state::walls::Wall;

/// Fraction of the run at its end in which breaking bonds show that breakage is not over.
const LATE: f64 = 0.05;
/// Share of all broken bonds that broke in that part of a run that inlets feed above which it ends
/// in the middle of an impact, and number of broken bonds below which nothing is said of it.
const BURST: f64 = 0.2;
const FEW_BREAKS: u32 = 100;
/// Force of standing walls at the end of a run, over the largest in the run and over the weight of
/// all that moves, from which an impact goes on.
const UNDER_IMPACT: [f64; 2] = [0.2, 3.0];
/// Number of bodies that a warning names; the others are counted.
const NAMED: usize = 3;

impl Monitors {
    /// Reasons to doubt the result at the end of a run, a sentence each.
    pub(super) fn warnings(
        &self,
        state: &State,
        scene: &Scene,
        bodies: &[PlacedBody],
        flying: Option<&Flying>,
        is_stopped: bool,
    ) -> Vec<String> {
        if is_stopped {
            return beyond(self.extremes());
        }
        let mut warnings = self.beyond_the_laws();
        warnings.extend(self.untouched(state, scene, bodies));
        if scene.test.is_none() {
            warnings.extend(self.still_breaking(state, scene));
        }
        warnings.extend(self.all_fell_past(state));
        warnings.extend(
            flying
                .filter(|flying| flying.may_break)
                .map(|flying| flying.text.clone()),
        );
        warnings.extend(self.never_replaced(state, scene, bodies));
        warnings.extend(unused_rules(state));
        warnings
    }

    /// Clumps whose trigger never fired.
    fn never_replaced(&self, state: &State, scene: &Scene, bodies: &[PlacedBody]) -> Vec<String> {
        let mut warnings = Vec::new();
        for (name, rule) in &scene.replacement {
            let starts_rigid = scene.bodies[name].start_as != StartAs::Bonded;
            let was_there = is_present(state, bodies, name) || self.came.contains(name);
            if self.replaced.contains(name) || !starts_rigid || !was_there {
                continue;
            }
            if let Some(needed_j_kg) = needed_j_kg(state, name) {
                warnings.push(format!(
                    "no particle of '{name}' was replaced by daughters: none took in {} J/kg{}{}",
                    significant(needed_j_kg, 4),
                    discharged_before(state, name),
                    self.taken.instead_of_daughters(name)
                ));
                continue;
            }
            let when = &rule.when;
            let touched = (!when.touches.is_empty())
                .then(|| format!("it touches '{}'", when.touches.join("' or '")));
            let trigger = [
                touched,
                when.enters
                    .as_ref()
                    .map(|region| format!("it enters '{region}'")),
                when.force_n
                    .map(|force| format!("a force above {} N", significant(force, 4))),
                when.contact_force_n
                    .map(|force| format!("a contact force above {} N", significant(force, 4))),
                when.principal_stress_pa.map(|stress| {
                    format!("a principal stress above {} Pa", significant(stress, 4))
                }),
                when.impact_energy_j
                    .map(|energy| format!("an impact energy above {} J", significant(energy, 4))),
                when.time_s
                    .map(|time| format!("the time {} s", significant(time, 4))),
            ];
            let trigger: Vec<String> = trigger.into_iter().flatten().collect();
            let joined = trigger.join(if rule.requires_all { " and " } else { " or " });
            warnings.push(format!(
                "no clump of '{name}' was replaced: its trigger ({joined}) was not met, so it could not break{}{}",
                self.taken.instead_of_trigger(name),
                discharged_before(state, name)
            ));
        }
        warnings
    }

    /// Laws beyond their range: in a test whose answers are those at its largest load, up to there.
    fn beyond_the_laws(&self) -> Vec<String> {
        match &self.at_peak {
            Some((_, at_peak)) => beyond(at_peak.each_ref()),
            None => beyond(self.extremes()),
        }
    }

    /// Notes on laws beyond their range in the pieces of a test after its largest load.
    pub(super) fn beyond_after_the_peak(&self) -> Vec<String> {
        let Some((_, at_peak)) = &self.at_peak else {
            return Vec::new();
        };
        let [before, after] = [beyond(at_peak.each_ref()), beyond(self.extremes())];
        let later = after.into_iter().filter(|said| !before.contains(said));
        later
            .map(|said| {
                format!("after the largest load, so that the results of the test do not depend on it: {said}")
            })
            .collect()
    }

    /// Bodies that could have touched something but did not.
    fn untouched(&self, state: &State, scene: &Scene, bodies: &[PlacedBody]) -> Vec<String> {
        if !can_meet(state, scene) {
            return Vec::new();
        }
        // Between a kick and the drift after it.
        let mut flying = free_bodies(state, bodies, 0.5 * state.time_step_s);
        let free = flying.len();
        flying.extend(standing_bodies(state, bodies));
        let loaded = loaded(state, bodies);
        let mut warnings = Vec::new();
        let mut unnamed = 0;
        for name in scene
            .bodies
            .keys()
            .filter(|name| !self.touched.contains(*name))
        {
            let own = flying[..free].iter().find(|flyer| flyer.name == *name);
            let is_loaded = loaded.contains(name.as_str());
            let is_there = own.is_some() || is_loaded || !is_present(state, bodies, name);
            // A held body is not meant to touch anything; one that no inlet has fed did not exist.
            if !is_there || self.never_came(state, name) || scene.parent_of(name).is_some() {
                continue;
            }
            if warnings.len() == NAMED {
                unnamed += 1;
                continue;
            }
            warnings.push(match own {
                Some(flyer) => format!(
                    "nothing touched the body '{name}': {}",
                    outlook(flyer, state, &flying)
                ),
                None if is_loaded => format!(
                    "nothing touched the body '{name}', on which loads act and which no support holds; check its position, the direction of the loads, gravity and the walls"
                ),
                None => format!("nothing touched the body '{name}', which is gone by the end"),
            });
        }
        if unnamed > 0 {
            warnings.push(format!("nothing touched {unnamed} other bodies"));
        }
        warnings
    }

    /// Whether inlets could have fed a body but did not.
    fn never_came(&self, state: &State, name: &str) -> bool {
        let is_own = |(t, _): &(u32, f64)| state.clumps.templates[*t as usize].body == name;
        let mut inlets = state.model.rules.inlets.iter();
        !self.came.contains(name) && inlets.any(|inlet| inlet.templates.iter().any(is_own))
    }

    /// Warning that much of the breakage of a scene that inlets feed happened shortly before its
    /// end: it ends in the middle of an impact.
    fn ends_in_a_burst(&self, late_from_s: f64) -> Option<String> {
        let [all, late] = self.breaks.all_and_since(late_from_s);
        let share = f64::from(late) / f64::from(all);
        (all >= FEW_BREAKS && share > BURST).then(|| {
            format!(
                "{:.0} % of the broken bonds broke shortly before the end, from {} s on: the run ends in the middle of an impact; set run.end_time later, or end the inlet before it (inlets.NAME.count)",
                100.0 * share,
                significant(late_from_s, 3)
            )
        })
    }

    /// Warning that bonds broke until the end.
    fn still_breaking(&self, state: &State, scene: &Scene) -> Option<String> {
        let last_s = self.last_break_s?;
        let late_from_s = (1.0 - LATE) * state.time_s;
        if is_fed(state) {
            return self.ends_in_a_burst(late_from_s);
        }
        let goes_on = last_s >= late_from_s && self.breaks.go_on(LATE, state.time_s);
        goes_on.then(|| {
            format!(
                "bonds still broke at the end, the last at {} s of {} s: the breakage may not be over; set run.end_time later than {} s",
                significant(last_s, 4),
                significant(state.time_s, 4),
                significant(scene.run.end_time_s, 4)
            )
        })
    }

    /// Warning that something hits a standing wall at the end time. Not where walls, loads or
    /// supports press, or inlets feed: such a process may end at any moment.
    pub(super) fn ends_in_an_impact(&self, state: &State) -> Option<String> {
        let presses = !state.loads.is_empty() || !state.supports.is_empty();
        if presses
            || state.walls.iter().any(Wall::does_work)
            || !state.model.rules.inlets.is_empty()
        {
            return None;
        }
        let [of_largest, of_weight] = UNDER_IMPACT;
        let (now_n, largest_n) = (stand_n(state), self.largest_stand_n);
        let weight_n = state.ledger.mass_kg() * Vector3::from(state.model.gravity_m_s2).norm();
        // What swings on a wall from the start does not hit it.
        let hits = self.stood_free && now_n > of_largest * largest_n;
        (hits && now_n > of_weight * weight_n).then(|| {
            format!(
                "the run ends in the middle of an impact: the walls push with {} N at the end, {} % of their largest force in the run, and the weight is {} N; set run.end_time later than {} s",
                significant(now_n, 3),
                significant(100.0 * now_n / largest_n, 3),
                significant(weight_n, 3),
                significant(state.time_s, 4),
            )
        })
    }

    /// Warning that bodies which inlets have fed touch each other, but no wall.
    fn all_fell_past(&self, state: &State) -> Option<String> {
        let is_fed = state.population.inlets.iter().any(|come| come.bodies > 0);
        let misses_all = !state.walls.is_empty() && self.has_touched_no_wall();
        // What is held may be the target of what is fed.
        let is_held = !state.supports.is_empty();
        (is_fed && misses_all && !is_held && !self.touched.is_empty()).then(|| {
            "nothing that the inlets fed has touched a wall; check the places of walls and inlets, or set run.end_time later".to_owned()
        })
    }

    /// The fragments that still move apart at the end: a warning if they may break further, else a
    /// note. Not for laboratory tests, nor while an inlet still feeds.
    pub(super) fn flying(
        &self,
        state: &State,
        scene: &Scene,
        fragments: &[Fragment],
    ) -> Option<Flying> {
        let last_break_s = self.last_break_s?;
        if is_fed(state) || scene.test.is_some() {
            return None;
        }
        let goes_on = self.breaks.go_on(QUIET, state.time_s);
        still_flying(
            state,
            fragments,
            self.largest_kinetic_j,
            last_break_s,
            goes_on,
        )
    }
}

/// Sentences on extremes of strain, plastic strain and indentation beyond the laws.
fn beyond([strain, yielded, pressed]: [&Extreme; 3]) -> Vec<String> {
    let where_ = |extreme: &Extreme| {
        let far_m = extreme
            .place_m
            .iter()
            .fold(0.0_f64, |far, x| far.max(x.abs()));
        // Rounding errors are shown as 0.
        let told = |x: f64| if x.abs() < 1e-9 * far_m { 0.0 } else { x };
        let [x, y, z] = extreme.place_m.map(|x| significant(told(x), 4));
        let time = significant(extreme.time_s, 4);
        format!(
            " between {}, at ({x}, {y}, {z}) m, {time} s",
            extreme.between
        )
    };
    let strained = strain_warning(strain.largest, &where_(strain));
    let flowed = plastic_strain_warning(yielded.largest, &where_(yielded));
    let pressed = indentation_warning(pressed.largest, &where_(pressed));
    strained.into_iter().chain(flowed).chain(pressed).collect()
}

/// Names of bodies on which loads act and which no support holds.
fn loaded<'a>(state: &State, bodies: &'a [PlacedBody]) -> BTreeSet<&'a str> {
    let held = state.supports.iter().flat_map(|support| &support.held);
    let held: BTreeSet<u32> = held.map(|held| held.particle).collect();
    let loads = state.loads.iter().flat_map(|load| &load.particles);
    let pushed: BTreeSet<u32> = loads.copied().collect();
    let is_own = |body: &&PlacedBody| {
        let any = |of: &BTreeSet<u32>| body.particles.iter().any(|i| of.contains(i));
        any(&pushed) && !any(&held)
    };
    let own = bodies.iter().filter(is_own);
    own.map(|body| body.name.as_str()).collect()
}

/// Whether an inlet still feeds.
fn is_fed(state: &State) -> bool {
    let mut inlets = state.model.rules.inlets.iter();
    inlets.any(|inlet| inlet.between_s[1] >= state.time_s)
}

/// Whether any part of a body is in the scene.
fn is_present(state: &State, bodies: &[PlacedBody], name: &str) -> bool {
    let mut clumps = state.clumps.all.iter();
    bodies.iter().any(|body| body.name == name)
        || clumps.any(|clump| state.clumps.template(clump).body == name)
}

/// Predicted outcome for a body in flight, in words.
fn outlook(flyer: &FreeBody, state: &State, flying: &[FreeBody]) -> String {
    let gaps = state
        .walls
        .iter()
        .map(|wall| (flyer.gap_after(wall, 0.0), wall));
    let nearest = gaps.min_by(|a, b| a.0.total_cmp(&b.0));
    let is = nearest.map_or("it".to_owned(), |(gap_m, wall)| {
        format!(
            "it is {} from the wall '{}' and",
            show_length(gap_m),
            wall.model.name
        )
    });
    match flyer.first_meeting(&state.walls, flying) {
        Meeting::At {
            after_s: 0.0, wall, ..
        } => {
            format!(
                "it stands at the wall '{wall}' and does not press on it; check gravity and its velocity"
            )
        }
        Meeting::At { after_s, wall, .. } => format!(
            "at the end it is on its way to the wall '{wall}', {} away, which it would reach at {} s; set run.end_time later than that",
            show_length(nearest.map_or(0.0, |(gap_m, _)| gap_m)),
            significant(state.time_s + after_s, 4)
        ),
        Meeting::Never => format!(
            "{is} would never meet anything as it moves; check its position and velocity, gravity and the walls"
        ),
        Meeting::Unknown => {
            format!(
                "at the end {is} has met nothing yet; check its position, or set run.end_time later"
            )
        }
    }
}

/// The outlets that removed clumps of a body, as the end of a sentence; empty if none did.
fn discharged_before(state: &State, name: &str) -> String {
    let rules = &state.model.rules;
    let is_own = |body: u32| {
        state
            .model
            .bodies
            .get(body as usize)
            .is_some_and(|own| own.name == *name)
    };
    let gone = &state.population.discharged;
    let of_outlet = |(number, outlet): (usize, &Outlet)| {
        let own = gone
            .iter()
            .filter(|one| one.outlet as usize == number && is_own(one.size.body));
        let count = own.count();
        (count > 0).then(|| format!("{count} by the outlet '{}'", outlet.name))
    };
    let told: Vec<String> = rules
        .outlets
        .iter()
        .enumerate()
        .filter_map(of_outlet)
        .collect();
    match told.is_empty() {
        true => String::new(),
        false => format!("; removed before: {}", told.join(", ")),
    }
}

/// Triggers, inlets and outlets that did nothing.
fn unused_rules(state: &State) -> Vec<String> {
    let rules = &state.model.rules;
    let mut warnings = Vec::new();
    let inlets = rules.inlets.iter().zip(&state.population.inlets);
    for (inlet, _) in inlets.filter(|(_, come)| come.bodies == 0) {
        let start_s = inlet.between_s[0];
        let why = if start_s >= state.time_s {
            format!("it starts at {} s", significant(start_s, 4))
        } else {
            "no place became free in its region".to_owned()
        };
        warnings.push(format!(
            "the inlet '{}' fed nothing up to {} s: {why}",
            inlet.name,
            significant(state.time_s, 4)
        ));
    }
    let made = state.clumps.templates.iter().zip(&rules.daughters);
    for ((template, rule), done) in made.zip(&state.population.by_daughters) {
        if rule.as_ref().is_some_and(|rule| *done >= rule.limit) {
            warnings.push(format!(
                "daughters replaced no more particles of '{}' after the first {done}, the limit in replacement.{0}: the others stayed whole",
                template.body
            ));
        }
    }
    for (outlet, removed) in rules.outlets.iter().zip(&state.population.outlets) {
        if removed.bodies == 0 && !outlet.removes_outside {
            warnings.push(format!(
                "the outlet '{}' removed nothing: no body reached its region",
                outlet.name
            ));
        }
    }
    warnings
}
