//! Lattices of spheres.

use dem_pack::Spheres;

/// n[0] x n[1] x n[2] spheres one apart, the first at (1/2, 1/2, 1/2).
pub(crate) fn cubic(n: [usize; 3], radius: f64) -> Spheres {
    let mut positions = Vec::new();
    for z in 0..n[2] {
        for y in 0..n[1] {
            for x in 0..n[0] {
                positions.push([x, y, z].map(|i| i as f64 + 0.5));
            }
        }
    }
    Spheres {
        radii: vec![radius; positions.len()],
        positions,
    }
}
