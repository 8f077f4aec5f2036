//! Convex prisms as STL.

use std::f64::consts::TAU;

/// Corners of the polygon that stands for a circle.
const CORNERS: u32 = 32;

/// A box with one corner at the origin, in the unit of the lengths.
pub(super) fn cuboid(x: f64, y: f64, z: f64) -> Vec<[[f64; 3]; 3]> {
    prism(&[[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]], z)
}

/// A cylinder around the z axis, on the plane z = 0.
pub(super) fn cylinder(radius: f64, height: f64) -> Vec<[[f64; 3]; 3]> {
    let corner = |k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(CORNERS)).sin_cos();
        [radius * cos, radius * sin]
    };
    prism(&(0..CORNERS).map(corner).collect::<Vec<_>>(), height)
}

/// The prism from z = 0 to `height` on a convex polygon, anticlockwise: facets with outward
/// normals.
fn prism(polygon: &[[f64; 2]], height: f64) -> Vec<[[f64; 3]; 3]> {
    let low = |k: usize| {
        let [x, y] = polygon[k % polygon.len()];
        [x, y, 0.0]
    };
    let high = |k: usize| {
        let [x, y, _] = low(k);
        [x, y, height]
    };
    let mut facets = Vec::new();
    for k in 1..polygon.len() - 1 {
        facets.push([low(0), low(k + 1), low(k)]);
        facets.push([high(0), high(k), high(k + 1)]);
    }
    for k in 0..polygon.len() {
        facets.push([low(k), low(k + 1), high(k + 1)]);
        facets.push([low(k), high(k + 1), high(k)]);
    }
    facets
}

/// Facets as an STL file (ASCII). Readers find the normals from the corners.
pub(super) fn stl(facets: &[[[f64; 3]; 3]]) -> String {
    let mut text = String::from("solid shape\n");
    for corners in facets {
        text += " facet normal 0 0 0\n  outer loop\n";
        for [x, y, z] in corners {
            text += &format!("   vertex {x} {y} {z}\n");
        }
        text += "  endloop\n endfacet\n";
    }
    text + "endsolid shape\n"
}
