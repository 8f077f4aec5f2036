//! Walls: their position and motion, their contacts and the resulting loads.

use std::sync::Arc;

use dem_scene::WallMotion;
use serde::{Deserialize, Serialize};

use super::renumbered::{NewNumbers, Renumbered};

pub use dem_physics::contact::history::WallContact;
use dem_physics::contact::law::ContactKind;
use dem_physics::contact::patch_book::{WallBook, WallBookModel};
use dem_physics::geometry::{Bounds, Frame, Shape};
pub use dem_physics::wall_load::WallLoad;

/// Definition of a wall in the scene.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct WallModel {
    /// Its name in the scene.
    pub name: String,
    /// Shape in its own frame, whose origin is the pivot.
    pub shape: Shape,
    /// Its motion.
    pub motion: WallMotion,
    /// Velocity of a belt, m/s. Length 3.
    pub surface_velocity_m_s: [f64; 3],
    /// Contact type with each material: numbers in `kinds`. Length materials.
    pub kind_of: Vec<u8>,
    /// Types of contacts.
    pub kinds: Vec<ContactKind>,
    /// How its loads are booked. None: they are not.
    pub book: Option<WallBookModel>,
}

/// A wall of the scene, with its present position and motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Wall {
    /// Its definition, that of the model.
    #[serde(skip)]
    pub model: Arc<WallModel>,
    /// Its present position.
    pub frame: Frame,
    /// Velocity of the pivot in the step just made and in the next, m/s.
    pub velocities_m_s: [[f64; 3]; 2],
    /// Spin in the step just made and in the next, rad/s.
    pub spins_rad_s: [[f64; 3]; 2],
    /// Particles near it, ascending.
    pub near: Vec<u32>,
    /// Contacts, by particle and then by feature.
    pub touching: Vec<WallContact>,
    /// Its load on the particles that touch it.
    pub push: WallLoad,
    /// Its load on sleeping particles that touch it, which is not in `push`.
    pub load_by_sleepers: WallLoad,
    /// Sum of the stiffnesses of its contacts along their normals, N/m.
    pub stiffness_n_m: f64,
    /// Energy lost to friction so far, J.
    pub friction_j: f64,
    /// Energy lost to damping so far, J.
    pub damping_j: f64,
    /// Work on the particles up to the present, and in the next half step, J.
    pub work_j: f64,
    /// See `work_j`.
    pub pending_j: f64,
    /// Its work on sleeping bodies that ride on it.
    pub ridden: Ridden,
    /// What contacts have done to its patches. None: not asked for.
    pub book: Option<Box<WallBook>>,
    /// Distance that the wall may move before its near particles are listed again, m.
    #[serde(skip)]
    pub skin_left_m: f64,
    /// Distance that it moved in the previous step, m.
    #[serde(skip)]
    pub moved_m: f64,
    /// Data valid for one step only.
    #[serde(skip)]
    pub scratch: WallScratch,
}

/// Work of a wall on the sleeping bodies that ride on it: it holds them against gravity.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Ridden {
    /// W.
    pub power_w: f64,
    /// The part of the work of the wall up to the present that they had, J.
    pub work_j: f64,
    /// Their work in the next half step, J.
    pub pending_j: f64,
}

/// Data of a wall valid for one step only.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WallScratch {
    /// The damping part of `push`.
    pub damping: WallLoad,
    /// Elastic energy of its contacts, J.
    pub elastic_j: f64,
    /// A particle whose centre has gone through its surface.
    pub crossed: Option<u32>,
}

impl Wall {
    /// Whether it moves, or its surface does.
    pub fn does_work(&self) -> bool {
        !matches!(self.model.motion, WallMotion::Fixed)
            || self.model.surface_velocity_m_s != [0.0; 3]
    }

    /// A wall without contacts.
    pub fn new(model: Arc<WallModel>, frame: Frame) -> Self {
        let book = model.book.as_ref();
        let book = book.map(|book| Box::new(WallBook::new(&book.patches, &model.shape)));
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
            ridden: Ridden::default(),
            book,
            skin_left_m: 0.0,
            moved_m: 0.0,
            scratch: WallScratch::default(),
        }
    }

    /// A wall at rest without contacts and without materials.
    pub fn standing(shape: Shape, frame: Frame) -> Self {
        let model = WallModel {
            shape,
            ..WallModel::default()
        };
        Self::new(Arc::new(model), frame)
    }

    /// Bounding box in space, m: infinite for a plane.
    pub fn bounds_in_space(&self) -> Bounds {
        if self.model.shape.plane().is_some() {
            return self.model.shape.bounds();
        }
        let corners = self.model.shape.bounds().corners();
        Bounds::of(corners.map(|corner| self.frame.to_space(corner)))
    }

    /// How its loads are booked, and the books. None: they are not.
    pub fn booked(&self) -> Option<(&WallBookModel, &WallBook)> {
        Some((self.model.book.as_ref()?, self.book.as_deref()?))
    }

    /// Force, N, and torque about the pivot, N m, on all particles that touch it, awake or asleep.
    pub fn total_load(&self) -> [[f64; 3]; 2] {
        let (awake, asleep) = (&self.push, &self.load_by_sleepers);
        let sum = |a: &[f64; 3], b: &[f64; 3]| [0, 1, 2].map(|k| a[k] + b[k]);
        [
            sum(&awake.force_n, &asleep.force_n),
            sum(&awake.torque_n_m, &asleep.torque_n_m),
        ]
    }

    /// Contact type with the material of this number, for which there must be one.
    pub fn kind(&self, material: u8) -> &ContactKind {
        &self.model.kinds[usize::from(self.model.kind_of[usize::from(material)])]
    }
}

impl Renumbered for Wall {
    fn renumber(&mut self, by: &NewNumbers<'_>) {
        self.touching.retain_mut(|touch| {
            let Some(now) = by.of(touch.particle) else {
                return false;
            };
            let less_m = by.less_m(touch.particle);
            if less_m > 0.0 {
                touch.history.tangential[3] = (touch.history.overlap_m() - less_m).max(0.0);
            }
            touch.particle = now;
            true
        });
        self.touching.sort_by_key(|touch| touch.particle);
    }
}
