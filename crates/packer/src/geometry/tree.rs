//! Triangles in a tree of boxes. The only module of this crate that uses parry3d.

use crate::spheres::Vector3;
use dem_io::Bounds;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use parry3d_f64::query::{PointQueryWithLocation, Ray};
use parry3d_f64::shape::{TriMesh, Triangle};
use std::hint::black_box;

/// Three corners, local units.
pub(super) type Corners = [[f64; 3]; 3];

/// Triangles in a tree of boxes, numbered as they were given. Lengths in local units.
pub struct TriangleTree(TriMesh);

impl TriangleTree {
    /// The tree over triangles, at least one, given by the indices of their vertices.
    pub(super) fn new(
        vertices: impl Iterator<Item = [f64; 3]>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, String> {
        TriMesh::new(vertices.map(Vector::from).collect(), triangles)
            .map(Self)
            .map_err(|e| e.to_string())
    }

    /// The corners of all triangles.
    pub(super) fn all(&self) -> impl Iterator<Item = Corners> + '_ {
        self.0.triangles().map(|t| [t.a, t.b, t.c].map(Into::into))
    }

    #[inline(always)]
    pub(super) fn corners(&self, triangle: u32) -> Corners {
        let corners = self.0.indices()[triangle as usize];
        let corner = |k: usize| self.0.vertices()[corners[k] as usize].into();
        [corner(0), corner(1), corner(2)]
    }

    /// Reads from a triangle, so that its cache lines are fetched.
    #[inline(always)]
    pub(super) fn fetch(&self, triangle: u32) {
        for corner in self.0.indices()[triangle as usize] {
            black_box(self.0.vertices()[corner as usize].x);
        }
    }

    /// The triangles whose boxes come within `reach` of `point`.
    pub(super) fn within(&self, point: &Vector3, reach: f64) -> impl Iterator<Item = u32> + '_ {
        let (centre, half) = (to_parry(point), Vector::splat(reach));
        self.in_box(Aabb::new(centre - half, centre + half))
    }

    /// The triangles whose boxes meet the box of `triangle`, including itself.
    pub(super) fn beside(&self, triangle: u32) -> impl Iterator<Item = u32> + '_ {
        self.in_box(self.0.triangle(triangle).local_aabb())
    }

    fn in_box(&self, query: Aabb) -> impl Iterator<Item = u32> + '_ {
        in_box(self.0.bvh(), query)
    }

    /// The triangles whose boxes a ray passes through.
    pub(super) fn on_ray(
        &self,
        origin: &Vector3,
        direction: &Vector3,
    ) -> impl Iterator<Item = u32> + use<'_> {
        let ray = Ray::new(to_parry(origin), to_parry(direction));
        self.0
            .bvh()
            .leaves(move |node| node.cast_ray(&ray, f64::MAX) < f64::MAX)
    }

    /// The triangle nearest to `point`, if it is closer than `cut_off`, with the result of
    /// `measure` for it: `measure(triangle, closest)` gives its distance, or None if that is not
    /// below `closest`.
    #[inline]
    pub(super) fn nearest<T>(
        &self,
        point: &Vector3,
        cut_off: f64,
        measure: impl Fn(u32, f64) -> Option<(f64, T)>,
    ) -> Option<T> {
        let distance = |node: &BvhNode, _: f64| distance_to_box(node, point);
        let (_, (_, found)) = self.0.bvh().find_best(cut_off, distance, measure)?;
        Some(found)
    }

    /// True if any triangle is closer to `point` than `radius`; `measure` as for
    /// [`TriangleTree::nearest`].
    #[inline]
    pub(super) fn reaches_into<T>(
        &self,
        point: &Vector3,
        radius: f64,
        measure: impl Fn(u32, f64) -> Option<(f64, T)>,
    ) -> bool {
        // The first triangle within the radius decides: no further box is examined.
        let distance = |node: &BvhNode, closest: f64| {
            if closest < radius {
                f64::MAX
            } else {
                distance_to_box(node, point)
            }
        };
        self.0.bvh().find_best(radius, distance, measure).is_some()
    }
}

/// Boxes in a tree, numbered as they were given. Lengths in local units.
pub(super) struct BoxTree(Bvh);

impl BoxTree {
    /// The tree over these boxes; faster to look into than that of `dem_io`.
    pub(super) fn new(boxes: &[Bounds]) -> Self {
        let boxes = boxes
            .iter()
            .map(|bounds| Aabb::new(bounds.low.into(), bounds.high.into()));
        Self(Bvh::from_iter(BvhBuildStrategy::Binned, boxes.enumerate()))
    }

    /// The boxes that meet `bounds`.
    pub(super) fn meeting(&self, bounds: &Bounds) -> impl Iterator<Item = u32> + '_ {
        in_box(&self.0, Aabb::new(bounds.low.into(), bounds.high.into()))
    }
}

/// The leaves whose boxes meet that of the query.
fn in_box(tree: &Bvh, query: Aabb) -> impl Iterator<Item = u32> + '_ {
    let query = BvhNode::leaf(query, 0);
    tree.leaves(move |node| node.intersects(&query))
}

/// The point of a triangle that is nearest to `point`, and its distance.
pub(super) fn projection(corners: Corners, point: &Vector3) -> (Vector3, f64) {
    let from = to_parry(point);
    let [a, b, c] = corners.map(Vector::from);
    let (projection, _) = Triangle::new(a, b, c).project_local_point_and_get_location(from, false);
    let distance = (projection.point - from).length();
    (from_parry(&projection.point), distance)
}

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
