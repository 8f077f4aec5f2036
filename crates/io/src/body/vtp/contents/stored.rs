//! The data of a .vtp file as a frame of a run, its particles or its walls.

use std::collections::BTreeMap;

use super::{Contents, OfFrame};
use crate::body::stored_frame::{self as frame, NO_FRAME, StoredFrame};
use crate::body::stored_particles::StoredParticles;
use crate::body::stored_walls::StoredWalls;
use crate::body::vtp::decode::DAMAGED;
use crate::body::vtp::numbers::check_count;
use crate::diagnostic::{Diagnostic, Result};
use crate::disjoint::DisjointSets;

/// For each particle the number of its piece, from 0 in the order of their first particles: what
/// bonds join that are not broken.
fn pieces(particles: usize, bonds: &[[u32; 2]], broken: &[bool]) -> Vec<u32> {
    let mut sets = DisjointSets::new(particles);
    for (&[a, b], _) in bonds.iter().zip(broken).filter(|(_, broken)| !**broken) {
        sets.join(a, b);
    }
    let mut number_of: BTreeMap<u32, u32> = BTreeMap::new();
    (0..particles as u32)
        .map(|i| {
            let next = number_of.len() as u32;
            *number_of.entry(sets.root(i)).or_insert(next)
        })
        .collect()
}

impl Contents {
    /// The frame, if all data of its fragments were present.
    pub(in super::super) fn into_frame(self) -> Result<StoredFrame> {
        self.check_counts()?;
        self.check_bond_ends()?;
        let missing = |name: &str| {
            Diagnostic::input(
                "",
                format!("no body can be made from this frame: there is no array '{name}'"),
                "run the scene again with this version of dem-run, which writes it",
            )
        };
        let OfFrame {
            time_s,
            clusters,
            densities,
            broken,
            rigid,
            ..
        } = self.of_frame;
        let parts = self.parts;
        let bonds = parts.bonds.len();
        let particles = parts.positions.len();
        let broken = broken.ok_or_else(|| missing(frame::BROKEN))?;
        let broken: Vec<bool> = broken.into_iter().map(|broken| broken != 0.0).collect();
        // Where nothing can break, frames name no fragments.
        let clusters = clusters.unwrap_or_else(|| pieces(particles, &parts.bonds, &broken));
        let turns_rad = (!parts.turns_rad.is_empty()).then_some(parts.turns_rad);
        Ok(StoredFrame {
            time_s: time_s.ok_or_else(|| missing(frame::TIME))?,
            turns_rad,
            clusters,
            rigid: rigid
                .unwrap_or_default()
                .into_iter()
                .map(|rigid| rigid != 0)
                .collect(),
            positions: parts.positions,
            radii: self.radii.ok_or_else(|| missing(frame::RADIUS))?,
            densities_kg_m3: densities.ok_or_else(|| missing(frame::DENSITY))?,
            bonds: parts.bonds,
            bond_radii: parts
                .bond_radii
                .ok_or_else(|| missing(frame::BOND_RADIUS))?,
            bond_lengths: parts
                .bond_lengths
                .ok_or_else(|| missing(frame::BOND_LENGTH))?,
            bond_directions: self.histories.directions(bonds),
            broken,
            sums: self.histories.sums(bonds),
            damages: parts.bond_damages,
            plastics: self.histories.plastics(bonds),
            joints: self.histories.joints(bonds),
        })
    }

    /// The particles and bonds of a frame of any run, if all their data were present.
    pub(in super::super) fn into_particles(self) -> Result<StoredParticles> {
        self.check_counts()?;
        self.check_bond_ends()?;
        let missing = |name: &str| {
            let problem = format!("{NO_FRAME}: there is no array '{name}'");
            Diagnostic::input("", problem, "run the scene again with this program")
        };
        let of_frame = self.of_frame;
        let velocities = of_frame
            .velocities
            .ok_or_else(|| missing(frame::VELOCITY))?;
        let broken = of_frame.broken.ok_or_else(|| missing(frame::BROKEN))?;
        let bond_radii = self.parts.bond_radii;
        Ok(StoredParticles {
            time_s: of_frame.time_s.ok_or_else(|| missing(frame::TIME))?,
            body_names: of_frame.body_names,
            bodies: of_frame.bodies.ok_or_else(|| missing(frame::BODY))?,
            ids: of_frame.ids.ok_or_else(|| missing(frame::PARTICLE_ID))?,
            positions: self.parts.positions,
            radii: self.radii.ok_or_else(|| missing(frame::RADIUS))?,
            velocities_m_s: velocities.as_chunks().0.to_vec(),
            fragments: of_frame.clusters,
            densities_kg_m3: of_frame.densities,
            bonds: self.parts.bonds,
            bond_radii: bond_radii.ok_or_else(|| missing(frame::BOND_RADIUS))?,
            broken: broken.into_iter().map(|broken| broken != 0.0).collect(),
        })
    }

    /// Checks that the particles of all bonds exist.
    fn check_bond_ends(&self) -> Result<()> {
        let particles = self.parts.positions.len();
        let mut ends = self.parts.bonds.as_flattened().iter();
        match ends.find(|end| **end as usize >= particles) {
            None => Ok(()),
            Some(end) => {
                let problem = format!("a bond joins particle {end}, but there are {particles}");
                Err(Diagnostic::input("", problem, DAMAGED))
            }
        }
    }

    /// The walls, if all their data were present.
    pub(in super::super) fn into_walls(self) -> Result<StoredWalls> {
        let (counts, walls) = (self.counts.unwrap_or_default(), self.walls);
        let found = [
            (self.parts.positions.len(), counts.points, "points"),
            (walls.triangles.len(), counts.cells_after, "triangles"),
            (walls.wall_of_triangle.len(), counts.cells_after, "values"),
            (walls.forces_n.len(), walls.names.len() as u64, "forces"),
        ];
        for (count, wanted, what) in found {
            check_count(count as u64, wanted.into(), what)?;
        }
        Ok(StoredWalls {
            time_s: self.of_frame.time_s.unwrap_or(0.0),
            points_m: self.parts.positions,
            ..walls
        })
    }
}
