//! The triangles of the wall that each sphere could touch, and the planes that stand for the wall
//! while a sphere hardly moves. A sphere's triangles are listed anew only when that sphere has come
//! far: most hardly leave their place while they settle.

use super::neighbours::{CHUNK, squared_distance};
use crate::geometry::boundary::{Boundary, Nearest};
use crate::spheres::{ReducedSphere, Vector3, centre_of};
use rayon::prelude::*;

/// Distance beyond contact up to which triangles are listed, in skins: half a skin is what a sphere
/// may move until neighbours are listed again.
const REACH: f64 = 1.5;
/// Distance from the wall, as a fraction of the radius, below which a centre may have been pushed
/// through it.
const BEYOND: f64 = 0.9;

/// The wall near each sphere.
pub struct WallLists<'a> {
    boundary: &'a Boundary,
    /// Radius over reduced radius: 1 + overlap.
    enlarge: f64,
    skin: f64,
    /// For each `CHUNK` spheres.
    pub(super) chunks: Vec<ChunkOfWalls>,
}

/// The wall near up to `CHUNK` spheres.
pub(super) struct ChunkOfWalls {
    /// Those that have triangles near, in their order.
    pub(super) near: Vec<NearWall>,
    /// Each sphere when its triangles were listed.
    listed_at: Vec<ReducedSphere>,
}

/// The wall near one sphere.
pub(super) struct NearWall {
    /// Number of the sphere within the chunk.
    pub(super) sphere: usize,
    /// The triangles near, nearest first, and the sphere when they were listed.
    triangles: Vec<NearTriangle>,
    listed_at: ReducedSphere,
    /// The triangle that was nearest last.
    nearest: u32,
    /// The walls that it touches, or nearly.
    planes: Vec<WallPlane>,
    /// Where the sphere was when these planes were found, and how far it may move until they are
    /// found anew, squared.
    found_at: ReducedSphere,
    lasts_squared: f64,
}

/// A triangle of the wall near a sphere.
struct NearTriangle {
    /// A lower bound of its distance from the sphere when it was listed.
    least: f32,
    number: u32,
}

/// The plane through the point of the wall nearest to a sphere.
struct WallPlane {
    point: Vector3,
    /// Unit vector towards the sphere, or away from it if its centre is beyond the wall.
    inward: Vector3,
}

impl<'a> WallLists<'a> {
    /// Lists the triangles near spheres, which touch the wall at their radius
    /// times `enlarge`. Lengths in local units.
    pub fn new(boundary: &'a Boundary, balls: &[ReducedSphere], enlarge: f64, skin: f64) -> Self {
        let mut lists = Self {
            boundary,
            enlarge,
            skin,
            chunks: Vec::new(),
        };
        let of_chunk = |balls: &[ReducedSphere]| ChunkOfWalls {
            near: (balls.iter().enumerate())
                .filter_map(|(k, ball)| lists.near(k, ball))
                .collect(),
            listed_at: balls.to_vec(),
        };
        lists.chunks = balls.par_chunks(CHUNK).map(of_chunk).collect();
        lists
    }

    /// Lists them anew for each sphere that could touch a triangle not in its list before it has
    /// moved by half the skin.
    pub fn renew(&mut self, balls: &[ReducedSphere]) {
        let mut chunks = std::mem::take(&mut self.chunks);
        let most_squared = ((REACH - 0.5) * self.skin).powi(2);
        let renew_chunk = |(chunk, of_chunk): (usize, &mut ChunkOfWalls)| {
            let mut before = std::mem::take(&mut of_chunk.near).into_iter().peekable();
            for (k, listed_at) in of_chunk.listed_at.iter_mut().enumerate() {
                let i = chunk * CHUNK + k;
                let known = before.next_if(|near| near.sphere == k);
                if squared_distance(listed_at, &balls[i]) > most_squared {
                    *listed_at = balls[i];
                    of_chunk.near.extend(self.near(k, &balls[i]));
                } else {
                    of_chunk.near.extend(known);
                }
            }
        };
        chunks.par_iter_mut().enumerate().for_each(renew_chunk);
        self.chunks = chunks;
    }

    /// The wall near sphere `k` of a chunk; none if it is far.
    fn near(&self, k: usize, ball: &ReducedSphere) -> Option<NearWall> {
        let (centre, radius) = (centre_of(ball), ball[3] * self.enlarge);
        let reach = radius + REACH * self.skin;
        let listed = |number: u32| {
            let least = self.boundary.least_below(number, &centre, reach)?;
            Some(NearTriangle {
                least: (least as f32).next_down(),
                number,
            })
        };
        let triangles = self.boundary.triangles_near(&centre, reach);
        let mut triangles: Vec<NearTriangle> = triangles.filter_map(listed).collect();
        triangles.sort_unstable_by(|a, b| {
            let nearer = a.least.total_cmp(&b.least);
            nearer.then(a.number.cmp(&b.number))
        });
        Some(NearWall {
            sphere: k,
            nearest: triangles.first()?.number,
            triangles,
            listed_at: *ball,
            planes: Vec::new(),
            found_at: *ball,
            lasts_squared: -1.0,
        })
    }

    /// Finds all planes anew for the next forces, however little the spheres have moved.
    pub(super) fn forget(&mut self) {
        for near in self.chunks.iter_mut().flat_map(|chunk| &mut chunk.near) {
            near.lasts_squared = -1.0;
        }
    }

    /// The spheres that have triangles near, each with the numbers of these.
    pub fn triangles(&self) -> impl Iterator<Item = (usize, impl Iterator<Item = u32>)> {
        let chunks = self.chunks.iter().enumerate();
        chunks.flat_map(|(chunk, walls)| {
            let sphere = move |near: &NearWall| chunk * CHUNK + near.sphere;
            let near = walls.near.iter();
            near.map(move |near| (sphere(near), near.triangles.iter().map(|t| t.number)))
        })
    }
}

impl WallPlane {
    /// Height of the centre of a sphere above the plane, positive inside.
    fn height(&self, ball: &ReducedSphere) -> f64 {
        (centre_of(ball) - self.point).dot(&self.inward)
    }
}

impl NearWall {
    /// Calls `push` with each wall that a sphere of this radius touches: the direction into the
    /// solid, and the height of its centre. The planes that stand for the wall are found anew once
    /// the sphere has moved by `lasts`. `touched` is a work array.
    pub(super) fn touching(
        &mut self,
        boundary: &Boundary,
        (ball, radius): (&ReducedSphere, f64),
        lasts: f64,
        touched: &mut Vec<Nearest>,
        mut push: impl FnMut([f64; 3], f64),
    ) {
        let most_squared = if self.planes.is_empty() {
            self.lasts_squared
        } else {
            self.lasts_squared.min(lasts * lasts)
        };
        if squared_distance(&self.found_at, ball) >= most_squared {
            self.find_planes(boundary, (ball, radius), lasts, touched);
        }
        for plane in &self.planes {
            let height = plane.height(ball);
            if height < radius {
                push(plane.inward.into(), height);
            }
        }
    }

    /// Finds the planes of the walls that come within `lasts` of a sphere.
    fn find_planes(
        &mut self,
        boundary: &Boundary,
        (ball, radius): (&ReducedSphere, f64),
        lasts: f64,
        touched: &mut Vec<Nearest>,
    ) {
        self.planes.clear();
        self.found_at = *ball;
        let (centre, reach) = (centre_of(ball), radius + lasts);
        let moved = squared_distance(&self.listed_at, ball).sqrt();
        let clear = (self.triangles.first()).map_or(reach, |t| f64::from(t.least) - moved);
        if clear >= reach {
            self.lasts_squared = (clear - radius).powi(2);
            return;
        }
        self.lasts_squared = lasts * lasts;
        let may_reach = |t: &&NearTriangle| f64::from(t.least) < reach + moved;
        let near = self
            .triangles
            .iter()
            .take_while(may_reach)
            .map(|t| t.number);
        let others = near.filter(|t| *t != self.nearest);
        let measured = |t: u32| (boundary.least_distance(t, &centre), t);
        let nearest_first = std::iter::once(self.nearest).chain(others).map(measured);
        boundary.walls_among(nearest_first, &centre, reach, touched);
        self.nearest = touched.first().map_or(self.nearest, |wall| wall.triangle);
        // A centre that was pushed through the wall is pulled back.
        let is_beyond = touched.first().is_some_and(|wall| {
            let all = self.triangles.iter().map(|t| t.number);
            wall.distance < BEYOND * radius
                && boundary.is_behind_nearest(all, &centre) == Some(false)
        });
        let side = if is_beyond { -1.0 } else { 1.0 };
        self.planes.extend(touched.iter().map(|wall| WallPlane {
            point: wall.point,
            inward: (centre - wall.point) * (side / wall.distance),
        }));
    }
}
