//! The camera: without perspective, so that one scale applies to the entire picture.

use dem_io::Bounds;
use nalgebra::Vector3;

use super::image::MAX_SIDE_PX;
use super::vector::unit;

/// Free margin at the left and the right, as a fraction of the width.
const SIDE: f64 = 0.04;
/// Free margin at the top, for the time, as a fraction of the height.
const TOP: f64 = 0.10;
/// Free margin at the bottom, for the scale bar, as a fraction of the height.
const BOTTOM: f64 = 0.12;

/// Direction of the three-quarter view if x runs across the picture: from the front, the right and
/// above.
const THREE_QUARTER: Vector3<f64> = Vector3::new(-0.42, 0.80, -0.43);

/// A side runs across the picture if it is longer than the other by this factor.
const LONGER: f64 = 1.01;

/// Points farther away than this are taken to be invalid, m.
const FARTHEST_M: f64 = 1e12;

/// A camera without perspective.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Unit vectors of the picture: to the right, up, and towards the viewer.
    axes: [Vector3<f64>; 3],
    /// The point in the middle of the picture, m.
    middle_m: Vector3<f64>,
    px_per_m: f64,
    size_px: [u32; 2],
    /// Depths of the nearest and the farthest point to which it was fitted, px.
    depth_px: [f64; 2],
}

impl Camera {
    /// The camera that looks in this direction and shows all these points, m, with `up` upwards in
    /// the picture. Shape n x 3. Tighter than around a box if walls are tilted.
    ///
    /// Directions may have any length. If they are invalid, the three-quarter view is used.
    /// `size_px`: width and height.
    pub fn around(
        direction: [f64; 3],
        up: [f64; 3],
        points_m: &[[f64; 3]],
        size_px: [u32; 2],
    ) -> Self {
        let size_px = size_px.map(|side| side.min(MAX_SIDE_PX));
        let axes = axes(direction.into(), up.into());
        let seen = sane(points_m).map(|p| axes.map(|axis| axis.dot(&Vector3::from(p))));
        let mut view = Bounds::of(seen);
        if !view.low.into_iter().all(f64::is_finite) {
            view = Bounds {
                low: [-0.5; 3],
                high: [0.5; 3],
            };
        }
        let [width, height] = size_px.map(|side| f64::from(side.max(1)));
        let extent = [0, 1].map(|k| view.high[k] - view.low[k]);
        let fits =
            (width * (1.0 - 2.0 * SIDE) / extent[0]).min(height * (1.0 - TOP - BOTTOM) / extent[1]);
        let px_per_m = if fits.is_normal() { fits } else { height };
        let [x, y, z] = [0, 1, 2].map(|k| 0.5 * (view.low[k] + view.high[k]));
        let y = y - 0.5 * (BOTTOM - TOP) * height / px_per_m;
        let [right, up, back] = axes;
        let middle_m = x * right + y * up + z * back;
        let depth_px = [view.low[2], view.high[2]].map(|depth| (depth - z) * px_per_m);
        Self {
            axes,
            middle_m,
            px_per_m,
            size_px,
            depth_px,
        }
    }

    /// The default view around points, m, shape n x 3: from the front, the right and above, the
    /// longer horizontal axis across the picture.
    pub fn three_quarter(points_m: &[[f64; 3]], size_px: [u32; 2]) -> Self {
        let direction = Self::three_quarter_direction(&Bounds::of(sane(points_m)));
        Self::around(direction, [0.0, 0.0, 1.0], points_m, size_px)
    }

    /// Its direction for what is in a box. Rounding does not decide between sides of one length.
    pub fn three_quarter_direction(bounds: &Bounds) -> [f64; 3] {
        let [x, y] = [0, 1].map(|k| bounds.high[k] - bounds.low[k]);
        three_quarter(y > LONGER * x).into()
    }

    /// Width and height of the picture, px.
    pub(crate) fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// The scale of the picture, px/m.
    pub fn px_per_m(&self) -> f64 {
        self.px_per_m
    }

    /// Position of a point, m, in the picture, px: from the left, from the top, and from the middle
    /// of the scene towards the viewer. Length 3.
    pub fn project(&self, point_m: [f64; 3]) -> [f64; 3] {
        let from = Vector3::from(point_m) - self.middle_m;
        let [x, y, z] = self.axes.map(|axis| axis.dot(&from) * self.px_per_m);
        let [width, height] = self.size_px.map(f64::from);
        [0.5 * width + x, 0.5 * height - y, z]
    }

    /// Depths of the farthest and the nearest point to which it was fitted, px.
    pub(crate) fn depth_px(&self) -> [f64; 2] {
        self.depth_px
    }
}

fn sane(points_m: &[[f64; 3]]) -> impl Iterator<Item = [f64; 3]> {
    let is_sane = |point: &[f64; 3]| point.iter().all(|x| x.abs() < FARTHEST_M);
    points_m.iter().copied().filter(is_sane)
}

fn three_quarter(is_y_longer: bool) -> Vector3<f64> {
    if is_y_longer {
        Vector3::new(-THREE_QUARTER.y, THREE_QUARTER.x, THREE_QUARTER.z)
    } else {
        THREE_QUARTER
    }
}

fn axes(direction: Vector3<f64>, up: Vector3<f64>) -> [Vector3<f64>; 3] {
    let ahead = unit(direction)
        .or(unit(THREE_QUARTER))
        .unwrap_or(Vector3::y());
    let ups = [up, Vector3::z(), Vector3::y(), Vector3::x()];
    let right = ups
        .into_iter()
        .filter_map(unit)
        .map(|up| ahead.cross(&up))
        .find(|right| right.norm_squared() > 1e-12)
        .and_then(unit)
        .unwrap_or(Vector3::x());
    [right, right.cross(&ahead), -ahead]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_box_is_inside_the_picture() {
        let at = Bounds {
            low: [-2.0, 1.0, 0.0],
            high: [5.0, 3.0, 2.5],
        };
        let camera = Camera::around([1.0, 2.0, -1.0], [0.0, 0.0, 1.0], &at.corners(), [960, 540]);
        for corner in at.corners() {
            let [x, y, _] = camera.project(corner);
            assert!((30.0..930.0).contains(&x) && (50.0..480.0).contains(&y));
        }
    }

    #[test]
    fn longer_horizontal_axis_runs_to_the_right() {
        for (points, far) in [
            ([[0.0; 3], [4.0, 1.0, 1.0]], [4.0, 0.0, 0.0]),
            ([[0.0; 3], [1.0, 4.0, 1.0]], [0.0, 4.0, 0.0]),
        ] {
            let camera = Camera::three_quarter(&points, [960, 540]);
            let [from, to] = [[0.0; 3], far].map(|point| camera.project(point));
            assert!(to[0] - from[0] > 2.0 * (to[1] - from[1]).abs());
            let above = camera.project([0.0, 0.0, 1.0]);
            assert!(above[1] < from[1] && (above[0] - from[0]).abs() < 1e-6);
        }
    }

    #[test]
    fn nonsense_gives_a_camera_all_the_same() {
        let points = [[f64::NAN; 3], [f64::INFINITY, 0.0, 0.0], [1e300; 3]];
        let nothing = [[f64::NAN; 3], [0.0; 3]];
        for direction in nothing.into_iter().chain([[0.0, 0.0, -1.0]]) {
            for shown in [&points[..], &[], &[[3.0; 3]]] {
                let camera = Camera::around(direction, [0.0, 0.0, 1.0], shown, [0, 540]);
                assert!(camera.project([3.0; 3]).into_iter().all(f64::is_finite));
            }
        }
    }
}
