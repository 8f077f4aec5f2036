//! The area between two curves of load over displacement.

use dem_io::interpolation::interpolated;

/// The area between two curves over the area under the second, from zero displacement to the later
/// of the two largest loads. Points are joined by lines; beyond its last point a curve keeps its
/// last load.
pub fn area_between(curve: &[[f64; 2]], reference: &[[f64; 2]]) -> f64 {
    let at_peak = |points: &[[f64; 2]]| {
        let peak = points.iter().max_by(|a, b| a[1].total_cmp(&b[1]));
        peak.map_or(0.0, |[x, _]| *x)
    };
    let end = at_peak(curve).max(at_peak(reference));
    let inner = curve.iter().chain(reference).map(|[x, _]| *x);
    let mut places: Vec<f64> = inner.filter(|x| *x > 0.0 && *x < end).collect();
    places.extend([0.0, end]);
    places.sort_by(f64::total_cmp);
    let (mut between, mut under) = (0.0, 0.0);
    for ends in places.windows(2) {
        let width_m = ends[1] - ends[0];
        let load_n = |points, x| interpolated(points, x).unwrap_or(0.0);
        let [own, other] =
            [curve, reference].map(|points| [load_n(points, ends[0]), load_n(points, ends[1])]);
        between += width_m * mean_size(own[0] - other[0], own[1] - other[1]);
        under += 0.5 * width_m * (other[0] + other[1]);
    }
    between / under
}

/// Mean of |y| for y changing linearly from `from` to `to`.
fn mean_size(from: f64, to: f64) -> f64 {
    if from * to < 0.0 {
        0.5 * (from * from + to * to) / (from.abs() + to.abs())
    } else {
        0.5 * (from + to).abs()
    }
}
