//! Surfaces that carry bodies: walls that keep their velocity and do not turn, and the flat faces of
//! belts.

use dem_scene::WallMotion;
use nalgebra::Vector3;

use super::motion::planned;
use crate::state::particles::Pose;
use crate::state::walls::Wall;
use dem_physics::geometry::{Bounds, Shape};

/// A belt whose velocity along the normal of a face is less than this part of it is parallel to it.
const PARALLEL: f64 = 1e-6;
/// What the feature of a face of a box has for each axis: see [`dem_physics::geometry::SolidBox`].
const STRIDES: [u32; 3] = [1, 3, 9];

/// Velocity of a wall that does not turn, m/s, if it is the same in the previous step and in that
/// which begins at `time_s` and has this length, s.
pub(crate) fn steady_velocity_m_s(
    wall: &Wall,
    [time_s, time_step_s]: [f64; 2],
) -> Option<[f64; 3]> {
    if let WallMotion::Servo { .. } | WallMotion::Bar { .. } | WallMotion::Weight { .. } =
        wall.model.motion
    {
        return None;
    }
    let [velocity, spin] = planned(wall, time_s, [time_step_s; 2]);
    let is_steady =
        [wall.spins_rad_s[0], spin] == [[0.0; 3]; 2] && velocity == wall.velocities_m_s[0];
    // A table of displacements gives velocities with rounding errors.
    let is_exact = velocity == [0.0; 3] || matches!(wall.model.motion, WallMotion::Velocity { .. });
    (is_steady && is_exact).then_some(velocity)
}

/// Whether its surface moves along itself.
pub(crate) fn is_belt(wall: &Wall) -> bool {
    wall.model.surface_velocity_m_s != [0.0; 3]
}

/// Velocity of bodies at rest on a wall with this velocity, m/s. None: it is a belt without a flat
/// face along which it moves.
pub(crate) fn carrying_velocity_m_s(wall: &Wall, velocity_m_s: [f64; 3]) -> Option<[f64; 3]> {
    if !is_belt(wall) {
        return Some(velocity_m_s);
    }
    let normals = faces_along(wall);
    let mut along = Vector3::from(wall.model.surface_velocity_m_s);
    for normal in &normals {
        along -= normal * along.dot(normal);
    }
    (!normals.is_empty()).then(|| (Vector3::from(velocity_m_s) + along).into())
}

/// Normals in space of the flat faces along which the surface of a belt moves, one for each pair of
/// opposite ones: of planes and boxes only.
fn faces_along(wall: &Wall) -> Vec<Vector3<f64>> {
    let belt = Vector3::from(wall.model.surface_velocity_m_s);
    let normals = match &wall.model.shape {
        Shape::Plane(plane) => vec![plane.normal()],
        Shape::Box(_) => vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        _ => Vec::new(),
    };
    let in_space = normals.into_iter();
    let in_space = in_space.map(|normal| Vector3::from(wall.frame.direction_to_space(normal)));
    let is_along = |normal: &Vector3<f64>| belt.dot(normal).abs() <= PARALLEL * belt.norm();
    in_space.filter(is_along).collect()
}

/// A flat face of a belt.
pub(crate) struct BeltFace {
    to_wall: Box<dyn Fn([f64; 3]) -> [f64; 3]>,
    /// Of a box: its ends, the axis across the face, and whether the face is the upper one. None: a
    /// plane.
    of_box: Option<(Bounds, usize, bool)>,
    /// Velocity of its surface along the axes of the wall, m/s.
    along_m_s: [f64; 3],
}

impl BeltFace {
    /// None: this feature of a belt is not a flat face along which it moves.
    pub(crate) fn of(wall: &Wall, feature: u32) -> Option<Self> {
        let of_box = match &wall.model.shape {
            Shape::Plane(_) => None,
            Shape::Box(solid) => {
                let side = |k: usize| feature / STRIDES[k] % 3;
                let mut across = (0..3).filter(|&k| side(k) != 1);
                let (Some(axis), None) = (across.next(), across.next()) else {
                    return None;
                };
                Some((solid.bounds(), axis, side(axis) == 2))
            }
            _ => return None,
        };
        let belt = Vector3::from(wall.model.surface_velocity_m_s);
        let along_m_s = [0, 1, 2].map(|k| {
            let axis = wall.frame.direction_to_space(Vector3::ith(k, 1.0).into());
            belt.dot(&Vector3::from(axis))
        });
        let is_along = |k: usize| along_m_s[k].abs() <= PARALLEL * belt.norm();
        if of_box.is_some_and(|(_, axis, _)| !is_along(axis)) {
            return None;
        }
        Some(Self {
            to_wall: Box::new(wall.frame.all_to_wall()),
            of_box,
            along_m_s,
        })
    }

    /// Time for which the belt can carry a sphere, s, until its centre is beyond the edge of the
    /// face; infinite if it cannot come to touch the wall. None: it is beside the face and could
    /// come to touch the edge.
    pub(crate) fn carries_s(&self, pose: &Pose) -> Option<f64> {
        let Some((bounds, axis, is_upper)) = &self.of_box else {
            return Some(f64::INFINITY);
        };
        let centre = (self.to_wall)(pose.place().into());
        let height_m = match is_upper {
            true => centre[*axis] - bounds.high[*axis],
            false => bounds.low[*axis] - centre[*axis],
        };
        if height_m >= pose.radius_m() {
            return Some(f64::INFINITY);
        }
        let beside = || (0..3).filter(|k| k != axis);
        let is_over = |k: usize| (bounds.low[k]..=bounds.high[k]).contains(&centre[k]);
        if height_m <= 0.0 || !beside().all(is_over) {
            return None;
        }
        let until_s = beside().map(|k| match self.along_m_s[k] {
            along if along > 0.0 => (bounds.high[k] - centre[k]) / along,
            along if along < 0.0 => (bounds.low[k] - centre[k]) / along,
            _ => f64::INFINITY,
        });
        Some(until_s.fold(f64::INFINITY, f64::min))
    }
}
