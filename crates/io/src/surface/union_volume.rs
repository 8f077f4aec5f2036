//! Volume of a solid whose shells cross each other or themselves: by columns, exact along each.

use super::mesh::Point;
use super::rays::Rays;
use crate::bounds::Bounds;

/// Columns along each side of the cross-section.
const COLUMNS: usize = 256;

/// Neither the columns nor their rows stand in a special direction to the axes: faces parallel to
/// them would be integrated badly.
const DIRECTION: Point = Point::new(0.237, 0.141, 0.961);
const ACROSS: Point = Point::new(0.313, 0.829, -0.457);

/// What the sum of the signed volumes of the shells has too much (or too little, when negative),
/// local units.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Excess {
    pub(super) volume: f64,
    /// Estimated from what every fourth column alone would give.
    pub(super) error: f64,
}

/// Integrates, over `region`, the winding number less one where it is positive, and the winding
/// number where it is negative. Outside `region`, the winding number must be 0 or 1.
pub(super) fn excess(rays: &Rays, region: Bounds) -> Excess {
    let direction = DIRECTION.normalize();
    let across = direction.cross(&ACROSS).normalize();
    let up = across.cross(&direction);
    let corners = region.corners().map(Point::from);
    let Bounds { low, high } =
        Bounds::of(corners.map(|corner| [across, up, direction].map(|axis| corner.dot(&axis))));
    let step = [0, 1].map(|k| (high[k] - low[k]) / COLUMNS as f64);
    let start = rays
        .mesh
        .vertices
        .iter()
        .map(|v| v.dot(&direction))
        .fold(f64::INFINITY, f64::min)
        - 0.01;
    let mut quarters = [0.0_f64; 4];
    let mut hits = Vec::new();
    for i in 0..COLUMNS {
        for j in 0..COLUMNS {
            // A column that grazes a facet is moved a little aside, a few times.
            for attempt in 0..4 {
                let offset = 0.5 + 1e-4 * f64::from(attempt);
                let foot = [
                    low[0] + (i as f64 + offset) * step[0],
                    low[1] + (j as f64 + offset) * step[1],
                ];
                let origin = foot[0] * across + foot[1] * up + start * direction;
                if rays.crossings(origin, direction, &mut hits) {
                    break;
                }
            }
            hits.sort_unstable_by(|a, b| a.at.total_cmp(&b.at));
            let mut winding = 0;
            for pair in hits.windows(2) {
                winding -= pair[0].sense;
                let too_much = if winding > 0 { winding - 1 } else { winding };
                quarters[2 * (i % 2) + j % 2] += f64::from(too_much) * (pair[1].at - pair[0].at);
            }
        }
    }
    let area = step[0] * step[1];
    let spread = quarters.iter().copied().fold(f64::MIN, f64::max)
        - quarters.iter().copied().fold(f64::MAX, f64::min);
    Excess {
        volume: quarters.iter().sum::<f64>() * area,
        error: 4.0 * spread * area,
    }
}
