//! Walls as triangles and lines.

use std::collections::BTreeMap;

use dem_io::Bounds;
use nalgebra::Vector3;

use super::vector::{across, unit};

/// Number of sides of a polygon that represents a circle.
const ROUND: u32 = 96;

/// Threshold for drawing a fold between two triangles: the cosine of 155 degrees between the
/// triangles.
const FOLD: f64 = -0.906;
/// Threshold below which there is no fold: the cosine of 179.9 degrees.
const FLAT: f64 = -0.999_998;

/// Distance by which a plane extends beyond the scene, as a fraction of its size.
const OVER: f64 = 0.06;

/// Distance within which two planes coincide, as a fraction of the size.
const SAME: f64 = 1e-9;

/// Light grey.
const GREY: [u8; 3] = [205, 209, 214];

/// Fraction of the balls behind a wall that it hides.
const OPACITY: f32 = 0.40;

/// A triangle of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// Corners, m, counterclockwise as seen from outside the wall. Shape 3 x 3.
    pub corners_m: [[f64; 3]; 3],
}

/// A straight line on a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Its ends, m. Shape 2 x 3.
    pub ends_m: [[f64; 3]; 2],
    /// For an edge on a round surface, which is drawn only where it is an outline: the third
    /// corners of the two adjacent triangles, m. Shape 2 x 3.
    pub beside_m: Option<[[f64; 3]; 2]>,
}

/// The half-space behind a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpace {
    /// A point of the plane, m. Length 3.
    pub point_m: [f64; 3],
    /// Outward normal of the wall, of any length. Length 3.
    pub normal: [f64; 3],
}

/// A wall to draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Its surface.
    pub triangles: Vec<Triangle>,
    /// Its lines.
    pub edges: Vec<Edge>,
    /// True if triangles are visible from outside only.
    pub solid: bool,
    /// Its colour: red, green, blue.
    pub colour: [u8; 3],
    /// Fraction of the balls behind it that it hides: 0 none, 1 all.
    pub opacity: f32,
}

impl Surface {
    /// The surface of a half-space: the part of the plane around a scene and outside the other
    /// `solids`.
    pub fn plane(plane: &HalfSpace, around: &Bounds, solids: &[HalfSpace]) -> Self {
        let point_m = Vector3::from(plane.point_m);
        let Some(normal) = unit(plane.normal.into()) else {
            return Self::mesh(&[], &[]);
        };
        let right = along_an_axis(normal);
        let up = normal.cross(&right);
        let reach = |axis: Vector3<f64>| {
            let along = around
                .corners()
                .map(|corner| (Vector3::from(corner) - point_m).dot(&axis));
            let low = along.into_iter().fold(f64::INFINITY, f64::min);
            let high = along.into_iter().fold(f64::NEG_INFINITY, f64::max);
            [low, high]
        };
        let [x, y] = [reach(right), reach(up)];
        let over = OVER * (x[1] - x[0]).max(y[1] - y[0]);
        let corner = |x: f64, y: f64| (point_m + x * right + y * up).into();
        let patch = [
            corner(x[0] - over, y[0] - over),
            corner(x[1] + over, y[0] - over),
            corner(x[1] + over, y[1] + over),
            corner(x[0] - over, y[1] + over),
        ];
        let patch = solids
            .iter()
            .fold(patch.to_vec(), |patch, solid| outside(&patch, solid));
        let triangles: Vec<[u32; 3]> = (2..patch.len() as u32).map(|k| [0, k - 1, k]).collect();
        Self {
            solid: true,
            ..Self::mesh(&patch, &triangles)
        }
    }

    /// A solid box with sides along the axes, m.
    pub fn solid_box(bounds: &Bounds) -> Self {
        let sides = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let triangles: Vec<[u32; 3]> = sides
            .into_iter()
            .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect();
        Self {
            solid: true,
            ..Self::mesh(&bounds.corners(), &triangles)
        }
    }

    /// A solid cylinder between the centres of its two flat ends, m, shape 2 x 3.
    pub fn cylinder(ends_m: [[f64; 3]; 2], radius_m: f64) -> Self {
        let ends = ends_m.map(Vector3::from);
        let Some(axis) = unit(ends[1] - ends[0]) else {
            return Self::mesh(&[], &[]);
        };
        let right = across(axis);
        let up = axis.cross(&right);
        let mut vertices = ends_m.to_vec();
        let mut triangles = Vec::new();
        for side in 0..ROUND {
            let (sine, cosine) =
                (std::f64::consts::TAU * f64::from(side) / f64::from(ROUND)).sin_cos();
            for end in ends {
                let out = end + radius_m * cosine * right + radius_m * sine * up;
                vertices.push(out.into());
            }
            let this = 2 + 2 * side;
            let next = 2 + 2 * ((side + 1) % ROUND);
            triangles.extend([
                [0, next, this],
                [1, this + 1, next + 1],
                [this, next, next + 1],
                [this, next + 1, this + 1],
            ]);
        }
        Self {
            solid: true,
            ..Self::mesh(&vertices, &triangles)
        }
    }

    /// A two-sided surface: vertices, m, shape n x 3, and triangles of three of them each, shape m
    /// x 3.
    ///
    /// Lines are its borders and folds, and its outline where it is round. Triangles that are not
    /// finite or whose vertices do not exist are ignored.
    pub fn mesh(vertices_m: &[[f64; 3]], triangles: &[[u32; 3]]) -> Self {
        let corners = |t: &[u32; 3]| -> Option<Triangle> {
            let [a, b, c] = t.map(|v| vertices_m.get(v as usize).copied());
            let corners_m = [a?, b?, c?];
            let is_finite = corners_m.as_flattened().iter().all(|x| x.is_finite());
            is_finite.then_some(Triangle { corners_m })
        };
        let triangles: Vec<Triangle> = triangles.iter().filter_map(corners).collect();
        Self {
            edges: edges(&triangles),
            triangles,
            solid: false,
            colour: GREY,
            opacity: OPACITY,
        }
    }

    /// The wall at another place: `place` moves each of its points, m, to its present position, m.
    #[must_use]
    pub fn moved(&self, place: &dyn Fn([f64; 3]) -> [f64; 3]) -> Self {
        let triangle = |t: &Triangle| Triangle {
            corners_m: t.corners_m.map(place),
        };
        let edge = |e: &Edge| Edge {
            ends_m: e.ends_m.map(place),
            beside_m: e.beside_m.map(|beside| beside.map(place)),
        };
        Self {
            triangles: self.triangles.iter().map(triangle).collect(),
            edges: self.edges.iter().map(edge).collect(),
            ..*self
        }
    }

    /// All corners of its triangles, m. Shape n x 3.
    pub fn points_m(&self) -> impl Iterator<Item = [f64; 3]> {
        self.triangles.iter().flat_map(|t| t.corners_m)
    }
}

/// A unit vector perpendicular to a unit vector, as close to one of the axes as possible.
fn along_an_axis(normal: Vector3<f64>) -> Vector3<f64> {
    let least = (0..3)
        .min_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()))
        .unwrap_or(0);
    let mut axis = Vector3::zeros();
    axis[least] = 1.0;
    unit(axis + -normal[least] * normal).unwrap_or(axis)
}

/// The part of a convex polygon, m, shape n x 3, that is not in a solid. A polygon in its plane is
/// unchanged.
fn outside(polygon: &[[f64; 3]], solid: &HalfSpace) -> Vec<[f64; 3]> {
    let Some(normal) = unit(solid.normal.into()) else {
        return polygon.to_vec();
    };
    let point_m = Vector3::from(solid.point_m);
    let height = |point: [f64; 3]| (Vector3::from(point) - point_m).dot(&normal);
    let size = Bounds::of(polygon.iter().copied()).diagonal_m();
    let ends = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let mut left = Vec::new();
    for (&a, &b) in ends {
        let [from, to] = [height(a), height(b)].map(|h| h + SAME * size);
        if from >= 0.0 {
            left.push(a);
        }
        if (from < 0.0) != (to < 0.0) {
            let (a, b) = (Vector3::from(a), Vector3::from(b));
            left.push((a + from / (from - to) * (b - a)).into());
        }
    }
    left
}

/// A side of a triangle: numbers of its ends in ascending order, the ends, and the third corner of
/// the triangle.
type Side = ([usize; 2], [[f64; 3]; 2], [f64; 3]);

/// Borders, folds and possible outlines. Corners at equal places count as one.
fn edges(triangles: &[Triangle]) -> Vec<Edge> {
    let mut numbers = BTreeMap::new();
    let mut sides: Vec<Side> = Vec::with_capacity(3 * triangles.len());
    for triangle in triangles {
        let corners = triangle.corners_m.map(|corner| {
            let next = numbers.len();
            // Minus zero is zero.
            *numbers
                .entry(corner.map(|x| (x + 0.0).to_bits()))
                .or_insert(next)
        });
        for k in 0..3 {
            let [a, b, c] =
                [0, 1, 2].map(|j| (corners[(k + j) % 3], triangle.corners_m[(k + j) % 3]));
            let (a, b) = if a.0 < b.0 { (a, b) } else { (b, a) };
            sides.push(([a.0, b.0], [a.1, b.1], c.1));
        }
    }
    sides.sort_by_key(|side| side.0);
    let edge = |group: &[Side]| {
        let (_, ends_m, _) = *group.first()?;
        let drawn = |beside_m| Some(Edge { ends_m, beside_m });
        match group {
            [(.., a), (.., b)] => match fold(ends_m, [*a, *b]) {
                cosine if cosine < FLAT => None,
                cosine if cosine < FOLD => drawn(Some([*a, *b])),
                _ => drawn(None),
            },
            _ => drawn(None),
        }
    };
    sides.chunk_by(|a, b| a.0 == b.0).filter_map(edge).collect()
}

/// The cosine of the angle between two triangles on one edge: -1 if they form one flat part.
fn fold(ends: [[f64; 3]; 2], beside: [[f64; 3]; 2]) -> f64 {
    let ends = ends.map(Vector3::from);
    let Some(along) = unit(ends[1] - ends[0]) else {
        return -1.0;
    };
    let out = beside.map(|corner| {
        let from = Vector3::from(corner) - ends[0];
        unit(from + -from.dot(&along) * along)
    });
    match out {
        [Some(a), Some(b)] => a.dot(&b),
        _ => -1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Bounds = Bounds {
        low: [0.0; 3],
        high: [1.0; 3],
    };

    fn half(point_m: [f64; 3], normal: [f64; 3]) -> HalfSpace {
        HalfSpace { point_m, normal }
    }

    fn volume(wall: &Surface) -> f64 {
        let of = |t: &Triangle| {
            let [a, b, c] = t.corners_m.map(Vector3::from);
            a.dot(&b.cross(&c)) / 6.0
        };
        wall.triangles.iter().map(of).sum()
    }

    #[test]
    fn box_has_twelve_edges_and_looks_outwards() {
        let wall = Surface::solid_box(&UNIT);
        assert_eq!((wall.triangles.len(), wall.edges.len()), (12, 12));
        assert!((volume(&wall) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn cylinder_has_two_rims_and_looks_outwards() {
        let wall = Surface::cylinder([[1.0, 2.0, 3.0], [1.0, 2.0, 5.0]], 0.5);
        let rims = wall.edges.iter().filter(|edge| edge.beside_m.is_none());
        assert_eq!(rims.count(), 2 * ROUND as usize);
        let round = std::f64::consts::PI * 0.5;
        assert!((volume(&wall) / round - 1.0).abs() < 2e-3);
    }

    #[test]
    fn plane_lies_around_the_scene() {
        let wall = Surface::plane(&half([0.5, 0.5, -1.0], [0.0, 0.0, 2.0]), &UNIT, &[]);
        assert_eq!((wall.triangles.len(), wall.edges.len()), (2, 4));
        let bounds = Bounds::of(wall.points_m());
        assert!(bounds.low[0] < 0.0 && bounds.high[1] > 1.0);
        assert_eq!((bounds.low[2], bounds.high[2]), (-1.0, -1.0));
        let [a, b, c] = wall.triangles[0].corners_m.map(Vector3::from);
        assert!((b - a).cross(&(c - a)).z > 0.0);
    }

    #[test]
    fn planes_end_where_others_begin() {
        let floor = half([0.0; 3], [0.0, 0.0, 1.0]);
        let left = half([0.25, 0.0, 0.0], [3.0, 0.0, 0.0]);
        let roof = half([0.0, 0.0, 2.0], [0.0, 0.0, -1.0]);
        let [floor, lost] = [
            [left, roof, floor],
            [left, half([2.0; 3], [0.0, 0.0, 1.0]), roof],
        ]
        .map(|solids| Surface::plane(&floor, &UNIT, &solids));
        let bounds = Bounds::of(floor.points_m());
        assert!((bounds.low[0] - 0.25).abs() < 1e-6 && bounds.high[0] > 1.0);
        assert_eq!(floor.edges.len(), 4);
        assert!(lost.triangles.is_empty());
    }

    #[test]
    fn nonsense_has_no_triangles() {
        let nowhere = Surface::plane(&half([0.0; 3], [0.0; 3]), &UNIT, &[]);
        assert!(nowhere.triangles.is_empty());
        let around_nothing = Surface::plane(&half([0.0; 3], [1.0; 3]), &Bounds::EMPTY, &[]);
        assert!(around_nothing.triangles.is_empty());
        assert!(Surface::cylinder([[0.0; 3]; 2], 1.0).triangles.is_empty());
        assert!(
            Surface::cylinder([[0.0; 3], [1.0; 3]], f64::NAN)
                .triangles
                .is_empty()
        );
        assert!(
            Surface::mesh(&[[0.0; 3]], &[[0, 0, 7]])
                .triangles
                .is_empty()
        );
    }
}
