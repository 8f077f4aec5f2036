//! Neighbour lists (Verlet lists): the other spheres and triangles of the wall that each sphere
//! could touch, listed from a grid of cells and from the tree of the facets.

use super::cells::SizeClasses;
use crate::geometry::boundary::Boundary;
use crate::geometry::wall_cells::WallCells;
use crate::spheres::{ReducedSphere, centre_of};
use rayon::prelude::*;

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
    /// Lower bound of its distance from the centre of the sphere when it was listed.
    pub(super) least_distance: f32,
}

impl NeighbourLists {
    /// Lists, for each of `balls`, the spheres less than `skin` (local units) away from it and the
    /// triangles less than half that away from its radius times `enlarge`: nothing else can touch
    /// it before one sphere has moved by half the skin.
    pub(super) fn new(wall: &WallCells, balls: &[ReducedSphere], enlarge: f64, skin: f64) -> Self {
        let classes = SizeClasses::new(balls, skin);
        let spheres = lists_of(balls, |i, ball, list| {
            classes.near(ball, |others, numbers| {
                for (other, j) in others.iter().zip(numbers) {
                    let reach = ball[3] + other[3] + skin;
                    if squared_distance(ball, other) < reach * reach && *j as usize != i {
                        list.push(*j);
                    }
                }
            });
        });
        let walls = lists_of(balls, |_, ball, list| {
            let centre = centre_of(ball);
            let reach = wall_reach(ball[3], enlarge, skin);
            list.extend(wall.near(&centre, reach).map(|number| NearTriangle {
                number,
                least_distance: (wall.boundary.least_distance(number, &centre) as f32).next_down(),
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

/// A list for each sphere, one after the other.
pub(super) struct Lists<T> {
    all: Vec<T>,
    /// Begin of each list, and end of the last. Spheres + 1.
    first: Vec<u32>,
}

impl<T> Default for Lists<T> {
    fn default() -> Self {
        Self {
            all: Vec::new(),
            first: Vec::new(),
        }
    }
}

impl<T> Lists<T> {
    pub(super) fn of(&self, sphere: usize) -> &[T] {
        &self.all[self.first[sphere] as usize..self.first[sphere + 1] as usize]
    }
}

/// For each sphere the list that `fill` makes.
fn lists_of<T: Copy + Send + Sync>(
    balls: &[ReducedSphere],
    fill: impl Fn(usize, &ReducedSphere, &mut Vec<T>) + Sync,
) -> Lists<T> {
    let parts: Vec<(Vec<T>, Vec<u32>)> = balls
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, part)| {
            let (mut list, mut ends) = (
                Vec::with_capacity(part.len() * 16),
                Vec::with_capacity(part.len()),
            );
            for (k, ball) in part.iter().enumerate() {
                fill(chunk * CHUNK + k, ball, &mut list);
                ends.push(list.len() as u32);
            }
            list.shrink_to_fit();
            (list, ends)
        })
        .collect();
    let mut all = Vec::with_capacity(parts.iter().map(|(list, _)| list.len()).sum());
    let mut first = Vec::with_capacity(balls.len() + 1);
    first.push(0);
    for (list, ends) in parts {
        let before = all.len() as u32;
        all.extend(list);
        first.extend(ends.into_iter().map(|e| e + before));
    }
    Lists { all, first }
}

pub(super) fn squared_distance(a: &ReducedSphere, b: &ReducedSphere) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)
}
