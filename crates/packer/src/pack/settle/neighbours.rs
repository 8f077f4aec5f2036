//! Neighbour lists (Verlet lists): the other spheres and triangles of the wall that each sphere
//! could touch, listed from a grid of cells and from the tree of the facets.

use super::cells::SizeClasses;
use crate::geometry::boundary::Boundary;
use crate::geometry::wall_cells::WallCells;
use crate::spheres::{ReducedSphere, centre_of};
use rayon::prelude::*;
use std::ops::Range;

/// Number of cells of the wall in addition to one per sphere.
const MOST_WALL_CELLS: usize = 100_000;
/// Number of spheres processed by one task.
pub(super) const CHUNK: usize = 1024;

/// The other spheres and the triangles of the wall that each sphere could touch before the lists
/// are rebuilt.
#[derive(Default)]
pub(super) struct NeighbourLists {
    pub(super) spheres: Lists<u32>,
    pub(super) walls: Lists<NearTriangle>,
}

/// A triangle of the wall near a sphere.
#[derive(Clone, Copy)]
pub(super) struct NearTriangle {
    pub(super) number: u32,
    /// Length of the sphere's path since it was listed up to which it cannot touch the triangle.
    pub(super) free_until: f32,
}

/// Length of a path, now `path`, up to which a sphere at this distance from a triangle cannot touch
/// it: rounded down.
pub(super) fn free_until(path: f64, distance: f64, radius: f64) -> f32 {
    const MARGIN: f64 = 1e-9;
    ((path + distance - (1.0 + MARGIN) * radius) as f32).next_down()
}

impl NeighbourLists {
    /// Lists, for each of `balls`, the spheres less than `skin` (local units) away from it and the
    /// triangles less than half that away from its radius times `enlarge`: nothing else can touch
    /// it before one sphere has moved by half the skin.
    pub(super) fn new(wall: &WallCells, balls: &[ReducedSphere], enlarge: f64, skin: f64) -> Self {
        let classes = SizeClasses::new(balls, skin);
        let spheres = lists_of(balls, |i, ball, list| {
            classes.near(ball, |others, numbers| {
                // Written in any case and kept if near, since a branch would be mispredicted.
                let mut end = list.len();
                list.resize(end + others.len(), 0);
                for (other, j) in others.iter().zip(numbers) {
                    let reach = ball[3] + other[3] + skin;
                    let is_near = squared_distance(ball, other) < reach * reach;
                    list[end] = *j;
                    end += usize::from(is_near & (*j as usize != i));
                }
                list.truncate(end);
            });
        });
        let walls = lists_of(balls, |_, ball, list| {
            let centre = centre_of(ball);
            let reach = wall_reach(ball[3], enlarge, skin);
            list.extend(wall.near(&centre, reach).map(|number| {
                let distance = wall.boundary.least_distance(number, &centre);
                NearTriangle {
                    number,
                    free_until: free_until(0.0, distance, ball[3] * enlarge),
                }
            }));
        });
        Self { spheres, walls }
    }
}

/// The wall sorted for the lists of these spheres.
pub(super) fn sort_wall<'a>(
    boundary: &'a Boundary,
    balls: &[ReducedSphere],
    enlarge: f64,
    skin: f64,
) -> WallCells<'a> {
    let reaches = || balls.iter().map(|ball| wall_reach(ball[3], enlarge, skin));
    let largest = reaches().fold(0.0, f64::max);
    let range = [reaches().fold(largest, f64::min), largest];
    WallCells::new(boundary, range, MOST_WALL_CELLS + balls.len())
}

/// Distance up to which the wall is listed.
fn wall_reach(radius: f64, enlarge: f64, skin: f64) -> f64 {
    radius * enlarge + 0.5 * skin
}

/// A list for each sphere.
pub(super) struct Lists<T> {
    /// Those of each `CHUNK` spheres.
    pub(super) chunks: Vec<ChunkOfLists<T>>,
}

/// The lists of up to `CHUNK` spheres, one after the other.
pub(super) struct ChunkOfLists<T> {
    all: Vec<T>,
    /// End of each list. One per sphere.
    ends: Vec<u32>,
}

impl<T> Default for Lists<T> {
    fn default() -> Self {
        Self { chunks: Vec::new() }
    }
}

impl<T> Lists<T> {
    pub(super) fn of(&self, sphere: usize) -> &[T] {
        self.chunks[sphere / CHUNK].of(sphere % CHUNK)
    }
}

impl<T> ChunkOfLists<T> {
    fn range(&self, sphere: usize) -> Range<usize> {
        let begin = sphere.checked_sub(1).map_or(0, |last| self.ends[last]);
        begin as usize..self.ends[sphere] as usize
    }

    /// The list of a sphere, numbered within the chunk.
    pub(super) fn of(&self, sphere: usize) -> &[T] {
        &self.all[self.range(sphere)]
    }

    pub(super) fn of_mut(&mut self, sphere: usize) -> &mut [T] {
        let range = self.range(sphere);
        &mut self.all[range]
    }
}

/// For each sphere the list that `fill` makes.
fn lists_of<T: Send>(
    balls: &[ReducedSphere],
    fill: impl Fn(usize, &ReducedSphere, &mut Vec<T>) + Sync,
) -> Lists<T> {
    let of_chunk = |(chunk, part): (usize, &[ReducedSphere])| {
        let mut all = Vec::with_capacity(part.len() * 16);
        let mut ends = Vec::with_capacity(part.len());
        for (k, ball) in part.iter().enumerate() {
            fill(chunk * CHUNK + k, ball, &mut all);
            ends.push(all.len() as u32);
        }
        all.shrink_to_fit();
        ChunkOfLists { all, ends }
    };
    Lists {
        chunks: balls.par_chunks(CHUNK).enumerate().map(of_chunk).collect(),
    }
}

pub(super) fn squared_distance(a: &ReducedSphere, b: &ReducedSphere) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)
}
