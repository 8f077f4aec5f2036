//! Places around one front sphere.

use super::{Front, centre_of};
use crate::Vector3;
use crate::boundary::Nearest;
use crate::grid::Ball;
use crate::halo::patches::Wall;
use crate::halo::{Halo, Neighbours};
use crate::inside::is_inside;

/// A place at the wall is taken before one that is nearer to the seed by up to this many radii: it fills the first layer at the wall.
const WALL_PREFERENCE: f64 = 0.5;

impl Front<'_> {
    /// Collects the spheres and walls that a new sphere of (not reduced) radius up to `largest` on the halo of `front` could touch.
    pub(super) fn look_around(
        &self,
        workspace: &mut Workspace,
        front: &Ball,
        placed: &[Ball],
        largest: f64,
    ) {
        let reduced = self.reduced(largest);
        let reach = front[3] + 2.0 * reduced + self.reduced(self.settings.radius_range[1]);
        let neighbours = &mut workspace.neighbours;
        neighbours.clear();
        self.grid.near(front[0], front[1], front[2], reach, |cell| {
            neighbours.gather(front, cell, reduced)
        });
        neighbours.gather(front, placed, reduced);
        neighbours.sort();
        workspace.walls.clear();
        if self.is_near_wall(front) {
            let centre = centre_of(front);
            let reach = front[3] + reduced + self.wall_clearance(largest);
            self.boundary.walls(
                self.boundary.triangles_near(&centre, reach),
                &centre,
                reach,
                &mut workspace.walls,
            );
        }
    }

    /// The place nearest to the seed for a new sphere of (not reduced) `radius` on the halo of `front`.
    pub(super) fn best_place(
        &self,
        workspace: &mut Workspace,
        front: &Ball,
        radius: f64,
        seed: &Vector3,
    ) -> Option<Vector3> {
        let Workspace {
            neighbours,
            halo,
            walls,
            ..
        } = workspace;
        halo.set(front, self.reduced(radius), neighbours);
        let from_seed = halo.centre - seed;
        let mut best: Option<Vector3> = None;
        halo.corners(&from_seed, |centre| {
            let takes = self.clears_wall(centre, radius);
            if takes {
                best = Some(*centre);
            }
            takes
        });
        let order_at = |place: &Vector3| (place - centre_of(front)).dot(&from_seed);
        let mut least = best.as_ref().map_or(f64::INFINITY, order_at);
        for wall in walls.iter() {
            let towards = (wall.point - halo.centre) / wall.distance;
            for j in 0..halo.neighbours() {
                let Some(places) =
                    halo.wall_corners(j, &towards, wall.distance - self.wall_clearance(radius))
                else {
                    continue;
                };
                for p in places {
                    let order =
                        order_at(&halo.position(&p)) - WALL_PREFERENCE * radius * from_seed.norm();
                    if order >= least || !halo.is_free(&p) {
                        continue;
                    }
                    if let Some(centre) = self.touch_wall(halo, radius, j, &p) {
                        (least, best) = (order, Some(centre));
                    }
                }
            }
        }
        best
    }

    /// From a place `p` on the rim of neighbour `j`, near to a place where a sphere of (not reduced) `radius` touches the wall: that place,
    /// if it is free. The wall is taken for a plane at its nearest point, again and again.
    fn touch_wall(&self, halo: &Halo, radius: f64, j: usize, p: &Vector3) -> Option<Vector3> {
        let radius = self.wall_clearance(radius);
        let wanted = radius * (1.0 + 1e-12);
        let mut p = *p;
        for _ in 0..8 {
            let centre = halo.position(&p);
            let near = self.boundary.nearest(&centre, 2.0 * radius)?;
            if near.distance >= radius && near.distance <= radius * (1.0 + 1e-10) {
                return halo.is_free(&p).then_some(centre);
            }
            let towards = (near.point - centre) / near.distance;
            let places = halo.wall_corners(
                j,
                &towards,
                (near.point - halo.centre).dot(&towards) - wanted,
            )?;
            p = if (places[0] - p).norm_squared() < (places[1] - p).norm_squared() {
                places[0]
            } else {
                places[1]
            };
        }
        None
    }

    /// A place where a sphere of the smallest radius touches `front` and overlaps neither sphere nor wall, if there is one.
    pub(super) fn place_for_smallest(
        &self,
        workspace: &mut Workspace,
        front: &Ball,
    ) -> Option<Vector3> {
        let smallest = self.settings.radius_range[0];
        let clearance = self.wall_clearance(smallest);
        let Workspace {
            neighbours,
            halo,
            planes,
            ..
        } = workspace;
        halo.set(front, self.reduced(smallest), neighbours);
        let reach = halo.radius + clearance;
        let is_near_wall =
            self.is_near(&self.wall_in_reach, front) && !self.boundary.clears(&halo.centre, reach);
        if !is_near_wall {
            return halo.any_corner(|_| true);
        }
        if self.boundary.flat_walls(&halo.centre, reach, planes) {
            halo.add_walls(
                planes
                    .iter()
                    .map(|(towards, distance)| (*towards, distance - clearance)),
            );
            return halo.any_corner(|_| true);
        }
        if let Some(place) = halo.any_corner(|centre| self.boundary.clears(centre, clearance)) {
            return Some(place);
        }
        halo.free_place(|centre, reach| {
            match self.boundary.nearest_triangle(centre, clearance + reach) {
                None => Wall::LeavesMiddle,
                Some((triangle, near)) => {
                    let is_behind = self.boundary.is_behind(triangle, centre);
                    let inwards = match is_behind {
                        Some(false) => -near.distance,
                        _ => near.distance,
                    };
                    if inwards + reach < clearance {
                        Wall::Covers
                    } else if inwards >= clearance
                        && (is_behind.is_some() || is_inside(self.boundary, centre))
                    {
                        Wall::LeavesMiddle
                    } else {
                        Wall::Cuts
                    }
                }
            }
        })
    }
}

/// Arrays that a thread uses again for every front sphere.
#[derive(Default)]
pub(super) struct Workspace {
    pub(super) neighbours: Neighbours,
    pub(super) halo: Halo,
    pub(super) walls: Vec<Nearest>,
    /// Direction and distance of flat walls.
    pub(super) planes: Vec<(Vector3, f64)>,
}
