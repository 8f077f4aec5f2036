//! A box as a closed surface, for tests.

/// Vertices, m, and triangles of a box: twelve with their normals outwards.
pub(crate) fn closed_box(low: [f64; 3], high: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let vertices = (0..8_usize)
        .map(|n| [0, 1, 2].map(|k| if n >> k & 1 == 0 { low[k] } else { high[k] }))
        .collect();
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = sides
        .into_iter()
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    (vertices, triangles)
}
