//! A triangulated surface.
//!
//! A touch is a point of the surface that is the nearest one of every triangle on which it lies. So
//! a tiled plane is a plane, a mesh of a box is a box, including its edges and corners, and in a
//! concave corner each side is touched. This includes triangles that overlap, or that meet without
//! common vertices.
//!
//! Of faces with nearly the same direction, only the nearest is touched: a round hollow pushes like
//! one face, not like several, and a thin plate with one side. So it is with all points on facets
//! smaller than the sphere: a rough scan of a plane pushes like a plane.
//!
//! Distances are exact to rounding, and so are points in flat parts. On an edge, nearer to a vertex
//! than 1e-7 of the reach, the error of a point may be as large; nearer than 1e-9 of the reach, the
//! point is skipped if the surface comes nearer beyond the vertex.

mod features;
mod inside;
mod triangle;

use std::cell::Cell;

use dem_io::boxes::Tree;
use dem_io::surface::OpenSurface;
use dem_io::{Diagnostic, Result};
use nalgebra::Vector3;
use serde::Serialize;

use super::one_surface::{ALIKE, ROUGH};
use super::touch::{Touch, are_finite};
use dem_io::Bounds;
use features::features;
use triangle::{REGIONS, Triangle};

/// Two points coincide within this fraction of the mesh's diagonal, to allow for rounding, plus
/// this fraction of the reach, to allow for thin triangles.
const SAME: [f64; 2] = [1e-12, 1e-9];

/// In units of these lengths: the distance beyond which a nearer point rules out another one, and
/// the distance within which two remaining points coincide. The second is larger, because around a
/// vertex there may be a row of triangles of which none rules out the next.
const FAR: f64 = 4.0;
const NEAR: f64 = 32.0;

/// A triangle with a height below this fraction of the diagonal has no area.
const NO_HEIGHT: f64 = 1e-12;

/// A triangulated surface with two sides, which may be open. Pushes towards the side of the centre.
///
/// Features are numbered: flat parts, then straight edges between or around them, then corners.
/// Triangles in one plane form one flat part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Mesh {
    /// In the order of the tree.
    triangles: Vec<Triangle>,
    /// The features of the regions of each.
    of_regions: Vec<[u32; REGIONS as usize]>,
    /// The largest extent of the flat parts at each feature, m.
    extents_m: Vec<f32>,
    tree: Tree,
    diagonal_m: f64,
    /// Its content.
    pub content: MeshContent,
}

/// Content of a mesh.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct MeshContent {
    /// Triangles with an area.
    pub triangles: usize,
    /// Triangles without area, dropped.
    pub degenerate: usize,
    /// Edges that belong to one triangle only. None: the surface is closed.
    pub open_edges: usize,
    /// Edges that belong to more than two triangles.
    pub crowded_edges: usize,
    /// Edges with different numbers of triangles in the two directions. None: the surface is closed
    /// and consistently oriented, so that it has an inside.
    pub unpaired_edges: usize,
    /// Flat parts.
    pub flat_parts: u32,
    /// Straight edges between or around flat parts.
    pub straight_edges: u32,
    /// Corners.
    pub corners: u32,
}

/// Number of points on the surface that is aimed at.
const POINTS: usize = 1000;

impl Mesh {
    /// A surface as read from a file.
    pub fn from_surface(surface: &OpenSurface) -> Result<Self> {
        Self::new(&surface.vertices_m, &surface.triangles)
            .map_err(|error| error.within(&surface.source))
    }

    /// The surface of these triangles, each of three of these vertices, m.
    ///
    /// # Errors
    /// A vertex that is missing or not finite, no triangle with an area, or too many triangles.
    pub fn new(vertices_m: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Self> {
        check(vertices_m, triangles)?;
        let corners = |t: &[u32; 3]| t.map(|v| Vector3::from(vertices_m[v as usize]));
        let used = triangles.iter().flatten().map(|v| vertices_m[*v as usize]);
        let diagonal_m = Bounds::of(used).diagonal_m();
        let kept: Vec<[u32; 3]> = triangles
            .iter()
            .filter(|t| has_area(&corners(t), NO_HEIGHT * diagonal_m))
            .copied()
            .collect();
        if kept.is_empty() {
            let count = triangles.len();
            return Err(refusal(format!(
                "none of the {count} triangles of the wall has an area"
            )));
        }
        let boxes: Vec<Bounds> = kept
            .iter()
            .map(|t| Bounds::of(t.map(|v| vertices_m[v as usize])))
            .collect();
        let tree = Tree::new(&boxes);
        let indices: Vec<[u32; 3]> = tree.order().iter().map(|t| kept[*t as usize]).collect();
        let sorted: Vec<Triangle> = indices.iter().map(|t| Triangle::new(corners(t))).collect();
        let features = features(&sorted, &indices, diagonal_m);
        Ok(Self {
            content: MeshContent {
                triangles: sorted.len(),
                degenerate: triangles.len() - sorted.len(),
                open_edges: features.open_edges,
                crowded_edges: features.crowded_edges,
                unpaired_edges: features.unpaired_edges,
                flat_parts: features.flat_parts,
                straight_edges: features.straight_edges,
                corners: features.corners,
            },
            triangles: sorted,
            of_regions: features.of_regions,
            extents_m: features.extents_m,
            tree,
            diagonal_m,
        })
    }

    /// The corners of all triangles, m. Shape n x 3 x 3.
    pub fn corners_m(&self) -> impl Iterator<Item = [[f64; 3]; 3]> {
        self.triangles.iter().map(|t| t.corners.map(Into::into))
    }

    /// The corners of a triangle, m. Shape 3 x 3. Numbers are those of [`Self::corners_m`].
    pub fn triangle_m(&self, number: usize) -> [[f64; 3]; 3] {
        self.triangles[number].corners.map(Into::into)
    }

    /// Number of the triangle that is nearest to a point, m; of several the first.
    pub fn nearest_triangle(&self, point: [f64; 3]) -> u32 {
        let p = Vector3::from(point);
        let nearest = Cell::new((f64::INFINITY, 0));
        self.tree.nearest(&point, |t| {
            let distance_m = self.nearest(t, &p).distance_m;
            let (least_m, first) = nearest.get();
            if distance_m < least_m || (distance_m == least_m && t < first) {
                nearest.set((distance_m, t));
            }
            distance_m
        });
        nearest.get().1
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Bounds {
        self.tree.bounds()
    }

    /// Length of the diagonal of its box, m.
    pub fn diagonal_m(&self) -> f64 {
        self.diagonal_m
    }

    /// As [`super::Shape::touches`]. Allocates nothing beyond `found`.
    pub fn touches(&self, centre: [f64; 3], reach_m: f64, found: &mut Vec<Touch>) {
        let from = found.len();
        let c = Vector3::from(centre);
        let is_near = |bounds: &Bounds| bounds.is_near(&centre, reach_m);
        self.tree.visit_leaves(is_near, |t| {
            let touch = self.nearest(t, &c);
            if touch.distance_m < reach_m {
                found.push(touch);
            }
        });
        let near = &mut found[from..];
        near.sort_unstable_by(|a, b| {
            a.distance_m
                .total_cmp(&b.distance_m)
                .then(a.feature.cmp(&b.feature))
        });
        let same_m = SAME[0] * self.diagonal_m + SAME[1] * reach_m;
        let nearest = near.first().copied();
        for i in (0..near.len()).rev() {
            if kind(&near[i]) > 0 && self.is_beaten(near, i, same_m) {
                near[i].distance_m = f64::INFINITY;
            }
        }
        let mut end = from;
        for i in from..found.len() {
            let touch = found[i];
            if touch.distance_m == f64::INFINITY {
                continue;
            }
            let is_same = |k: &usize| {
                let nearer = &found[*k];
                self.are_one(&touch, nearer, NEAR * same_m)
                    || self.are_rough(&touch, nearer, reach_m)
            };
            match (from..end).find(is_same) {
                None => {
                    found[end] = touch;
                    end += 1;
                }
                // Of coinciding points, one in a face is exact, and one on an edge is more accurate
                // than a corner.
                Some(k)
                    if kind(&touch) < kind(&found[k])
                        && are_near(&touch, &found[k], NEAR * same_m) =>
                {
                    found[k] = touch;
                }
                Some(_) => {}
            }
        }
        found.truncate(end);
        if end == from {
            // Rounding may make thin triangles rule out each other.
            found.extend(nearest);
        }
        for touch in &mut found[from..] {
            self.name_feature(touch, &c, NEAR * same_m);
        }
    }

    /// Whether any triangle is nearer to `centre` than `reach_m`.
    pub(super) fn is_within(&self, centre: [f64; 3], reach_m: f64) -> bool {
        let c = Vector3::from(centre);
        let is_near = |bounds: &Bounds| bounds.is_near(&centre, reach_m);
        let is_within = |t| self.nearest(t, &c).distance_m < reach_m;
        self.tree.any_leaf(is_near, is_within)
    }

    /// Sets the feature of a touch. Within a flat part its point is the foot on the plane,
    /// whichever triangle gave it.
    fn name_feature(&self, touch: &mut Touch, c: &Vector3<f64>, near_m: f64) {
        let triangle = &self.triangles[(touch.feature / REGIONS) as usize];
        let feature = self.feature(touch);
        let foot = triangle.over(c, feature);
        if feature < self.content.flat_parts && are_near(touch, &foot, near_m) {
            *touch = foot;
        }
        touch.feature = feature;
    }

    /// The nearest point of triangle `t`. Until the touches are sorted, a touch has
    /// `REGIONS * triangle + region` as its feature.
    fn nearest(&self, t: u32, c: &Vector3<f64>) -> Touch {
        let triangle = &self.triangles[t as usize];
        let (point, region) = triangle.nearest(c);
        let feature = REGIONS * t + region;
        let foot = triangle.over(c, feature);
        if region == 0 {
            foot
        } else {
            Touch::towards(*c, point, foot.normal.into(), feature)
        }
    }

    /// Whether the point of touch `i` lies on a triangle that has a nearer one.
    fn is_beaten(&self, near: &[Touch], i: usize, same_m: f64) -> bool {
        let point = Vector3::from(near[i].point);
        // Most are ruled out by a neighbouring triangle, at about the same distance.
        (0..i).rev().chain(i + 1..near.len()).any(|j| {
            !are_near(&near[i], &near[j], FAR * same_m)
                && self.triangles[(near[j].feature / REGIONS) as usize].holds(&point, same_m)
        })
    }

    /// Whether a touch coincides with a nearer one.
    fn are_one(&self, touch: &Touch, nearer: &Touch, same_m: f64) -> bool {
        let are_alike = || {
            Vector3::from(touch.normal).dot(&Vector3::from(nearer.normal)) > ALIKE
                && self.feature(touch) < self.content.flat_parts
                && self.feature(nearer) < self.content.flat_parts
        };
        self.feature(touch) == self.feature(nearer)
            || are_near(touch, nearer, same_m)
            || are_alike()
    }

    /// Whether two touches are on facets smaller than the sphere and in directions so near to each
    /// other that they stand for one rough surface.
    fn are_rough(&self, touch: &Touch, nearer: &Touch, radius_m: f64) -> bool {
        Vector3::from(touch.normal).dot(&Vector3::from(nearer.normal)) > ROUGH
            && self.is_fine(self.feature(touch), radius_m)
            && self.is_fine(self.feature(nearer), radius_m)
    }

    /// Whether a feature is a flat part, not an edge or a corner.
    pub(super) fn is_flat(&self, feature: u32) -> bool {
        feature < self.content.flat_parts
    }

    /// Whether all flat parts at a feature are smaller than the radius of a sphere.
    pub(super) fn is_fine(&self, feature: u32, radius_m: f64) -> bool {
        f64::from(self.extents_m[feature as usize]) < radius_m
    }

    /// Distance of a point from the surface, m.
    pub(super) fn distance_m(&self, point: [f64; 3]) -> f64 {
        let p = Vector3::from(point);
        self.tree
            .nearest(&point, |t| self.nearest(t, &p).distance_m)
    }

    fn feature(&self, touch: &Touch) -> u32 {
        let [triangle, region] = [touch.feature / REGIONS, touch.feature % REGIONS];
        self.of_regions[triangle as usize][region as usize]
    }

    /// Points of a grid on each triangle, or the corners of some of very many, m.
    pub(super) fn surface_points_m(&self) -> Vec<[f64; 3]> {
        let pieces = (POINTS / self.content.triangles).isqrt().max(1);
        let every = (3 * self.content.triangles).div_ceil(3 * POINTS);
        let share = 1.0 / pieces as f64;
        let mut points = Vec::new();
        for corners in self.corners_m().step_by(every) {
            for one in 0..=pieces {
                for two in 0..=pieces - one {
                    let parts = [one, two, pieces - one - two].map(|part| share * part as f64);
                    points.push([0, 1, 2].map(|k| (0..3).map(|n| parts[n] * corners[n][k]).sum()));
                }
            }
        }
        points
    }
}

/// 0 for a point in the face of its triangle, 1 on an edge, 2 in a corner.
fn kind(touch: &Touch) -> u32 {
    match touch.feature % REGIONS {
        0 => 0,
        1..=3 => 1,
        _ => 2,
    }
}

fn are_near(a: &Touch, b: &Touch, within_m: f64) -> bool {
    (Vector3::from(a.point) - Vector3::from(b.point)).norm_squared() <= within_m * within_m
}

fn refusal(problem: String) -> Diagnostic {
    Diagnostic::input("", problem, "export the shape again")
}

fn check(vertices_m: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<()> {
    if triangles.len() > (u32::MAX / REGIONS) as usize {
        return Err(refusal(format!(
            "a wall of {} triangles: at most {} can be numbered",
            triangles.len(),
            u32::MAX / REGIONS
        )));
    }
    for v in triangles.iter().flatten() {
        match vertices_m.get(*v as usize) {
            Some(vertex) if are_finite(vertex) => {}
            Some(vertex) => {
                return Err(refusal(format!("vertex {v} of a wall is at {vertex:?} m")));
            }
            None => {
                return Err(refusal(format!(
                    "a triangle of a wall has vertex {v}, but there are {}",
                    vertices_m.len()
                )));
            }
        }
    }
    Ok(())
}

fn has_area([a, b, c]: &[Vector3<f64>; 3], least_height_m: f64) -> bool {
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    (b - a).cross(&(c - a)).norm() > least_height_m * longest
}
