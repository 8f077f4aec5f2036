//! Shapes as facets, in mm, with the middle of their box at the origin.

use std::f64::consts::TAU;

use super::surfaces::{Facet, revolved};

/// Corners of the polygon that stands for a circle.
const CORNERS: u32 = 32;

/// The shape of a template.
#[derive(Debug, Clone, Copy)]
pub(super) enum Shape {
    /// Edges along x, y and z, mm.
    Block([f64; 3]),
    /// Diameter and height along z, mm.
    Cylinder(f64, f64),
    /// Diameter and thickness along y, mm.
    Disc(f64, f64),
    /// Diameter, mm.
    Ball(f64),
}

impl Shape {
    pub(super) fn facets(self) -> Vec<Facet> {
        match self {
            Self::Block([x, y, z]) => {
                let corners = [[-x, -y], [x, -y], [x, y], [-x, y]];
                prism(&corners.map(|corner| corner.map(|at| 0.5 * at)), z)
            }
            Self::Cylinder(diameter, height) => prism(&circle(0.5 * diameter), height),
            Self::Disc(diameter, thickness) => {
                let facets = prism(&circle(0.5 * diameter), thickness);
                facets.iter().map(|facet| facet.map(z_to_y)).collect()
            }
            Self::Ball(diameter) => {
                let parts = f64::from(CORNERS / 2);
                let arc: Vec<[f64; 2]> = (0..=CORNERS / 2)
                    .map(|k| {
                        let (sin, cos) = (0.5 * TAU * f64::from(k) / parts).sin_cos();
                        let is_end = k == 0 || k == CORNERS / 2;
                        let radius = if is_end { 0.0 } else { 0.5 * diameter * sin };
                        [radius, -0.5 * diameter * cos]
                    })
                    .collect();
                revolved(&arc)
            }
        }
    }

    /// In words.
    pub(super) fn described(self) -> String {
        match self {
            Self::Block([x, y, z]) => format!("a block of {x} mm by {y} mm by {z} mm"),
            Self::Cylinder(diameter, height) => {
                format!("a cylinder of {diameter} mm by {height} mm")
            }
            Self::Ball(diameter) => format!("a ball of {diameter} mm"),
            Self::Disc(diameter, thickness) => format!("a disc of {diameter} mm by {thickness} mm"),
        }
    }
}

/// The inside of a drum around the y axis, open at both ends.
pub(super) fn drum(radius: f64, length: f64) -> Vec<Facet> {
    let circle = circle(radius);
    let tube = sides(&circle, length);
    let inwards = tube.map(|[a, b, c]| [a, c, b].map(z_to_y));
    inwards.collect()
}

/// Turns the z axis onto the y axis.
fn z_to_y([x, y, z]: [f64; 3]) -> [f64; 3] {
    [y, z, x]
}

fn circle(radius: f64) -> Vec<[f64; 2]> {
    let corner = |k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(CORNERS)).sin_cos();
        [radius * cos, radius * sin]
    };
    (0..CORNERS).map(corner).collect()
}

/// The prism on a convex polygon, anticlockwise.
fn prism(polygon: &[[f64; 2]], height: f64) -> Vec<Facet> {
    let at = |k: usize, z: f64| [polygon[k][0], polygon[k][1], z];
    let (low, high) = (-0.5 * height, 0.5 * height);
    let ends = (1..polygon.len() - 1).flat_map(|k| {
        let below = [at(0, low), at(k + 1, low), at(k, low)];
        [below, [at(0, high), at(k, high), at(k + 1, high)]]
    });
    ends.chain(sides(polygon, height)).collect()
}

fn sides(polygon: &[[f64; 2]], height: f64) -> impl Iterator<Item = Facet> + '_ {
    (0..polygon.len()).flat_map(move |k| {
        let [[a, b], [c, d]] = [polygon[k], polygon[(k + 1) % polygon.len()]];
        let (low, high) = (-0.5 * height, 0.5 * height);
        let lower = [[a, b, low], [c, d, low], [c, d, high]];
        [lower, [[a, b, low], [c, d, high], [a, b, high]]]
    })
}

/// Facets as an STL file (ASCII). Readers find the normals from the corners.
pub(super) fn stl(facets: &[Facet]) -> String {
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
