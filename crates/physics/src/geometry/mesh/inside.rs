//! The inside of a closed, consistently oriented surface.

use nalgebra::Vector3;

use super::Mesh;
use super::triangle::Triangle;
use crate::geometry::touch::Touch;
use dem_io::Bounds;

/// Offsets of rays from the point, in fractions of the diagonal: with them no ray runs along a
/// face, or through an edge or a corner, of typical models. The majority of three rays is right.
const BESIDE: [[f64; 2]; 3] = [[3.1e-10, 7.3e-10], [-8.7e-10, 2.9e-10], [5.3e-10, -9.1e-10]];

/// The first search distance for the nearest triangle, as a fraction of the diagonal.
const FIRST_LOOK: f64 = 1e-3;

impl Mesh {
    /// Whether the point is inside the surface, as in a solid with its normals outwards. In nested
    /// shells, those with normals inwards are hollows.
    ///
    /// A surface that is open, or not consistently oriented, has no inside; neither has one with
    /// its normals inwards: it is a container.
    pub fn holds(&self, point: [f64; 3]) -> bool {
        if self.content.unpaired_edges > 0 || !self.bounds().is_near(&point, 0.0) {
            return false;
        }
        let is_in = |[x, y]: [f64; 2]| {
            let d = self.diagonal_m;
            self.winding([point[0] + x * d, point[1] + y * d, point[2]]) > 0
        };
        let [one, other] = [is_in(BESIDE[0]), is_in(BESIDE[1])];
        if one == other { one } else { is_in(BESIDE[2]) }
    }

    /// The nearest point of the surface for a centre inside its solid: at a distance below 0.
    pub fn touch_from_inside(&self, centre: [f64; 3]) -> Touch {
        let c = Vector3::from(centre);
        let mut reach_m = FIRST_LOOK * self.diagonal_m;
        loop {
            let mut nearest: Option<Touch> = None;
            let is_near = |bounds: &Bounds| bounds.is_near(&centre, reach_m);
            self.tree.visit_leaves(is_near, |t| {
                let touch = self.nearest(t, &c);
                if nearest.is_none_or(|nearest| touch.distance_m < nearest.distance_m) {
                    nearest = Some(touch);
                }
            });
            match nearest {
                Some(touch) if touch.distance_m <= reach_m || reach_m.is_infinite() => {
                    return Touch {
                        normal: touch.normal.map(|x| -x),
                        distance_m: -touch.distance_m,
                        feature: self.feature(&touch),
                        ..touch
                    };
                }
                _ => reach_m *= 2.0,
            }
        }
    }

    /// Winding number of the surface around a point: by a ray along z, +1 where it leaves the
    /// solid, -1 where it enters.
    fn winding(&self, point: [f64; 3]) -> i32 {
        let p = Vector3::from(point);
        let mut sum = 0;
        // What a ray from the point along z may meet.
        let is_above = |Bounds { low, high }: &Bounds| {
            (0..2).all(|k| point[k] >= low[k] && point[k] <= high[k]) && point[2] <= high[2]
        };
        self.tree.visit_leaves(is_above, |t| {
            sum += crossing(&self.triangles[t as usize], &p);
        });
        sum
    }
}

/// 1 if a ray from `p` along z leaves through the triangle, -1 if it enters, 0 if it does not meet
/// it. Triangles that share an edge leave no gap.
fn crossing(triangle: &Triangle, p: &Vector3<f64>) -> i32 {
    let [a, b, c] = triangle.corners.map(|corner| corner - p);
    let across = |u: &Vector3<f64>, v: &Vector3<f64>| u.x * v.y - u.y * v.x;
    let fractions = [across(&b, &c), across(&c, &a), across(&a, &b)];
    let way = if fractions.iter().all(|fraction| *fraction > 0.0) {
        1
    } else if fractions.iter().all(|fraction| *fraction < 0.0) {
        -1
    } else {
        return 0;
    };
    let height = fractions[0] * a.z + fractions[1] * b.z + fractions[2] * c.z;
    if height * f64::from(way) > 0.0 {
        way
    } else {
        0
    }
}
