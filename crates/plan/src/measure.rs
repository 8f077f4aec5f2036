//! Measures: named quantities of particle groups, recorded during a run.

mod bonds;
mod bulk;
mod heap;
mod members;
mod mixing;
mod mixture;
mod objects;
pub mod sizes;
mod spheres;
mod whole;

use std::collections::BTreeMap;
use std::sync::Arc;

use dem_io::units::significant;
use dem_results::summary::Measured;
use dem_scene::{ALL, Measure, Quantity, Statistic};
use nalgebra::{UnitQuaternion, Vector3};

use crate::Plan;
use crate::measures::{FEWEST_IN_HEAP, FEWEST_MIXED_CELLS};
use dem_engine::stages::clumps::synchronous;
use dem_engine::stages::totals::synchronous_motions;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::clusters::fragments;
use dem_engine::state::events::Renumbering;
use dem_engine::state::watches::{Seen, Watch, WatchTarget};
use dem_results::Balance;

use self::members::{Members, wall_number};
use self::spheres::spheres;
use self::whole::{Motions, Starts, start_centre, starts, turned_before};

pub use self::bonds::utilisation_under;
pub use self::bonds::{DynamicUtilisation, bond_utilisation, dynamic_utilisations, load};
pub use self::mixture::MixedCell;
pub use dem_engine::state::watches::{History, IndexError};

/// A measure and its particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Its name in the scene.
    pub name: String,
    /// Its definition.
    pub measure: Measure,
    members: Members,
    /// The particles of its second object, if that is not a wall.
    with: Option<Members>,
    /// The walls among its two objects, by number.
    walls: [Option<usize>; 2],
    /// The region to which it is restricted: number in the rules of the state.
    region: Option<usize>,
    /// Mass over the volume of the shape of the body that it measures, kg/m3. NaN if not known.
    solid_density_kg_m3: f64,
    /// Initial positions of the bodies of the scene. Empty if not needed.
    starts: Arc<Starts>,
    /// Initial centre of mass of its particles, m. NaN if not needed.
    start: Vector3<f64>,
    /// Initial rotations of those of its particles that were rotated. Empty if not needed.
    turned_before: BTreeMap<u32, UnitQuaternion<f64>>,
    /// Its values so far.
    pub history: History,
}

/// Data at one time that several measures need. Each part is empty if none does.
#[derive(Debug, Default)]
struct Common {
    motions: Motions,
    /// Mass of every cluster, kg.
    masses_kg: Vec<f64>,
    /// All bonds; broken ones are none.
    bonds: Vec<Option<DynamicUtilisation>>,
}

/// The probes of a plan that has not been stepped.
pub fn probes(scene: &dem_scene::Scene, plan: &Plan) -> Vec<Probe> {
    let counts_from_start = |measure: &Measure| {
        matches!(
            measure.quantity,
            Quantity::Displacement(_) | Quantity::DisplacementMagnitude | Quantity::Rotation(_)
        )
    };
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
            quantity: probe.measure.quantity,
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
    let needs_motions = |g: &Probe| {
        matches!(
            g.measure.quantity,
            Quantity::Velocity(_)
                | Quantity::VelocityMagnitude
                | Quantity::AngularVelocity(_)
                | Quantity::KineticEnergy
        )
    };
    let needs_rates = |g: &Probe| {
        matches!(
            g.measure.quantity,
            Quantity::LargestStrainRate
                | Quantity::LargestDynamicIncreaseFactor
                | Quantity::LargestDynamicUtilisation
                | Quantity::FractionBelowDynamicUtilisation
        )
    };
    let counts_mass = |g: &Probe| {
        let quantity = g.measure.quantity;
        matches!(
            quantity,
            Quantity::MassFractionOfLargest | Quantity::MassOfLargest
        )
    };
    let mut common = Common::default();
    if probes.iter().any(counts_mass) {
        common.masses_kg = masses_of_pieces_kg(state);
    }
    if probes.iter().any(needs_rates) {
        common.bonds = dynamic_utilisations(state);
    }
    if probes.iter().any(needs_motions) {
        common.motions = Motions {
            particles: synchronous_motions(state),
            clumps: synchronous(state),
        };
    }
    let mut watches = state.watches.iter();
    let mut values = Vec::new();
    for probe in probes {
        let watch = probe.is_watched().then(|| watches.next()).flatten();
        let value = match watch {
            Some(watch) => {
                probe.history = watch.seen.history;
                watch.seen.value
            }
            None => {
                let value = probe.read(state, &common, balance);
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

/// Against gravity; without gravity along z.
fn up(state: &State) -> Vector3<f64> {
    let down = Vector3::from(state.model.gravity_m_s2);
    (-down).try_normalize(0.0).unwrap_or_else(Vector3::z)
}

impl Probe {
    /// Updates everything that depends on its particles.
    fn count_anew(&mut self, bodies: &[PlacedBody], state: &State) {
        match self.measure.quantity {
            Quantity::Displacement(_) | Quantity::DisplacementMagnitude => {
                self.start = start_centre(&self.members, &self.starts, bodies, state);
            }
            Quantity::Rotation(_) => {
                self.turned_before = turned_before(&self.members, &self.starts, bodies);
            }
            _ => {}
        }
    }

    /// Whether it is evaluated in every step.
    fn is_watched(&self) -> bool {
        let quantity = self.measure.quantity;
        let is_force = matches!(quantity, Quantity::Force(_) | Quantity::ForceMagnitude);
        is_force || quantity.is_of_contact()
    }

    /// The object whose forces and contacts it records in every step. None: it has none.
    fn watched(&self, state: &State) -> Option<WatchTarget> {
        if !self.is_watched() {
            return None;
        }
        let own = || self.members.marked(state);
        Some(match (self.walls, &self.with) {
            ([Some(wall), _], _) => WatchTarget::Wall(wall),
            ([None, Some(wall)], _) => WatchTarget::WithWall(own(), wall),
            (_, Some(with)) => WatchTarget::Between([own(), with.marked(state)]),
            (_, None) => WatchTarget::Particles(own()),
        })
    }

    fn read(&self, state: &State, common: &Common, balance: &Balance) -> f64 {
        let (motions, masses_kg) = (&common.motions, &common.masses_kg);
        let wall = self.walls[0].and_then(|wall| state.walls.get(wall));
        let members = &self.members;
        let reactions = |k: usize| {
            let held = state.supports.iter().flat_map(|support| &support.held);
            held.filter(|held| members.particles.binary_search(&held.particle).is_ok())
                .map(|held| held.reactions[0][k])
                .sum::<f64>()
        };
        let at = usize::from;
        match self.measure.quantity {
            Quantity::Position(k) if let Some(wall) = wall => wall.frame.position_m[at(k)],
            Quantity::Position(k) => whole::centre(members, state)[at(k)],
            Quantity::Displacement(k) => whole::centre_from(members, state, self.start)[at(k)],
            Quantity::DisplacementMagnitude => {
                whole::centre_from(members, state, self.start).norm()
            }
            Quantity::Velocity(k) => whole::velocity(members, state, motions)[at(k)],
            Quantity::VelocityMagnitude => whole::velocity(members, state, motions).norm(),
            Quantity::Rotation(k) => {
                whole::turn(members, state, &self.starts, &self.turned_before)[at(k)]
            }
            Quantity::AngularVelocity(k) => whole::spin(members, state, motions)[at(k)],
            Quantity::Reaction(k) => reactions(at(k)),
            Quantity::ReactionTorque(k) => reactions(3 + at(k)),
            Quantity::KineticEnergy if members.are_all => balance.kinetic_j,
            Quantity::KineticEnergy => whole::kinetic_j(members, state, motions),
            Quantity::ElasticEnergy if members.are_all => balance.elastic_j(),
            Quantity::ElasticEnergy => self.over_bonds(state, 0.0, |sum, at, ends_in| {
                if state.bonds.is_broken(at) {
                    return sum;
                }
                sum + 0.5
                    * ends_in
                    * state
                        .bonds
                        .forces(at, &state.particles.poses)
                        .energy
                        .total()
            }),
            Quantity::BrokenBonds => self.broken_bonds(state),
            Quantity::LargestUtilisation => {
                bonds::largest_utilisation(state, &members.marked(state))
            }
            Quantity::LargestStrainRate
            | Quantity::LargestDynamicIncreaseFactor
            | Quantity::LargestDynamicUtilisation
            | Quantity::FractionBelowDynamicUtilisation => self.at_rates(state, common),
            Quantity::AngleOfRepose => {
                heap::angle_of_repose_deg(&spheres(members, state), up(state))
            }
            Quantity::Mass
            | Quantity::BulkDensity
            | Quantity::BulkingFactor
            | Quantity::MixingIndex => self.in_bulk(state),
            // Torque of the particles on the wall.
            Quantity::Torque(k) => wall.map_or(f64::NAN, |w| 0.0 - w.total_load()[1][at(k)]),
            Quantity::Count => {
                let clusters = state.clusters.as_ref();
                let gone = state.population.discharged.len();
                clusters.map_or(f64::NAN, |c| (c.living().count() + gone) as f64)
            }
            Quantity::MassOfLargest => masses_kg.iter().copied().fold(0.0, f64::max),
            Quantity::MassFractionOfLargest => {
                masses_kg.iter().copied().fold(0.0, f64::max) / masses_kg.iter().sum::<f64>()
            }
            // Evaluated in every step, if there are steps.
            Quantity::Force(_)
            | Quantity::ForceMagnitude
            | Quantity::ContactForce(_)
            | Quantity::ContactForceMagnitude
            | Quantity::ContactOverlap
            | Quantity::ContactDuration => f64::NAN,
        }
    }

    /// Broken bonds since the start, those of what has left included.
    fn broken_bonds(&self, state: &State) -> f64 {
        if self.members.name == ALL {
            return state.broken_count as f64;
        }
        let mut bodies = state.model.bodies.iter();
        let body = bodies.position(|body| body.name == self.members.name);
        let gone = body.and_then(|body| state.population.broken_gone.get(body));
        let gone = gone.copied().unwrap_or(0) as f64;
        self.over_bonds(state, gone, |sum, at, _| {
            sum + f64::from(u8::from(state.bonds.is_broken(at)))
        })
    }

    /// Value of a quantity of the spheres in a region, or of all of them.
    fn in_bulk(&self, state: &State) -> f64 {
        let own = spheres(&self.members, state);
        let region = self.region.map(|at| &state.model.rules.regions[at]);
        let density = || match region {
            Some(region) => bulk::mass_within_kg(&own, region) / region.volume_m3(),
            None => bulk::heap_density_kg_m3(&own, up(state)),
        };
        match (self.measure.quantity, region) {
            (Quantity::BulkDensity, _) => density(),
            (Quantity::BulkingFactor, _) => match density() {
                0.0 => f64::NAN,
                density => self.solid_density_kg_m3 / density,
            },
            (Quantity::MixingIndex, _) => {
                (self.mixing(state)).map_or(f64::NAN, |mixture| mixture.lacey_index())
            }
            (_, Some(region)) => bulk::mass_within_kg(&own, region),
            (_, None) => 0.0 + own.iter().map(|sphere| sphere.mass_kg).sum::<f64>(),
        }
    }

    /// Value of a quantity of intact bonds at their strain rates.
    fn at_rates(&self, state: &State, common: &Common) -> f64 {
        let largest = |least: f64, of: fn(&DynamicUtilisation) -> f64| {
            self.over_intact(state, common, least, |largest, bond| largest.max(of(bond)))
        };
        match self.measure.quantity {
            Quantity::LargestStrainRate => largest(f64::NAN, |bond| bond.strain_rate_1_s),
            Quantity::LargestDynamicIncreaseFactor => largest(1.0, |bond| bond.increase_factor),
            Quantity::LargestDynamicUtilisation => largest(0.0, |bond| bond.utilisation),
            _ => {
                let limit = self.measure.limit.unwrap_or(f64::NAN);
                let start = [0.0, 0.0];
                let [below, all] = self.over_intact(state, common, start, |[below, all], bond| {
                    let is_below = u8::from(bond.utilisation < limit);
                    [below + f64::from(is_below), all + 1.0]
                });
                below / all
            }
        }
    }

    /// Reason why it has no value at the end. None: it has one.
    fn missing(&self, value: f64) -> Option<String> {
        let (name, of) = (&self.name, &self.measure.of);
        let left = self.members.particles.len();
        if !value.is_nan() {
            None
        } else if left == 0 && self.measure.within.is_none() {
            Some(format!("{name} has no value: nothing of \"{of}\" is left"))
        } else if self.measure.quantity == Quantity::AngleOfRepose && left >= FEWEST_IN_HEAP {
            Some(format!(
                "{name} has no value: \"{of}\" is not one round heap, but several, a ridge or a ring; name the body of one heap in \"of\""
            ))
        } else if self.measure.quantity == Quantity::AngleOfRepose {
            Some(format!(
                "{name} has no value: an angle of repose needs {FEWEST_IN_HEAP} particles or more, and \"{of}\" has {left}"
            ))
        } else if self.measure.quantity == Quantity::MixingIndex {
            let within = self.measure.within.as_deref().unwrap_or_default();
            Some(format!(
                "{name} has no value: the region \"{within}\" has nothing of one of the two, cell_size is so small that no cell has two pieces, or so large that fewer than {FEWEST_MIXED_CELLS} cells hold something"
            ))
        } else if self.measure.quantity == Quantity::BulkingFactor {
            let within = self.measure.within.as_deref().unwrap_or_default();
            Some(format!(
                "{name} has no value: the region \"{within}\" has nothing of \"{of}\""
            ))
        } else if matches!(
            self.measure.quantity,
            Quantity::LargestStrainRate | Quantity::FractionBelowDynamicUtilisation
        ) {
            Some(format!("{name} has no value: \"{of}\" has no intact bond"))
        } else {
            None
        }
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

    /// Folds over the bonds that have an end in the set, with the number of ends in it.
    fn over_bonds<T>(&self, state: &State, start: T, next: impl Fn(T, usize, f64) -> T) -> T {
        let is_in = self.members.marked(state);
        let mut value = start;
        for (at, ends) in state.bonds.ends.iter().enumerate() {
            let ends_in = ends.iter().filter(|&&end| is_in[end as usize]).count();
            if ends_in > 0 {
                value = next(value, at, ends_in as f64);
            }
        }
        value
    }

    /// Folds over the intact bonds that have an end in the set.
    fn over_intact<T>(
        &self,
        state: &State,
        common: &Common,
        start: T,
        next: impl Fn(T, &DynamicUtilisation) -> T,
    ) -> T {
        self.over_bonds(state, start, |value, at, _| match &common.bonds[at] {
            Some(bond) => next(value, bond),
            None => value,
        })
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

    /// Unit of its quantity; empty for plain numbers.
    pub fn unit(&self) -> &'static str {
        self.measure.quantity.dimension().si
    }
}

/// Mass of every cluster, of what is inside and of what has left through outlets, kg.
fn masses_of_pieces_kg(state: &State) -> Vec<f64> {
    let Some(clusters) = &state.clusters else {
        return Vec::new();
    };
    let all = fragments(clusters, &state.particles, &state.clumps, None);
    let gone = state.population.discharged.iter();
    let gone = gone.map(|gone| gone.size.mass_kg);
    all.iter().map(|one| one.mass_kg).chain(gone).collect()
}
