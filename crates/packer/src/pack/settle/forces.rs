//! Forces of overlaps, and the largest overlap: settling spends most of its time in this loop.

use super::cells::LANES;
#[cfg(target_arch = "x86_64")]
use super::eight::{self, Eight};
use super::neighbours::ChunkOfLists;
use super::walls::ChunkOfWalls;
use crate::geometry::boundary::Boundary;
use crate::spheres::ReducedSphere;
#[cfg(target_arch = "x86_64")]
use pulp::x86::V4;
use pulp::{Arch, NullaryFnOnce};

/// Relative surplus of the radii while settling.
pub(super) const MARGIN: f64 = 5e-5;
/// Largest protrusion of a sphere from the wall at its true size when settling ends, as a fraction
/// of its radius. Two spheres then overlap by less than the surplus of one of them, so not at all
/// at their true sizes.
const STANDS_OUT: f64 = 1e-10;

/// Protrusion of a sphere of this radius, `MARGIN` larger than true, from a wall at this distance
/// from its centre, as a fraction of the radius. Zero if it fits at its true size: a sphere between
/// two walls may have no room for the surplus.
pub(super) fn wall_overlap(radius: f64, distance: f64) -> f64 {
    let stands_out = radius / (1.0 + MARGIN) * (1.0 - STANDS_OUT) > distance;
    if stands_out {
        1.0 - distance / radius
    } else {
        0.0
    }
}

/// The forces on the spheres from index `first` on, one for each entry of `force`.
pub(super) struct ForcesOn<'a> {
    pub(super) force: &'a mut [[f64; 4]],
    pub(super) first: usize,
    pub(super) boundary: &'a Boundary,
    pub(super) balls: &'a [ReducedSphere],
    pub(super) spheres: &'a ChunkOfLists,
    pub(super) walls: &'a mut ChunkOfWalls,
    pub(super) enlarge: f64,
    /// Fraction of its radius that a sphere may move while planes stand for the wall.
    pub(super) planes_last: f64,
}

impl ForcesOn<'_> {
    /// Finds them. Returns the largest overlap, in radii.
    pub(super) fn find(self) -> f64 {
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = V4::try_new() {
            return simd.vectorize(Eight(simd, self));
        }
        Arch::new().dispatch(self)
    }

    /// The same, where `of_neighbours` gives the force of the neighbours in a list on a sphere,
    /// given with its number. Returns the largest overlap with the wall.
    #[inline(always)]
    pub(super) fn find_by(
        self,
        mut of_neighbours: impl FnMut(
            (u32, &ReducedSphere),
            &[[u32; LANES]],
            &[ReducedSphere],
        ) -> [f64; 3],
    ) -> f64 {
        let Self {
            force,
            first,
            boundary,
            balls,
            spheres,
            walls,
            enlarge,
            planes_last,
        } = self;
        let mut worst = 0.0_f64;
        for (k, f) in force.iter_mut().enumerate() {
            let ball = balls[first + k];
            let number = (first + k) as u32;
            let [x, y, z] = of_neighbours((number, &ball), spheres.of(k), balls);
            *f = [x, y, z, 0.0];
        }
        let ChunkOfWalls {
            near,
            listed_at,
            search,
        } = walls;
        for near in near {
            let k = near.sphere;
            let ball = &balls[first + k];
            let radius = ball[3] * enlarge;
            let lasts = planes_last * radius;
            near.touching(
                boundary,
                (ball, radius, &listed_at[k]),
                lasts,
                search,
                |inward, height| {
                    for axis in 0..3 {
                        force[k][axis] += (radius - height) * inward[axis];
                    }
                    worst = worst.max(wall_overlap(radius, height));
                },
            );
        }
        worst
    }
}

impl NullaryFnOnce for ForcesOn<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let mut worst = 0.0_f64;
        let of_wall = self.find_by(
            #[inline(always)]
            |sphere, list, balls| {
                let (force, overlap) = of_neighbours(sphere, list, balls);
                worst = worst.max(overlap / sphere.1[3]);
                force
            },
        );
        worst.max(of_wall)
    }
}

#[cfg(target_arch = "x86_64")]
impl NullaryFnOnce for Eight<ForcesOn<'_>> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let Self(simd, work) = self;
        let mut worst = pulp::cast([0.0_f64; LANES]);
        let of_wall = work.find_by(
            #[inline(always)]
            |sphere, list, balls| eight::of_neighbours(simd, sphere, list, balls, &mut worst),
        );
        let worst: [f64; LANES] = pulp::cast(worst);
        worst.into_iter().fold(of_wall, f64::max)
    }
}

/// The force of the neighbours in a list on a sphere, given with its number, and the largest
/// overlap.
#[inline(always)]
pub(super) fn of_neighbours(
    (number, ball): (u32, &ReducedSphere),
    list: &[[u32; LANES]],
    balls: &[ReducedSphere],
) -> ([f64; 3], f64) {
    let mut push = ForceLanes::default();
    for group in list {
        let others = group.map(|j| balls[j as usize]);
        let is_other = group.map(|j| j != number);
        push.add(ball, others, is_other);
    }
    push.sum()
}

/// Forces and largest overlaps of the neighbours of one sphere, in `LANES` partial sums that are
/// added at the end.
#[derive(Default)]
struct ForceLanes {
    force: [[f64; LANES]; 3],
    overlap: [f64; LANES],
}

impl ForceLanes {
    /// Adds `LANES` neighbours of `ball`, as far as they are others, at once and without a branch:
    /// contacts of near spheres change too often to be predicted.
    #[expect(
        clippy::needless_range_loop,
        reason = "several arrays side by side, lane by lane"
    )]
    #[inline(always)]
    fn add(
        &mut self,
        ball: &ReducedSphere,
        others: [ReducedSphere; LANES],
        is_other: [bool; LANES],
    ) {
        let mut d = [[0.0; LANES]; 3];
        let (mut squared, mut touching, mut excess, mut push) =
            ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            for axis in 0..3 {
                d[axis][k] = ball[axis] - others[k][axis];
            }
            touching[k] = ball[3] + others[k][3];
        }
        for k in 0..LANES {
            squared[k] = d[0][k] * d[0][k] + d[1][k] * d[1][k] + d[2][k] * d[2][k];
        }
        for k in 0..LANES {
            let of_touching = touching[k] * touching[k];
            excess[k] = if (of_touching > squared[k]) & is_other[k] {
                of_touching - squared[k]
            } else {
                0.0
            };
            push[k] = 0.5 * excess[k] / of_touching;
        }
        for k in 0..LANES {
            // The overlap, if it is small.
            let overlap = push[k] * touching[k];
            self.overlap[k] = if overlap > self.overlap[k] {
                overlap
            } else {
                self.overlap[k]
            };
            for axis in 0..3 {
                self.force[axis][k] += push[k] * d[axis][k];
            }
        }
    }

    /// The total force and the largest overlap.
    fn sum(&self) -> ([f64; 3], f64) {
        (
            self.force.map(|lanes| lanes.iter().sum()),
            self.overlap.iter().copied().fold(0.0, f64::max),
        )
    }
}
