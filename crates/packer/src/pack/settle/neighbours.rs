//! Neighbour lists (Verlet lists): the other spheres that each sphere could touch, listed from a
//! grid of cells.

use super::cells::{AT_ONCE, LANES, Row, SizeClasses};
#[cfg(target_arch = "x86_64")]
use super::eight::{self, Eight};
use crate::spheres::ReducedSphere;
#[cfg(target_arch = "x86_64")]
use pulp::x86::V4;
use pulp::{Arch, NullaryFnOnce};
use rayon::prelude::*;

/// Number of spheres processed by one task.
pub(super) const CHUNK: usize = 1024;

/// The other spheres that each sphere could touch before the lists are rebuilt.
#[derive(Default)]
pub(super) struct NeighbourLists {
    /// Those of each `CHUNK` spheres.
    pub(super) chunks: Vec<ChunkOfLists>,
}

/// The lists of up to `CHUNK` spheres, one after the other. Each ends with the sphere's own number,
/// repeated until its length is a multiple of `LANES` or of twice as many.
pub(super) struct ChunkOfLists {
    all: Vec<u32>,
    /// End of each list. One per sphere.
    ends: Vec<u32>,
}

impl NeighbourLists {
    /// Lists, for each of `balls`, the spheres less than `skin` (local units) away from it: no
    /// other can touch it before one sphere has moved by half the skin.
    pub(super) fn new(balls: &[ReducedSphere], skin: f64) -> Self {
        let classes = SizeClasses::new(balls, skin);
        let of_chunk = |(chunk, part): (usize, &[ReducedSphere])| {
            let work = ListChunk {
                classes: &classes,
                part,
                first: chunk * CHUNK,
                skin,
            };
            #[cfg(target_arch = "x86_64")]
            if let Some(simd) = V4::try_new() {
                return simd.vectorize(Eight(simd, work));
            }
            Arch::new().dispatch(work)
        };
        let chunks = balls.par_chunks(CHUNK).enumerate();
        Self {
            chunks: chunks.map(of_chunk).collect(),
        }
    }

    /// The neighbours of a sphere.
    pub(super) fn of(&self, sphere: usize) -> &[u32] {
        let list = self.chunks[sphere / CHUNK].of(sphere % CHUNK);
        let list = list.as_flattened();
        // Its own number fills the list up.
        let filled_up = list.iter().rev();
        let filled_up = filled_up.take_while(|other| **other as usize == sphere);
        &list[..list.len() - filled_up.count()]
    }
}

impl ChunkOfLists {
    /// The list of a sphere, numbered within the chunk, with the repetitions of its own number.
    pub(super) fn of(&self, sphere: usize) -> &[[u32; LANES]] {
        let begin = sphere.checked_sub(1).map_or(0, |last| self.ends[last]);
        let list = &self.all[begin as usize..self.ends[sphere] as usize];
        list.as_chunks().0
    }
}

/// The lists of the spheres `part`, numbered from `first` on.
pub(super) struct ListChunk<'a> {
    pub(super) classes: &'a SizeClasses,
    pub(super) part: &'a [ReducedSphere],
    pub(super) first: usize,
    pub(super) skin: f64,
}

impl ListChunk<'_> {
    /// Makes them, each as long as a multiple of `multiple`. `add` adds those of a row of spheres
    /// that are near a sphere, given with its number, to the list from an end on.
    #[inline(always)]
    pub(super) fn by(
        &self,
        multiple: usize,
        add: impl Fn((&ReducedSphere, u32), &Row, &mut [u32], &mut usize),
    ) -> ChunkOfLists {
        let mut all = vec![0; self.part.len() * 16];
        let mut end = 0;
        let mut ends = Vec::with_capacity(self.part.len());
        for (k, ball) in self.part.iter().enumerate() {
            let number = (self.first + k) as u32;
            self.classes.near(
                ball,
                #[inline(always)]
                |row| {
                    let most = end + row.spheres.len() + AT_ONCE;
                    if most > all.len() {
                        all.resize(2 * most, 0);
                    }
                    add((ball, number), &row, &mut all, &mut end);
                },
            );
            while !end.is_multiple_of(multiple) {
                all[end] = number;
                end += 1;
            }
            ends.push(end as u32);
        }
        all.truncate(end);
        all.shrink_to_fit();
        ChunkOfLists { all, ends }
    }
}

impl NullaryFnOnce for ListChunk<'_> {
    type Output = ChunkOfLists;

    #[inline(always)]
    fn call(self) -> ChunkOfLists {
        let skin = self.skin;
        self.by(
            LANES,
            #[inline(always)]
            |sphere, row, list, end| add_near(sphere, row, skin, list, end),
        )
    }
}

#[cfg(target_arch = "x86_64")]
impl NullaryFnOnce for Eight<ListChunk<'_>> {
    type Output = ChunkOfLists;

    #[inline(always)]
    fn call(self) -> ChunkOfLists {
        let Self(simd, work) = self;
        let skin = work.skin;
        work.by(
            AT_ONCE,
            #[inline(always)]
            |sphere, row, list, end| eight::add_near(simd, sphere, row, skin, list, end),
        )
    }
}

/// Adds those of a row of spheres that are less than `skin` away from `ball`, sphere `number`, to
/// the list from `end` on. Each is written in any case and kept if near, since a branch would be
/// mispredicted.
#[expect(
    clippy::needless_range_loop,
    reason = "several arrays side by side, lane by lane"
)]
#[inline(always)]
fn add_near(
    (ball, number): (&ReducedSphere, u32),
    row: &Row,
    skin: f64,
    list: &mut [u32],
    end: &mut usize,
) {
    let is_near = |[x, y, z, radius]: [f64; 4]| {
        let (dx, dy, dz) = (ball[0] - x, ball[1] - y, ball[2] - z);
        let reach = ball[3] + radius + skin;
        dx * dx + dy * dy + dz * dz < reach * reach
    };
    let spheres = || row.spheres.clone();
    let [x, y, z, radius] = row
        .coordinates
        .map(|all| all[spheres()].as_chunks::<LANES>());
    let (numbers, last) = row.numbers[spheres()].as_chunks::<LANES>();
    for (g, numbers) in numbers.iter().enumerate() {
        let mut near = [false; LANES];
        for k in 0..LANES {
            near[k] = is_near([x.0[g][k], y.0[g][k], z.0[g][k], radius.0[g][k]]);
        }
        for k in 0..LANES {
            list[*end] = numbers[k];
            *end += usize::from(near[k] & (numbers[k] != number));
        }
    }
    for (k, other) in last.iter().enumerate() {
        list[*end] = *other;
        let near = is_near([x.1[k], y.1[k], z.1[k], radius.1[k]]);
        *end += usize::from(near & (*other != number));
    }
}

pub(super) fn squared_distance(a: &ReducedSphere, b: &ReducedSphere) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)
}
