//! Distance to the surface. The only module that knows parry3d.

use crate::Vector3;
use crate::union::outer_pieces;
use dem_io::{Diagnostic, Result, Surface};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::BvhNode;
use parry3d_f64::query::{PointQueryWithLocation, Ray};
use parry3d_f64::shape::TriMesh;

/// The point of the surface nearest to some other point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Where it is, in local units.
    pub point: Vector3,
    /// How far it is, in local units.
    pub distance: f64,
}

/// The facets of a surface in a tree, for distance queries and rays.
pub struct Boundary {
    /// All facets of the surface, in its order: what rays are counted against.
    facets: TriMesh,
    /// What bounds the solid, where that is not all facets: parts of the surface may lie inside others.
    union: Option<TriMesh>,
    /// The triangles of the wall, prepared for `nearest_on`.
    planes: Vec<Plane>,
}

/// A triangle as the plane that it lies in: p is above it where u = (p - corner) . along_u >= 0, v >= 0 and u + v <= 1.
struct Plane {
    corner: Vector3,
    normal: Vector3,
    along_u: Vector3,
    along_v: Vector3,
}

/// Triangles whose height is a smaller share of their longest edge have no plane: its normal would be off by more than 1e-10.
const THINNEST: f64 = 1e-6;

impl Plane {
    fn new(corners: [[f64; 3]; 3]) -> Self {
        let [a, b, c] = corners.map(Vector3::from);
        let (edge_u, edge_v) = (b - a, c - a);
        let normal = edge_u.cross(&edge_v);
        let longest = edge_u.norm().max(edge_v.norm()).max((c - b).norm());
        // A thin triangle does not tell its normal well, and has hardly an inner part that a point could be above: NaN fails every comparison.
        let squared = if normal.norm() < THINNEST * longest * longest {
            f64::NAN
        } else {
            normal.norm_squared()
        };
        Self {
            corner: a,
            normal: normal / squared.sqrt(),
            along_u: edge_v.cross(&normal) / squared,
            along_v: normal.cross(&edge_u) / squared,
        }
    }

    /// u and v of a point given from the corner.
    fn along_triangle(&self, from_corner: &Vector3) -> [f64; 2] {
        [&self.along_u, &self.along_v].map(|along| from_corner.dot(along))
    }

    /// How far a point is from the plane, positive on the side of the normal, if it is above or below the triangle.
    fn height_over_triangle(&self, point: &Vector3) -> Option<f64> {
        let from_corner = point - self.corner;
        let [u, v] = self.along_triangle(&from_corner);
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| from_corner.dot(&self.normal))
    }
}

impl Boundary {
    /// Builds the tree.
    ///
    /// # Errors
    /// A surface without triangles.
    pub fn new(surface: &Surface) -> Result<Self> {
        let refused = |e| {
            Diagnostic::input(
                surface.source.clone(),
                format!("the surface cannot be used: {e}"),
                "",
            )
        };
        let vertices = surface.vertices.iter().map(|v| Vector::from(*v)).collect();
        let facets = TriMesh::new(vertices, surface.triangles.clone()).map_err(refused)?;
        let mut boundary = Self {
            facets,
            union: None,
            planes: Vec::new(),
        };
        if surface.repairs.self_intersections > 0 || surface.overlap_volume_m3 != 0.0 {
            let pieces = outer_pieces(surface, &boundary);
            let triangles = (0..pieces.len() as u32)
                .map(|k| [3 * k, 3 * k + 1, 3 * k + 2])
                .collect();
            let corners = pieces.into_iter().flatten().map(Vector::from).collect();
            boundary.union = Some(TriMesh::new(corners, triangles).map_err(refused)?);
        }
        boundary.planes = boundary
            .wall()
            .triangles()
            .map(|t| Plane::new([t.a, t.b, t.c].map(Into::into)))
            .collect();
        Ok(boundary)
    }

    /// The triangles that bound the solid.
    fn wall(&self) -> &TriMesh {
        self.union.as_ref().unwrap_or(&self.facets)
    }

    /// The nearest point of the surface, if it is closer than `cut_off` (local units).
    pub fn nearest(&self, point: &Vector3, cut_off: f64) -> Option<Nearest> {
        self.nearest_triangle(point, cut_off).map(|(_, near)| near)
    }

    /// As [`Boundary::nearest`], with the triangle of the wall that the nearest point lies on.
    pub fn nearest_triangle(&self, point: &Vector3, cut_off: f64) -> Option<(u32, Nearest)> {
        let (triangle, (_, near)) = self.wall().bvh().find_best(
            cut_off,
            |node, _| distance_to_box(node, point),
            |triangle, closest| self.nearest_below(triangle, point, closest),
        )?;
        Some((triangle, near))
    }

    /// Whether a point is behind the triangle of the wall that is nearest to it, on the inner side: then it is inside. None
    /// where that is not sure: the nearest point is at an edge, or the point on the wall itself.
    pub fn is_behind(&self, nearest_triangle: u32, point: &Vector3) -> Option<bool> {
        const EDGE: f64 = 1e-6;
        let plane = self.planes.get(nearest_triangle as usize)?;
        let from_corner = point - plane.corner;
        let [u, v] = plane.along_triangle(&from_corner);
        let height = from_corner.dot(&plane.normal);
        let sure =
            u > EDGE && v > EDGE && u + v < 1.0 - EDGE && height.abs() > EDGE * from_corner.norm();
        sure.then_some(height < 0.0)
    }

    /// Whether the surface leaves a ball of this radius (local units) free.
    pub fn clears(&self, centre: &Vector3, radius: f64) -> bool {
        // The first triangle within the radius decides: no box is worth a look after it.
        let distance = |node: &BvhNode, closest: f64| {
            if closest < radius {
                f64::MAX
            } else {
                distance_to_box(node, centre)
            }
        };
        self.wall()
            .bvh()
            .find_best(radius, distance, |triangle, closest| {
                self.nearest_below(triangle, centre, closest)
            })
            .is_none()
    }

    /// The nearest point of a triangle of the wall with its distance, unless its plane is farther away than `closest`.
    fn nearest_below(
        &self,
        triangle: u32,
        point: &Vector3,
        closest: f64,
    ) -> Option<(f64, Nearest)> {
        let plane = &self.planes[triangle as usize];
        // The plane of a thin triangle is NaN, and not farther away than anything.
        if (point - plane.corner).dot(&plane.normal).abs() >= closest {
            return None;
        }
        let near = self.nearest_on(triangle, point);
        Some((near.distance, near))
    }

    /// The triangles of the wall whose boxes come within `reach` (local units) of `point`.
    pub fn triangles_near(&self, point: &Vector3, reach: f64) -> impl Iterator<Item = u32> + '_ {
        let (centre, half) = (to_parry(point), Vector::splat(reach));
        let query = BvhNode::leaf(Aabb::new(centre - half, centre + half), 0);
        self.wall()
            .bvh()
            .leaves(move |node| node.intersects(&query))
    }

    /// The facets of the surface whose boxes meet that of `facet`, itself among them.
    pub fn facets_near_facet(&self, facet: u32) -> impl Iterator<Item = u32> + '_ {
        let query = BvhNode::leaf(self.facets.triangle(facet).local_aabb(), 0);
        self.facets
            .bvh()
            .leaves(move |node| node.intersects(&query))
    }

    /// The facets of the surface whose boxes a ray passes, as indices of the surface's triangles.
    pub fn facets_on_ray(
        &self,
        origin: &Vector3,
        direction: &Vector3,
    ) -> impl Iterator<Item = u32> + '_ {
        on_ray(&self.facets, origin, direction)
    }

    /// The corners of a facet of the surface, local units.
    pub fn facet_corners(&self, facet: u32) -> [[f64; 3]; 3] {
        let triangle = self.facets.triangle(facet);
        [triangle.a, triangle.b, triangle.c].map(Into::into)
    }

    /// The triangles of the wall whose boxes a ray passes, by their corners.
    pub fn walls_on_ray(
        &self,
        origin: &Vector3,
        direction: &Vector3,
    ) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
        on_ray(self.wall(), origin, direction).map(|t| self.corners_of_wall(t))
    }

    /// The planes of the triangles that come within `reach` (local units) of a point inside, as directions to them and distances, if the
    /// solid lies behind each of these planes as far as the triangles go: a ball within reach then clears the wall where it clears
    /// the planes. False where the wall is curved or hollow.
    pub fn flat_walls(&self, point: &Vector3, reach: f64, found: &mut Vec<(Vector3, f64)>) -> bool {
        const MOST: usize = 24;
        const SAME_PLANE: f64 = 1e-11;
        found.clear();
        for triangle in self.triangles_near(point, reach).take(MOST + 1) {
            let plane = &self.planes[triangle as usize];
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
                    && self.corners_of_wall(triangle).iter().all(|corner| {
                        let from_point = Vector3::from(*corner) - point;
                        // NaN, of a thin triangle, is behind nothing.
                        found.iter().all(|(normal, distance)| {
                            from_point.dot(normal) <= distance + SAME_PLANE * reach
                        })
                    })
            })
    }

    fn corners_of_wall(&self, triangle: u32) -> [[f64; 3]; 3] {
        let triangle = self.wall().triangle(triangle);
        [triangle.a, triangle.b, triangle.c].map(Into::into)
    }

    /// The walls that a ball of this radius (local units) would meet: nearest points in directions that differ by more than 14 degrees,
    /// a face hidden behind a nearer one (the same plane, the far side of an edge) left out. `triangles` limits the search; the 8 nearest are found.
    pub fn walls(
        &self,
        triangles: impl Iterator<Item = u32>,
        centre: &Vector3,
        radius: f64,
        found: &mut Vec<Nearest>,
    ) {
        const SAME_DIRECTION: f64 = 0.97;
        const MOST: usize = 8;
        found.clear();
        let toward = |near: &Nearest| (near.point - centre) / near.distance;
        for triangle in triangles {
            let near = self.nearest_on(triangle, centre);
            if near.distance >= radius || near.distance <= 0.0 {
                continue;
            }
            let direction = toward(&near);
            match found
                .iter()
                .position(|other| toward(other).dot(&direction) > SAME_DIRECTION)
            {
                Some(k) if near.distance < found[k].distance => found[k] = near,
                None => found.push(near),
                _ => {}
            }
        }
        found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut kept = 0;
        for k in 0..found.len() {
            let near = found[k];
            let hidden = found[..kept]
                .iter()
                .any(|nearer| (near.point - nearer.point).dot(&toward(nearer)) > -1e-6 * radius);
            if !hidden {
                found[kept] = near;
                kept += 1;
            }
        }
        found.truncate(kept.min(MOST));
    }

    /// The nearest point of one triangle of the wall.
    pub fn nearest_on(&self, triangle: u32, point: &Vector3) -> Nearest {
        let plane = &self.planes[triangle as usize];
        if let Some(height) = plane.height_over_triangle(point) {
            return Nearest {
                point: point - plane.normal * height,
                distance: height.abs(),
            };
        }
        let from = to_parry(point);
        let (projection, _) = self
            .wall()
            .triangle(triangle)
            .project_local_point_and_get_location(from, false);
        let point = from_parry(&projection.point);
        Nearest {
            point,
            distance: (projection.point - from).length(),
        }
    }

    /// Whether a point (local units) lies inside the solid, judged by the normal of the nearest triangle: much faster than a ray.
    /// `triangles` must hold the nearest one and all that are as near.
    ///
    /// `None` where this decides nothing, and [`is_inside`](crate::inside::is_inside) does: the nearest place is an edge or a
    /// corner, or several triangles within 1e-9 of the nearest contradict each other (as where two parts touch).
    pub fn is_behind_nearest(
        &self,
        triangles: impl Iterator<Item = u32>,
        point: &Vector3,
    ) -> Option<bool> {
        const AS_NEAR: f64 = 1e-9;
        let mut near: Vec<(f64, Option<bool>)> = triangles
            .map(|triangle| {
                let height = self.planes[triangle as usize].height_over_triangle(point);
                match height {
                    Some(height) => (height.abs(), Some(height < 0.0)),
                    None => (self.nearest_on(triangle, point).distance, None),
                }
            })
            .collect();
        let nearest = near.iter().map(|n| n.0).fold(f64::INFINITY, f64::min);
        near.retain(|n| n.0 <= nearest + AS_NEAR);
        let (_, first) = *near.first()?;
        near.iter().all(|n| n.1 == first).then_some(first)?
    }
}

fn on_ray<'a>(
    mesh: &'a TriMesh,
    origin: &Vector3,
    direction: &Vector3,
) -> impl Iterator<Item = u32> + use<'a> {
    let ray = Ray::new(to_parry(origin), to_parry(direction));
    mesh.bvh()
        .leaves(move |node| node.cast_ray(&ray, f64::MAX) < f64::MAX)
}

/// Distance from a point to the box of a node.
fn distance_to_box(node: &BvhNode, point: &Vector3) -> f64 {
    let from = to_parry(point);
    (node.mins() - from)
        .max(from - node.maxs())
        .max(Vector::ZERO)
        .length()
}

fn to_parry(v: &Vector3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

fn from_parry(v: &Vector) -> Vector3 {
    Vector3::new(v.x, v.y, v.z)
}
