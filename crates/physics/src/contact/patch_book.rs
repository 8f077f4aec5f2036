//! What contacts have done to the patches of a wall: impulses, works and wear.
//!
//! Forces act for the length of a kick, so that impulses are those of the particles but for
//! rounding. Works and ways are those of the step just made, with the mean of the forces at its two
//! ends, as all losses of contacts.
//!
//! Archard's law (Archard 1953): the volume worn off is the wear constant K/H times the normal force
//! times the way that the surfaces slide along each other, V = (K/H) int F_n |v_t| dt.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::geometry::patches::Patches;
use crate::geometry::{Frame, Shape};

/// What one contact does to a wall in a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PatchStep {
    /// Force on the wall, N, along axes that turn with it. Length 3.
    pub force_n: [f64; 3],
    /// Force on the wall along the normal into it after the step, N; below 0: the particle pulls.
    pub normal_n: f64,
    /// The same before the step, N.
    pub normal_before_n: f64,
    /// Magnitude of the force across the normal, N.
    pub tangential_n: f64,
    /// Growth of the overlap in the step, m.
    pub closing_m: f64,
    /// Way of the particle's surface along that of the wall in the step, m.
    pub slid_m: f64,
    /// Energy lost to friction and to damping in the step, J.
    pub lost_j: [f64; 2],
}

impl PatchStep {
    /// The force, N, of a wall in this position on a particle, with the normal out of the wall, as
    /// a force on the wall, and nothing else.
    pub fn of(frame: &Frame, force: Vector3<f64>, normal: Vector3<f64>) -> Self {
        let normal_n = force.dot(&normal);
        Self {
            force_n: frame.direction_to_wall((-force).into()),
            normal_n,
            normal_before_n: normal_n,
            tangential_n: (force - normal * normal_n).norm(),
            ..Self::default()
        }
    }
}

/// Sums of [`PatchStep`]s.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct PatchBook {
    /// Impulse on the wall, N s, along axes that turn with it. Length 3.
    pub impulse_n_s: [f64; 3],
    /// Impulse along the normal into the wall, N s; what pulls counts negative.
    pub normal_impulse_n_s: f64,
    /// Sum of the magnitudes of the impulses across the normal, N s.
    pub tangential_impulse_n_s: f64,
    /// Work of the normal force while overlaps grow, J: the kinetic energy of the approach that
    /// impacts take up.
    pub impact_j: f64,
    /// Energy lost to friction, J.
    pub friction_j: f64,
    /// Energy lost to damping of the contact, J.
    pub damping_j: f64,
    /// Normal force times the way of the surfaces along each other, int F_n |v_t| dt, N m.
    pub sliding_load_n_m: f64,
}

impl PatchBook {
    /// Adds what a contact has done in a step before a kick of `kick_s`, s.
    pub fn add(&mut self, step: &PatchStep, kick_s: f64) {
        let mean_n = 0.5 * (step.normal_before_n.max(0.0) + step.normal_n.max(0.0));
        self.add_all(&Self {
            impulse_n_s: step.force_n.map(|force_n| kick_s * force_n),
            normal_impulse_n_s: kick_s * step.normal_n,
            tangential_impulse_n_s: kick_s * step.tangential_n,
            impact_j: mean_n * step.closing_m.max(0.0),
            friction_j: step.lost_j[0],
            damping_j: step.lost_j[1],
            sliding_load_n_m: mean_n * step.slid_m,
        });
    }

    /// Adds the sums of another book.
    pub fn add_all(&mut self, other: &Self) {
        for k in 0..3 {
            self.impulse_n_s[k] += other.impulse_n_s[k];
        }
        self.normal_impulse_n_s += other.normal_impulse_n_s;
        self.tangential_impulse_n_s += other.tangential_impulse_n_s;
        self.impact_j += other.impact_j;
        self.friction_j += other.friction_j;
        self.damping_j += other.damping_j;
        self.sliding_load_n_m += other.sliding_load_n_m;
    }

    /// Volume worn off by Archard's law with the wear constant K/H, 1/Pa: m3.
    pub fn wear_m3(&self, wear_constant_1_pa: f64) -> f64 {
        wear_constant_1_pa * self.sliding_load_n_m
    }
}

/// How the loads of a wall are booked.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct WallBookModel {
    /// Its patches.
    pub patches: Patches,
    /// Archard's wear constant K/H, 1/Pa.
    pub wear_constant_1_pa: f64,
    /// Place of the wall at the start.
    pub start: Frame,
}

impl WallBookModel {
    /// Number of the patch at a point of the surface of a wall in this position, m, with the normal
    /// into the wall, both in space.
    pub fn patch_at(&self, shape: &Shape, now: &Frame, point: [f64; 3], inward: [f64; 3]) -> u64 {
        let inward = now.direction_to_wall(inward);
        self.patches.at(shape, now.to_wall(point), inward)
    }
}

/// The books of the patches of a wall.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct WallBook {
    /// In the order of their numbers; of a plane in the order in which they were first touched.
    books: Vec<PatchBook>,
    /// For each touched square of a plane its place in `books`. None: another shape.
    squares: Option<BTreeMap<u64, u32>>,
}

impl WallBook {
    /// Empty books of the patches of a shape.
    pub fn new(patches: &Patches, shape: &Shape) -> Self {
        let count = patches.count(shape);
        Self {
            books: vec![PatchBook::default(); count.unwrap_or(0) as usize],
            squares: count.is_none().then(BTreeMap::new),
        }
    }

    /// The book of the patch of this number.
    pub fn of(&mut self, number: u64) -> &mut PatchBook {
        let place = match &mut self.squares {
            None => number as usize,
            Some(squares) => {
                let next = self.books.len() as u32;
                let place = *squares.entry(number).or_insert(next);
                if place == next {
                    self.books.push(PatchBook::default());
                }
                place as usize
            }
        };
        &mut self.books[place]
    }

    /// The patches by their numbers, rising; of a plane those that have been touched.
    pub fn patches(&self) -> Vec<(u64, &PatchBook)> {
        match &self.squares {
            None => (0..).zip(&self.books).collect(),
            Some(squares) => (squares.iter())
                .map(|(number, place)| (*number, &self.books[*place as usize]))
                .collect(),
        }
    }

    /// The sums over all patches.
    pub fn total(&self) -> PatchBook {
        let mut total = PatchBook::default();
        self.books.iter().for_each(|book| total.add_all(book));
        total
    }

    /// Bytes of its arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.books[..])
    }
}
