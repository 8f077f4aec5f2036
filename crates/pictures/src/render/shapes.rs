//! Balls, triangles and lines in view space, px.

use nalgebra::Vector3;

/// A ball in view space, px.
#[derive(Debug, Clone, Copy)]
pub(super) struct Body {
    pub(super) centre: Vector3<f32>,
    pub(super) radius: f32,
    pub(super) colour: [f32; 3],
    /// Visible fraction of the sky: the mean, and its gradient along each axis.
    pub(super) sky: [f32; 4],
}

/// A triangle in view space, px.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    pub(super) corners: [[f64; 3]; 3],
    /// Change of depth to the right and downwards.
    pub(super) slope: [f64; 2],
    /// Unit vector towards the viewer.
    pub(super) normal: Vector3<f32>,
    pub(super) colour: [f32; 3],
    pub(super) opacity: f32,
}

impl Face {
    pub(super) fn depth(&self, x: f64, y: f64) -> f64 {
        let [a, ..] = self.corners;
        a[2] + self.slope[0] * (x - a[0]) + self.slope[1] * (y - a[1])
    }

    pub(super) fn point(&self, x: f32, y: f32) -> Vector3<f32> {
        Vector3::new(x, y, self.depth(f64::from(x), f64::from(y)) as f32)
    }
}

/// A line in view space, px.
pub(super) type Line = [[f64; 3]; 2];

pub(super) fn range<const N: usize>(values: [f64; N]) -> [f64; 2] {
    let low = values.into_iter().fold(f64::INFINITY, f64::min);
    let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
    [low, high]
}

/// The x of the crossings between a row and a triangle: equal for both triangles on one edge.
pub(super) fn crossings(corners: &[[f64; 3]; 3], y: f64) -> [f64; 2] {
    let mut found = [f64::INFINITY, f64::NEG_INFINITY];
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let (a, b) = if a[1] < b[1] { (a, b) } else { (b, a) };
        if a[1] <= y && y < b[1] {
            let x = a[0] + (y - a[1]) * ((b[0] - a[0]) / (b[1] - a[1]));
            found = [found[0].min(x), found[1].max(x)];
        }
    }
    if found[0] <= found[1] {
        found
    } else {
        [0.0; 2]
    }
}
