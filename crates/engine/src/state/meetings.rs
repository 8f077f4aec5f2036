//! Where particles meet a wall in a step, and the forces there: kept from step to step for their
//! memory only.

use std::ops::Range;

use nalgebra::Vector3;

use super::particles::Pose;
use super::walls::WallContact;
use dem_physics::geometry::{Place, Touch};

/// What some of the particles near a wall meet. Valid for one step.
#[derive(Debug, Clone, Default)]
pub struct Meetings {
    /// The wall's number, and the range of these particles in its list of those near.
    pub of: (usize, Range<usize>),
    /// Where one particle touches the wall.
    pub touches: Vec<Touch>,
    /// In the order of the particles.
    pub all: Vec<Meeting>,
    /// The interactions. Length as `all`.
    pub met: Vec<Met>,
}

/// A particle at a point of a wall.
#[derive(Debug, Clone, Copy)]
pub struct Meeting {
    /// Its number.
    pub particle: u32,
    /// In space.
    pub there: Touch,
    /// Number of the contact that it continues, of the same wall or of `old_wall`.
    pub old: Option<u32>,
    /// The wall from which the particle has moved over. None: it has not.
    pub old_wall: Option<u32>,
    /// Whether another meeting stands for the same surface, so that this one does not count.
    pub is_double: bool,
    /// Whether the particle has gone through a wall thinner than itself.
    pub is_behind: bool,
}

impl Meeting {
    /// One that has not gone through the wall.
    pub fn new(particle: u32, there: Touch, old: Option<u32>) -> Self {
        Self {
            particle,
            there,
            old,
            old_wall: None,
            is_double: false,
            is_behind: false,
        }
    }

    /// A contact that has ended, with its number among those of its wall: its losses are still to
    /// be recorded.
    pub fn ended(old: &WallContact, pose: &Pose, number: u32) -> Self {
        let there = Touch {
            point: pose.place().into(),
            feature: old.feature,
            normal: old.normal.map(|n| -n),
            distance_m: pose.radius_m(),
        };
        Self::new(old.particle, there, Some(number))
    }
}

/// A meeting of a particle that touches several walls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Joint {
    /// Number of the particle.
    pub particle: u32,
    /// Number of the wall.
    pub wall: usize,
    /// Number of the chunk of meetings.
    pub chunk: usize,
    /// Number of the meeting in the chunk.
    pub at: usize,
}

/// A touch of a sphere with a wall: the wall, the place, and whether it continues a contact.
pub(crate) type WallTouch = (usize, Place, bool);

/// Vectors of the search for walls that meet, kept from step to step for their memory only.
#[derive(Debug, Clone, Default)]
pub(crate) struct JointBuffers {
    /// Meetings of particles that touch several walls.
    pub(crate) joints: Vec<Joint>,
    /// The first chunk of meetings of each touched wall, and the one after its last.
    pub(crate) of_walls: Vec<[usize; 2]>,
    /// The touches of one sphere.
    pub(crate) touches: Vec<WallTouch>,
    /// Those of them that are yet to be compared.
    pub(crate) left: Vec<usize>,
    /// Of those that stand for one surface, the one kept and one dropped.
    pub(crate) doubles: Vec<(usize, usize)>,
}

/// Interaction of a particle and a wall at one point.
#[derive(Debug, Clone, Copy)]
pub struct Met {
    /// The contact.
    pub touch: WallContact,
    /// Point of contact, m.
    pub point: Vector3<f64>,
    /// Velocity of the belt there, m/s.
    pub belt: Vector3<f64>,
    /// Force on the particle and its damping part, N.
    pub forces: [Vector3<f64>; 2],
    /// Torque on the particle, N m.
    pub torque: Vector3<f64>,
    /// Moment of rolling friction on the particle and its damping part, N m.
    pub moments: [Vector3<f64>; 2],
    /// Energy stored, J.
    pub elastic_j: f64,
    /// Energy lost to friction and to damping in the step just made, J.
    pub lost_j: [f64; 2],
    /// Whether the centre of the particle has gone through the surface.
    pub crossed: bool,
    /// Stiffness along the normal, N/m.
    pub stiffness_n_m: f64,
}
