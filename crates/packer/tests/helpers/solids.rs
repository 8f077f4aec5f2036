//! Solids for the tests of the packer.

use super::exact::{cross, distance_to_triangle, dot, length, scaled, sub};
use super::facets::{Facets, Point, cuboid, prism, rounded, stl};
use dem_io::Surface;
use dem_io::surface::{ReadSettings, read_surface};
use dem_pack::internals::Boundary;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;

/// Random numbers that are the same on every machine.
pub(crate) fn random_numbers(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// A random number between two limits.
pub(crate) fn between(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * random.random::<f64>()
}

/// A random point of the box between two corners.
pub(crate) fn point_between(random: &mut ChaCha8Rng, low: Point, high: Point) -> Point {
    [0, 1, 2].map(|k| between(random, low[k], high[k]))
}

/// The packer's input for facets in mm.
pub(crate) fn surface_of(facets: &Facets) -> (Surface, Boundary) {
    let settings = ReadSettings {
        unit_m: Some(1e-3),
        scale: 1.0,
        fill_holes: false,
    };
    let surface = read_surface(&stl(facets), "test", settings).unwrap();
    let boundary = Boundary::new(&surface).unwrap();
    (surface, boundary)
}

/// The facets as the surface keeps them, in its local units.
pub(crate) fn local_facets(surface: &Surface) -> Facets {
    (0..surface.triangles.len())
        .map(|t| surface.corners(t))
        .collect()
}

/// Distance from a point to the nearest of the facets.
pub(crate) fn distance_to_surface(facets: &[[Point; 3]], p: &Point) -> f64 {
    facets
        .iter()
        .map(|facet| distance_to_triangle(p, facet))
        .fold(f64::INFINITY, f64::min)
}

/// A torus around the z axis: ring radius, tube radius, facets along both.
pub(crate) fn torus(ring: f64, tube: f64, around_ring: usize, around_tube: usize) -> Facets {
    let at = |i: usize, j: usize| {
        let phi = TAU * (i % around_ring) as f64 / around_ring as f64;
        let theta = TAU * (j % around_tube) as f64 / around_tube as f64;
        let rho = ring + tube * theta.cos();
        [rho * phi.cos(), rho * phi.sin(), tube * theta.sin()]
    };
    let mut facets = Facets::new();
    for i in 0..around_ring {
        for j in 0..around_tube {
            facets.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            facets.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    rounded(facets)
}

/// An icosahedron whose facets were cut into four `times` over and whose corners were moved to
/// `radius(direction)`.
pub(crate) fn icosphere(times: usize, radius: &dyn Fn(Point) -> f64) -> Facets {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut corners = Vec::new();
    for a in [-1.0, 1.0] {
        for b in [-golden, golden] {
            corners.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]]);
        }
    }
    // Corners are joined where they are 2 apart.
    let joined = |p: Point, q: Point| (length(sub(p, q)) - 2.0).abs() < 0.1;
    let mut facets = Facets::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                let [a, b, c] = [corners[i], corners[j], corners[k]];
                if joined(a, b) && joined(b, c) && joined(c, a) {
                    let outwards = dot(a, cross(sub(b, a), sub(c, a))) > 0.0;
                    facets.push(if outwards { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    // The middle of an edge is the same from both sides: a + b = b + a.
    let middle = |a: Point, b: Point| [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]));
    for _ in 0..times {
        facets = facets
            .into_iter()
            .flat_map(|[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let moved = |p: Point| {
        let direction = scaled(p, 1.0 / length(p));
        scaled(direction, radius(direction))
    };
    rounded(
        facets
            .into_iter()
            .map(|corners| corners.map(moved))
            .collect(),
    )
}

/// The same facets seen from the other side: the wall of a cavity.
pub(crate) fn turned_inside_out(facets: Facets) -> Facets {
    facets.into_iter().map(|[a, b, c]| [a, c, b]).collect()
}

/// The facets moved and rotated at random.
pub(crate) fn turned(random: &mut ChaCha8Rng, facets: Facets) -> Facets {
    let angles = [0; 3].map(|_| between(random, 0.0, TAU));
    let rotation = nalgebra::Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
    let shift = point_between(random, [-50.0; 3], [50.0; 3]);
    let place = |p: Point| {
        let q = rotation * nalgebra::Vector3::from(p);
        [0, 1, 2].map(|k| q[k] + shift[k])
    };
    rounded(
        facets
            .into_iter()
            .map(|corners| corners.map(place))
            .collect(),
    )
}

/// A shape of a different kind for each of 0 to 5, with random sizes, about 10 across (mm).
pub(crate) fn random_solid(random: &mut ChaCha8Rng, kind: usize) -> (&'static str, Facets) {
    match kind {
        0 => ("box", cuboid([0; 3].map(|_| between(random, 5.0, 14.0)))),
        1 => {
            let base = between(random, 12.0, 20.0);
            let top = point_between(random, [0.0, 0.0, 10.0], [base, base, 18.0]);
            let [o, x, y] = [[0.0; 3], [base, 0.0, 0.0], [0.3 * base, base, 0.0]];
            (
                "tetrahedron",
                rounded(vec![[o, y, x], [o, x, top], [x, y, top], [y, o, top]]),
            )
        }
        2 => {
            let waves = [0; 6].map(|_| between(random, -1.0, 1.0));
            let radius = move |d: Point| {
                let bumps = waves[0] * (3.0 * d[0] + waves[3]).sin()
                    + waves[1] * (4.0 * d[1] + waves[4]).sin()
                    + waves[2] * (5.0 * d[2] + waves[5]).sin();
                6.0 * (0.25 * bumps).exp()
            };
            ("star", icosphere(3, &radius))
        }
        3 => {
            let [a, b] = [0; 2].map(|_| between(random, 9.0, 14.0));
            let [s, t] = [0; 2].map(|_| between(random, 3.0, 6.0));
            (
                "L",
                prism(
                    &[[0.0, 0.0], [a, 0.0], [a, s], [t, s], [t, b], [0.0, b]],
                    between(random, 3.0, 8.0),
                ),
            )
        }
        4 => {
            let (long, thick) = (between(random, 20.0, 30.0), between(random, 3.0, 5.0));
            (
                "wedge",
                prism(
                    &[[0.0, 0.0], [long, 0.0], [long, thick]],
                    between(random, 6.0, 12.0),
                ),
            )
        }
        _ => (
            "torus",
            torus(between(random, 6.0, 9.0), between(random, 1.6, 2.5), 40, 20),
        ),
    }
}
