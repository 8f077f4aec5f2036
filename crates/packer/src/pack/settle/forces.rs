//! Forces of overlaps, and the largest overlap: settling spends most of its time in this loop.

use super::neighbours::{ChunkOfLists, NearTriangle, free_until};
use crate::geometry::boundary::{Boundary, walls_among};
use crate::spheres::{ReducedSphere, centre_of};
use pulp::NullaryFnOnce;

/// Relative surplus of the radii while settling.
pub(super) const MARGIN: f64 = 5e-5;
/// Largest protrusion of a sphere from the wall at its true size when settling ends, as a fraction
/// of its radius. Two spheres then overlap by less than the surplus of one of them, so not at all
/// at their true sizes.
const STANDS_OUT: f64 = 1e-10;
/// Distance from the wall, as a fraction of the radius, below which a centre may have been pushed
/// through it.
const BEYOND: f64 = 0.9;
/// A coordinate far from everything, in local units.
const FAR: f64 = 1e6;
/// Number of neighbours processed at once.
const LANES: usize = 4;

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

/// The forces on the spheres from index `first` on, one for each entry of `force`: a call that is
/// compiled for AVX2 as well.
pub(super) struct ForcesOn<'a> {
    pub(super) force: &'a mut [[f64; 4]],
    pub(super) first: usize,
    pub(super) boundary: &'a Boundary,
    pub(super) balls: &'a [ReducedSphere],
    /// Lengths of the paths of these spheres since neighbours were listed.
    pub(super) path: &'a [f64],
    pub(super) spheres: &'a ChunkOfLists<u32>,
    pub(super) walls: &'a mut ChunkOfLists<NearTriangle>,
    pub(super) enlarge: f64,
}

impl NullaryFnOnce for ForcesOn<'_> {
    /// The largest overlap, in radii.
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let Self {
            force,
            first,
            boundary,
            balls,
            path,
            spheres,
            walls,
            enlarge,
        } = self;
        let mut worst = 0.0_f64;
        let (mut reached, mut touched) = (Vec::new(), Vec::new());
        for (k, f) in force.iter_mut().enumerate() {
            let ball = balls[first + k];
            let mut push = ForceLanes::default();
            let (groups, rest) = spheres.of(k).as_chunks::<LANES>();
            for group in groups {
                push.add(&ball, group.map(|j| balls[j as usize]));
            }
            if !rest.is_empty() {
                // Padded with points far away, which touch nothing.
                let mut last = [[FAR, FAR, FAR, 0.0]; LANES];
                for (other, j) in last.iter_mut().zip(rest) {
                    *other = balls[*j as usize];
                }
                push.add(&ball, last);
            }
            let (mut total, worst_overlap) = push.sum();
            worst = worst.max(worst_overlap / ball[3]);
            let walls = walls.of_mut(k);
            if !walls.is_empty() {
                let (centre, radius) = (centre_of(&ball), ball[3] * enlarge);
                reached.clear();
                for wall in walls
                    .iter_mut()
                    .filter(|w| f64::from(w.free_until) <= path[k])
                {
                    let near = boundary.nearest_on(wall.number, &centre);
                    wall.free_until = free_until(path[k], near.distance, radius);
                    if near.distance < radius {
                        reached.push((wall.number, near));
                    }
                }
                let nearest = reached.iter().map(|(_, near)| *near);
                walls_among(nearest, &centre, radius, &mut touched);
                // A centre that was pushed through the wall is pulled back.
                let side = match touched.first() {
                    Some(wall)
                        if wall.distance < BEYOND * radius
                            && boundary.is_behind_nearest(reached.iter().map(|r| r.0), &centre)
                                == Some(false) =>
                    {
                        -1.0
                    }
                    _ => 1.0,
                };
                for wall in &touched {
                    let overlap = radius - side * wall.distance;
                    let push = side * overlap / wall.distance;
                    for axis in 0..3 {
                        total[axis] += push * (ball[axis] - wall.point[axis]);
                    }
                    worst = worst.max(wall_overlap(radius, side * wall.distance));
                }
            }
            *f = [total[0], total[1], total[2], 0.0];
        }
        worst
    }
}

/// Forces and largest overlaps of the neighbours of one sphere, in `LANES` partial sums that are
/// added at the end.
#[derive(Default)]
struct ForceLanes {
    force: [[f64; LANES]; 3],
    overlap: [f64; LANES],
}

impl ForceLanes {
    /// Adds `LANES` neighbours of `ball` at once and without a branch: contacts of near spheres
    /// change too often to be predicted.
    #[expect(
        clippy::needless_range_loop,
        reason = "several arrays side by side, lane by lane"
    )]
    #[inline(always)]
    fn add(&mut self, ball: &ReducedSphere, others: [ReducedSphere; LANES]) {
        let mut d = [[0.0; LANES]; 3];
        let (mut squared, mut touching, mut overlap, mut push) =
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
        let distance = squared.map(f64::sqrt);
        for k in 0..LANES {
            overlap[k] = if touching[k] > distance[k] {
                touching[k] - distance[k]
            } else {
                0.0
            };
        }
        for k in 0..LANES {
            push[k] = overlap[k] / distance[k];
        }
        for k in 0..LANES {
            self.overlap[k] = if overlap[k] > self.overlap[k] {
                overlap[k]
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
