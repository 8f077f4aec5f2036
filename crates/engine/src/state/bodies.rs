//! Particles and bonds of each body of the scene, by the numbers of its file.

use serde::{Deserialize, Serialize};

use super::clumps::Clumps;
use super::events::{NewCluster, REMOVED, Renumbering};

/// Particles and bonds of a body in the state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlacedBody {
    /// Its name in the scene.
    pub name: String,
    /// The number of its clump among the clusters. None: it was there from the start.
    pub came_as: Option<u32>,
    /// First of its particles in the state.
    pub first_particle: usize,
    /// For each particle of the body's file, in order: its number in the state, or `REMOVED`.
    pub particles: Vec<u32>,
    /// First of its bonds in the state.
    pub first_bond: usize,
    /// For each bond of the body in the state, in order: its number in the body's file.
    pub bonds: Vec<u32>,
}

impl PlacedBody {
    /// Number in the body's file of a particle of the state.
    pub fn number_of(&self, particle: u32) -> Option<u32> {
        let number = self.particles.iter().position(|&i| i == particle)?;
        Some(number as u32)
    }

    /// A clump that has become a cluster.
    pub fn created(created: &NewCluster) -> Self {
        let template = &created.template;
        let mut particles = vec![REMOVED; template.spheres.len()];
        for (i, &number) in (created.first_particle as u32..).zip(template.file_number.iter()) {
            particles[number as usize] = i;
        }
        Self {
            name: template.body.clone(),
            came_as: Some(created.clump.cluster),
            first_particle: created.first_particle,
            particles,
            first_bond: created.first_bond,
            bonds: template.bonds_of_file.to_vec(),
        }
    }
}

/// Bodies under the new numbers, with new bodies and without those of which nothing remains.
pub fn renumber(bodies: &mut Vec<PlacedBody>, by: &Renumbering) {
    bodies.retain_mut(|body| {
        for particle in body.particles.iter_mut().filter(|p| **p != REMOVED) {
            *particle = by.particles[*particle as usize];
            if *particle >= by.free {
                *particle = REMOVED;
            }
        }
        let mut first_bond = None;
        let mut at = body.first_bond;
        body.bonds.retain(|_| {
            let now = by.bonds[at];
            at += 1;
            if now != REMOVED {
                first_bond.get_or_insert(now as usize);
            }
            now != REMOVED
        });
        body.first_bond = first_bond.unwrap_or(0);
        let left = body.particles.iter().filter(|p| **p != REMOVED);
        let first = left.min();
        body.first_particle = first.map_or(0, |first| *first as usize);
        first.is_some()
    });
    bodies.extend(by.created.iter().map(PlacedBody::created));
}

/// The body of a bond of the state, and the bond's number in that body's file.
pub fn bond_of_file(bodies: &[PlacedBody], at: usize) -> Option<(&PlacedBody, u32)> {
    bodies.iter().find_map(|body| {
        let number = body.bonds.get(at.checked_sub(body.first_bond)?)?;
        Some((body, *number))
    })
}

/// Human-readable name of a particle of the state, by its number in the body's file. Several bodies
/// of one name are told apart by the fragments as which they came.
pub fn called(bodies: &[PlacedBody], clumps: &Clumps, particle: u32) -> String {
    let of_bodies = bodies.iter().find_map(|body| {
        let number = body.number_of(particle)?;
        Some((number, &body.name, body.came_as))
    });
    let of_clumps = || {
        clumps.all.iter().find_map(|clump| {
            let template = clumps.template(clump);
            let own = particle.checked_sub(clump.first)?;
            let sphere = *template.outer.get(own as usize)?;
            let number = template.file_number[sphere as usize];
            Some((number, &template.body, Some(clump.cluster)))
        })
    };
    let Some((number, name, came_as)) = of_bodies.or_else(of_clumps) else {
        return format!("particle {particle}");
    };
    let names = bodies.iter().map(|body| &body.name);
    let of_clumps = clumps.all.iter().map(|clump| &clumps.template(clump).body);
    let is_single = names.chain(of_clumps).filter(|one| *one == name).count() == 1;
    match came_as.filter(|_| !is_single) {
        Some(fragment) => {
            format!("particle {number} of the body '{name}' that came as fragment {fragment}")
        }
        None => format!("particle {number} of the body '{name}'"),
    }
}
