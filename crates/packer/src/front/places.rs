//! Candidate points: places next to one front sphere where a new sphere touches it and two others,
//! or one other and the wall (Platzer 2022, sections 4.1.2 and 4.1.3).

use super::assembly::Assembly;
use super::halo::{Halo, Neighbours};
use crate::geometry::near_triangles::{NearTriangles, WallSearch};
use crate::spheres::{ReducedSphere, Vector3, centre_of};

/// A place at the wall is preferred to one that is nearer to the seed by up to this many radii:
/// this fills the first layer at the wall.
const WALL_PREFERENCE: f64 = 0.5;

impl Assembly<'_> {
    /// Collects what a new sphere of (not reduced) `radius` next to `initial` could touch, unless
    /// the workspace holds it already: for its size class, since others of that class may follow.
    pub(super) fn need_neighbours(
        &self,
        workspace: &mut Workspace,
        initial: &ReducedSphere,
        assembled: &[ReducedSphere],
        radius: f64,
    ) {
        if workspace.gathered >= radius {
            return;
        }
        let mut largest = self.settings.radius_range[1];
        if workspace.gathered == 0.0 {
            self.find_walls(workspace, initial, largest);
        }
        while 0.5 * largest >= radius {
            largest *= 0.5;
        }
        self.find_neighbours(workspace, initial, assembled, largest);
        workspace.gathered = largest;
    }

    /// True if `initial` is certainly hemmed in: the spheres near it, which are found much sooner
    /// than all that a large new sphere of (not reduced) `radius` could touch, leave no place for
    /// it next to `initial`. False if the workspace holds the neighbours already.
    pub(super) fn is_hemmed_in(
        &self,
        workspace: &mut Workspace,
        initial: &ReducedSphere,
        assembled: &[ReducedSphere],
        radius: f64,
    ) -> bool {
        const LARGE: f64 = 2.0;
        let near = initial[3] * (1.0 + self.settings.overlap);
        if workspace.gathered >= radius || radius < LARGE * near {
            return false;
        }
        workspace.gathered = 0.0;
        self.find_neighbours(workspace, initial, assembled, near);
        let Workspace {
            neighbours, halo, ..
        } = workspace;
        halo.set(initial, self.reduced(radius), neighbours);
        halo.is_covered()
    }

    /// Collects the spheres that a new sphere of (not reduced) radius up to `largest` next to
    /// `initial` could touch. `assembled` are the spheres not yet in the grid.
    pub(super) fn find_neighbours(
        &self,
        workspace: &mut Workspace,
        initial: &ReducedSphere,
        assembled: &[ReducedSphere],
        largest: f64,
    ) {
        let reduced = self.reduced(largest);
        let gap = initial[3] + 2.0 * reduced;
        let neighbours = &mut workspace.neighbours;
        neighbours.clear();
        self.grid
            .near([initial[0], initial[1], initial[2]], gap, |cell| {
                neighbours.gather(initial, cell, reduced);
            });
        neighbours.gather(initial, assembled, reduced);
        neighbours.sort();
    }

    /// Collects the walls that a new sphere of (not reduced) radius up to `largest` next to
    /// `initial` could touch.
    pub(super) fn find_walls(
        &self,
        workspace: &mut Workspace,
        initial: &ReducedSphere,
        largest: f64,
    ) {
        workspace.walls.found.clear();
        if self.is_near_wall(initial) {
            let centre = centre_of(initial);
            let reach = initial[3] + self.reduced(largest) + self.wall_clearance(largest);
            let near = NearTriangles::new(self.boundary, &centre, reach);
            let walls = &mut workspace.walls;
            near.walls(self.boundary, (&centre, reach), 0.0, None, walls);
        }
    }

    /// The candidate point nearest to the seed for a new sphere of (not reduced) `radius` next to
    /// `initial` that overlaps neither sphere nor wall.
    pub(super) fn best_place(
        &self,
        workspace: &mut Workspace,
        initial: &ReducedSphere,
        radius: f64,
        seed: &Vector3,
    ) -> Option<Vector3> {
        let Workspace {
            neighbours,
            halo,
            walls,
            full_below,
            ..
        } = workspace;
        if !halo.set_unless_covered(initial, self.reduced(radius), neighbours) {
            return None;
        }
        let from_seed = halo.centre - seed;
        let mut best: Option<Vector3> = None;
        let smaller = full_below.iter().filter(|(known, _)| *known <= radius);
        let from = smaller.fold(f64::NEG_INFINITY, |from, (_, order)| from.max(*order));
        let none_below = halo.corners(&from_seed, from, |centre| {
            let takes = self.clears_wall(centre, radius);
            if takes {
                best = Some(*centre);
            }
            takes
        });
        if none_below > from {
            full_below.push((radius, none_below));
        }
        let order_at = |place: &Vector3| (place - centre_of(initial)).dot(&from_seed);
        let mut least = best.as_ref().map_or(f64::INFINITY, order_at);
        for wall in &walls.found {
            let towards = wall.towards(&halo.centre);
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

    /// The place, if it is free, where a sphere of (not reduced) `radius` touches the wall,
    /// searched from a place `p` nearby on the rim of neighbour `j`. The wall is repeatedly
    /// approximated by a plane at its nearest point.
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
}

/// A place for a new sphere, and its size as a quantile of the distribution by number (0 to 1).
pub(super) struct Place {
    pub(super) centre: Vector3,
    pub(super) quantile: f64,
}

/// Work arrays that a thread reuses for every front sphere.
#[derive(Default)]
pub(super) struct Workspace {
    pub(super) neighbours: Neighbours,
    /// Largest (not reduced) radius of a new sphere whose neighbours these are; 0 if none.
    pub(super) gathered: f64,
    pub(super) halo: Halo,
    pub(super) walls: WallSearch,
    /// For sizes tried beside the present front sphere, their (not reduced) radius and the order
    /// below which no place on the halo is free for them, as seen from its seed, local units: see
    /// [`Halo::corners`].
    full_below: Vec<(f64, f64)>,
    /// Direction and distance of flat walls.
    pub(super) planes: Vec<(Vector3, f64)>,
}

impl Workspace {
    /// Forgets what is known of the places beside a front sphere.
    pub(super) fn begin(&mut self) {
        self.gathered = 0.0;
        self.full_below.clear();
    }

    /// Adds a sphere just placed to the neighbours of `initial`, as [`Assembly::find_neighbours`]
    /// would with the reduced radius `largest`.
    pub(super) fn add_neighbour(
        &mut self,
        initial: &ReducedSphere,
        new: &ReducedSphere,
        largest: f64,
    ) {
        self.neighbours.insert(initial, new, largest);
    }
}
