//! Small solids and their files, for tests.

/// Three corners.
pub(crate) type Facet = [[f64; 3]; 3];

/// A box along the axes, 12 facets wound outwards.
pub(crate) fn block(min: [f64; 3], max: [f64; 3]) -> Vec<Facet> {
    let corner = |i: usize| [0, 1, 2].map(|k| if i >> k & 1 == 0 { min[k] } else { max[k] });
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    faces
        .iter()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
        .map(|facet| facet.map(corner))
        .collect()
}

/// A box from the origin, each face a grid of `counts[face]` squares by as many.
pub(crate) fn block_of_grids(size: [f64; 3], counts: [usize; 6]) -> Vec<Facet> {
    let mut facets = Vec::new();
    for (face, count) in counts.into_iter().enumerate() {
        let (axis, upper) = (face / 2, face % 2 == 1);
        let point = |i: usize, j: usize| {
            let mut point = [0.0; 3];
            point[axis] = if upper { size[axis] } else { 0.0 };
            point[(axis + 1) % 3] = size[(axis + 1) % 3] * i as f64 / count as f64;
            point[(axis + 2) % 3] = size[(axis + 2) % 3] * j as f64 / count as f64;
            point
        };
        let mut grid = Vec::new();
        for i in 0..count {
            for j in 0..count {
                let [a, b, c, d] = [
                    point(i, j),
                    point(i + 1, j),
                    point(i + 1, j + 1),
                    point(i, j + 1),
                ];
                grid.extend([[a, b, c], [a, c, d]]);
            }
        }
        facets.extend(if upper { grid } else { turned(&grid) });
    }
    facets
}

/// A one-sided strip: `count` pieces around a ring, with half a twist.
pub(crate) fn moebius_strip(count: usize) -> Vec<Facet> {
    let point = |i: usize, side: f64| {
        let angle = std::f64::consts::TAU * i as f64 / count as f64;
        let side = if i == count { -side } else { side };
        let twist = if i == count { 0.0 } else { angle / 2.0 };
        let radius = 3.0 + side * twist.cos();
        let angle = if i == count { 0.0 } else { angle };
        [
            radius * angle.cos(),
            radius * angle.sin(),
            side * twist.sin(),
        ]
    };
    let quads = (0..count).map(|i| {
        [
            point(i, -1.0),
            point(i + 1, -1.0),
            point(i + 1, 1.0),
            point(i, 1.0),
        ]
    });
    quads
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect()
}

/// A tube of radius 1 along z, `count` sides around, closed at the bottom and open at the top.
pub(crate) fn open_tube(count: usize, height: f64) -> Vec<Facet> {
    let point = |i: usize, z: f64| {
        let angle = std::f64::consts::TAU * (i % count) as f64 / count as f64;
        [angle.cos(), angle.sin(), z]
    };
    let side = |i: usize| {
        let [a, b, c, d] = [
            point(i, 0.0),
            point(i + 1, 0.0),
            point(i + 1, height),
            point(i, height),
        ];
        [[a, b, c], [a, c, d], [[0.0; 3], b, a]]
    };
    (0..count).flat_map(side).collect()
}

/// The facets with reversed winding.
pub(crate) fn turned(facets: &[Facet]) -> Vec<Facet> {
    facets.iter().map(|[a, b, c]| [*a, *c, *b]).collect()
}

/// The facets, moved.
pub(crate) fn moved(facets: &[Facet], by: [f64; 3]) -> Vec<Facet> {
    facets
        .iter()
        .map(|facet| facet.map(|p| [p[0] + by[0], p[1] + by[1], p[2] + by[2]]))
        .collect()
}

/// The facets mirrored in the plane x = 1, wound outwards again.
pub(crate) fn mirrored(facets: &[Facet]) -> Vec<Facet> {
    turned(
        &facets
            .iter()
            .map(|facet| facet.map(|p| [2.0 - p[0], p[1], p[2]]))
            .collect::<Vec<_>>(),
    )
}

/// The facets rotated about z, y and x, in this order, by three angles in radians.
pub(crate) fn rotated(facets: &[Facet], angles: [f64; 3]) -> Vec<Facet> {
    let turn = |p: [f64; 3]| {
        let mut p = p;
        for (k, angle) in angles.into_iter().enumerate() {
            let (i, j) = (k, (k + 1) % 3);
            (p[i], p[j]) = (
                p[i] * angle.cos() - p[j] * angle.sin(),
                p[i] * angle.sin() + p[j] * angle.cos(),
            );
        }
        p
    };
    facets.iter().map(|facet| facet.map(turn)).collect()
}

/// A binary STL.
pub(crate) fn binary(facets: &[Facet]) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((facets.len() as u32).to_le_bytes());
    for facet in facets {
        bytes.extend([0; 12]);
        bytes.extend(
            facet
                .as_flattened()
                .iter()
                .flat_map(|x| (*x as f32).to_le_bytes()),
        );
        bytes.extend([0; 2]);
    }
    bytes
}

/// An ASCII STL with one solid for each of `solids`, every number with all its digits.
pub(crate) fn ascii(solids: &[&[Facet]]) -> String {
    let mut text = String::new();
    for facets in solids {
        text += "solid part\n";
        for facet in *facets {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in facet {
                text += &format!("vertex {x:e} {y:e} {z:e}\n");
            }
            text += "endloop\nendfacet\n";
        }
        text += "endsolid part\n";
    }
    text
}
