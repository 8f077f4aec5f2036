//! Boxes around points.

use nalgebra::Vector3;
use serde::Serialize;

/// A box with sides along the axes, m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bounds {
    /// Smallest coordinates; may be infinite. Length 3.
    pub low: [f64; 3],
    /// Largest coordinates; may be infinite. Length 3.
    pub high: [f64; 3],
}

impl Bounds {
    /// No point at all.
    pub const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// The smallest box around these points.
    pub fn of(points: impl IntoIterator<Item = impl Into<[f64; 3]>>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| {
            let point = point.into();
            bounds.with(&Self {
                low: point,
                high: point,
            })
        })
    }

    /// The box larger by `margin` on every side.
    #[must_use]
    pub fn grown(&self, margin: f64) -> Self {
        Self {
            low: self.low.map(|x| x - margin),
            high: self.high.map(|x| x + margin),
        }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            low: [0, 1, 2].map(|k| self.low[k].min(other.low[k])),
            high: [0, 1, 2].map(|k| self.high[k].max(other.high[k])),
        }
    }

    /// The largest box in both: [`Self::EMPTY`] where they have no point in common.
    #[must_use]
    pub fn common(&self, other: &Self) -> Self {
        let low = [0, 1, 2].map(|k| self.low[k].max(other.low[k]));
        let high = [0, 1, 2].map(|k| self.high[k].min(other.high[k]));
        if (0..3).all(|k| low[k] <= high[k]) {
            Self { low, high }
        } else {
            Self::EMPTY
        }
    }

    /// Whether the boxes have a point in common.
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }

    /// Whether a point lies within `reach` of the box, along each axis.
    pub fn is_near(&self, point: &[f64; 3], reach: f64) -> bool {
        (0..3).all(|k| point[k] >= self.low[k] - reach && point[k] <= self.high[k] + reach)
    }

    /// Distance of a point from the box, m; 0 inside.
    pub fn distance(&self, point: &[f64; 3]) -> f64 {
        let apart = [0, 1, 2].map(|k| {
            (self.low[k] - point[k])
                .max(point[k] - self.high[k])
                .max(0.0)
        });
        Vector3::from(apart).norm()
    }

    /// Distance between two boxes, m; 0 if they have a point in common.
    pub fn gap_m(&self, other: &Self) -> f64 {
        let apart = [0, 1, 2].map(|k| {
            let apart = (self.low[k] - other.high[k]).max(other.low[k] - self.high[k]);
            apart.max(0.0)
        });
        Vector3::from(apart).norm()
    }

    /// The box at another place.
    #[must_use]
    pub fn moved(&self, by: [f64; 3]) -> Self {
        Self {
            low: [0, 1, 2].map(|k| self.low[k] + by[k]),
            high: [0, 1, 2].map(|k| self.high[k] + by[k]),
        }
    }

    /// Time until the box, moving at this velocity, m/s, meets another, s: 0 if they have a point
    /// in common, infinite if they never have.
    pub fn meets_after_s(&self, velocity_m_s: [f64; 3], other: &Self) -> f64 {
        let (mut enters, mut leaves) = (0.0_f64, f64::INFINITY);
        for (k, along) in velocity_m_s.into_iter().enumerate() {
            let (low, high) = (other.low[k] - self.high[k], other.high[k] - self.low[k]);
            if along != 0.0 {
                enters = enters.max((low / along).min(high / along));
                leaves = leaves.min((low / along).max(high / along));
            } else if low > 0.0 || high < 0.0 {
                return f64::INFINITY;
            }
        }
        if enters <= leaves {
            enters
        } else {
            f64::INFINITY
        }
    }

    /// Whether a segment comes within `reach` of the box, along each axis.
    pub fn on_segment(&self, [start, end]: [Vector3<f64>; 2], reach: f64) -> bool {
        let (mut near, mut far) = (0.0_f64, 1.0_f64);
        for k in 0..3 {
            let low = self.low[k] - reach - start[k];
            let high = self.high[k] + reach - start[k];
            let along = end[k] - start[k];
            if along != 0.0 {
                near = near.max((low / along).min(high / along));
                far = far.min((low / along).max(high / along));
            } else if low > 0.0 || high < 0.0 {
                return false;
            }
        }
        near <= far
    }

    /// Whether the ray from `origin` meets the box; `inverse` is 1/direction, no component of it
    /// infinite.
    pub(crate) fn on_ray(&self, origin: &Vector3<f64>, inverse: &Vector3<f64>) -> bool {
        let (mut near, mut far) = (0.0_f64, f64::INFINITY);
        for k in 0..3 {
            let t1 = (self.low[k] - origin[k]) * inverse[k];
            let t2 = (self.high[k] - origin[k]) * inverse[k];
            near = near.max(t1.min(t2));
            far = far.min(t1.max(t2));
        }
        // A margin for rounding: a box that is flat along an axis must not be missed.
        near <= far + 1e-12 * (1.0 + far.abs())
    }

    /// The eight corners, m. Shape 8 x 3.
    pub fn corners(&self) -> [[f64; 3]; 8] {
        [0, 1, 2, 3, 4, 5, 6, 7].map(|corner| {
            [0, 1, 2].map(|k| match corner >> k & 1 {
                0 => self.low[k],
                _ => self.high[k],
            })
        })
    }

    /// Length of its longest side, m; 0 of no point at all.
    pub fn longest_side_m(&self) -> f64 {
        let sides = (0..3).map(|k| self.high[k] - self.low[k]);
        sides.fold(0.0, f64::max)
    }

    /// Length of the diagonal, m.
    pub fn diagonal_m(&self) -> f64 {
        (Vector3::from(self.high) - Vector3::from(self.low)).norm()
    }
}
