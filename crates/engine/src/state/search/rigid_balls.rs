//! Rigid bodies in the neighbour search: the balls of a clump follow from its template and from
//! where the clump was.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use crate::state::clumps::Template;
use dem_physics::geometry::Bounds;
use dem_physics::geometry::balls::{BLOCK, Ball, Blocks, NOWHERE};
use dem_physics::rotation::rotation;

/// A clump at the last search for its neighbours.
#[derive(Debug, Clone, Copy, Default)]
pub struct ClumpReference {
    /// Centre of mass, m. Length 3.
    pub place_m: [f64; 3],
    /// Rotation: unit quaternion x, y, z, w.
    pub turned: [f64; 4],
    /// Distance that each of its spheres may move, m.
    pub allowance_m: f64,
    /// What is left of it, m, at least.
    pub left_m: f64,
}

/// The outer spheres of a template along its principal axes, without allowance.
#[derive(Debug, Clone)]
pub struct RigidBalls {
    /// Boxes around them.
    pub(crate) blocks: Arc<Blocks>,
    /// The balls of each block by columns, x, y, z and radius, m, filled up with [`NOWHERE`].
    pub(crate) columns: Vec<[[f64; BLOCK]; 4]>,
    /// Number of balls.
    count: usize,
    /// Largest radius, m.
    pub(crate) largest_m: f64,
}

/// Where a large clump was at its last search.
#[derive(Debug, Clone)]
pub struct RigidBody {
    /// Number of the clump.
    pub(crate) clump: usize,
    /// The balls of its template.
    pub(crate) balls: Arc<RigidBalls>,
    /// From its axes to space.
    pub(crate) to_space: Placement,
    /// What is added to each radius, m.
    pub(crate) allowance_m: f64,
}

/// How points in the axes of one body are found in those of another, or in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Placement {
    /// Rotation.
    pub(crate) turned: Matrix3<f64>,
    /// Where the origin comes to lie, m.
    pub(crate) place_m: Vector3<f64>,
}

impl RigidBalls {
    pub(crate) fn new(template: &Template) -> Self {
        let ball = |&sphere: &u32| -> Ball {
            let sphere = &template.spheres[sphere as usize];
            let [x, y, z] = sphere.place_m;
            [x, y, z, sphere.radius_m * template.scale]
        };
        let balls: Vec<Ball> = template.outer.iter().map(ball).collect();
        let by_columns = |some: &[Ball]| {
            [0, 1, 2, 3].map(|k| std::array::from_fn(|lane| some.get(lane).unwrap_or(&NOWHERE)[k]))
        };
        Self {
            blocks: Arc::new(Blocks::of(&balls)),
            columns: balls.chunks(BLOCK).map(by_columns).collect(),
            count: balls.len(),
            largest_m: template.largest_m(),
        }
    }
}

impl RigidBody {
    pub(crate) fn new(clump: usize, balls: Arc<RigidBalls>) -> Self {
        Self {
            clump,
            balls,
            to_space: Placement::NONE,
            allowance_m: 0.0,
        }
    }

    /// Puts it where the clump was at its search.
    pub(crate) fn put_at(&mut self, reference: &ClumpReference) {
        self.to_space = Placement {
            turned: *rotation(reference.turned).to_rotation_matrix().matrix(),
            place_m: reference.place_m.into(),
        };
        self.allowance_m = reference.allowance_m;
    }

    /// A ball of a block, in space.
    pub(crate) fn ball(&self, block: usize, lane: usize) -> Ball {
        self.in_space(&self.balls.columns[block].map(|column| column[lane]))
    }

    /// Calls `found` with the place, in the order of its balls, of each that is nearer to a plane
    /// than `margin_m`, with the allowance. The plane: a point, m, and its unit normal, in space.
    pub(crate) fn each_near_plane(
        &self,
        [point, normal]: [Vector3<f64>; 2],
        margin_m: f64,
        mut found: impl FnMut(usize),
    ) {
        // In its own axes only the distance from its centre along the normal matters.
        let level_m = (point - self.to_space.place_m).dot(&normal) + margin_m + self.allowance_m;
        let normal = self.to_space.turned.tr_mul(&normal);
        let lowest_m =
            |[x, y, z, radius_m]: Ball| normal.x * x + normal.y * y + normal.z * z - radius_m;
        for (block, &ball) in self.balls.blocks.around.iter().enumerate() {
            if lowest_m(ball) < level_m {
                let columns = &self.balls.columns[block];
                let is_near: [bool; BLOCK] = std::array::from_fn(|lane| {
                    lowest_m([0, 1, 2, 3].map(|k| columns[k][lane])) < level_m
                });
                let left = self.balls.count - block * BLOCK;
                let places = (block * BLOCK..).zip(is_near).take(left);
                let near = places.filter(|(_, is_near)| *is_near);
                near.for_each(|(place, _)| found(place));
            }
        }
    }

    /// A ball of its axes in space, with the allowance.
    pub(crate) fn in_space(&self, &[x, y, z, radius_m]: &Ball) -> Ball {
        let [x, y, z] = self.to_space.point(&Vector3::new(x, y, z)).into();
        [x, y, z, radius_m + self.allowance_m]
    }
}

impl Placement {
    /// Points stay where they are.
    pub(crate) const NONE: Self = Self {
        turned: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        place_m: Vector3::new(0.0, 0.0, 0.0),
    };

    pub(crate) fn point(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.place_m + self.turned * point
    }

    /// The box around a box, larger by `margin_m` on every side.
    pub(crate) fn of_box(&self, &Bounds { low, high }: &Bounds, margin_m: f64) -> Bounds {
        let [low, high] = [low, high].map(Vector3::from);
        let centre = self.point(&(0.5 * (low + high)));
        let half = self.turned.abs() * (0.5 * (high - low)) + Vector3::repeat(margin_m);
        Bounds {
            low: (centre - half).into(),
            high: (centre + half).into(),
        }
    }

    /// The same as this in the axes that `axes` brings to space.
    pub(crate) fn seen_from(&self, axes: &Self) -> Self {
        let back = axes.turned.transpose();
        Self {
            turned: back * self.turned,
            place_m: back * (self.place_m - axes.place_m),
        }
    }
}
