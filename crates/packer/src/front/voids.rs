//! Voids: places that take the smallest sphere, and the size of the sphere that fits there.

use super::assembly::{Assembly, cells_near_wall};
use super::patches::Wall;
use super::places::{Place, Workspace};
use crate::geometry::inside::is_inside;
use crate::seed::climb;
use crate::spheres::{ReducedSphere, Vector3, centre_of, distance};
use rayon::prelude::*;

/// Voids are counted up to this number, and extrapolated beyond it.
const MOST_COUNTED: usize = 10_000;

impl Assembly<'_> {
    /// For each cell of the grid, true if a sphere with its centre there may have neighbours that
    /// touch the wall.
    pub(super) fn cells_with_wall_in_reach(&self) -> Vec<bool> {
        let largest = self.settings.radius_range[1];
        let reach = 2.0 * self.reduced(largest) + self.wall_clearance(largest);
        cells_near_wall(&self.grid, self.boundary, reach)
    }

    /// A place where a sphere of the smallest radius touches `initial` and overlaps neither sphere
    /// nor wall, if there is one. Of the places that touch two others `takes` may refuse some.
    /// `wall_in_reach` is from [`Assembly::cells_with_wall_in_reach`].
    pub(super) fn place_for_smallest(
        &self,
        workspace: &mut Workspace,
        initial: &ReducedSphere,
        wall_in_reach: &[bool],
        mut takes: impl FnMut(&Vector3) -> bool,
    ) -> Option<Vector3> {
        let smallest = self.settings.radius_range[0];
        let clearance = self.wall_clearance(smallest);
        let Workspace {
            neighbours,
            halo,
            planes,
            ..
        } = workspace;
        halo.set(initial, self.reduced(smallest), neighbours);
        let reach = halo.radius + clearance;
        let is_near_wall =
            wall_in_reach[self.cell_of(initial)] && !self.boundary.clears(&halo.centre, reach);
        if !is_near_wall {
            return halo.any_corner(takes);
        }
        if self.boundary.flat_walls(&halo.centre, reach, planes) {
            halo.add_walls(
                planes
                    .iter()
                    .map(|(towards, distance)| (*towards, distance - clearance)),
            );
            return halo.any_corner(takes);
        }
        halo.any_corner(|centre| self.boundary.clears(centre, clearance) && takes(centre))
            .or_else(|| halo.free_place(|centre, reach| self.wall_at(centre, reach, clearance)))
    }

    /// The part of a ball of places (centre and radius `reach`, local units) that is farther from
    /// the wall than `clearance`.
    fn wall_at(&self, centre: &Vector3, reach: f64, clearance: f64) -> Wall {
        let boundary = self.boundary;
        let Some(near) = boundary.nearest(centre, clearance + reach) else {
            return Wall::LeavesMiddle;
        };
        let is_behind = boundary.is_behind(near.triangle, centre);
        let inwards = match is_behind {
            Some(false) => -near.distance,
            _ => near.distance,
        };
        if inwards + reach < clearance {
            Wall::Covers
        } else if inwards >= clearance && (is_behind.is_some() || is_inside(boundary, centre)) {
            Wall::LeavesMiddle
        } else {
            Wall::Cuts
        }
    }

    /// Places that take a sphere of the smallest radius next to the spheres `around` (indices).
    pub(crate) fn voids(&self, around: &[u32]) -> Vec<Vector3> {
        let smallest = self.settings.radius_range[0];
        around
            .par_iter()
            .with_min_len(256)
            .map_init(Workspace::default, |workspace, i| {
                let sphere = self.spheres[*i as usize];
                workspace.begin();
                self.find_neighbours(workspace, &sphere, &[], smallest);
                self.find_walls(workspace, &sphere, smallest);
                self.best_place(workspace, &sphere, smallest, &centre_of(&sphere))
            })
            .flatten_iter()
            .collect()
    }

    /// The roomiest place near a void, no farther from it than the blocks of one colour allow, and
    /// the largest size that fits there. `assembled` are the spheres not yet in the grid.
    pub(super) fn roomiest_place(&self, void: &Vector3, assembled: &[ReducedSphere]) -> Place {
        let [smallest, largest] = self.settings.radius_range;
        let enlarge = 1.0 + self.settings.overlap;
        let room = |p: &Vector3| {
            if (p - void).norm() > 0.5 * self.reduced(largest) {
                return f64::NEG_INFINITY;
            }
            let gap = assembled
                .iter()
                .map(|sphere| (distance(sphere, p) - sphere[3]) * enlarge)
                .fold(self.room(p), f64::min);
            gap * (1.0 - 1e-12)
        };
        let roomiest = climb(void, 0.1 * smallest, 1e-3 * smallest, &room);
        let quantile = self.largest_quantile_below(roomiest.radius);
        let centre = if quantile > 0.0 {
            roomiest.centre
        } else {
            *void
        };
        Place { centre, quantile }
    }

    /// The roomiest place near a void, and a radius (not reduced) among those that fit there: the
    /// fraction `drawn` (0 to 1) of their quantiles.
    pub(crate) fn roomy_place(&self, void: &Vector3, drawn: f64) -> (Vector3, f64) {
        let smallest = self.settings.radius_range[0];
        let roomiest = climb(void, 0.1 * smallest, 1e-3 * smallest, &|p| self.room(p));
        let fits = self.largest_quantile_below(roomiest.radius);
        let radius = self.radius(fits * drawn);
        if self.fits(&roomiest.centre, radius) {
            (roomiest.centre, radius)
        } else {
            (*void, smallest)
        }
    }

    /// Radius (not reduced) of the largest sphere around a place that overlaps neither sphere nor
    /// wall, at most the largest size.
    fn room(&self, place: &Vector3) -> f64 {
        let largest = self.settings.radius_range[1];
        let wall = self
            .boundary
            .nearest(place, largest)
            .map_or(largest, |near| near.distance);
        wall.min(self.reach_to_spheres(place, largest)).min(largest)
    }

    /// Fraction of the sizes whose radius is at most this.
    fn largest_quantile_below(&self, radius: f64) -> f64 {
        let (mut fits, mut fits_not) = (0.0, 1.0);
        for _ in 0..52 {
            let middle = 0.5 * (fits + fits_not);
            if self.radius(middle) <= radius {
                fits = middle;
            } else {
                fits_not = middle;
            }
        }
        fits
    }

    /// Approximate number of the smallest spheres that would still fit around the spheres `open`:
    /// the voids are filled with them.
    pub(super) fn count_voids(mut self, open: &[ReducedSphere], wall_in_reach: &[bool]) -> usize {
        let mut workspace = Workspace::default();
        let smallest = self.settings.radius_range[0];
        let mut found = 0;
        // In strides, so that the places found first are spread evenly.
        let stride = open.len().div_ceil(100).max(1);
        let spread = (0..stride).flat_map(|first| open.iter().skip(first).step_by(stride));
        for (searched, sphere) in spread.enumerate() {
            if found >= MOST_COUNTED {
                return found * open.len() / searched;
            }
            self.find_neighbours(&mut workspace, sphere, &[], smallest);
            let apart_squared = (2.0 * self.reduced(smallest)).powi(2);
            loop {
                // As many places at a time as there are, since those of a large sphere are many.
                let mut places: Vec<Vector3> = Vec::new();
                let collect = |place: &Vector3| {
                    let is_free = |other: &Vector3| (place - other).norm_squared() >= apart_squared;
                    if places.iter().all(is_free) {
                        places.push(*place);
                    }
                    false
                };
                let other = self.place_for_smallest(&mut workspace, sphere, wall_in_reach, collect);
                if places.is_empty() {
                    places.extend(other);
                }
                if places.is_empty() {
                    break;
                }
                for place in &places {
                    let new = self.sphere(place, smallest);
                    workspace.add_neighbour(sphere, &new, new[3]);
                    self.grid.insert(new);
                }
                found += places.len();
            }
        }
        found
    }

    /// Approximate number of the smallest spheres that would fit around all spheres.
    pub(crate) fn count_all_voids(self) -> usize {
        let wall_in_reach = self.cells_with_wall_in_reach();
        let open = self.spheres.clone();
        self.count_voids(&open, &wall_in_reach)
    }
}
