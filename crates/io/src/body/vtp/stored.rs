//! The arrays of a .vtp file as a frame of a run, its particles or its walls.

use std::collections::BTreeMap;
use std::io::BufRead;

use super::read::particles_and_bonds;
use super::shapes::{CORNERS, POSITIONS, of_cells, of_frame, of_points, of_walls};
use crate::body::parts::Parts;
use crate::body::stored_frame::{self as frame, NO_FRAME, StoredFrame};
use crate::body::stored_particles::StoredParticles;
use crate::body::stored_walls::{FIXED_WALLS, StoredWalls, WALL, WALL_FORCES, WALL_NAMES};
use crate::diagnostic::{Diagnostic, Result};
use crate::disjoint::DisjointSets;
use crate::vtp::{Arrays, DAMAGED, Reader, check_count};

/// Reads the fragments of a frame of a run.
///
/// # Errors
/// Damaged or cut off, compressed, wrong counts, or an array of fragments is missing.
pub(crate) fn read_frame(input: &mut dyn BufRead) -> Result<StoredFrame> {
    let (mut arrays, parts) = frame_of(input)?;
    let missing = |name: &str| {
        Diagnostic::input(
            "",
            format!("no body can be made from this frame: there is no array '{name}'"),
            "run the scene again with this version of dem-run, which writes it",
        )
    };
    let clusters = arrays.take_indices(&of_points(frame::FRAGMENT_ID))?;
    let rigid = arrays.take_indices(&of_points(frame::RIGID))?;
    let broken = broken(&mut arrays).ok_or_else(|| missing(frame::BROKEN))?;
    let mut number = |key: String, name: &str| arrays.take(&key).ok_or_else(|| missing(name));
    let radii = number(of_points(frame::RADIUS), frame::RADIUS)?;
    let densities_kg_m3 = number(of_points(frame::DENSITY), frame::DENSITY)?;
    Ok(StoredFrame {
        time_s: arrays
            .float(frame::TIME)
            .ok_or_else(|| missing(frame::TIME))?,
        turns_rad: (!parts.turns_rad.is_empty()).then_some(parts.turns_rad),
        // Where nothing can break, frames name no fragments.
        clusters: clusters.unwrap_or_else(|| pieces(parts.positions.len(), &parts.bonds, &broken)),
        rigid: (rigid.unwrap_or_default().into_iter())
            .map(|rigid| rigid != 0)
            .collect(),
        positions: parts.positions,
        radii,
        densities_kg_m3,
        bonds: parts.bonds,
        bond_radii: (parts.bond_radii).ok_or_else(|| missing(frame::BOND_RADIUS))?,
        bond_lengths: (parts.bond_lengths).ok_or_else(|| missing(frame::BOND_LENGTH))?,
        bond_directions: parts.bond_directions,
        broken,
        damages: parts.bond_damages,
        histories: parts.bond_histories,
    })
}

/// Reads the particles and bonds of a frame of any run.
///
/// # Errors
/// Damaged or cut off, compressed, wrong counts, or an array is missing.
pub(crate) fn read_particles(input: &mut dyn BufRead) -> Result<StoredParticles> {
    let (mut arrays, parts) = frame_of(input)?;
    let missing = |name: &str| {
        let problem = format!("{NO_FRAME}: there is no array '{name}'");
        Diagnostic::input("", problem, "run the scene again with this program")
    };
    let velocities = arrays.take(&of_points(frame::VELOCITY));
    let velocities = velocities.ok_or_else(|| missing(frame::VELOCITY))?;
    let broken = broken(&mut arrays).ok_or_else(|| missing(frame::BROKEN))?;
    let bodies = arrays.take_indices(&of_points(frame::BODY))?;
    let ids = arrays.take_indices(&of_points(frame::PARTICLE_ID))?;
    let radii = arrays.take(&of_points(frame::RADIUS));
    Ok(StoredParticles {
        time_s: arrays
            .float(frame::TIME)
            .ok_or_else(|| missing(frame::TIME))?,
        body_names: arrays.texts(frame::BODY_NAMES)?,
        bodies: bodies.ok_or_else(|| missing(frame::BODY))?,
        ids: ids.ok_or_else(|| missing(frame::PARTICLE_ID))?,
        positions: parts.positions,
        radii: radii.ok_or_else(|| missing(frame::RADIUS))?,
        velocities_m_s: velocities.as_chunks().0.to_vec(),
        fragments: arrays.take_indices(&of_points(frame::FRAGMENT_ID))?,
        densities_kg_m3: arrays.take(&of_points(frame::DENSITY)),
        bonds: parts.bonds,
        bond_radii: (parts.bond_radii).ok_or_else(|| missing(frame::BOND_RADIUS))?,
        broken,
    })
}

/// Reads the walls of a frame of a run.
///
/// # Errors
/// Damaged or cut off, compressed, wrong counts.
pub(crate) fn read_walls(input: &mut dyn BufRead) -> Result<StoredWalls> {
    let mut arrays = Reader::open(input, &of_walls)?.read()?;
    let counts = arrays.counts();
    let corners = arrays.take_indices(CORNERS)?.unwrap_or_default();
    let walls = StoredWalls {
        time_s: arrays.float(frame::TIME).unwrap_or(0.0),
        names: arrays.texts(WALL_NAMES)?,
        forces_n: arrays.floats(WALL_FORCES).as_chunks().0.to_vec(),
        points_m: arrays.take_vectors(POSITIONS),
        triangles: corners.as_chunks().0.to_vec(),
        wall_of_triangle: arrays.take_indices(&of_cells(WALL))?.unwrap_or_default(),
        has_fixed: arrays.has_field(FIXED_WALLS),
    };
    let found = [
        (walls.points_m.len(), counts.points, "points"),
        (walls.triangles.len(), counts.cells_after, "triangles"),
        (walls.wall_of_triangle.len(), counts.cells_after, "values"),
        (walls.forces_n.len(), walls.names.len() as u64, "forces"),
    ];
    for (count, wanted, what) in found {
        check_count(count as u64, wanted.into(), what)?;
    }
    Ok(walls)
}

/// The arrays of a frame, and its particles and bonds, whose particles exist.
fn frame_of(input: &mut dyn BufRead) -> Result<(Arrays, Parts)> {
    let mut arrays = Reader::open(input, &of_frame)?.read()?;
    let parts = particles_and_bonds(&mut arrays)?;
    let particles = parts.positions.len();
    let mut ends = parts.bonds.as_flattened().iter();
    match ends.find(|end| **end as usize >= particles) {
        None => Ok((arrays, parts)),
        Some(end) => {
            let problem = format!("a bond joins particle {end}, but there are {particles}");
            Err(Diagnostic::input("", problem, DAMAGED))
        }
    }
}

/// Whether each bond is broken.
fn broken(arrays: &mut Arrays) -> Option<Vec<bool>> {
    let broken = arrays.take(&of_cells(frame::BROKEN))?;
    Some(broken.into_iter().map(|broken| broken != 0.0).collect())
}

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
