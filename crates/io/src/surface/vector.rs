//! Arithmetic of points and vectors.

/// A point or a vector.
pub(super) type Point = [f64; 3];

pub(super) fn subtract(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + factor * b`.
pub(super) fn along(a: Point, factor: f64, b: Point) -> Point {
    [
        a[0] + factor * b[0],
        a[1] + factor * b[1],
        a[2] + factor * b[2],
    ]
}

pub(super) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(super) fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

pub(super) fn distance(a: Point, b: Point) -> f64 {
    length(subtract(a, b))
}

/// `a` with length 1. Not for a zero vector.
pub(super) fn unit(a: Point) -> Point {
    let length = length(a);
    a.map(|x| x / length)
}

/// Normal of a triangle, as long as twice its area.
pub(super) fn normal([a, b, c]: [Point; 3]) -> Point {
    cross(subtract(b, a), subtract(c, a))
}

/// The middle of some points. Not for none.
pub(super) fn mean(points: impl IntoIterator<Item = Point>) -> Point {
    let mut sum = [0.0; 3];
    let mut count = 0.0;
    for point in points {
        sum = along(sum, 1.0, point);
        count += 1.0;
    }
    sum.map(|x| x / count)
}

/// Smallest and largest coordinates of some points.
pub(super) fn bounds(points: impl IntoIterator<Item = Point>) -> (Point, Point) {
    let mut min = [f64::INFINITY; 3];
    let mut max = [f64::NEG_INFINITY; 3];
    for point in points {
        for k in 0..3 {
            min[k] = min[k].min(point[k]);
            max[k] = max[k].max(point[k]);
        }
    }
    (min, max)
}
