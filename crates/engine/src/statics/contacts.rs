//! Contacts of particles with walls at rest: normal forces that can open, without friction.
//!
//! Without friction a body slides and rolls on its pins at the slightest imbalance. Weak springs
//! across the normals hold it during a step of the load, and are released after it.

use nalgebra::Vector3;

use super::degrees_of_freedom::DegreesOfFreedom;
use super::matrix::Matrix;
use crate::stages::walls::joints::drop_doubles;
use crate::stages::walls::{list_near, wall_contact};
use crate::state::State;
use crate::state::contacts::Contacts;
use crate::state::particles::{Particles, Pose};
use crate::state::walls::Wall;
use dem_physics::geometry::{Frame, Touch};

/// A particle that touches a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallForce {
    /// Number of the particle.
    pub particle: usize,
    /// Number of the wall.
    pub wall: usize,
    /// Unit vector from the wall to the particle.
    pub normal: Vector3<f64>,
    /// Normal force, N.
    pub force_n: f64,
    /// Its derivative with respect to the overlap, N/m.
    pub stiffness_n_m: f64,
    /// Energy, J.
    pub energy_j: f64,
}

/// Walls with their initial places and their displacements during the test, m. Length 3 each.
#[derive(Debug, Clone)]
pub struct MovingWalls {
    walls: Vec<(Frame, Vector3<f64>)>,
}

impl MovingWalls {
    /// The walls of a state before its first step; those in `moving` are displaced by `way_m`.
    pub fn new(state: &State, moving: &[usize], way_m: Vector3<f64>) -> Self {
        let place = |(at, wall): (usize, &Wall)| {
            let moves = moving.contains(&at);
            (wall.frame, if moves { way_m } else { Vector3::zeros() })
        };
        Self {
            walls: state.walls.iter().enumerate().map(place).collect(),
        }
    }

    /// Moves the walls of the state to this fraction of their displacements, and lists the
    /// particles nearer to them than `skin_m`.
    pub fn place(&self, state: &mut State, fraction: f64, skin_m: f64) {
        for (wall, (start, way_m)) in state.walls.iter_mut().zip(&self.walls) {
            wall.frame = *start;
            let place = Vector3::from(start.position_m) + fraction * way_m;
            wall.frame.position_m = place.into();
        }
        list_near(&mut state.walls, &state.particles, skin_m);
    }
}

/// All contacts with walls of the particles at their present places, by wall and particle.
pub fn wall_forces(state: &State) -> Vec<WallForce> {
    let mut found: Vec<(u32, usize, Touch)> = Vec::new();
    let Some(contacts) = &state.contacts else {
        return Vec::new();
    };
    for (number, wall) in state.walls.iter().enumerate() {
        let to_wall = wall.frame.all_to_wall();
        let mut touches = Vec::new();
        for &particle in &wall.near {
            let pose = &state.particles.poses[particle as usize];
            touches.clear();
            let centre = to_wall(pose.place().into());
            wall.model
                .shape
                .touches(centre, pose.radius_m(), &mut touches);
            // One contact for each wall: the deepest.
            let deepest = touches
                .iter()
                .min_by(|a, b| a.distance_m.total_cmp(&b.distance_m));
            if let Some(touch) = deepest {
                found.push((particle, number, wall.frame.touch_to_space(touch)));
            }
        }
    }
    // Walls that meet are one surface.
    found.sort_by_key(|(particle, ..)| *particle);
    let mut kept = Vec::new();
    for own in found.chunk_by(|a, b| a.0 == b.0) {
        let mut touches: Vec<(usize, Touch)> = own.iter().map(|one| (one.1, one.2)).collect();
        let radius_m = state.particles.poses[own[0].0 as usize].radius_m();
        drop_doubles(&state.walls, &mut touches, radius_m);
        kept.extend(
            touches
                .into_iter()
                .map(|(wall, touch)| (own[0].0, wall, touch)),
        );
    }
    kept.sort_by_key(|(_, wall, _)| *wall);
    let force = |(particle, number, touch): &(u32, usize, Touch)| {
        let wall = (*number, &state.walls[*number]);
        at(wall, *particle as usize, touch, contacts, &state.particles)
    };
    kept.iter().map(force).collect()
}

fn at(
    (number, wall): (usize, &Wall),
    particle: usize,
    touch: &Touch,
    contacts: &Contacts,
    particles: &Particles,
) -> WallForce {
    let overlap_m = particles.poses[particle].radius_m() - touch.distance_m;
    let normal = -Vector3::from(touch.normal);
    let kinematics = wall_contact(particles, particle, &normal, overlap_m);
    let kind = wall.kind(contacts.materials[particle]);
    let [force_n, stiffness_n_m, energy_j] = kind.elastic(&kinematics);
    WallForce {
        particle,
        wall: number,
        normal,
        force_n,
        stiffness_n_m,
        energy_j,
    }
}

/// Ratio of the stiffness across the normal of a contact to that along it.
const ACROSS: f64 = 0.02;

impl WallForce {
    /// Force on the particle, N, at a place to which it has moved by `moved_m` since the contacts
    /// across the normal were without force.
    pub fn on_particle_n(&self, moved_m: &Vector3<f64>) -> Vector3<f64> {
        let across = moved_m - moved_m.dot(&self.normal) * self.normal;
        self.force_n * self.normal - ACROSS * self.stiffness_n_m * across
    }
}

/// Adds the stiffness of contacts, and of ground springs of `ground_n_m` at every particle, to a
/// symmetric matrix. Rotations have such springs here alone, and no torque from them: a row of
/// spheres can spin.
pub fn add_contacts(
    matrix: &mut Matrix,
    degrees_of_freedom: &DegreesOfFreedom,
    contacts: &[WallForce],
    poses: &[Pose],
    ground_n_m: f64,
) {
    for (unknown, pose) in degrees_of_freedom.unknown.iter().zip(poses) {
        for (k, &unknown) in unknown.iter().enumerate() {
            let arm_m = if k < 3 { 1.0 } else { pose.radius_m() };
            matrix.add_symmetric(unknown, unknown, ground_n_m * arm_m * arm_m);
        }
    }
    for contact in contacts {
        let unknown = &degrees_of_freedom.unknown[contact.particle];
        for row in 0..3 {
            for column in 0..3 {
                let along = contact.normal[row] * contact.normal[column];
                let across = f64::from(u8::from(row == column)) - along;
                let value = contact.stiffness_n_m * (along + ACROSS * across);
                matrix.add_symmetric(unknown[row], unknown[column], value);
            }
        }
    }
}
