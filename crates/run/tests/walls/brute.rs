//! Meshes compared with a separate test of every face, edge and vertex.

use dem_physics::geometry::{Shape, Touch};
use nalgebra::Vector3;
use proptest::prelude::*;

use super::{Surface, add_tiles, apart, mesh, touches};

type Vector = Vector3<f64>;

/// Points nearer than all surface around them, found without any tolerance: over a face; over an
/// edge from which every adjacent triangle leads away; over a vertex from which every adjacent edge
/// leads away.
///
/// None if not in general position: the foot on an edge is so near to one of its ends that the
/// nearest point is undecided within rounding, if the surface comes nearer beyond the end.
fn everything(
    (vertices, triangles): &Surface,
    c: Vector,
    reach: f64,
) -> Option<Vec<(Vector, bool, bool)>> {
    let at = |v: u32| Vector::from(vertices[v as usize]);
    // Whether all triangles with these vertices are smaller than the reach.
    let is_fine = |some: &[u32]| {
        let own = triangles
            .iter()
            .filter(|t| some.iter().all(|v| t.contains(v)));
        own.clone().all(|t| {
            let [p, q, r] = t.map(at);
            (p.sup(&q).sup(&r) - p.inf(&q).inf(&r)).norm() < reach
        })
    };
    let mut found: Vec<(Vector, bool, bool)> = Vec::new();
    for [a, b, d] in triangles {
        let [p, q, r] = [a, b, d].map(|v| at(*v));
        let normal = (q - p).cross(&(r - p)).normalize();
        let foot = c - (c - p).dot(&normal) * normal;
        let is_left = |x: Vector, y: Vector| (y - x).cross(&(foot - x)).dot(&normal) > 0.0;
        if is_left(p, q) && is_left(q, r) && is_left(r, p) {
            found.push((foot, true, is_fine(&[*a, *b, *d])));
        }
    }
    let mut edges: Vec<[u32; 2]> = triangles
        .iter()
        .flat_map(|[a, b, d]| [[a, b], [b, d], [d, a]].map(|[x, y]| [*x.min(y), *x.max(y)]))
        .collect();
    edges.sort_unstable();
    edges.dedup();
    for [a, b] in &edges {
        let (p, q) = (at(*a), at(*b));
        let fraction = (c - p).dot(&(q - p)) / (q - p).norm_squared();
        let to_ends_m = [fraction, 1.0 - fraction].map(|s| s.abs() * (q - p).norm());
        if to_ends_m[0].min(to_ends_m[1]) < 4e-9 * reach {
            return None;
        }
        if fraction <= 0.0 || fraction >= 1.0 {
            continue;
        }
        let foot = p.lerp(&q, fraction);
        let leads_away = triangles
            .iter()
            .filter(|t| t.contains(a) && t.contains(b))
            .all(|t| {
                let third = t.iter().find(|v| *v != a && *v != b).unwrap();
                let across = at(*third) - p;
                let across = across - across.dot(&(q - p)) / (q - p).norm_squared() * (q - p);
                (c - foot).dot(&across) < 0.0
            });
        if leads_away {
            found.push((foot, false, is_fine(&[*a, *b])));
        }
    }
    for v in 0..vertices.len() as u32 {
        let mut others = edges
            .iter()
            .filter(|e| e.contains(&v))
            .map(|e| at(e[0] + e[1] - v))
            .peekable();
        if others.peek().is_some() && others.all(|other| (c - at(v)).dot(&(other - at(v))) < 0.0) {
            found.push((at(v), false, is_fine(&[v])));
        }
    }
    found.retain(|(p, ..)| (c - p).norm() < reach);
    found.sort_by(|a, b| (c - a.0).norm().total_cmp(&(c - b.0).norm()));
    // Of faces with the same direction within 8 degrees, the nearest; of points on facets smaller
    // than the reach, within 26 degrees.
    let mut kept: Vec<(Vector, bool, bool)> = Vec::new();
    for (p, is_face, is_fine) in found {
        let hidden = |(q, other, fine): &(Vector, bool, bool)| {
            let cosine = (p - c).normalize().dot(&(q - c).normalize());
            is_face && *other && cosine > 0.99 || is_fine && *fine && cosine > 0.9
        };
        if !kept.iter().any(hidden) {
            kept.push((p, is_face, is_fine));
        }
    }
    Some(kept)
}

fn assert_finds_everything(surface: &Surface, centres: &[[f64; 3]], reach: f64) {
    let shape = Shape::Mesh(mesh(surface));
    for centre in centres {
        let Some(wanted) = everything(surface, Vector::from(*centre), reach) else {
            continue;
        };
        let mut found: Vec<Touch> = touches(&shape, *centre, reach);
        found.sort_by(|a, b| a.distance_m.total_cmp(&b.distance_m));
        assert_eq!(
            found.len(),
            wanted.len(),
            "{centre:?}: {found:?} {wanted:?}"
        );
        for (found, (wanted, ..)) in found.iter().zip(&wanted) {
            assert!(apart(found.point, (*wanted).into()) < 1e-12);
        }
    }
}

fn places(count: usize) -> impl Strategy<Value = Vec<[f64; 3]>> {
    prop::collection::vec(prop::array::uniform3(-1.2..1.2_f64), count)
}

proptest! {
    /// Hills and hollows, open at the rim.
    #[test]
    fn of_a_landscape(
        heights in prop::collection::vec(-0.5..0.5_f64, 49),
        centres in places(30),
        reach in 0.05..2.0_f64,
    ) {
        let mut surface = (Vec::new(), Vec::new());
        add_tiles(&mut surface, 6, |i, j| {
            let at = |i: u32| f64::from(i) / 3.0 - 1.0;
            [at(i), at(j), heights[(7 * i + j) as usize]]
        });
        assert_finds_everything(&surface, &centres, reach);
    }

    /// Triangles anywhere, with random shared vertices: edges of one to several triangles.
    #[test]
    fn of_a_heap_of_triangles(
        vertices in places(12),
        triangles in prop::collection::btree_set(prop::array::uniform3(0_u32..12), 1..15),
        centres in places(30),
        reach in 0.05..2.0_f64,
    ) {
        let mut known = std::collections::BTreeSet::new();
        let triangles: Vec<[u32; 3]> = triangles
            .into_iter()
            .filter(|t| {
                let mut sorted = *t;
                sorted.sort_unstable();
                sorted[0] < sorted[1] && sorted[1] < sorted[2] && known.insert(sorted)
            })
            .collect();
        prop_assume!(!triangles.is_empty());
        assert_finds_everything(&(vertices, triangles), &centres, reach);
    }
}

/// A ridge that rises to a peak, beyond which a slope leads to a nearer point. Above the ridge, all
/// points within the rounding tolerance of the peak are replaced by that slope; a little farther
/// down they are contacts of their own.
#[test]
fn next_to_a_peak_only_what_stands_out_is_touched() {
    let vertices = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.5, 1.0, -1.0],
        [0.5, -1.0, -1.0],
        [-1.0, 0.5, 0.5],
        [-1.0, -0.5, 0.5],
    ];
    let triangles = vec![[0, 1, 2], [0, 3, 1], [0, 4, 5]];
    let shape = Shape::Mesh(mesh(&(vertices.clone(), triangles.clone())));
    let points = |x: f64| -> Vec<[f64; 3]> {
        let found = touches(&shape, [x, 0.0, 0.5], 0.6);
        found.iter().map(|touch| touch.point).collect()
    };
    for x in [1e-3, 1e-6, 1e-8, 4e-9] {
        assert_eq!(points(x).len(), 2, "{x}: {:?}", points(x));
        let surface = (vertices.clone(), triangles.clone());
        assert_finds_everything(&surface, &[[x, 0.0, 0.5]], 0.6);
    }
    for x in [4e-10, 1e-12, 0.0, -1e-9, -1e-3] {
        let [nearest] = points(x)[..] else {
            panic!("{x}: {:?}", points(x));
        };
        assert!(apart(nearest, [-0.2, 0.0, 0.1]) < 1e-2, "{nearest:?}");
    }
}

/// Many more triangles than are near.
#[test]
fn of_a_large_landscape() {
    let mut surface = (Vec::new(), Vec::new());
    add_tiles(&mut surface, 40, |i, j| {
        let at = |i: u32| f64::from(i) / 20.0 - 1.0;
        [
            at(i),
            at(j),
            0.1 * (7.0 * at(i)).sin() * (5.0 * at(j)).cos(),
        ]
    });
    let centres: Vec<[f64; 3]> = (1..300)
        .map(|i| {
            let t = f64::from(i);
            [(1.1 * t).sin(), (1.7 * t).cos(), 0.3 * (2.3 * t).sin()]
        })
        .collect();
    assert_finds_everything(&surface, &centres, 0.15);
}
