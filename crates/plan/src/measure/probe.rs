//! A measure with its objects and its values so far.

use std::collections::BTreeMap;
use std::sync::Arc;

use dem_engine::state::watches::{History, part};
use dem_scene::Measure;
use nalgebra::{UnitQuaternion, Vector3};

use super::members::Members;
use super::starts::Starts;

/// A measure and its particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Its name in the scene.
    pub name: String,
    /// Its definition.
    pub measure: Measure,
    pub(super) members: Members,
    /// The particles of its second object, if that is not a wall.
    pub(super) with: Option<Members>,
    /// The walls among its two objects, by number.
    pub(super) walls: [Option<usize>; 2],
    /// The region to which it is restricted: number in the rules of the state.
    pub(super) region: Option<usize>,
    /// Mass over the volume of the shape of the body that it measures, kg/m3. NaN if not known.
    pub(super) solid_density_kg_m3: f64,
    /// Initial positions of the bodies of the scene. Empty if not needed.
    pub(super) starts: Arc<Starts>,
    /// Initial centre of mass of its particles, m. NaN if not needed.
    pub(super) start: Vector3<f64>,
    /// Initial rotations of those of its particles that were rotated. Empty if not needed.
    pub(super) turned_before: BTreeMap<u32, UnitQuaternion<f64>>,
    /// Its values so far.
    pub history: History,
}

impl Probe {
    /// The walls among its two objects, by number.
    pub fn walls(&self) -> [Option<usize>; 2] {
        self.walls
    }

    /// The particles of its first object, ascending, if that is not a wall.
    pub fn particles(&self) -> &[u32] {
        &self.members.particles
    }

    /// The part of a vector that it measures: a component or the magnitude.
    pub(super) fn part(&self, vector: &Vector3<f64>) -> f64 {
        part(vector, self.measure.part)
    }

    /// Unit of its quantity; empty for plain numbers.
    pub fn unit(&self) -> &'static str {
        self.measure.quantity.dimension.si
    }
}
