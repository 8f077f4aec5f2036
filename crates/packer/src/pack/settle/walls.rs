//! The triangles of the wall that each sphere could touch, and the planes that stand for the wall
//! while a sphere hardly moves. A sphere's triangles are listed anew only when that sphere has come
//! far: most hardly leave their place while they settle.

use super::neighbours::{CHUNK, squared_distance};
use crate::geometry::boundary::{AS_NEAR, Boundary};
use crate::geometry::near_triangles::{NearTriangles, WallSearch};
use crate::geometry::nearest::Nearest;
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
    /// Those that have triangles near, in any order.
    pub(super) near: Vec<NearWall>,
    /// Each sphere when its triangles were listed.
    pub(super) listed_at: Vec<ReducedSphere>,
    /// Work arrays of searches for planes.
    pub(super) search: WallSearch,
}

pub(super) struct NearWall {
    /// Number of the sphere within the chunk.
    pub(super) sphere: usize,
    /// The triangles near.
    triangles: NearTriangles,
    /// The triangle that was nearest last.
    nearest: u32,
    /// The nearest two walls that it touches, or nearly, and the others: there are few of them, and
    /// a plane that is found here need not be fetched from elsewhere.
    planes: [Option<WallPlane>; 2],
    others: Vec<WallPlane>,
    /// Where the sphere was when these planes were found, and how far it may move until they are
    /// found anew, squared.
    found_at: ReducedSphere,
    lasts_squared: f64,
}

/// How far a sphere is from the wall.
pub(super) struct Clearance {
    /// A lower bound of the distance of its centre from the wall, local units.
    pub(super) distance: f64,
    /// True if it has triangles near.
    pub(super) is_near: bool,
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
        const FAR: ReducedSphere = [f64::INFINITY; 4];
        let of_chunk = |balls: &[ReducedSphere]| ChunkOfWalls {
            near: Vec::new(),
            listed_at: vec![FAR; balls.len()],
            search: WallSearch::default(),
        };
        let mut lists = Self {
            boundary,
            enlarge,
            skin,
            chunks: balls.chunks(CHUNK).map(of_chunk).collect(),
        };
        lists.renew(balls);
        lists
    }

    /// Lists them anew for each sphere that could touch a triangle not in its list before it has
    /// moved by half the skin.
    pub fn renew(&mut self, balls: &[ReducedSphere]) {
        let mut chunks = std::mem::take(&mut self.chunks);
        let most_squared = ((REACH - 0.5) * self.skin).powi(2);
        let renew_chunk = |(chunk, of_chunk): (usize, &mut ChunkOfWalls)| {
            let of_sphere = |k: usize| &balls[chunk * CHUNK + k];
            let has_moved = |k: usize, listed_at: &ReducedSphere| {
                squared_distance(listed_at, of_sphere(k)) > most_squared
            };
            let listed_at = &mut of_chunk.listed_at;
            let near = &mut of_chunk.near;
            near.retain(|near| !has_moved(near.sphere, &listed_at[near.sphere]));
            for (k, listed_at) in listed_at.iter_mut().enumerate() {
                if has_moved(k, listed_at) {
                    *listed_at = *of_sphere(k);
                    near.extend(self.near(k, listed_at));
                }
            }
        };
        chunks.par_iter_mut().enumerate().for_each(renew_chunk);
        self.chunks = chunks;
    }

    /// Distance from the centre of a sphere up to which triangles are listed.
    fn reach(&self, ball: &ReducedSphere) -> f64 {
        ball[3] * self.enlarge + REACH * self.skin
    }

    /// The wall near sphere `k` of a chunk; none if it is far.
    fn near(&self, k: usize, ball: &ReducedSphere) -> Option<NearWall> {
        let triangles = NearTriangles::new(self.boundary, &centre_of(ball), self.reach(ball));
        let nearest = triangles.numbers().next()?;
        Some(NearWall {
            sphere: k,
            nearest,
            triangles,
            planes: [None, None],
            others: Vec::new(),
            found_at: *ball,
            lasts_squared: -1.0,
        })
    }

    /// How far each sphere is from the wall at least.
    pub(super) fn clearances(&self, balls: &[ReducedSphere]) -> Vec<Clearance> {
        let far = |ball| Clearance {
            distance: self.reach(ball),
            is_near: false,
        };
        let mut clearances: Vec<Clearance> = balls.iter().map(far).collect();
        for (of_chunk, clearances) in self.chunks.iter().zip(clearances.chunks_mut(CHUNK)) {
            for near in &of_chunk.near {
                clearances[near.sphere] = Clearance {
                    distance: near.triangles.least_distance().unwrap_or(0.0),
                    is_near: true,
                };
            }
        }
        let listed_at = self.chunks.iter().flat_map(|of_chunk| &of_chunk.listed_at);
        for ((clearance, ball), listed_at) in clearances.iter_mut().zip(balls).zip(listed_at) {
            let moved = squared_distance(ball, listed_at).sqrt();
            clearance.distance = (clearance.distance - moved).max(0.0);
        }
        clearances
    }

    /// Finds all planes anew for the next forces, however little the spheres have moved.
    pub(super) fn forget(&mut self) {
        for near in self.chunks.iter_mut().flat_map(|chunk| &mut chunk.near) {
            near.lasts_squared = -1.0;
        }
    }

    /// The spheres that have triangles near, each with these.
    pub fn triangles(&self) -> impl Iterator<Item = (usize, &NearTriangles)> {
        let chunks = self.chunks.iter().enumerate();
        chunks.flat_map(|(chunk, walls)| {
            let near = walls.near.iter();
            near.map(move |near| (chunk * CHUNK + near.sphere, &near.triangles))
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
    /// the sphere has moved by `lasts`. Its triangles were listed at `listed_at`. `search` holds
    /// work arrays.
    pub(super) fn touching(
        &mut self,
        boundary: &Boundary,
        (ball, radius, listed_at): (&ReducedSphere, f64, &ReducedSphere),
        lasts: f64,
        search: &mut WallSearch,
        mut push: impl FnMut([f64; 3], f64),
    ) {
        let most_squared = if self.planes[0].is_none() {
            self.lasts_squared
        } else {
            self.lasts_squared.min(lasts * lasts)
        };
        if squared_distance(&self.found_at, ball) >= most_squared {
            self.find_planes(boundary, (ball, radius, listed_at), lasts, search);
        }
        for plane in self.planes.iter().flatten().chain(&self.others) {
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
        (ball, radius, listed_at): (&ReducedSphere, f64, &ReducedSphere),
        lasts: f64,
        search: &mut WallSearch,
    ) {
        self.planes = [None, None];
        self.others.clear();
        self.found_at = *ball;
        let (centre, reach) = (centre_of(ball), radius + lasts);
        let moved = squared_distance(listed_at, ball).sqrt();
        let clear = self.triangles.least_distance().unwrap_or(reach) - moved;
        if clear >= reach {
            self.lasts_squared = (clear - radius).powi(2);
            return;
        }
        self.lasts_squared = lasts * lasts;
        let reached = (&centre, reach);
        self.triangles
            .walls(boundary, reached, moved, Some(self.nearest), search);
        let nearest = search.found.first();
        self.nearest = nearest.map_or(self.nearest, |wall| wall.triangle);
        // A centre that was pushed through the wall is pulled back.
        let is_beyond = nearest.is_some_and(|wall| {
            let as_near = self.triangles.within(wall.distance + AS_NEAR, search);
            wall.distance < BEYOND * radius
                && boundary.is_behind_nearest(as_near, &centre) == Some(false)
        });
        let side = if is_beyond { -1.0 } else { 1.0 };
        // It is not pulled towards walls that it only touches, as those across a gap.
        let pulls = |wall: &&Nearest| !is_beyond || wall.distance < BEYOND * radius;
        let found = search.found.iter().filter(pulls);
        let mut planes = found.map(|wall| WallPlane {
            point: wall.point,
            inward: (centre - wall.point) * (side / wall.distance),
        });
        self.planes = [planes.next(), planes.next()];
        self.others.extend(planes);
    }
}
