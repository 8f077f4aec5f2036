//! Measures: named quantities of particle groups, recorded during a run.

mod bonds;
mod bulk;
mod contacts;
mod heap;
pub(crate) mod measurement;
mod members;
mod mixing;
mod mixture;
mod pieces;
mod probe;
pub(crate) mod refused;
pub mod sizes;
mod spheres;
mod starts;
mod supports;
mod utilisation;
mod view;
mod whole;

use std::collections::BTreeMap;
use std::sync::Arc;

use dem_io::units::significant;
use dem_results::summary::Measured;
use dem_scene::{Measure, Statistic};
use nalgebra::Vector3;

use crate::Plan;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::events::Renumbering;
use dem_engine::state::watches::{Seen, Watch, WatchTarget};
use dem_results::Balance;

use self::members::{Members, wall_number};
use self::starts::{Starts, start_centre, starts, turned_before};
use self::view::View;

pub use self::measurement::{IfZero, Measurement, Settles};
pub use self::mixture::MixedCell;
pub use self::probe::Probe;
pub use self::utilisation::{
    DynamicUtilisation, bond_utilisation, dynamic_utilisations, load, utilisation_under,
};
pub use dem_engine::state::watches::{History, IndexError};

/// One that is not in the list.
static UNKNOWN: Measurement = Measurement::new("", |_, _| f64::NAN);

fn measurements() -> impl Iterator<Item = &'static Measurement> {
    let files = [
        whole::MEASUREMENTS,
        supports::MEASUREMENTS,
        bonds::MEASUREMENTS,
        heap::MEASUREMENTS,
        bulk::MEASUREMENTS,
        mixing::MEASUREMENTS,
        contacts::MEASUREMENTS,
        pieces::MEASUREMENTS,
    ];
    files.into_iter().flatten()
}

impl Measurement {
    /// The measurement of a measure.
    pub fn of(measure: &Measure) -> &'static Self {
        let names = measure.quantity.names;
        measurements()
            .find(|one| names.contains(&one.name))
            .unwrap_or(&UNKNOWN)
    }
}

/// The probes of a plan that has not been stepped.
pub fn probes(scene: &dem_scene::Scene, plan: &Plan) -> Vec<Probe> {
    let counts_from_start = |measure| Measurement::of(measure).counts_from_start;
    let starts = if scene.measures.values().any(counts_from_start) {
        starts(&plan.bodies, &plan.state)
    } else {
        Starts::new()
    };
    let starts = Arc::new(starts);
    let members = |name: &str| {
        let particles = plan.groups.get(name).cloned().unwrap_or_default();
        let mut members = Members::new(name, particles);
        // The sets of a plan do not include spheres of clumps.
        members.renumber(&[], &plan.bodies, &plan.state);
        members
    };
    let probe = |(name, measure): (&String, &Measure)| {
        let with = measure.with.as_deref();
        let with_wall = with.and_then(|with| wall_number(scene, with));
        let mut probe = Probe {
            name: name.clone(),
            measure: measure.clone(),
            members: members(&measure.of),
            with: with.filter(|_| with_wall.is_none()).map(members),
            walls: [wall_number(scene, &measure.of), with_wall],
            region: (measure.within.as_ref())
                .and_then(|name| scene.regions.keys().position(|region| region == name)),
            solid_density_kg_m3: (plan.masses.get(&measure.of))
                .and_then(|mass| mass.solid_density_kg_m3)
                .unwrap_or(f64::NAN),
            starts: Arc::clone(&starts),
            start: Vector3::repeat(f64::NAN),
            turned_before: BTreeMap::new(),
            history: History::default(),
        };
        probe.count_anew(&plan.bodies, &plan.state);
        probe
    };
    scene.measures.iter().map(probe).collect()
}

/// Makes a state that is about to be stepped record what the probes need in every step.
pub fn place_watches(probes: &[Probe], state: &mut State) {
    let watch = |probe: &Probe| {
        Some(Watch {
            quantity: probe.measurement().recorded?,
            part: probe.measure.part,
            of: probe.watched(state)?,
            seen: Seen::default(),
        })
    };
    let watches = probes.iter().filter_map(watch).collect();
    state.watches = watches;
}

/// Evaluates all probes between the two halves of a step, `interact` and `advance`, and records
/// their values. Returns one value for each.
pub fn read_probes(probes: &mut [Probe], state: &State, balance: &Balance) -> Vec<f64> {
    let view = View::new(state, balance);
    let mut watches = state.watches.iter();
    let mut values = Vec::new();
    for probe in probes {
        let measurement = probe.measurement();
        let watch = measurement.recorded.and_then(|_| watches.next());
        let value = match watch {
            Some(watch) => {
                probe.history = watch.seen.history;
                watch.seen.value
            }
            None => {
                let value = (measurement.read)(probe, &view);
                probe.history.note(state.time_s, value);
                if let Some(error) = probe.mixing(state).and_then(|mixture| mixture.error()) {
                    probe.history.note_error(error);
                }
                value
            }
        };
        values.push(value);
    }
    values
}

/// Updates the probes, and what the state records for them, to the new numbers of particles.
pub fn renumber(
    probes: &mut [Probe],
    by: &[Renumbering],
    bodies: &[PlacedBody],
    state: &mut State,
) {
    for probe in &mut *probes {
        let members = [Some(&mut probe.members), probe.with.as_mut()];
        for members in members.into_iter().flatten() {
            members.renumber(by, bodies, state);
        }
        probe.count_anew(bodies, state);
    }
    let mut watched = Vec::new();
    watched.extend(probes.iter().filter_map(|probe| probe.watched(state)));
    for (watch, of) in state.watches.iter_mut().zip(watched) {
        watch.of = of;
    }
}

impl Probe {
    /// How its quantity is measured.
    pub fn measurement(&self) -> &'static Measurement {
        Measurement::of(&self.measure)
    }

    /// Updates everything that depends on its particles.
    fn count_anew(&mut self, bodies: &[PlacedBody], state: &State) {
        if self.measurement().counts_from_start {
            self.start = start_centre(&self.members, &self.starts, bodies, state);
            self.turned_before = turned_before(&self.members, &self.starts, bodies);
        }
    }

    /// The object whose forces and contacts it records in every step. None: it has none.
    fn watched(&self, state: &State) -> Option<WatchTarget> {
        self.measurement().recorded?;
        let own = || self.members.marked(state);
        Some(match (self.walls, &self.with) {
            ([Some(wall), _], _) => WatchTarget::Wall(wall),
            ([None, Some(wall)], _) => WatchTarget::WithWall(own(), wall),
            (_, Some(with)) => WatchTarget::Between([own(), with.marked(state)]),
            (_, None) => WatchTarget::Particles(own()),
        })
    }

    /// Reason why it has no value at the end. None: it has one.
    fn missing(&self, value: f64) -> Option<String> {
        let (name, of) = (&self.name, &self.measure.of);
        let left = self.members.particles.len();
        let why = if !value.is_nan() {
            return None;
        } else if left == 0 && self.measure.within.is_none() {
            format!("nothing of \"{of}\" is left")
        } else {
            (self.measurement().missing)(self)?
        };
        Some(format!("{name} has no value: {why}"))
    }

    /// For a run that went on to its end time: what it says of a measure with `end_run_above`,
    /// whose value did not end it. None for any other, and without a value.
    pub fn end_not_reached(&self) -> Option<String> {
        let limit = self.measure.end_run_above?;
        let largest = self.history.largest?;
        let remedy = if largest > limit {
            "this was between two rows of the time series: make output.series shorter"
        } else {
            "set a later run.end_time, or let what changes it, such as a plunger, move faster"
        };
        let with_unit = |value| {
            let text = format!("{} {}", significant(value, 4), self.unit());
            text.trim_end().to_owned()
        };
        Some(format!(
            "{} did not end the run, which its end_run_above of {} was to do: its largest value is {}; {remedy}",
            self.name,
            with_unit(limit),
            with_unit(largest)
        ))
    }

    /// Its result at the end of a run.
    pub fn result(&self) -> Measured {
        let history = &self.history;
        let last = history.last.map_or(f64::NAN, |(_, value)| value);
        let value = match self.measure.statistic {
            Statistic::End => last,
            Statistic::Largest => history.largest.unwrap_or(f64::NAN),
            Statistic::Smallest => history.smallest.unwrap_or(f64::NAN),
            Statistic::Mean if history.duration_s > 0.0 => history.integral / history.duration_s,
            Statistic::Mean => last,
        };
        let error = self.measure.reference.map(|reference| {
            let off = value - reference;
            if reference == 0.0 {
                off
            } else {
                off / reference.abs()
            }
        });
        Measured {
            missing: self.missing(value),
            name: self.name.clone(),
            value,
            unit: self.unit().to_owned(),
            reference: self.measure.reference,
            error,
            tolerance: self.measure.tolerance,
            absolute_tolerance: self.measure.absolute_tolerance,
        }
    }
}

#[cfg(test)]
mod tests {
    use dem_scene::QUANTITIES;

    #[test]
    fn every_quantity_of_scenes_is_measured_once() {
        let mut measured: Vec<&str> = super::measurements().map(|one| one.name).collect();
        let mut known: Vec<&str> = QUANTITIES.iter().map(|one| one.names[0]).collect();
        measured.sort_unstable();
        known.sort_unstable();
        assert_eq!(measured, known);
    }
}
