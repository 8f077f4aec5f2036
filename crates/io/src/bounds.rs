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
    pub fn of(points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| {
            bounds.with(&Self {
                low: point,
                high: point,
            })
        })
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

    /// Whether a point lies within `reach` of the box, along each axis.
    pub fn is_near(&self, point: &[f64; 3], reach: f64) -> bool {
        (0..3).all(|k| point[k] >= self.low[k] - reach && point[k] <= self.high[k] + reach)
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

    /// Length of the diagonal, m.
    pub fn diagonal_m(&self) -> f64 {
        (Vector3::from(self.high) - Vector3::from(self.low)).norm()
    }
}
