//! Quantities that a run monitors besides its measures: what was touched, and extremes.

use std::collections::BTreeSet;

use dem_scene::Scene;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::breaks::Breaks;
use super::rigid_hits::RigidHits;
use super::taken_in::Taken;
use dem_engine::check::validity::{LARGEST_INDENTATION, LARGEST_STRAIN};
use dem_engine::stages::bonds::forces::{
    edge_strain, most_strained, most_strained_edge, most_yielded,
};
use dem_engine::state::State;
use dem_engine::state::bodies::{PlacedBody, called};
use dem_engine::state::events::{PopulationEvent, REMOVED, STARTS_BONDED};
use dem_physics::contact::kinematics::indentation;

/// The largest value of a quantity, and where it occurred.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Extreme {
    /// The value.
    pub(super) largest: f64,
    pub(super) time_s: f64,
    /// m. Length 3.
    pub(super) place_m: [f64; 3],
    /// The objects concerned, in words; empty within the range of validity of the laws.
    pub(super) between: String,
}

/// Quantities monitored so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Monitors {
    /// Names of bodies that something has touched.
    pub(super) touched: BTreeSet<String>,
    /// Numbers of walls that something has touched.
    touched_walls: BTreeSet<usize>,
    /// Largest ratio of overlap to the smaller radius.
    pub(super) largest_overlap: f64,
    /// Depth to which a contact presses in its smaller sphere, over the radius of this sphere.
    pub(super) indentation: Extreme,
    /// Strain at the edge of a bond.
    pub(super) bond_strain: Extreme,
    /// Plastic strain at the edge of a bond.
    pub(super) plastic_strain: Extreme,
    /// Hits that rigid clumps could not break by.
    pub(super) rigid_hits: RigidHits,
    /// Energies that particles took in.
    pub(super) taken: Taken,
    /// Names of bodies with a clump that was replaced.
    pub(super) replaced: BTreeSet<String>,
    /// Names of bodies that an inlet has fed.
    pub(super) came: BTreeSet<String>,
    /// Time of the last bond breakage, s.
    pub(super) last_break_s: Option<f64>,
    /// Broken bonds over time.
    pub(super) breaks: Breaks,
    /// Largest kinetic energy at a row of the time series, J.
    pub(super) largest_kinetic_j: f64,
    /// Largest force of standing walls on all that touches them, N.
    pub(super) largest_stand_n: f64,
    /// Whether these walls have ever exerted no force.
    pub(super) stood_free: bool,
    /// Of a test whose answers are those at its largest load: this load, N, and the extremes at it,
    /// of strain, plastic strain and indentation.
    pub(super) at_peak: Option<(f64, [Extreme; 3])>,
}

impl Monitors {
    /// Records the bonds that have broken in this step, and the strains of those that broke at
    /// their strength.
    pub(super) fn note_breaks(&mut self, state: &State, bodies: &[PlacedBody]) {
        let broken = state.scratch.events.broken.len();
        if broken > 0 {
            self.last_break_s = Some(state.time_s);
            self.breaks.note(state.time_s, broken);
        }
        for broken in &state.scratch.events.broken {
            let at = broken.bond as usize;
            if state.bonds.was_damaged(at) {
                continue;
            }
            self.note_strain(
                edge_strain(&state.bonds, at, &state.particles.poses),
                at,
                state,
                bodies,
            );
        }
    }

    /// Records the clumps that have been replaced.
    pub(super) fn note_population(&mut self, happened: &[PopulationEvent]) {
        for one in happened {
            if let PopulationEvent::Replaced { body, cause, .. } = one
                && *cause != STARTS_BONDED
            {
                self.replaced.insert(body.clone());
            }
            if let PopulationEvent::Broken {
                body,
                specific_j_kg,
                ..
            } = one
            {
                self.taken.note_broken(body, *specific_j_kg);
                // Something pressed it, maybe for a few steps only.
                self.touched.insert(body.clone());
                self.replaced.insert(body.clone());
            }
            if let PopulationEvent::Came { body, .. } = one {
                self.came.insert(body.clone());
            }
        }
    }

    /// Records that the largest load of a test has been this so far, N.
    pub(super) fn note_peak(&mut self, largest_n: f64) {
        if self
            .at_peak
            .as_ref()
            .is_none_or(|(before_n, _)| largest_n > *before_n)
        {
            self.at_peak = Some((largest_n, self.extremes().map(Extreme::clone)));
        }
    }

    /// The extremes of strain, plastic strain and indentation so far.
    pub(super) fn extremes(&self) -> [&Extreme; 3] {
        [&self.bond_strain, &self.plastic_strain, &self.indentation]
    }

    /// Records the force of standing walls.
    pub(super) fn note_stand(&mut self, state: &State) {
        let force_n = stand_n(state);
        self.largest_stand_n = self.largest_stand_n.max(force_n);
        self.stood_free |= force_n == 0.0;
    }

    /// Records the kinetic energy, J.
    pub(super) fn note_kinetic(&mut self, kinetic_j: f64) {
        self.largest_kinetic_j = self.largest_kinetic_j.max(kinetic_j);
    }

    /// Whether nothing has touched some body yet.
    pub(super) fn misses_one(&self, scene: &Scene) -> bool {
        self.touched.len() < scene.bodies.len()
    }

    /// Checks contacts and their overlaps. Cheap enough for every eighth step.
    pub(super) fn look_at_contacts(&mut self, state: &State, scene: &Scene, bodies: &[PlacedBody]) {
        let Some(contacts) = &state.contacts else {
            return;
        };
        let p = &state.particles;
        let radius = |i: u32| p.poses[i as usize].radius_m();
        let misses_one = self.misses_one(scene);
        let mut touching = Vec::new();
        // Particle and wall, or two particles.
        let mut deepest: Option<(f64, u32, Result<usize, u32>)> = None;
        let mut largest_overlap = self.largest_overlap;
        let mut take = |overlap_m: f64, a: u32, other: Result<usize, u32>| {
            let [small_m, large_m] = match other {
                Ok(_) => [radius(a), f64::INFINITY],
                Err(b) => [radius(a).min(radius(b)), radius(a).max(radius(b))],
            };
            largest_overlap = largest_overlap.max(overlap_m / small_m);
            let indentation = indentation(overlap_m, small_m, large_m);
            if indentation > deepest.map_or(self.indentation.largest, |(largest, ..)| largest) {
                deepest = Some((indentation, a, other));
            }
        };
        for (n, wall) in state.walls.iter().enumerate() {
            for touch in &wall.touching {
                let overlap_m = touch.history.overlap_m();
                take(overlap_m, touch.particle, Ok(n));
                if overlap_m > 0.0 {
                    self.touched_walls.insert(n);
                    if misses_one {
                        touching.push(touch.particle);
                    }
                }
            }
        }
        for partition in state
            .contact_partitions()
            .iter()
            .filter(|partition| partition.computed > 0)
        {
            for at in partition.close.iter().flat_map(|[_, own]| own) {
                let overlap_m = contacts.histories[*at as usize].overlap_m();
                if overlap_m > 0.0 {
                    let [a, b] = contacts.pairs[*at as usize];
                    take(overlap_m, a, Err(b));
                    if misses_one {
                        touching.extend([a, b]);
                    }
                }
            }
        }
        self.largest_overlap = largest_overlap;
        if let Some((ratio, a, other)) = deepest {
            let between = if ratio > LARGEST_INDENTATION {
                let other = match other {
                    Ok(wall) => format!("the wall '{}'", state.walls[wall].model.name),
                    Err(b) => called(bodies, &state.clumps, b),
                };
                format!("{} and {other}", called(bodies, &state.clumps, a))
            } else {
                String::new()
            };
            self.indentation = Extreme {
                largest: ratio,
                time_s: state.time_s,
                place_m: p.poses[a as usize].place().into(),
                between,
            };
        }
        if !touching.is_empty() {
            self.note_touched(state, bodies, touching);
        }
    }

    fn note_touched(&mut self, state: &State, bodies: &[PlacedBody], mut touching: Vec<u32>) {
        touching.sort_unstable();
        touching.dedup();
        let is_touched = |i: &u32| touching.binary_search(i).is_ok();
        for body in bodies {
            let mut living = body.particles.iter().filter(|i| **i != REMOVED);
            if !self.touched.contains(&body.name) && living.any(is_touched) {
                self.touched.insert(body.name.clone());
            }
        }
        for clump in &state.clumps.all {
            let name = &state.clumps.template(clump).body;
            let mut spheres = state.clumps.spheres_of(clump);
            if !self.touched.contains(name) && spheres.any(|i| is_touched(&(i as u32))) {
                self.touched.insert(name.clone());
            }
        }
    }

    /// Checks elongation and compression of bonds. Returns the largest present elongation.
    pub(super) fn look_at_bonds(&mut self, state: &State, bodies: &[PlacedBody]) -> f64 {
        let Some((strain, at)) = most_strained(&state.bonds, &state.particles.poses) else {
            return 0.0;
        };
        if !state.bonds.was_damaged(at) && !state.bonds.has_yielded(at) {
            self.note_strain(strain, at, state, bodies);
        }
        strain
    }

    /// Checks strains at the edges of bonds, including bending and torsion.
    pub(super) fn look_at_edges(&mut self, state: &State, bodies: &[PlacedBody]) {
        if let Some((strain, at)) = most_strained_edge(&state.bonds, &state.particles.poses) {
            self.note_strain(strain, at, state, bodies);
        }
        if let Some((strain, at)) = most_yielded(&state.bonds)
            && strain > self.plastic_strain.largest
        {
            self.plastic_strain = extreme_of_bond(strain, at, state, bodies);
        }
    }

    fn note_strain(&mut self, strain: f64, at: usize, state: &State, bodies: &[PlacedBody]) {
        if strain > self.bond_strain.largest {
            self.bond_strain = extreme_of_bond(strain, at, state, bodies);
        }
    }

    /// Whether anything has touched the wall of this number.
    pub(super) fn has_touched_wall(&self, number: usize) -> bool {
        self.touched_walls.contains(&number)
    }

    /// Whether nothing has touched any wall.
    pub(super) fn has_touched_no_wall(&self) -> bool {
        self.touched_walls.is_empty()
    }

    /// Whether this is the name of a body of the scene that nothing has touched, of those that
    /// are looked at.
    pub(super) fn is_untouched(&self, scene: &Scene, name: &str) -> bool {
        scene.bodies.contains_key(name) && !self.touched.contains(name)
    }
}

/// Force of the walls that do not move on all that touches them, N.
pub(super) fn stand_n(state: &State) -> f64 {
    let standing = state.walls.iter().filter(|wall| !wall.does_work());
    let forces = standing.map(|wall| Vector3::from(wall.total_load()[0]));
    forces.sum::<Vector3<f64>>().norm()
}

/// The strain of a bond at this moment, and what it joins if that is beyond its law.
fn extreme_of_bond(strain: f64, at: usize, state: &State, bodies: &[PlacedBody]) -> Extreme {
    let p = &state.particles;
    let [a, b] = state.bonds.ends[at];
    let [place_a, place_b] = [a, b].map(|end| p.poses[end as usize].place());
    Extreme {
        largest: strain,
        time_s: state.time_s,
        place_m: (0.5 * (place_a + place_b)).into(),
        between: if strain > LARGEST_STRAIN {
            let [a, b] = [a, b].map(|end| called(bodies, &state.clumps, end));
            format!("{a} and {b}")
        } else {
            String::new()
        },
    }
}
