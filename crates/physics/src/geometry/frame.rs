//! Position and orientation of a wall.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::touch::Touch;

/// Place and orientation of a wall's own frame in space.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Its origin, m. Length 3.
    pub position_m: [f64; 3],
    /// Its rotation as a unit quaternion x, y, z, w. Length 4.
    pub turned: [f64; 4],
}

impl Default for Frame {
    fn default() -> Self {
        Self {
            position_m: [0.0; 3],
            turned: [0.0, 0.0, 0.0, 1.0],
        }
    }
}

impl Frame {
    fn rotation(&self) -> UnitQuaternion<f64> {
        let [x, y, z, w] = self.turned;
        UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
    }

    /// A point in space in the wall's frame, m.
    pub fn to_wall(&self, point: [f64; 3]) -> [f64; 3] {
        let from_origin = Vector3::from(point) - Vector3::from(self.position_m);
        self.rotation()
            .inverse_transform_vector(&from_origin)
            .into()
    }

    /// As [`Self::to_wall`], for many points.
    pub fn all_to_wall(&self) -> impl Fn([f64; 3]) -> [f64; 3] + use<> {
        let rotation = self.rotation().inverse().to_rotation_matrix();
        let origin = Vector3::from(self.position_m);
        move |point| (rotation * (Vector3::from(point) - origin)).into()
    }

    /// A point of the wall's frame in space, m.
    pub fn to_space(&self, point: [f64; 3]) -> [f64; 3] {
        (Vector3::from(self.direction_to_space(point)) + Vector3::from(self.position_m)).into()
    }

    /// A vector of the wall's frame in space.
    pub fn direction_to_space(&self, vector: [f64; 3]) -> [f64; 3] {
        (self.rotation() * Vector3::from(vector)).into()
    }

    /// A vector in space in the wall's frame.
    pub fn direction_to_wall(&self, vector: [f64; 3]) -> [f64; 3] {
        self.rotation()
            .inverse_transform_vector(&Vector3::from(vector))
            .into()
    }

    /// A touch found in the wall's frame, in space.
    pub fn touch_to_space(&self, touch: &Touch) -> Touch {
        Touch {
            point: self.to_space(touch.point),
            normal: self.direction_to_space(touch.normal),
            ..*touch
        }
    }
}
