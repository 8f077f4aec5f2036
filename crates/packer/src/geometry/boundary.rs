//! The wall of the solid: its distance from a point, the side on which a point lies, and the parts
//! that a ball would meet.

use super::nearest::Nearest;
use super::plane::{Plane, Surroundings, height_over};
use super::tree::{Corners, TriangleTree, projection};
use super::union::outer_pieces;
use super::wall_eights::WallEights;
use crate::grid::curve_position;
use crate::spheres::Vector3;
use dem_io::{Diagnostic, Result, Surface};

/// Triangles farther than the nearest by less than this (local units) are as near.
pub(crate) const AS_NEAR: f64 = 1e-9;

/// The facets of a surface in a tree, for distance queries and rays.
pub struct Boundary {
    /// All facets of the surface: rays are counted against them.
    facets: TriangleTree,
    /// The triangles that bound the solid, if they differ from the facets: parts of the surface may
    /// lie inside others.
    union: Option<TriangleTree>,
    /// The surroundings of the triangles of the wall.
    surroundings: Vec<Surroundings>,
    /// The same triangles, to find those near a place.
    eights: WallEights,
}

impl Boundary {
    /// Builds the tree.
    pub fn new(surface: &Surface) -> Result<Self> {
        let refused = |e: String| {
            Diagnostic::input(
                surface.source.clone(),
                format!("the surface cannot be used: {e}"),
                "",
            )
        };
        let extent = surface.extent();
        let (facets, union);
        if surface.repairs.self_intersections > 0 || surface.overlap_volume_m3 != 0.0 {
            let vertices = surface.vertices.iter().copied();
            let triangles = surface.triangles.clone();
            facets = TriangleTree::new(vertices, triangles).map_err(refused)?;
            let pieces = outer_pieces(surface, &facets);
            let mut triangles = (0..pieces.len() as u32)
                .map(|k| [3 * k, 3 * k + 1, 3 * k + 2])
                .collect::<Vec<_>>();
            let corners = pieces.into_iter().flatten().collect::<Vec<_>>();
            let corners = sort_along_curve(&mut triangles, &corners, extent);
            union = Some(TriangleTree::new(corners.into_iter(), triangles).map_err(refused)?);
        } else {
            let mut triangles = surface.triangles.clone();
            let vertices = sort_along_curve(&mut triangles, &surface.vertices, extent);
            facets = TriangleTree::new(vertices.into_iter(), triangles).map_err(refused)?;
            union = None;
        }
        let wall = union.as_ref().unwrap_or(&facets);
        let surroundings: Vec<Surroundings> = wall.all().map(Surroundings::new).collect();
        Ok(Self {
            eights: WallEights::new(wall.all(), &surroundings),
            surroundings,
            facets,
            union,
        })
    }

    /// All facets of the surface.
    pub fn facets(&self) -> &TriangleTree {
        &self.facets
    }

    /// The plane of a triangle of the wall.
    #[inline]
    fn plane(&self, triangle: u32) -> Plane {
        Plane::new(self.wall().corners(triangle))
    }

    /// The triangles that bound the solid.
    fn wall(&self) -> &TriangleTree {
        self.union.as_ref().unwrap_or(&self.facets)
    }

    /// The nearest point of the surface, if it is closer than `cut_off` (local units).
    pub fn nearest(&self, point: &Vector3, cut_off: f64) -> Option<Nearest> {
        self.wall().nearest(point, cut_off, |triangle, closest| {
            self.nearest_below(triangle, point, closest)
        })
    }

    /// True if a point is behind the triangle of the wall that is nearest to it, on the inner side:
    /// then it is inside. None if this is uncertain because the nearest point is at an edge, or the
    /// point on the wall itself.
    pub(crate) fn is_behind(&self, nearest_triangle: u32, point: &Vector3) -> Option<bool> {
        const EDGE: f64 = 1e-6;
        let plane = self.plane(nearest_triangle);
        let from_corner = point - plane.corner;
        let [u, v] = plane.along_triangle(&from_corner);
        let height = from_corner.dot(&plane.normal);
        let sure =
            u > EDGE && v > EDGE && u + v < 1.0 - EDGE && height.abs() > EDGE * from_corner.norm();
        sure.then_some(height < 0.0)
    }

    /// True if a ball of this radius (local units) does not meet the surface.
    pub fn clears(&self, centre: &Vector3, radius: f64) -> bool {
        !self
            .wall()
            .reaches_into(centre, radius, |triangle, closest| {
                self.nearest_below(triangle, centre, closest)
            })
    }

    /// The nearest point of a triangle of the wall with its distance, unless that is certainly not
    /// below `closest`.
    fn nearest_below(
        &self,
        triangle: u32,
        point: &Vector3,
        closest: f64,
    ) -> Option<(f64, Nearest)> {
        self.least_below(triangle, point, closest)?;
        let near = self.nearest_on(triangle, point);
        Some((near.distance, near))
    }

    /// The triangles of the wall whose boxes come within `reach` (local units) of `point`.
    pub fn triangles_near(&self, point: &Vector3, reach: f64) -> impl Iterator<Item = u32> + '_ {
        self.wall().within(point, reach)
    }

    /// The triangles of the wall, by their corners, whose boxes a ray passes through.
    pub(crate) fn walls_on_ray(
        &self,
        origin: &Vector3,
        direction: &Vector3,
    ) -> impl Iterator<Item = Corners> + '_ {
        let wall = self.wall();
        wall.on_ray(origin, direction).map(|t| wall.corners(t))
    }

    /// The planes of the triangles that come within `reach` (local units) of a point inside, as
    /// directions to them and distances, if the solid lies behind each of these planes as far as
    /// the triangles go: a ball within reach then clears the wall where it clears the planes. False
    /// where the wall is curved or hollow.
    pub(crate) fn flat_walls(
        &self,
        point: &Vector3,
        reach: f64,
        found: &mut Vec<(Vector3, f64)>,
    ) -> bool {
        const MOST: usize = 24;
        const SAME_PLANE: f64 = 1e-11;
        found.clear();
        for triangle in self.triangles_near(point, reach).take(MOST + 1) {
            let plane = self.plane(triangle);
            let distance = (plane.corner - point).dot(&plane.normal);
            let is_known = |(normal, other): &(Vector3, f64)| {
                (normal - plane.normal).norm() < SAME_PLANE
                    && (other - distance).abs() < SAME_PLANE * reach
            };
            if !found.iter().any(is_known) {
                found.push((plane.normal, distance));
            }
        }
        self.triangles_near(point, reach)
            .enumerate()
            .all(|(k, triangle)| {
                k < MOST
                    && self.wall().corners(triangle).iter().all(|corner| {
                        let from_point = Vector3::from(*corner) - point;
                        // NaN, for a thin triangle, is behind nothing.
                        found.iter().all(|(normal, distance)| {
                            from_point.dot(normal) <= distance + SAME_PLANE * reach
                        })
                    })
            })
    }

    /// The triangles of the wall that come within `reach` (local units) of a place, or could, each
    /// with a lower bound of its distance.
    pub(super) fn bounds_near(&self, place: &Vector3, reach: f64) -> Vec<(f64, u32)> {
        self.eights.near(place, reach)
    }

    pub(super) fn surroundings(&self, triangle: u32) -> &Surroundings {
        &self.surroundings[triangle as usize]
    }

    /// False if a triangle of the wall is certainly farther from a point than `reach` (local
    /// units).
    pub(crate) fn may_be_nearer(&self, triangle: u32, point: &Vector3, reach: f64) -> bool {
        self.least_below(triangle, point, reach).is_some()
    }

    /// A lower bound of the distance of a triangle of the wall from a point, if it is less than
    /// `reach` (local units).
    #[inline]
    fn least_below(&self, triangle: u32, point: &Vector3, reach: f64) -> Option<f64> {
        let around = self.surroundings(triangle);
        if around.is_beyond(point, reach) {
            return None;
        }
        Some(around.least_distance(point)).filter(|least| *least < reach)
    }

    /// A lower bound of the distance of a triangle of the wall from a point, at little cost.
    #[inline]
    pub(crate) fn least_distance(&self, triangle: u32, point: &Vector3) -> f64 {
        self.surroundings(triangle).least_distance(point)
    }

    /// Reads from a triangle of the wall that will be measured soon, so that its cache lines are on
    /// their way.
    #[inline(always)]
    pub(super) fn fetch(&self, triangle: u32) {
        self.wall().fetch(triangle);
    }

    /// The nearest point of one triangle of the wall.
    pub fn nearest_on(&self, triangle: u32, point: &Vector3) -> Nearest {
        let corners = self.wall().corners(triangle);
        if let Some((height, normal)) = height_over(corners, point) {
            return Nearest {
                point: point - normal * height,
                distance: height.abs(),
                triangle,
            };
        }
        let (point, distance) = projection(corners, point);
        Nearest {
            point,
            distance,
            triangle,
        }
    }

    /// True if a point (local units) lies inside the solid, judged by the normal of the nearest
    /// triangle: much faster than a ray. `triangles` must contain the nearest one and all that are
    /// equally near.
    ///
    /// `None` if this is undecided, and [`is_inside`](super::inside::is_inside) is needed: the
    /// nearest place is an edge or a corner, or several triangles within 1e-9 of the nearest
    /// contradict each other (as where two parts touch).
    pub fn is_behind_nearest(
        &self,
        triangles: impl Iterator<Item = u32>,
        point: &Vector3,
    ) -> Option<bool> {
        let mut near: Vec<(f64, Option<bool>)> = triangles
            .map(|triangle| {
                let corners = self.wall().corners(triangle);
                match height_over(corners, point) {
                    Some((height, _)) => (height.abs(), Some(height < 0.0)),
                    None => (projection(corners, point).1, None),
                }
            })
            .collect();
        let nearest = near.iter().map(|n| n.0).fold(f64::INFINITY, f64::min);
        near.retain(|n| n.0 <= nearest + AS_NEAR);
        let (_, first) = *near.first()?;
        near.iter().all(|n| n.1 == first).then_some(first)?
    }
}

/// Sorts triangles (indices of vertices) along a curve, so that neighbours in space are neighbours
/// in memory, and numbers their vertices in the order in which they first occur. Returns these
/// vertices, without those that no triangle uses. `extent` is the largest corner of their box,
/// whose smallest is the origin.
fn sort_along_curve(
    triangles: &mut [[u32; 3]],
    vertices: &[[f64; 3]],
    extent: [f64; 3],
) -> Vec<[f64; 3]> {
    const CELLS_ALONG: f64 = 1024.0;
    let cell = extent.iter().copied().fold(0.0, f64::max) / CELLS_ALONG;
    triangles.sort_by_cached_key(|corners| {
        let [a, b, c] = corners.map(|corner| Vector3::from(vertices[corner as usize]));
        curve_position(((a + b + c) / 3.0).into(), cell)
    });
    let mut numbers = vec![None; vertices.len()];
    let mut used = Vec::with_capacity(vertices.len());
    for corner in triangles.as_flattened_mut() {
        let old = *corner as usize;
        *corner = *numbers[old].get_or_insert_with(|| {
            used.push(vertices[old]);
            used.len() as u32 - 1
        });
    }
    used
}
