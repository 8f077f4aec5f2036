//! Solids as the facets of a binary STL file would hold them: bare triangles, coordinates that are
//! exact in single precision.

/// A point, in the unit of the file.
pub(crate) type Point = [f64; 3];
/// Triangles, counter-clockwise seen from outside.
pub(crate) type Facets = Vec<[Point; 3]>;

/// The facets with every coordinate rounded to single precision, as an STL file keeps them.
pub(crate) fn rounded(facets: Facets) -> Facets {
    facets
        .into_iter()
        .map(|corners| corners.map(|p| p.map(|x| f64::from(x as f32))))
        .collect()
}

/// A binary STL file.
pub(crate) fn stl(facets: &[[Point; 3]]) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((facets.len() as u32).to_le_bytes());
    for corners in facets {
        bytes.extend([0; 12]);
        for x in corners.iter().flatten() {
            bytes.extend((*x as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

/// A polygon (counter-clockwise, no corner twice) drawn out from z = 0 to `height`.
pub(crate) fn prism(polygon: &[[f64; 2]], height: f64) -> Facets {
    let at = |i: usize, z: f64| {
        let [x, y] = polygon[i % polygon.len()];
        [x, y, z]
    };
    let mut facets = Facets::new();
    for i in 0..polygon.len() {
        facets.push([at(i, 0.0), at(i + 1, 0.0), at(i + 1, height)]);
        facets.push([at(i, 0.0), at(i + 1, height), at(i, height)]);
    }
    for [a, b, c] in ears(polygon) {
        facets.push([at(a, height), at(b, height), at(c, height)]);
        facets.push([at(a, 0.0), at(c, 0.0), at(b, 0.0)]);
    }
    rounded(facets)
}

/// A box with one corner at the origin.
pub(crate) fn cuboid([x, y, z]: Point) -> Facets {
    prism(&[[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]], z)
}

/// The triangles of a polygon, by cutting off one ear after the other.
fn ears(polygon: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let turn = |a: usize, b: usize, c: usize| {
        let [p, q, r] = [a, b, c].map(|i| polygon[i]);
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    };
    let mut left: Vec<usize> = (0..polygon.len()).collect();
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let n = left.len();
        let ear = (0..n).find(|i| {
            let [a, b, c] = [left[(i + n - 1) % n], left[*i], left[(i + 1) % n]];
            let others = left.iter().filter(|p| ![a, b, c].contains(p));
            turn(a, b, c) > 0.0
                && others
                    .into_iter()
                    .all(|p| turn(a, b, *p) < 0.0 || turn(b, c, *p) < 0.0 || turn(c, a, *p) < 0.0)
        });
        let ear = ear.expect("a simple polygon has an ear");
        triangles.push([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]]);
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]]);
    triangles
}
