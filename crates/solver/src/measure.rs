//! Measures: named quantities of sets of particles, followed through a run.

mod heap;

use dem_io::scene::{At, Measure, Quantity};
use serde::{Deserialize, Serialize};

use crate::check::ledger::Balance;
use crate::check::totals::synchronous_motions;
use crate::clusters::fragments;
use crate::physics::bond::BondLoad;
use crate::physics::bond::failure::{stresses, utilisation};
use crate::physics::rigid::rotation_vector;
use crate::plan::Plan;
use crate::plan::bodies::PlacedBody;
use crate::stages::population::{GONE, Renumbered};
use crate::state::State;
use crate::state::particles::Motion;

/// A measure and the particles that it is of.
#[derive(Debug, Clone, PartialEq)]
pub struct Gauge {
    /// Its name in the scene.
    pub name: String,
    /// What is asked.
    pub measure: Measure,
    particles: Vec<u32>,
    /// The wall that it is of, by number.
    wall: Option<usize>,
    /// Whether those are all there are.
    of_all: bool,
    /// Mean position at the start, m. Length 3.
    start_m: [f64; 3],
    /// What it has shown.
    pub history: History,
}

/// What a measure has shown so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct History {
    last: Option<(f64, f64)>,
    largest: Option<f64>,
    smallest: Option<f64>,
    integral: f64,
    duration_s: f64,
}

/// Result of a measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measured {
    /// Its name in the scene.
    #[serde(skip_serializing)]
    pub name: String,
    /// In `unit`.
    pub value: f64,
    /// SI unit; empty for plain numbers.
    pub unit: String,
    /// What it should be.
    pub reference: Option<f64>,
    /// (value - reference) / |reference|; the plain difference for a reference of 0.
    pub error: Option<f64>,
    /// Largest error for the run to be called good.
    pub tolerance: Option<f64>,
}

impl Measured {
    /// Whether the error is within the tolerance; true without one.
    pub fn is_good(&self) -> bool {
        match (self.error, self.tolerance) {
            (Some(error), Some(tolerance)) => error.abs() <= tolerance,
            _ => true,
        }
    }
}

/// The gauges of a plan that has not been stepped.
pub fn gauges(scene: &dem_io::Scene, plan: &Plan) -> Vec<Gauge> {
    let mut gauges: Vec<Gauge> = scene
        .measures
        .iter()
        .map(|(name, measure)| {
            let particles = plan.sets.get(&measure.of).cloned().unwrap_or_default();
            let mut walls = scene.walls.keys();
            Gauge {
                wall: walls.position(|wall| *wall == measure.of),
                name: name.clone(),
                measure: measure.clone(),
                of_all: particles.len() == plan.state.particles.len(),
                start_m: mean_position(&plan.state, &particles),
                particles,
                history: History::default(),
            }
        })
        .collect();
    if !plan.state.clumps.templates.is_empty() {
        // The sets of a plan know no spheres of clumps.
        renumber(&mut gauges, &[], &plan.bodies, &plan.state);
        for gauge in &mut gauges {
            gauge.start_m = mean_position(&plan.state, &gauge.particles);
        }
    }
    gauges
}

/// Reads all gauges between a kick and the drift after it, and notes what they show. One value for each.
pub fn read_gauges(gauges: &mut [Gauge], state: &State, balance: &Balance) -> Vec<f64> {
    let needs_motions = |g: &Gauge| {
        matches!(
            g.measure.quantity,
            Quantity::Velocity(_) | Quantity::AngularVelocity(_) | Quantity::KineticEnergy
        )
    };
    let counts_mass = |g: &Gauge| {
        let quantity = g.measure.quantity;
        matches!(
            quantity,
            Quantity::MassFractionOfLargest | Quantity::MassOfLargest
        )
    };
    let masses_kg = if gauges.iter().any(counts_mass) {
        masses_of_pieces_kg(state)
    } else {
        Vec::new()
    };
    let motions = if gauges.iter().any(needs_motions) {
        synchronous_motions(state)
    } else {
        Vec::new()
    };
    gauges
        .iter_mut()
        .map(|gauge| {
            let value = gauge.read(state, &motions, &masses_kg, balance);
            gauge.history.note(state.time_s, value);
            value
        })
        .collect()
}

/// Lets the gauges count particles as they are counted now: those of all, of bodies by their names, and of sets as far as their particles are there.
pub fn renumber(gauges: &mut [Gauge], by: &[Renumbered], bodies: &[PlacedBody], state: &State) {
    for gauge in gauges {
        let named = |name: &String| *name == gauge.measure.of;
        let templates = &state.clumps.templates;
        if gauge.measure.of == "all" {
            gauge.particles = (0..state.particles.len() as u32).collect();
        } else if templates.iter().any(|template| named(&template.body)) {
            let own = bodies.iter().filter(|body| named(&body.name));
            let own = own.flat_map(|body| body.particles.iter().copied().filter(|i| *i != GONE));
            let clumps = state.clumps.all.iter();
            let clumps = clumps.filter(|clump| named(&state.clumps.template(clump).body));
            let carried = clumps.flat_map(|clump| state.clumps.spheres_of(clump));
            let carried = carried.map(|i| i as u32);
            gauge.particles = own.chain(carried).collect();
            gauge.particles.sort_unstable();
        } else {
            for by in by {
                gauge.particles.retain_mut(|particle| {
                    *particle = by.particles[*particle as usize];
                    *particle < by.free
                });
            }
        }
        gauge.of_all = gauge.particles.len() == state.particles.len();
    }
}

impl Gauge {
    fn read(&self, state: &State, motions: &[Motion], masses_kg: &[f64], balance: &Balance) -> f64 {
        let p = &state.particles;
        let wall = self.wall.and_then(|wall| state.walls.get(wall));
        let count = self.particles.len() as f64;
        let mean = |of: &dyn Fn(usize) -> f64| {
            self.particles.iter().map(|&i| of(i as usize)).sum::<f64>() / count
        };
        let reactions = |k: usize| {
            let held = state.supports.iter().flat_map(|support| &support.held);
            held.filter(|held| self.particles.binary_search(&held.particle).is_ok())
                .map(|held| held.reactions[0][k])
                .sum::<f64>()
        };
        match self.measure.quantity {
            Quantity::Position(k) if let Some(wall) = wall => wall.frame.position_m[k as usize],
            Quantity::Position(k) => mean(&|i| p.poses[i].position_m[k as usize]),
            Quantity::Displacement(k) => {
                mean(&|i| p.poses[i].position_m[k as usize] - self.start_m[k as usize])
            }
            Quantity::Velocity(k) => mean(&|i| motions[i].velocity_m_s[k as usize]),
            Quantity::Rotation(k) => mean(&|i| rotation_vector(p.poses[i].turned)[k as usize]),
            Quantity::AngularVelocity(k) => mean(&|i| motions[i].spin_rad_s[k as usize]),
            Quantity::Reaction(k) => reactions(k as usize),
            Quantity::ReactionTorque(k) => reactions(3 + k as usize),
            Quantity::KineticEnergy if self.of_all => balance.kinetic_j,
            Quantity::KineticEnergy => self
                .particles
                .iter()
                .map(|&i| p.kinetic_j(i as usize, &motions[i as usize]))
                .sum(),
            Quantity::ElasticEnergy if self.of_all => balance.elastic_j(),
            Quantity::ElasticEnergy => self.over_bonds(state, 0.0, |sum, at, ends_in| {
                if state.bonds.is_broken(at) {
                    return sum;
                }
                sum + 0.5 * ends_in * state.bonds.forces(at, &p.poses).energy.total()
            }),
            Quantity::BrokenBonds => self.over_bonds(state, 0.0, |sum, at, _| {
                sum + f64::from(u8::from(state.bonds.is_broken(at)))
            }),
            Quantity::LargestUtilisation => self.over_bonds(state, 0.0, |largest: f64, at, _| {
                largest.max(bond_utilisation(state, at))
            }),
            Quantity::AngleOfRepose => {
                let down = nalgebra::Vector3::from(state.gravity_m_s2);
                let up = (-down)
                    .try_normalize(0.0)
                    .unwrap_or_else(nalgebra::Vector3::z);
                heap::angle_of_repose_rad(p, &self.particles, up)
            }
            // Of the particles on the wall.
            Quantity::Force(k) => wall.map_or(f64::NAN, |w| 0.0 - w.whole_push()[0][k as usize]),
            Quantity::Torque(k) => wall.map_or(f64::NAN, |w| 0.0 - w.whole_push()[1][k as usize]),
            Quantity::Count => {
                let clusters = state.clusters.as_ref();
                clusters.map_or(f64::NAN, |c| c.living().count() as f64)
            }
            Quantity::MassOfLargest => masses_kg.iter().copied().fold(0.0, f64::max),
            Quantity::MassFractionOfLargest => {
                masses_kg.iter().copied().fold(0.0, f64::max) / masses_kg.iter().sum::<f64>()
            }
        }
    }

    /// Goes through the bonds that have an end in the set, with the number of ends in it.
    fn over_bonds(&self, state: &State, start: f64, next: impl Fn(f64, usize, f64) -> f64) -> f64 {
        let mut is_in = vec![self.of_all; state.particles.len()];
        for &i in &self.particles {
            is_in[i as usize] = true;
        }
        let mut value = start;
        for (at, ends) in state.bonds.ends.iter().enumerate() {
            let ends_in = ends.iter().filter(|&&end| is_in[end as usize]).count();
            if ends_in > 0 {
                value = next(value, at, ends_in as f64);
            }
        }
        value
    }

    /// What it comes to at the end of a run.
    pub fn result(&self) -> Measured {
        let history = &self.history;
        let last = history.last.map_or(f64::NAN, |(_, value)| value);
        let value = match self.measure.at {
            At::End => last,
            At::Largest => history.largest.unwrap_or(f64::NAN),
            At::Smallest => history.smallest.unwrap_or(f64::NAN),
            At::Mean if history.duration_s > 0.0 => history.integral / history.duration_s,
            At::Mean => last,
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
            name: self.name.clone(),
            value,
            unit: self.unit().to_owned(),
            reference: self.measure.reference,
            error,
            tolerance: self.measure.tolerance,
        }
    }

    /// SI unit of its quantity; empty for plain numbers.
    pub fn unit(&self) -> &'static str {
        self.measure.quantity.dimension().si
    }
}

impl History {
    fn note(&mut self, time_s: f64, value: f64) {
        if let Some((before_s, before)) = self.last {
            self.integral += 0.5 * (value + before) * (time_s - before_s);
            self.duration_s += time_s - before_s;
        }
        self.last = Some((time_s, value));
        self.largest = Some(self.largest.map_or(value, |l| l.max(value)));
        self.smallest = Some(self.smallest.map_or(value, |s| s.min(value)));
    }
}

/// Mass of every cluster that is whole, kg.
fn masses_of_pieces_kg(state: &State) -> Vec<f64> {
    let Some(clusters) = &state.clusters else {
        return Vec::new();
    };
    let all = fragments(clusters, &state.particles, &state.clumps, None);
    all.iter().map(|fragment| fragment.mass_kg).collect()
}

/// What a bond carries: nothing if it is broken.
pub fn load(state: &State, at: usize) -> BondLoad {
    if state.bonds.is_broken(at) {
        return BondLoad::default();
    }
    state.bonds.forces(at, &state.particles.poses).load
}

/// Stress over strength of a bond, before any strengthening by rate; 0 for one that is broken or cannot break.
pub fn bond_utilisation(state: &State, at: usize) -> f64 {
    utilisation_under(state, at, &load(state, at))
}

/// The same under a load that is known.
pub fn utilisation_under(state: &State, at: usize, load: &BondLoad) -> f64 {
    let bonds = &state.bonds;
    match &bonds.rules[bonds.rule_of(at)].criteria {
        Some(criteria) if !bonds.is_broken(at) => {
            let stresses = stresses(load, bonds.radius_m(at));
            utilisation(criteria, &stresses, bonds.strength_factor(at))
        }
        _ => 0.0,
    }
}

fn mean_position(state: &State, particles: &[u32]) -> [f64; 3] {
    let count = particles.len().max(1) as f64;
    [0, 1, 2].map(|k| {
        let places = particles
            .iter()
            .map(|&i| state.particles.poses[i as usize].position_m[k]);
        places.sum::<f64>() / count
    })
}
