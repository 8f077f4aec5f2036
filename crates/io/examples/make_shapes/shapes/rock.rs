//! Balls, and a rock made of one.

use super::mesh::{Mesh, cross, dot, unit};
use super::noise::{Random, layered};
use std::collections::BTreeMap;

/// A sphere of triangles: an icosahedron with every triangle divided into four `times` times,
/// corners on the sphere.
pub(crate) fn ball(centre: [f64; 3], radius: f64, times: u32) -> Mesh {
    let mut mesh = directions(times);
    for vertex in &mut mesh.vertices {
        *vertex = std::array::from_fn(|k| centre[k] + radius * vertex[k]);
    }
    mesh
}

/// The same of radius 1 about the origin.
fn directions(times: u32) -> Mesh {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut mesh = Mesh::default();
    for (a, b) in [
        (-1.0, golden),
        (1.0, golden),
        (-1.0, -golden),
        (1.0, -golden),
    ] {
        for point in [[a, b, 0.0], [0.0, a, b], [b, 0.0, a]] {
            mesh.vertex(unit(point));
        }
    }
    let near = |v: usize, w: usize| dot(mesh.vertices[v], mesh.vertices[w]) > 0.4;
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    let [p, q, r] = [a, b, c].map(|v| mesh.vertices[v]);
                    let outward = dot(p, cross(q, r)) > 0.0;
                    let turn = if outward { [a, b, c] } else { [a, c, b] };
                    mesh.triangles.push(turn.map(|v| v as u32));
                }
            }
        }
    }
    for _ in 0..times {
        mesh = cut_in_four(&mesh);
    }
    mesh
}

fn cut_in_four(coarse: &Mesh) -> Mesh {
    let mut fine = Mesh {
        vertices: coarse.vertices.clone(),
        triangles: Vec::new(),
    };
    let mut middles = BTreeMap::new();
    for &[a, b, c] in &coarse.triangles {
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(v, w)| {
            *middles.entry((v.min(w), v.max(w))).or_insert_with(|| {
                let (p, q) = (coarse.vertices[v as usize], coarse.vertices[w as usize]);
                fine.vertex(unit(std::array::from_fn(|k| p[k] + q[k])))
            })
        });
        fine.triangles
            .extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    fine
}

/// A rock about 40 mm long: an ellipsoid with layers of noise, broken flat on some sides. Every
/// corner stays on its ray from the centre, so the surface is star-shaped and cannot cross itself.
pub(crate) fn rock() -> Mesh {
    const SEED: u64 = 11;
    let mut random = Random(SEED);
    let cuts: Vec<([f64; 3], f64)> = (0..14)
        .map(|_| (random.direction(), random.between(0.74, 0.95)))
        .collect();
    let mut mesh = directions(5);
    for vertex in &mut mesh.vertices {
        let at = *vertex;
        let mut reach = 1.0 + 0.30 * layered(SEED, at.map(|x| 1.3 * x), 2, 0.5);
        for (normal, distance) in &cuts {
            let along = dot(at, *normal);
            if along > 0.0 {
                reach = reach.min(distance / along);
            }
        }
        let ridges = layered(SEED + 100, at.map(|x| 3.1 * x), 3, 0.55).abs();
        let grain = layered(SEED + 200, at.map(|x| 9.0 * x), 3, 0.6);
        reach *= 1.0 - 0.05 * ridges + 0.011 * grain;
        *vertex = [
            20.5 * reach * at[0],
            16.5 * reach * at[1],
            14.0 * reach * at[2],
        ];
    }
    mesh
}
