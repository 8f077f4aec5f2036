//! Regions of space used by the rules of a scene.

use std::f64::consts::PI;

use nalgebra::Vector3;
use serde::Serialize;

use crate::geometry::Bounds;

/// A region of space.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub enum Region {
    /// A box along the axes, m.
    Box(Bounds),
    /// A ball.
    Sphere {
        /// m. Length 3.
        centre_m: [f64; 3],
        /// m.
        radius_m: f64,
    },
    /// A cylinder with flat ends.
    Cylinder {
        /// Middle of one end, m. Length 3.
        from_m: [f64; 3],
        /// Middle of the other, m. Length 3.
        to_m: [f64; 3],
        /// m.
        radius_m: f64,
    },
    /// The inside of a closed surface: the corners of its triangles, m.
    Inside(Vec<[[f64; 3]; 3]>, Bounds),
}

impl Region {
    /// Whether it contains a point, m.
    pub fn contains(&self, point_m: [f64; 3]) -> bool {
        match self {
            Self::Box(bounds) => is_in(bounds, point_m),
            Self::Sphere { centre_m, radius_m } => {
                (Vector3::from(point_m) - Vector3::from(*centre_m)).norm() <= *radius_m
            }
            Self::Cylinder {
                from_m,
                to_m,
                radius_m,
            } => {
                let [along, apart_m] = beside_axis([*from_m, *to_m], point_m);
                (0.0..=1.0).contains(&along) && apart_m <= *radius_m
            }
            Self::Inside(triangles, bounds) => {
                is_in(bounds, point_m) && turns(triangles, &point_m.into()) > 0.5
            }
        }
    }

    /// Box around it, m.
    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Box(bounds) | Self::Inside(_, bounds) => *bounds,
            Self::Sphere { centre_m, radius_m } => Bounds::of([*centre_m]).grown(*radius_m),
            Self::Cylinder {
                from_m,
                to_m,
                radius_m,
            } => Bounds::of([*from_m, *to_m]).grown(*radius_m),
        }
    }

    /// Whether its border may cut a ball, m: false only for balls wholly inside or outside.
    pub fn cuts(&self, place_m: [f64; 3], ball_m: f64) -> bool {
        match self {
            Self::Box(Bounds { low, high }) => (0..3).any(|k| {
                let ends = [low[k] - place_m[k], high[k] - place_m[k]];
                ends.iter().any(|end| end.abs() < ball_m)
            }),
            Self::Sphere { centre_m, radius_m } => {
                let apart_m = (Vector3::from(place_m) - Vector3::from(*centre_m)).norm();
                (apart_m - radius_m).abs() < ball_m
            }
            Self::Cylinder {
                from_m,
                to_m,
                radius_m,
            } => {
                let [along, apart_m] = beside_axis([*from_m, *to_m], place_m);
                let length_m = (Vector3::from(*to_m) - Vector3::from(*from_m)).norm();
                [
                    along * length_m,
                    (along - 1.0) * length_m,
                    apart_m - radius_m,
                ]
                .iter()
                .any(|left| left.abs() < ball_m)
            }
            Self::Inside(triangles, _) => triangles.iter().any(|corners| {
                let near = Bounds::of(*corners);
                near.is_near(&place_m, ball_m)
            }),
        }
    }

    /// A distance, m, within which there is no border around a point.
    pub fn to_border_m(&self, point_m: Vector3<f64>) -> f64 {
        let bounds = self.bounds();
        let place: [f64; 3] = point_m.into();
        let outside_m = bounds.distance(&place);
        if outside_m > 0.0 {
            return outside_m;
        }
        match self {
            Self::Box(Bounds { low, high }) => {
                let depths = (0..3).map(|k| (place[k] - low[k]).min(high[k] - place[k]));
                depths.fold(f64::INFINITY, f64::min)
            }
            Self::Sphere { centre_m, radius_m } => {
                ((point_m - Vector3::from(*centre_m)).norm() - radius_m).abs()
            }
            Self::Cylinder {
                from_m,
                to_m,
                radius_m,
            } => {
                let [along, apart_m] = beside_axis([*from_m, *to_m], place);
                let length_m = (Vector3::from(*to_m) - Vector3::from(*from_m)).norm();
                let beyond_m = [(along - 1.0).max(-along) * length_m, apart_m - radius_m];
                if beyond_m.iter().all(|beyond_m| *beyond_m <= 0.0) {
                    return -beyond_m[0].max(beyond_m[1]);
                }
                let [ends_m, side_m] = beyond_m.map(|beyond_m| beyond_m.max(0.0));
                ends_m.hypot(side_m)
            }
            Self::Inside(triangles, _) => {
                let distances = triangles.iter().map(|t| Bounds::of(*t).distance(&place));
                distances.fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// Whether a straight way between two points, m, both of them outside, leads through it.
    pub fn is_passed(&self, [from, to]: [Vector3<f64>; 2]) -> bool {
        if !self.bounds().on_segment([from, to], 0.0) {
            return false;
        }
        let way = to - from;
        let passed = match self {
            Self::Box(_) => true,
            Self::Sphere { centre_m, radius_m } => {
                let apart = Vector3::from(*centre_m) - from;
                let fraction = (apart.dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
                (apart - fraction * way).norm() <= *radius_m
            }
            Self::Cylinder {
                from_m,
                to_m,
                radius_m,
            } => crosses_cylinder([*from_m, *to_m], *radius_m, [from, to]),
            Self::Inside(triangles, _) => triangles.iter().any(|t| crosses(t, &from, &way)),
        };
        passed && !self.contains(to.into())
    }

    /// Its volume, m3.
    pub fn volume_m3(&self) -> f64 {
        match self {
            Self::Box(Bounds { low, high }) => (0..3).map(|k| high[k] - low[k]).product(),
            Self::Sphere { radius_m, .. } => 4.0 / 3.0 * PI * radius_m.powi(3),
            Self::Cylinder {
                from_m,
                to_m,
                radius_m,
            } => {
                let length_m = (Vector3::from(*to_m) - Vector3::from(*from_m)).norm();
                PI * radius_m * radius_m * length_m
            }
            Self::Inside(triangles, _) => {
                let tetrahedron = |corners: &[[f64; 3]; 3]| {
                    let [a, b, c] = corners.map(Vector3::from);
                    a.dot(&b.cross(&c)) / 6.0
                };
                triangles.iter().map(tetrahedron).sum::<f64>().abs()
            }
        }
    }

    /// A point of it from numbers in (0, 1), or none if they give a point outside: try again with
    /// others.
    pub fn point(&self, [u, v, w]: [f64; 3]) -> Option<[f64; 3]> {
        let Bounds { low, high } = self.bounds();
        let fraction = [u, v, w];
        let point = [0, 1, 2].map(|k| low[k] + fraction[k] * (high[k] - low[k]));
        self.contains(point).then_some(point)
    }
}

/// Where a point is beside an axis from one end, m, to the other: the fraction of the way along it,
/// and the distance from it, m.
fn beside_axis([from_m, to_m]: [[f64; 3]; 2], point_m: [f64; 3]) -> [f64; 2] {
    let axis = Vector3::from(to_m) - Vector3::from(from_m);
    let way = Vector3::from(point_m) - Vector3::from(from_m);
    let along = way.dot(&axis) / axis.norm_squared();
    [along, (way - along * axis).norm()]
}

/// Whether a straight way between two points, m, comes into a cylinder with flat ends.
fn crosses_cylinder(ends_m: [[f64; 3]; 2], radius_m: f64, [from, to]: [Vector3<f64>; 2]) -> bool {
    let [start, end] = ends_m.map(Vector3::from);
    let axis = (end - start).normalize();
    let [height, rise] = [(from - start).dot(&axis), (to - from).dot(&axis)];
    // The part of the way that is between the planes of the ends.
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for plane in [0.0, (end - start).norm()] {
        let above = plane == 0.0;
        let [now, then] =
            [height - plane, height + rise - plane].map(|h| if above { h } else { -h });
        if now < 0.0 && then < 0.0 {
            return false;
        }
        let crossing = now / (now - then);
        if now < 0.0 {
            first = first.max(crossing);
        } else if then < 0.0 {
            last = last.min(crossing);
        }
    }
    let across = |v: Vector3<f64>| v - v.dot(&axis) * axis;
    let (beside, way) = (across(from - start), across(to - from));
    let nearest = -beside.dot(&way) / way.norm_squared();
    let nearest = if nearest.is_finite() { nearest } else { 0.0 };
    let nearest = nearest.max(first).min(last);
    first <= last && (beside + nearest * way).norm() <= radius_m
}

/// Whether a straight way leads through a triangle (Moeller and Trumbore 1997).
fn crosses(corners: &[[f64; 3]; 3], from: &Vector3<f64>, way: &Vector3<f64>) -> bool {
    let [a, b, c] = corners.map(Vector3::from);
    let (ab, ac, apart) = (b - a, c - a, from - a);
    let normal = way.cross(&ac);
    let determinant = ab.dot(&normal);
    let across = apart.cross(&ab);
    let [u, v, along] =
        [apart.dot(&normal), way.dot(&across), ac.dot(&across)].map(|part| part / determinant);
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&along)
}

fn is_in(bounds: &Bounds, point: [f64; 3]) -> bool {
    (0..3).all(|k| (bounds.low[k]..=bounds.high[k]).contains(&point[k]))
}

/// Winding number of a closed surface around a point: 1 inside, 0 outside (solid angles by van
/// Oosterom and Strackee 1983).
fn turns(triangles: &[[[f64; 3]; 3]], point: &Vector3<f64>) -> f64 {
    let mut angle = 0.0;
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| Vector3::from(corner) - point);
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        let below = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        angle += 2.0 * a.dot(&b.cross(&c)).atan2(below);
    }
    angle.abs() / (4.0 * std::f64::consts::PI)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dem_io::random::uniform;

    /// A tetrahedron, its corners in m.
    fn tetrahedron() -> Region {
        let [a, b, c, d] = [
            [-0.5, -0.4, -0.3],
            [0.6, -0.2, -0.4],
            [0.0, 0.7, -0.2],
            [0.1, 0.0, 0.6],
        ];
        let triangles = vec![[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
        Region::Inside(triangles, Bounds::of([a, b, c, d]))
    }

    fn all() -> [Region; 4] {
        let [low, high] = [[-0.3, -0.2, -0.6], [0.4, 0.1, 0.5]];
        let [from_m, to_m] = [[-0.4, -0.2, -0.3], [0.5, 0.3, 0.2]];
        [
            Region::Box(Bounds { low, high }),
            Region::Sphere {
                centre_m: [0.1, -0.1, 0.2],
                radius_m: 0.4,
            },
            Region::Cylinder {
                from_m,
                to_m,
                radius_m: 0.3,
            },
            tetrahedron(),
        ]
    }

    fn place(n: u64, of: u64) -> Vector3<f64> {
        Vector3::from([0, 1, 2].map(|k| 2.0 * uniform(n, &[of, k]) - 1.0))
    }

    #[test]
    fn ways_through_a_region_are_found() {
        for region in all() {
            let (mut passed, mut missed) = (0, 0);
            for n in 0..2000 {
                let [from, to] = [place(n, 0), place(n, 1)];
                if region.contains(from.into()) || region.contains(to.into()) {
                    continue;
                }
                let mut points = (1..1000).map(|at| from.lerp(&to, f64::from(at) / 1000.0));
                let comes_in = points.any(|point| region.contains(point.into()));
                let is_passed = region.is_passed([from, to]);
                // Between two points there may be a shorter way through a corner.
                assert!(is_passed || !comes_in, "{region:?} {from} {to}");
                passed += u32::from(is_passed);
                missed += u32::from(is_passed && !comes_in);
            }
            assert!(passed > 100 && missed <= passed / 50, "{passed} {missed}");
        }
    }

    #[test]
    fn no_border_is_nearer_than_told() {
        for region in all() {
            let mut sum_m = 0.0;
            for n in 0..5000 {
                let from = place(n, 2);
                let free_m = region.to_border_m(from);
                sum_m += free_m;
                let to = from + 0.999 * free_m * place(n, 3).normalize();
                let same = region.contains(from.into()) == region.contains(to.into());
                assert!(same, "{region:?} {from} {to}");
            }
            assert!(sum_m > 500.0, "{sum_m}");
        }
    }
}
