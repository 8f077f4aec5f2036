//! Division of the surface of a wall into patches, on which its loads are summed.
//!
//! A box and a plane are divided into rectangles, the side of a cylinder by angle and length; each
//! end of a cylinder is one patch, and so is each triangle of a mesh. A plane is infinite: any of
//! its squares may be asked for. Points and vectors are those of the wall's own frame.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use dem_io::units::show_length;
use dem_io::{Diagnostic, Result};
use nalgebra::Vector3;
use serde::Serialize;

use super::cylinder::Cylinder;
use super::mesh::Mesh;
use super::plane::Plane;
use super::solid_box::SolidBox;

/// Most patches of a box, a cylinder or the part of a plane that bodies can reach.
pub const MOST_PATCHES: f64 = 1e6;
/// Fewest patches around a cylinder, so that flat ones show that it is round.
const FEWEST_AROUND: f64 = 12.0;
/// Offset of the numbers of squares of a plane, which may be below 0.
const MIDDLE: i64 = 1 << 31;

/// The patches of a shape. Its functions need that shape.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Patches {
    /// Edge of the squares of a plane, m; 0 for other shapes.
    edge_m: f64,
    /// Number of patches: of a box along each axis, of a cylinder around and along it; 0 for
    /// others.
    pub(super) counts: [u64; 3],
}

/// A shape whose surface is divided into patches.
pub trait Divided {
    /// Its patches with edges of at most `edge_m`, m.
    ///
    /// # Errors
    /// More than [`MOST_PATCHES`] of them.
    fn patches(&self, edge_m: f64) -> Result<Patches>;

    /// See [`Patches::count`].
    fn count(&self, patches: &Patches) -> Option<u64>;

    /// See [`Patches::at`].
    fn at(&self, patches: &Patches, point_m: [f64; 3], inward: [f64; 3]) -> u64;

    /// See [`Patches::patch`].
    fn patch(&self, patches: &Patches, number: u64) -> Patch;
}

/// One patch, in the wall's own frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// Its middle, m. Length 3.
    pub centre_m: [f64; 3],
    /// Unit vector out of the wall; of a triangle that around which its corners run
    /// counter-clockwise. Length 3.
    pub normal: [f64; 3],
    /// m2.
    pub area_m2: f64,
    /// Its corners, counter-clockwise around the normal, m. Shape n x 3.
    pub corners_m: Vec<[f64; 3]>,
}

impl Patches {
    /// Divides a shape into patches with edges of at most `edge_m`, m; a mesh into its triangles,
    /// whatever that is.
    ///
    /// # Errors
    /// More than [`MOST_PATCHES`] patches of a box or a cylinder.
    pub fn new(shape: &dyn Divided, edge_m: f64) -> Result<Self> {
        shape.patches(edge_m)
    }

    /// Number of patches. None: a plane is infinite.
    pub fn count(&self, shape: &dyn Divided) -> Option<u64> {
        shape.count(self)
    }

    /// Number of the patch at a point of the surface, m, where `inward` is the unit vector into the
    /// wall. Numbers are below [`Self::count`], those of a plane below 2^64.
    pub fn at(&self, shape: &dyn Divided, point_m: [f64; 3], inward: [f64; 3]) -> u64 {
        shape.at(self, point_m, inward)
    }

    /// The patch of this number.
    pub fn patch(&self, shape: &dyn Divided, number: u64) -> Patch {
        shape.patch(self, number)
    }

    /// These numbers of patches.
    pub(super) fn of_counts(counts: [f64; 3]) -> Self {
        Self {
            edge_m: 0.0,
            counts: counts.map(|count| count as u64),
        }
    }

    /// The two axes of a face of a box that is across axis `k`, and the patches along them.
    fn face(&self, k: usize) -> ([usize; 2], [u64; 2]) {
        let axes = [(k + 1) % 3, (k + 2) % 3];
        (axes, axes.map(|axis| self.counts[axis]))
    }
}

impl Divided for Plane {
    fn patches(&self, edge_m: f64) -> Result<Patches> {
        Ok(Patches {
            edge_m,
            ..Patches::default()
        })
    }

    fn count(&self, _patches: &Patches) -> Option<u64> {
        None
    }

    fn at(&self, patches: &Patches, point_m: [f64; 3], _inward: [f64; 3]) -> u64 {
        let from = Vector3::from(point_m) - Vector3::from(self.point_m());
        let square = across(&self.normal().into()).map(|axis| {
            let place = (from.dot(&axis) / patches.edge_m).floor();
            // Limited to 32 bits by the conversion.
            (i64::from(place as i32) + MIDDLE) as u64
        });
        (square[0] << 32) | square[1]
    }

    fn patch(&self, patches: &Patches, number: u64) -> Patch {
        let normal = Vector3::from(self.normal());
        let [u, v] = across(&normal);
        let place = |bits: u64| (bits as i64 - MIDDLE) as f64;
        let [i, j] = [place(number >> 32), place(number & 0xFFFF_FFFF)];
        let point =
            |i: f64, j: f64| Vector3::from(self.point_m()) + (u * i + v * j) * patches.edge_m;
        rectangle(
            normal,
            [[i, j], [i + 1.0, j], [i + 1.0, j + 1.0], [i, j + 1.0]].map(|[i, j]| point(i, j)),
        )
    }
}

impl Divided for SolidBox {
    fn patches(&self, edge_m: f64) -> Result<Patches> {
        let bounds = self.bounds();
        let [x, y, z] = [0, 1, 2].map(|k| parts(bounds.high[k] - bounds.low[k], edge_m));
        refuse_many(edge_m, 2.0 * (x * y + y * z + z * x))?;
        Ok(Patches::of_counts([x, y, z]))
    }

    fn count(&self, patches: &Patches) -> Option<u64> {
        let [x, y, z] = patches.counts;
        Some(2 * (x * y + y * z + z * x))
    }

    fn at(&self, patches: &Patches, point_m: [f64; 3], inward: [f64; 3]) -> u64 {
        let mut across = 0;
        for k in 1..3 {
            if inward[k].abs() > inward[across].abs() {
                across = k;
            }
        }
        let before = (0..across).map(|k| {
            let (_, [a, b]) = patches.face(k);
            2 * a * b
        });
        let (axes, [along_a, along_b]) = patches.face(across);
        let is_high = u64::from(inward[across] < 0.0);
        let bounds = self.bounds();
        let [i, j] = axes.map(|axis| {
            let (low, high) = (bounds.low[axis], bounds.high[axis]);
            part((point_m[axis] - low) / (high - low), patches.counts[axis])
        });
        before.sum::<u64>() + is_high * along_a * along_b + j * along_a + i
    }

    fn patch(&self, patches: &Patches, number: u64) -> Patch {
        let mut left = number;
        let mut k = 0;
        let ([a, b], [along_a, along_b]) = loop {
            let face = patches.face(k);
            let of_both = 2 * face.1[0] * face.1[1];
            if left < of_both || k == 2 {
                break face;
            }
            left -= of_both;
            k += 1;
        };
        let is_high = left >= along_a * along_b;
        let left = left % (along_a * along_b);
        let [i, j] = [left % along_a, left / along_a];
        let bounds = self.bounds();
        let side = if is_high { &bounds.high } else { &bounds.low };
        let corner = |i: u64, j: u64| {
            let mut point = Vector3::zeros();
            point[k] = side[k];
            for (axis, at, of) in [(a, i, along_a), (b, j, along_b)] {
                let fraction = at as f64 / of as f64;
                point[axis] = bounds.low[axis] + fraction * (bounds.high[axis] - bounds.low[axis]);
            }
            point
        };
        let mut corners = [
            corner(i, j),
            corner(i + 1, j),
            corner(i + 1, j + 1),
            corner(i, j + 1),
        ];
        let normal = if is_high {
            Vector3::ith(k, 1.0)
        } else {
            corners.reverse();
            Vector3::ith(k, -1.0)
        };
        rectangle(normal, corners)
    }
}

impl Divided for Cylinder {
    fn patches(&self, edge_m: f64) -> Result<Patches> {
        let around = parts(TAU * self.radius_m(), edge_m).max(FEWEST_AROUND);
        let along = parts(axis_of(self).1, edge_m);
        refuse_many(edge_m, around * along + 2.0)?;
        Ok(Patches::of_counts([around, along, 0.0]))
    }

    fn count(&self, patches: &Patches) -> Option<u64> {
        let [around, along, _] = patches.counts;
        Some(around * along + 2)
    }

    fn at(&self, patches: &Patches, point_m: [f64; 3], inward: [f64; 3]) -> u64 {
        let [around, along, _] = patches.counts;
        let (axis, length_m) = axis_of(self);
        let out = -axis.dot(&Vector3::from(inward));
        if out.abs() > FRAC_1_SQRT_2 {
            return around * along + u64::from(out > 0.0);
        }
        let from = Vector3::from(point_m) - Vector3::from(self.ends_m()[0]);
        let [u, v] = across(&axis).map(|radial| from.dot(&radial));
        let angle = v.atan2(u).rem_euclid(TAU);
        part(from.dot(&axis) / length_m, along) * around + part(angle / TAU, around)
    }

    fn patch(&self, patches: &Patches, number: u64) -> Patch {
        let [around, along, _] = patches.counts;
        let (axis, length_m) = axis_of(self);
        let [u, v] = across(&axis);
        let radius_m = self.radius_m();
        let radial = |i: f64| {
            let (sine, cosine) = (TAU * i / around as f64).sin_cos();
            u * cosine + v * sine
        };
        let point = |i: f64, j: f64, radius_m: f64| {
            let at = axis * (length_m * j / along as f64) + radial(i) * radius_m;
            (Vector3::from(self.ends_m()[0]) + at).into()
        };
        if let Some(end) = number.checked_sub(around * along) {
            let j = [0, along][(end as usize).min(1)] as f64;
            let mut corners_m: Vec<_> = (0..around).map(|i| point(i as f64, j, radius_m)).collect();
            if end == 0 {
                corners_m.reverse();
            }
            return Patch {
                centre_m: point(0.0, j, 0.0),
                normal: (axis * [-1.0, 1.0][(end as usize).min(1)]).into(),
                area_m2: 0.5 * TAU * radius_m * radius_m,
                corners_m,
            };
        }
        let [i, j] = [(number % around) as f64, (number / around) as f64];
        let corners = [[i, j], [i + 1.0, j], [i + 1.0, j + 1.0], [i, j + 1.0]];
        Patch {
            centre_m: point(i + 0.5, j + 0.5, radius_m),
            normal: radial(i + 0.5).into(),
            area_m2: TAU * radius_m / around as f64 * length_m / along as f64,
            corners_m: corners.map(|[i, j]| point(i, j, radius_m)).into(),
        }
    }
}

impl Divided for Mesh {
    fn patches(&self, _edge_m: f64) -> Result<Patches> {
        Ok(Patches::default())
    }

    fn count(&self, _patches: &Patches) -> Option<u64> {
        Some(self.content.triangles as u64)
    }

    fn at(&self, _patches: &Patches, point_m: [f64; 3], _inward: [f64; 3]) -> u64 {
        u64::from(self.nearest_triangle(point_m))
    }

    fn patch(&self, _patches: &Patches, number: u64) -> Patch {
        let corners = self.triangle_m(number as usize).map(Vector3::from);
        let [a, b, c] = corners;
        let twice = (b - a).cross(&(c - a));
        Patch {
            centre_m: ((a + b + c) / 3.0).into(),
            normal: twice.normalize().into(),
            area_m2: 0.5 * twice.norm(),
            corners_m: corners.map(Into::into).into(),
        }
    }
}

/// Refuses patches with an edge of `edge_m`, m, if there are more than [`MOST_PATCHES`].
///
/// # Errors
/// There are.
pub fn refuse_many(edge_m: f64, patches: f64) -> Result<()> {
    if patches <= MOST_PATCHES {
        return Ok(());
    }
    let enough_m = edge_m * (patches / MOST_PATCHES).sqrt();
    // A step of the second digit more, so that what is written is enough.
    let digit_m = 10_f64.powf(enough_m.log10().floor() - 1.0);
    Err(Diagnostic::input(
        "",
        format!(
            "patches of {} divide it into {patches:.3e} of them; there can be at most {MOST_PATCHES:.0e}",
            show_length(edge_m)
        ),
        format!(
            "give a larger patch, such as {}",
            show_length((enough_m / digit_m).ceil() * digit_m + digit_m)
        ),
    ))
}

fn rectangle(normal: Vector3<f64>, corners: [Vector3<f64>; 4]) -> Patch {
    let [a, b, c, d] = corners;
    Patch {
        centre_m: ((a + b + c + d) / 4.0).into(),
        normal: normal.into(),
        area_m2: (b - a).cross(&(d - a)).norm(),
        corners_m: corners.map(Into::into).into(),
    }
}

/// Number of parts of at most `edge_m` of a length, m.
pub(super) fn parts(length_m: f64, edge_m: f64) -> f64 {
    (length_m / edge_m).ceil().max(1.0)
}

/// Number of the part at a fraction of a length that is divided into `parts`.
pub(super) fn part(fraction: f64, parts: u64) -> u64 {
    // Below 0 is 0, by the conversion.
    ((fraction * parts as f64) as u64).min(parts - 1)
}

/// Unit vector from the first to the second end of a cylinder, and its length, m.
fn axis_of(pin: &Cylinder) -> (Vector3<f64>, f64) {
    let [from, to] = pin.ends_m().map(Vector3::from);
    let length_m = (to - from).norm();
    ((to - from) / length_m, length_m)
}

/// Two unit vectors across a normal and each other, of which the third is the normal.
fn across(normal: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let axis = Vector3::ith(normal.iamin(), 1.0);
    let first = (axis - normal * normal.dot(&axis)).normalize();
    [first, normal.cross(&first)]
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test stops where it fails")]
mod tests {
    use crate::geometry::patches::*;

    /// Shapes with patches of 2 m, and the areas of their surfaces, m2.
    fn shapes() -> [(Box<dyn Divided>, f64); 3] {
        let solid = SolidBox::new([-1.0, 0.0, 2.0], [4.0, 3.0, 9.0]).unwrap();
        let pin = Cylinder::new([[1.0, 2.0, 3.0], [4.0, 6.0, 3.0]], 2.0).unwrap();
        let corners = [[0.0; 3], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]];
        let tetrahedron = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mesh = Mesh::new(&corners, &tetrahedron).unwrap();
        let of_mesh = 13.5 + 4.5 * 3.0_f64.sqrt();
        [
            (Box::new(solid), 2.0 * (5.0 * 3.0 + 3.0 * 7.0 + 7.0 * 5.0)),
            (Box::new(pin), TAU * 2.0 * (5.0 + 2.0)),
            (Box::new(mesh), of_mesh),
        ]
    }

    #[test]
    fn patches_cover_a_shape_and_are_found_at_their_middles() {
        for (shape, area_m2) in shapes() {
            let patches = Patches::new(&*shape, 2.0).unwrap();
            let count = patches.count(&*shape).unwrap();
            let mut sum_m2 = 0.0;
            for number in 0..count {
                let patch = patches.patch(&*shape, number);
                let inward = patch.normal.map(|n| -n);
                assert_eq!(
                    patches.at(&*shape, patch.centre_m, inward),
                    number,
                    "{patch:?}"
                );
                sum_m2 += patch.area_m2;
                assert_runs_around(&patch);
            }
            assert!((sum_m2 / area_m2 - 1.0).abs() < 1e-12, "{sum_m2} {area_m2}");
        }
    }

    /// Its corners run counter-clockwise around the normal.
    fn assert_runs_around(patch: &Patch) {
        let [a, b, c] = [0, 1, 2].map(|k| Vector3::from(patch.corners_m[k]));
        assert!(
            (b - a).cross(&(c - b)).dot(&Vector3::from(patch.normal)) > 0.0,
            "{patch:?}"
        );
    }

    #[test]
    fn a_plane_has_squares_on_all_sides_of_its_point() {
        let plane = Plane::new([1.0, 2.0, 3.0], [1.0, 2.0, -2.0]).unwrap();
        let [u, v] = across(&plane.normal().into());
        let patches = Patches::new(&plane, 2.0).unwrap();
        assert_eq!(patches.count(&plane), None);
        let mut numbers = Vec::new();
        for [i, j] in [[-2.5, 0.5], [-0.5, -0.5], [0.5, 0.5], [7.5, -3.5]] {
            let middle = Vector3::from(plane.point_m()) + (u * i + v * j) * 2.0;
            let number = patches.at(&plane, middle.into(), plane.normal().map(|n| -n));
            let patch = patches.patch(&plane, number);
            assert!((Vector3::from(patch.centre_m) - middle).norm() < 1e-12);
            assert!((patch.area_m2 - 4.0).abs() < 1e-12);
            assert_runs_around(&patch);
            numbers.push(number);
        }
        numbers.dedup();
        assert_eq!(numbers.len(), 4);
    }

    #[test]
    fn a_patch_larger_than_the_wall_is_each_of_its_faces() {
        let (shape, _) = &shapes()[0];
        let patches = Patches::new(&**shape, 100.0).unwrap();
        assert_eq!(patches.count(&**shape), Some(6));
        assert!(Patches::new(&**shape, 1e-3).is_err());
    }
}
