//! Interpolated values.

/// The value at `x` by linear interpolation between points (x, y) with ascending x. Before the
/// first point and after the last one, the value is that of the point. None if there are no points.
pub fn interpolated(points: &[[f64; 2]], x: f64) -> Option<f64> {
    let after = points.partition_point(|point| point[0] <= x);
    match (points[..after].last(), points.get(after)) {
        (Some([x0, y0]), Some([x1, y1])) => Some(y0 + (y1 - y0) * (x - x0) / (x1 - x0)),
        (Some([_, y]), None) | (None, Some([_, y])) => Some(*y),
        (None, None) => None,
    }
}
