//! Shapes swept along circles and curves.

use super::mesh::{Mesh, cross, sub, unit};
use std::f64::consts::TAU;

/// Joins rings with equal numbers of corners into a tube; with `closed` the last is joined to the
/// first. The corners run clockwise, seen along the tube from its end.
fn join_rings(mesh: &mut Mesh, rings: &[Vec<u32>], closed: bool) {
    let pairs = if closed { rings.len() } else { rings.len() - 1 };
    for i in 0..pairs {
        let (here, next) = (&rings[i], &rings[(i + 1) % rings.len()]);
        for j in 0..here.len() {
            let k = (j + 1) % here.len();
            mesh.quad([here[j], here[k], next[k], next[j]]);
        }
    }
}

/// A torus with R = 20 mm and r = 6 mm: 120 sections with 48 corners each.
pub(crate) fn torus() -> Mesh {
    let mut mesh = Mesh::default();
    let rings: Vec<Vec<u32>> = (0..120)
        .map(|i| {
            let (sin, cos) = (TAU * f64::from(i) / 120.0).sin_cos();
            (0..48)
                .map(|j| {
                    let (out, up) = (TAU * f64::from(j) / 48.0).sin_cos();
                    let distance = 20.0 + 6.0 * out;
                    mesh.vertex([distance * cos, distance * sin, 6.0 * up])
                })
                .collect()
        })
        .collect();
    join_rings(&mut mesh, &rings, true);
    mesh
}

/// A C: three quarters of a flat ring with the radii 14 and 26 mm, 12 mm high, whose box centre
/// lies in the opening.
pub(crate) fn c_shape() -> Mesh {
    const STEPS: u32 = 90;
    let mut mesh = Mesh::default();
    let rings: Vec<Vec<u32>> = (0..=STEPS)
        .map(|i| {
            let angle = TAU / 8.0 + 0.75 * TAU * f64::from(i) / f64::from(STEPS);
            let (sin, cos) = angle.sin_cos();
            [(14.0, 0.0), (14.0, 12.0), (26.0, 12.0), (26.0, 0.0)]
                .map(|(distance, z)| mesh.vertex([distance * cos, distance * sin, z]))
                .to_vec()
        })
        .collect();
    join_rings(&mut mesh, &rings, false);
    let (first, last) = (&rings[0], &rings[STEPS as usize]);
    mesh.quad([first[3], first[2], first[1], first[0]]);
    mesh.quad([last[0], last[1], last[2], last[3]]);
    mesh
}

/// A tube, open at both ends: 10 mm wide inside, 20 mm long, with a wall of 0.3 mm.
pub(crate) fn tube() -> Mesh {
    ring(&[(0.0, 5.0, 5.3), (20.0, 5.0, 5.3)])
}

/// A round plate of 40 mm, 1 mm thick, with its top on z = 0 and a hole of 10 mm.
pub(crate) fn orifice() -> Mesh {
    ring(&[(-1.0, 5.0, 20.0), (0.0, 5.0, 20.0)])
}

/// A cone of 45 degrees that widens from a hole of 10 mm on z = 0 to 52 mm on z = 21 mm. Its wall
/// is 0.5 mm wide, seen from above.
pub(crate) fn funnel() -> Mesh {
    ring(&[(0.0, 5.0, 5.5), (7.0, 12.0, 12.5), (21.0, 26.0, 26.5)])
}

/// A ring through these heights from below, each with the radii inside and outside, in mm: polygons
/// of 72 corners, those inside with the area of their circle.
fn ring(heights: &[(f64, f64, f64)]) -> Mesh {
    const SIDES: u32 = 72;
    let side = TAU / f64::from(SIDES);
    let wider = (side / side.sin()).sqrt();
    let inside = heights.iter().map(|(z, inside, _)| (inside * wider, *z));
    let outside = heights.iter().rev().map(|(z, _, outside)| (*outside, *z));
    let corners: Vec<(f64, f64)> = inside.chain(outside).collect();
    let mut mesh = Mesh::default();
    let section = |i: u32| {
        let (sin, cos) = (side * f64::from(i)).sin_cos();
        let corner = |&(distance, z): &(f64, f64)| mesh.vertex([distance * cos, distance * sin, z]);
        corners.iter().map(corner).collect()
    };
    let rings: Vec<Vec<u32>> = (0..SIDES).map(section).collect();
    join_rings(&mut mesh, &rings, true);
    mesh
}

/// An infinity knot: a round tube 14 mm thick along (45 sin t, 20 sin 2t, 8 cos t) mm, which passes
/// over itself with a gap of 2 mm.
pub(crate) fn infinity_knot() -> Mesh {
    const STEPS: u32 = 240;
    const CORNERS: u32 = 30;
    let mut mesh = Mesh::default();
    let rings: Vec<Vec<u32>> = (0..STEPS)
        .map(|i| {
            let t = TAU * f64::from(i) / f64::from(STEPS);
            let centre = [45.0 * t.sin(), 20.0 * (2.0 * t).sin(), 8.0 * t.cos()];
            let along = unit([45.0 * t.cos(), 40.0 * (2.0 * t).cos(), -8.0 * t.sin()]);
            let up = unit(sub([0.0, 0.0, 1.0], along.map(|x| x * along[2])));
            let side = cross(along, up);
            (0..CORNERS)
                .map(|j| {
                    let (sin, cos) = (TAU * f64::from(j) / f64::from(CORNERS)).sin_cos();
                    mesh.vertex(std::array::from_fn(|k| {
                        centre[k] + 7.0 * (cos * up[k] + sin * side[k])
                    }))
                })
                .collect()
        })
        .collect();
    join_rings(&mut mesh, &rings, true);
    mesh
}

/// The disc of the Brazilian test: 50 mm across and 25 mm thick, with its axis along y and 96
/// sides, around the origin.
pub(crate) fn disc() -> Mesh {
    round_bar(25.0, 12.5, 96, 1)
}

/// A stalk: 12 mm across and 200 mm long, with its axis along z and 48 sides, upright on z = 0.
pub(crate) fn stalk() -> Mesh {
    let mut stalk = round_bar(6.0, 100.0, 48, 8);
    for [x, y, z] in &mut stalk.vertices {
        [*x, *y, *z] = [*z, *x, *y + 100.0];
    }
    stalk
}

/// A dog bone: 80 mm long, upright on z = 0, round, with ends 25 mm across and 15 mm long, a neck
/// 15 mm across and 24 mm long in the middle, and smooth fillets of 13 mm between them.
pub(crate) fn dog_bone() -> Mesh {
    const SEGMENTS: u32 = 80;
    let mut bone = round_bar(1.0, 40.0, 48, SEGMENTS);
    for [x, y, z] in &mut bone.vertices {
        let along_fillet = ((y.abs() - 12.0) / 13.0).clamp(0.0, 1.0);
        let radius = 7.5 + 2.5 * (1.0 - (0.5 * TAU * along_fillet).cos());
        [*x, *y, *z] = [radius * *z, radius * *x, *y + 40.0];
    }
    bone
}

/// A round bar around the origin, with its axis along y, divided into segments along it.
fn round_bar(radius: f64, half_length: f64, sides: u32, segments: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut ring = |n: u32| -> Vec<u32> {
        let y = half_length * (1.0 - 2.0 * f64::from(n) / f64::from(segments));
        (0..sides)
            .map(|j| {
                let (sin, cos) = (TAU * f64::from(j) / f64::from(sides)).sin_cos();
                mesh.vertex([radius * cos, y, radius * sin])
            })
            .collect()
    };
    let rings: Vec<Vec<u32>> = (0..=segments).map(&mut ring).collect();
    join_rings(&mut mesh, &rings, false);
    for (ring, y, from, to) in [
        (&rings[0], half_length, 1, 0),
        (&rings[segments as usize], -half_length, 0, 1),
    ] {
        let centre = mesh.vertex([0.0, y, 0.0]);
        for j in 0..ring.len() {
            let pair = [ring[j], ring[(j + 1) % ring.len()]];
            mesh.triangles.push([centre, pair[from], pair[to]]);
        }
    }
    mesh
}

/// A round biconvex tablet: 10 mm across, a band 2.4 mm high and on each side a dome of 1 mm, which
/// is part of a sphere of 13 mm radius.
pub(crate) fn tablet() -> Mesh {
    const RINGS: u32 = 16;
    let mut mesh = Mesh::default();
    let bottom = dome(&mut mesh, RINGS, -1.0);
    let mut rings = vec![bottom];
    for z in [-0.4, 0.4] {
        rings.push(circle(&mut mesh, 6 * RINGS, 5.0, z));
    }
    rings.push(dome(&mut mesh, RINGS, 1.0));
    join_rings(&mut mesh, &rings, false);
    mesh
}

fn circle(mesh: &mut Mesh, corners: u32, radius: f64, z: f64) -> Vec<u32> {
    (0..corners)
        .map(|j| {
            let (sin, cos) = (TAU * f64::from(j) / f64::from(corners)).sin_cos();
            mesh.vertex([radius * cos, radius * sin, z])
        })
        .collect()
}

/// Adds the upper (`side` = 1) or lower (-1) dome of the tablet, rings with 6, 12, 18 ... corners;
/// returns its rim.
fn dome(mesh: &mut Mesh, rings: u32, side: f64) -> Vec<u32> {
    let height = |radius: f64| side * (1.2 + (169.0 - radius * radius).sqrt() - 12.0);
    let first_triangle = mesh.triangles.len();
    let mut inner = vec![mesh.vertex([0.0, 0.0, height(0.0)])];
    for ring in 1..=rings {
        let radius = 5.0 * f64::from(ring) / f64::from(rings);
        let outer = circle(mesh, 6 * ring, radius, height(radius));
        for sixth in 0..6 {
            let (ring, sixth) = (ring as usize, sixth as usize);
            for j in 0..ring {
                let at = |k: usize| outer[(sixth * ring + k) % outer.len()];
                let within = |k: usize| inner[(sixth * (ring - 1) + k) % inner.len()];
                mesh.triangles.push([within(j), at(j), at(j + 1)]);
                if j + 1 < ring {
                    mesh.triangles.push([within(j), at(j + 1), within(j + 1)]);
                }
            }
        }
        inner = outer;
    }
    if side < 0.0 {
        for triangle in &mut mesh.triangles[first_triangle..] {
            triangle.swap(1, 2);
        }
    }
    inner
}
