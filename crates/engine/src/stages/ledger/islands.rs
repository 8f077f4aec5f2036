//! The energy of each island of pieces, found when the ledger of the whole is looked at.

use std::ops::Range;

use super::rounding::{all_kinds, pressed_j, stretched_j};
use crate::stages::bonds::energy_kernel::elastic_energy_of;
use crate::stages::contacts::bridges::bridge_energies_j;
use crate::stages::contacts::forces::{contact_energy_j, pairs_adhesion_j};
use crate::stages::walls::{touch_energy_j, touches_adhesion_j};
use crate::state::State;
use crate::state::clumps::Clump;
use crate::state::contacts::{ContactHistory, Contacts};
use crate::state::islands::{IslandSums, Islands};
use crate::state::particles::Motion;

/// An energy found by subtraction is at least this part of what it is subtracted from; below that
/// rounding would show.
const LEAST_REST: f64 = 1e-6;

/// Joins what is near a wall that moves, or whose surface does, with that wall.
pub(crate) fn join_at_moving_walls(contacts: &mut Contacts, state: &State) {
    let Some(clusters) = &state.clusters else {
        return;
    };
    for (number, wall) in (0..).zip(&state.walls).filter(|(_, wall)| wall.does_work()) {
        (contacts.islands).join_with(number, wall.near.iter().copied(), clusters);
    }
}

/// Looks at the energies of all islands, if there are several. `motions` of the free particles and
/// `clumps` are those at the time of the poses, `bonds_j` the elastic energy of all bonds.
pub(super) fn look_at_islands(
    state: &mut State,
    motions: &[Motion],
    clumps: &[Clump],
    bonds_j: f64,
) {
    let Some(contacts) = &mut state.contacts else {
        return;
    };
    if !contacts.islands.is_open() {
        return;
    }
    let mut islands = std::mem::take(&mut contacts.islands);
    let of_particle = names_of_particles(state, &mut islands);
    if of_particle.windows(2).any(|two| two[0] != two[1]) {
        let sums = Sums {
            state,
            of_particle: &of_particle,
            all: vec![IslandSums::default(); islands.len()],
        };
        let sums = sums.found(&mut islands, motions, clumps, bonds_j);
        islands.look(sums, |islands| floors_j(state, &of_particle, islands.len()));
    }
    if let Some(contacts) = &mut state.contacts {
        contacts.islands = islands;
    }
}

/// The island of each particle.
fn names_of_particles(state: &State, islands: &mut Islands) -> Vec<u32> {
    let Some(clusters) = &state.clusters else {
        return Vec::new();
    };
    let acting = islands.acting();
    let loaded = state.loads.iter().flat_map(|load| &load.particles).copied();
    let held = state.supports.iter().flat_map(|support| &support.held);
    let acted_on = loaded.chain(held.map(|held| held.particle));
    islands.join_with(acting, acted_on, clusters);
    let ids = clusters.of_particle.iter();
    ids.map(|id| islands.of_piece(*id)).collect()
}

/// For each island an energy below which all is rounding, J.
fn floors_j(state: &State, of_particle: &[u32], count: usize) -> Vec<f64> {
    let mut floors_j = vec![0.0; count];
    for (at, [first, _]) in state.bonds.ends.iter().enumerate() {
        floors_j[of_particle[*first as usize] as usize] += stretched_j(state, at);
    }
    if let Some(contacts) = &state.contacts {
        let kinds = all_kinds(contacts, &state.walls);
        for (i, name) in of_particle.iter().enumerate() {
            floors_j[*name as usize] += pressed_j(state, &kinds, i);
        }
    }
    floors_j
}

/// The sums of each island, while they are found.
struct Sums<'a> {
    state: &'a State,
    of_particle: &'a [u32],
    all: Vec<IslandSums>,
}

impl Sums<'_> {
    fn found(
        mut self,
        islands: &mut Islands,
        motions: &[Motion],
        clumps: &[Clump],
        bonds_j: f64,
    ) -> Vec<IslandSums> {
        self.add_particles(motions);
        self.add_clumps(clumps);
        self.add_bonds(bonds_j);
        self.add_contacts();
        for (particle, energy_j) in bridge_energies_j(self.state) {
            self.of(particle).attraction_j += energy_j;
        }
        for (island, lost_j) in islands.losses_at_walls() {
            self.all[island as usize].lost_j += lost_j;
        }
        for (number, wall) in (0..).zip(&self.state.walls) {
            // Those who ride on it are not in the sums.
            let work_j = wall.work_j - wall.ridden.work_j;
            self.all[islands.of_set(number) as usize].work_j += work_j;
        }
        let work = &self.state.ledger.work;
        let acting = islands.acting();
        self.all[islands.of_set(acting) as usize].work_j += work.loads + work.supports;
        self.add_names(islands);
        let all_lose = self.state.bridges.is_some() || self.state.model.particle_damping > 0.0;
        for of in &mut self.all {
            of.loses_more |= all_lose;
        }
        self.all
    }

    fn of(&mut self, particle: u32) -> &mut IslandSums {
        &mut self.all[self.of_particle[particle as usize] as usize]
    }

    /// Potential energy in gravity, J.
    fn height_j(&self, mass_kg: f64, place_m: [f64; 3]) -> f64 {
        let (g, about_m) = (self.state.model.gravity_m_s2, self.state.ledger.about_m);
        let along = (0..3).map(|k| g[k] * (place_m[k] - about_m[k]));
        -mass_kg * along.sum::<f64>()
    }

    fn add_particles(&mut self, motions: &[Motion]) {
        let p = &self.state.particles;
        for (i, motion) in motions.iter().enumerate() {
            if p.sleeps(i) {
                continue;
            }
            let [x, y, z, _] = p.poses[i].position_m;
            let height_j = self.height_j(1.0 / p.motions[i].inverse_mass, [x, y, z]);
            let of = self.of(i as u32);
            of.key = of.key.wrapping_add(key_of(p.id(i)));
            of.held_j += p.kinetic_j(i, motion);
            of.height_j += height_j;
        }
    }

    fn add_clumps(&mut self, clumps: &[Clump]) {
        for clump in clumps.iter().filter(|clump| !clump.asleep) {
            let template = self.state.clumps.template(clump);
            let height_j = self.height_j(template.mass_kg, clump.place_m);
            let id = self.state.particles.id(clump.first as usize);
            let of = self.of(clump.first);
            // Not the number of its first sphere once that is free.
            of.key = of.key.wrapping_add(key_of(id).rotate_left(32));
            of.held_j += clump.kinetic_j(template);
            of.height_j += height_j;
        }
    }

    /// The island with the most bonds has what the others leave of the energy of all: most of a
    /// broken body is one piece, and its energy is known already.
    fn add_bonds(&mut self, all_j: f64) {
        let runs = self.runs_of_bonds();
        let mut counts = vec![0; self.all.len()];
        for (island, run) in &runs {
            counts[*island] += run.len();
            self.all[*island].loses_more = true;
        }
        let largest = (0..counts.len()).max_by_key(|island| counts[*island]);
        let mut rest_j = all_j;
        let (own, others): (Vec<_>, Vec<_>) =
            (runs.into_iter()).partition(|(island, _)| Some(*island) == largest);
        for (island, run) in others {
            let energy_j = elastic_energy_of(self.state, run).total();
            self.all[island].held_j += energy_j;
            rest_j -= energy_j;
        }
        if rest_j < LEAST_REST * all_j {
            rest_j = (own.into_iter())
                .map(|(_, run)| elastic_energy_of(self.state, run).total())
                .sum();
        }
        if let Some(island) = largest {
            self.all[island].held_j += rest_j;
        }
    }

    /// Bonds that follow each other in one island: the island, and their numbers.
    fn runs_of_bonds(&self) -> Vec<(usize, Range<usize>)> {
        let ends = &self.state.bonds.ends;
        let mut runs: Vec<(usize, Range<usize>)> = Vec::new();
        for (at, [first, _]) in ends.iter().enumerate() {
            let island = self.of_particle[*first as usize] as usize;
            match runs.last_mut() {
                Some((same, run)) if *same == island => run.end = at + 1,
                _ => runs.push((island, at..at + 1)),
            }
        }
        runs
    }

    fn add_contacts(&mut self) {
        let Some(contacts) = &self.state.contacts else {
            return;
        };
        let p = &self.state.particles;
        for (at, (pair, history)) in contacts.pairs.iter().zip(&contacts.histories).enumerate() {
            if *history == ContactHistory::default() {
                continue;
            }
            let energy_j = contact_energy_j(contacts, p, at);
            let adhesion_j = pairs_adhesion_j(contacts, p, [(pair, history)].into_iter());
            self.add_contact(pair[0], energy_j, adhesion_j);
        }
        for wall in &self.state.walls {
            for touch in &wall.touching {
                let energy_j = touch_energy_j(wall, contacts, p, touch);
                let adhesion_j = touches_adhesion_j(wall, contacts, p, [touch].into_iter());
                self.add_contact(touch.particle, energy_j, adhesion_j);
            }
        }
        for (i, [friction_j, damping_j]) in (0..).zip(&contacts.lost_j) {
            self.of(i).lost_j += friction_j + damping_j;
        }
    }

    fn add_contact(&mut self, particle: u32, energy_j: f64, adhesion_j: f64) {
        let of = self.of(particle);
        of.held_j += energy_j - adhesion_j;
        of.attraction_j += adhesion_j;
    }

    /// Adds the bodies and the first piece of each.
    fn add_names(&mut self, islands: &mut Islands) {
        let Some(clusters) = &self.state.clusters else {
            return;
        };
        for id in clusters.living() {
            let of = &mut self.all[islands.of_piece(id) as usize];
            let body = clusters.history[id as usize].body;
            if of.bodies.is_empty() {
                of.piece = id;
            }
            if !of.bodies.contains(&body) {
                of.bodies.push(body);
            }
        }
    }
}

/// A number for an object of this number, such that sums of them hardly agree by chance.
fn key_of(id: u32) -> u64 {
    (u64::from(id) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15)
}
