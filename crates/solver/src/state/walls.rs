//! Walls: where they stand, how they move, what touches them and what that does to them.

use std::sync::Arc;

use dem_scene::WallMotion;
use serde::{Deserialize, Serialize};

use super::contacts::ContactHistory;
use crate::geometry::{Bounds, Frame, Shape};
use crate::physics::contact::law::ContactKind;

/// What the scene says of a wall.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct WallModel {
    /// Its name in the scene.
    pub name: String,
    /// In its own frame, whose origin is the pivot.
    pub shape: Shape,
    /// How it moves.
    pub motion: WallMotion,
    /// Velocity of a belt, m/s. Length 3.
    pub surface_velocity_m_s: [f64; 3],
    /// How it meets each material: numbers in `kinds`. Length materials.
    pub kind_of: Vec<u8>,
    /// Kinds of contacts.
    pub kinds: Vec<ContactKind>,
}

/// A wall of the scene, as it stands and moves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Wall {
    /// What the scene says of it: that of the model.
    #[serde(skip)]
    pub model: Arc<WallModel>,
    /// Where it stands now.
    pub frame: Frame,
    /// Velocity of the pivot in the step just made and in the one to come, m/s.
    pub velocities_m_s: [[f64; 3]; 2],
    /// Spin in the step just made and in the one to come, rad/s.
    pub spins_rad_s: [[f64; 3]; 2],
    /// Particles that are near, rising.
    pub near: Vec<u32>,
    /// What touches it, by particle and then by feature.
    pub touching: Vec<WallContact>,
    /// What it does to the particles that touch it.
    pub push: WallLoad,
    /// What it does to the particles that touch it and sleep, which are not among those.
    pub load_by_sleepers: WallLoad,
    /// Stiffness of its contacts along their normals, together, N/m.
    pub stiffness_n_m: f64,
    /// Energy that friction took so far, J.
    pub friction_j: f64,
    /// Energy that damping took so far, J.
    pub damping_j: f64,
    /// Work that it did on the particles up to the present, and in the half step to come, J.
    pub work_j: f64,
    /// See `work_j`.
    pub pending_j: f64,
    /// What holds for one step only.
    #[serde(skip)]
    pub scratch: WallScratch,
}

/// What holds of a wall for one step only.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WallScratch {
    /// The part of its push which is damping.
    pub damping: WallLoad,
    /// Elastic energy of its contacts, J.
    pub elastic_j: f64,
    /// A particle whose centre has gone through its surface.
    pub crossed: Option<u32>,
}

impl Wall {
    /// A wall that nothing touches yet.
    pub fn new(model: Arc<WallModel>, frame: Frame) -> Self {
        Self {
            model,
            frame,
            velocities_m_s: [[0.0; 3]; 2],
            spins_rad_s: [[0.0; 3]; 2],
            near: Vec::new(),
            touching: Vec::new(),
            push: WallLoad::default(),
            load_by_sleepers: WallLoad::default(),
            stiffness_n_m: 0.0,
            friction_j: 0.0,
            damping_j: 0.0,
            work_j: 0.0,
            pending_j: 0.0,
            scratch: WallScratch::default(),
        }
    }

    /// A wall that stands still and that nothing touches, of no material.
    pub fn standing(shape: Shape, frame: Frame) -> Self {
        let model = WallModel {
            shape,
            ..WallModel::default()
        };
        Self::new(Arc::new(model), frame)
    }

    /// Box around it in space, m: without end for a plane.
    pub fn bounds_in_space(&self) -> Bounds {
        if matches!(self.model.shape, Shape::Plane(_)) {
            return self.model.shape.bounds();
        }
        let corners = self.model.shape.bounds().corners();
        Bounds::of(corners.map(|corner| self.frame.to_space(corner)))
    }

    /// Force, N, and torque about the pivot, N m, on all particles that touch it, be they awake or
    /// asleep.
    pub fn total_load(&self) -> [[f64; 3]; 2] {
        let (awake, asleep) = (&self.push, &self.load_by_sleepers);
        let sum = |a: &[f64; 3], b: &[f64; 3]| [0, 1, 2].map(|k| a[k] + b[k]);
        [
            sum(&awake.force_n, &asleep.force_n),
            sum(&awake.torque_n_m, &asleep.torque_n_m),
        ]
    }

    /// How it meets a material of this number, which it is known to meet.
    pub fn kind(&self, material: u8) -> &ContactKind {
        &self.model.kinds[usize::from(self.model.kind_of[usize::from(material)])]
    }
}

/// A particle that touches a wall, and what is remembered of it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WallContact {
    /// Which particle.
    pub particle: u32,
    /// Where on the wall: see [`crate::geometry::Touch`].
    pub feature: u32,
    /// Unit vector from the wall to the centre. Length 3.
    pub normal: [f64; 3],
    /// Springs, overlap and origin.
    pub history: ContactHistory,
}

/// What a wall does to the particles that touch it, together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct WallLoad {
    /// N.
    pub force_n: [f64; 3],
    /// About the wall's pivot, N m.
    pub torque_n_m: [f64; 3],
    /// Power that the surface velocity of a belt takes, W.
    pub belt_w: f64,
}

impl WallLoad {
    /// Adds a force, N, a torque about the pivot, N m, and a power of the belt, W.
    pub fn add(&mut self, force_n: [f64; 3], torque_n_m: [f64; 3], belt_w: f64) {
        for k in 0..3 {
            self.force_n[k] += force_n[k];
            self.torque_n_m[k] += torque_n_m[k];
        }
        self.belt_w += belt_w;
    }

    /// Power of the wall with the particles while it moves so, W.
    pub fn power_w(&self, velocity_m_s: [f64; 3], spin_rad_s: [f64; 3]) -> f64 {
        let moving: f64 = (0..3)
            .map(|k| self.force_n[k] * velocity_m_s[k] + self.torque_n_m[k] * spin_rad_s[k])
            .sum();
        moving + self.belt_w
    }
}
