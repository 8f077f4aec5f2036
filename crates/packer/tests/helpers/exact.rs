//! Conditions that hold exactly for every packing, checked without the packer's own geometry:
//! distances to all triangles one by one (Ericson 2005, section 5.1.5), and the inside by the
//! winding number, a sum of solid angles (van Oosterom and Strackee 1983).

use super::facets::Point;

/// Fraction of a radius above which an overlap or a protrusion is not a rounding error.
pub(crate) const EXACT: f64 = 1e-9;

/// Checks a packing: no overlap of the reduced spheres, nothing outside. All lengths in the same
/// unit. `unsure` is the distance by which the facets may deviate from the surface that was filled
/// (0 unless the file had to be repaired).
pub(crate) fn assert_exact(
    what: &str,
    facets: &[[Point; 3]],
    positions: &[Point],
    radii: &[f64],
    overlap: f64,
    unsure: f64,
) {
    assert!(!radii.is_empty(), "{what}: no sphere");
    assert!(
        positions
            .iter()
            .flatten()
            .chain(radii)
            .all(|x| x.is_finite()),
        "{what}: not a number"
    );
    let reduced: Vec<f64> = radii.iter().map(|r| r / (1.0 + overlap)).collect();
    let worst = largest_overlap(positions, &reduced);
    assert!(
        worst <= EXACT,
        "{what}: two spheres overlap by {worst:e} of a radius"
    );
    let smallest = radii.iter().copied().fold(f64::INFINITY, f64::min);
    let worst = largest_protrusion(facets, positions, radii);
    assert!(
        worst <= EXACT + unsure / smallest,
        "{what}: a sphere stands out by {worst:e} of its radius"
    );
    let outside = positions
        .iter()
        .filter(|p| winding_number(facets, p) == 0)
        .count();
    assert_eq!(outside, 0, "{what}: centres outside the solid");
}

/// Largest overlap of two spheres as a fraction of the smaller radius; negative if there is a gap
/// everywhere.
pub(crate) fn largest_overlap(positions: &[Point], radii: &[f64]) -> f64 {
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.sort_by(|a, b| positions[*a][0].total_cmp(&positions[*b][0]));
    let reach = 2.0 * radii.iter().copied().fold(0.0, f64::max);
    let mut worst = f64::NEG_INFINITY;
    for (k, a) in order.iter().enumerate() {
        for b in &order[k + 1..] {
            let (p, q) = (positions[*a], positions[*b]);
            if q[0] - p[0] > reach {
                break;
            }
            let overlap = radii[*a] + radii[*b] - length(sub(p, q));
            worst = f64::max(worst, overlap / radii[*a].min(radii[*b]));
        }
    }
    worst
}

/// Largest protrusion of a facet into a sphere, as a fraction of its radius; 0 if there is none.
pub(crate) fn largest_protrusion(facets: &[[Point; 3]], positions: &[Point], radii: &[f64]) -> f64 {
    let boxes: Vec<[Point; 2]> = facets
        .iter()
        .map(|[a, b, c]| {
            [
                [0, 1, 2].map(|k| a[k].min(b[k]).min(c[k])),
                [0, 1, 2].map(|k| a[k].max(b[k]).max(c[k])),
            ]
        })
        .collect();
    let mut worst = 0.0_f64;
    for (p, r) in positions.iter().zip(radii) {
        for (facet, [low, high]) in facets.iter().zip(&boxes) {
            if (0..3).all(|k| low[k] - r < p[k] && p[k] < high[k] + r) {
                worst = worst.max((r - distance_to_triangle(p, facet)) / r);
            }
        }
    }
    worst
}

/// Winding number of the facets around a point: 0 outside a closed surface.
pub(crate) fn winding_number(facets: &[[Point; 3]], p: &Point) -> i64 {
    let mut angle = 0.0;
    for corners in facets {
        let [a, b, c] = corners.map(|corner| sub(corner, *p));
        let [la, lb, lc] = [a, b, c].map(length);
        let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        angle += 2.0 * dot(a, cross(b, c)).atan2(below);
    }
    (angle / (4.0 * std::f64::consts::PI)).round() as i64
}

/// Distance from a point to a triangle.
pub(crate) fn distance_to_triangle(p: &Point, [a, b, c]: &[Point; 3]) -> f64 {
    let (ab, ac, ap) = (sub(*b, *a), sub(*c, *a), sub(*p, *a));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return length(ap);
    }
    let bp = sub(*p, *b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return length(bp);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return length(sub(ap, scaled(ab, d1 / (d1 - d3))));
    }
    let cp = sub(*p, *c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return length(cp);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return length(sub(ap, scaled(ac, d2 / (d2 - d6))));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return length(sub(
            bp,
            scaled(sub(*c, *b), (d4 - d3) / ((d4 - d3) + (d5 - d6))),
        ));
    }
    let normal = cross(ab, ac);
    dot(ap, normal).abs() / length(normal)
}

pub(crate) fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn scaled(a: Point, factor: f64) -> Point {
    a.map(|x| factor * x)
}
