//! Polygons -> triangles: ears are cut off, one after the other, so that polygons need not be
//! convex.

use nalgebra::{Vector2, Vector3};

/// Three corners.
pub(super) type Facet = [[f64; 3]; 3];

/// The remedy for a polygon that is not split.
pub(super) const REMEDY_SPLIT: &str =
    "split it into triangles in the program that made the shape, or export it as STL";

/// Largest distance of a corner from the plane of its polygon, over the size of the polygon.
/// Splitting it along the other diagonal would change the volume by about this part.
const FLAT: f64 = 0.01;
/// Twice the area of an ear that has none, over the square of the size of the polygon.
const NO_AREA: f64 = 1e-12;
/// Largest number of corners: the time grows with its square or more.
const MOST_CORNERS: usize = 10_000;

/// Adds the triangles of a polygon with at least three corners to `facets`, wound as it is. A
/// triangle, and a polygon all in one line, are added unchecked: readers of surfaces drop what has
/// no area.
///
/// # Errors
/// What is wrong with a polygon that is not flat, or crosses itself.
pub(super) fn split(corners: &[[f64; 3]], facets: &mut Vec<Facet>) -> Result<(), String> {
    if let [a, b, c] = *corners {
        facets.push([a, b, c]);
        return Ok(());
    }
    if corners.len() > MOST_CORNERS {
        let count = corners.len();
        return Err(format!(
            "it has {count} corners, more than the {MOST_CORNERS} that are split into triangles"
        ));
    }
    let first = Vector3::from(corners[0]);
    let points: Vec<Vector3<f64>> = corners.iter().map(|c| Vector3::from(*c) - first).collect();
    let size = points
        .iter()
        .map(nalgebra::Matrix::norm)
        .fold(0.0, f64::max);
    let next = |k: usize| points[(k + 1) % points.len()];
    let all = 0..points.len();
    // Newell's normal: twice the area of the polygon.
    let normal: Vector3<f64> = all.map(|k| points[k].cross(&next(k))).sum();
    if normal.norm() <= NO_AREA * size * size {
        return split_without_area(corners, &points, size, facets);
    }
    let normal = normal.normalize();
    let middle: Vector3<f64> = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let off = points.iter().map(|p| (p - middle).dot(&normal).abs());
    let off = off.fold(0.0, f64::max);
    if off > FLAT * size {
        return Err(format!(
            "it has {} corners that lie in no plane: one is {:.1} % of its size off",
            corners.len(),
            100.0 * off / size
        ));
    }
    let along = normal.cross(&axis_across(&normal)).normalize();
    let up = normal.cross(&along);
    let flat: Vec<Vector2<f64>> = (points
        .iter()
        .map(|p| Vector2::new(p.dot(&along), p.dot(&up))))
    .collect();
    cut_ears(&flat, NO_AREA * size * size, |ear| {
        facets.push(ear.map(|k| corners[k]));
    })
    .ok_or_else(|| format!("it has {} corners and crosses itself", corners.len()))
}

/// A polygon whose corners lie in one line is as good as none; any other crosses itself.
fn split_without_area(
    corners: &[[f64; 3]],
    points: &[Vector3<f64>],
    size: f64,
    facets: &mut Vec<Facet>,
) -> Result<(), String> {
    let farthest =
        points.iter().copied().fold(
            Vector3::zeros(),
            |a: Vector3<f64>, b| {
                if b.norm() > a.norm() { b } else { a }
            },
        );
    let crosses = |p: &Vector3<f64>| p.cross(&farthest).norm() > NO_AREA.sqrt() * size * size;
    if points.iter().any(crosses) {
        return Err(format!(
            "it has {} corners and crosses itself",
            corners.len()
        ));
    }
    facets.extend((1..corners.len() - 1).map(|k| [corners[0], corners[k], corners[k + 1]]));
    Ok(())
}

/// The axis that is farthest from being along `normal`.
fn axis_across(normal: &Vector3<f64>) -> Vector3<f64> {
    let mut axis = Vector3::zeros();
    axis[normal.iamin()] = 1.0;
    axis
}

/// Cuts the ears of a polygon that runs anticlockwise, until a triangle is left: three indices
/// each. None: it crosses itself.
fn cut_ears(points: &[Vector2<f64>], no_area: f64, mut cut: impl FnMut([usize; 3])) -> Option<()> {
    let mut left: Vec<usize> = (0..points.len()).collect();
    while left.len() > 3 {
        let corners = |at: usize| {
            let count = left.len();
            [
                left[(at + count - 1) % count],
                left[at],
                left[(at + 1) % count],
            ]
        };
        let is_ear = |at: &usize| {
            let ear = corners(*at);
            let area = twice_area(ear.map(|k| points[k]));
            area > no_area
                && !left
                    .iter()
                    .any(|k| is_in(points[*k], ear.map(|k| points[k])))
        };
        let is_flat = |at: &usize| twice_area(corners(*at).map(|k| points[k])).abs() <= no_area;
        let mut all = 0..left.len();
        // A corner in the middle of an edge waits for an ear that has it as its end.
        let at = all.clone().find(is_ear).or_else(|| all.find(is_flat))?;
        cut(corners(at));
        left.remove(at);
    }
    let last = [left[0], left[1], left[2]];
    let is_outside_in = twice_area(last.map(|k| points[k])) < -no_area;
    cut(last);
    (!is_outside_in).then_some(())
}

fn twice_area([a, b, c]: [Vector2<f64>; 3]) -> f64 {
    (b - a).perp(&(c - a))
}

/// True for a point in an anticlockwise triangle or on its edges, but not in its corners.
fn is_in(point: Vector2<f64>, corners: [Vector2<f64>; 3]) -> bool {
    let [a, b, c] = corners;
    !corners.contains(&point)
        && [[a, b], [b, c], [c, a]]
            .iter()
            .all(|[from, to]| (to - from).perp(&(point - from)) >= 0.0)
}
