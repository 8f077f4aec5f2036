//! The Verlet list: pairs of particles of different clusters that are closer than a skin, found
//! with a grid of cells. The list is valid until a particle may have moved by half the skin.
//!
//! Particles far from every other cluster are not put into the grid. A body that flies alone has
//! none in it.

use rayon::prelude::*;

use crate::geometry::Bounds;
use crate::stages::motion::CHUNK;
use crate::state::particles::Pose;

/// Clusters with fewer particles are not tested for near clusters: they always are in the grid.
const SMALL: u32 = 16;
/// Largest number of cells per particle: a wide, empty scene gets larger cells.
const CELLS_PER_PARTICLE: usize = 4;

/// Pairs of particles of different clusters whose surfaces are less than `skin_m` apart, the
/// smaller index first, sorted. `clusters`: one for each particle.
pub fn near_pairs(poses: &[Pose], clusters: &[u32], skin_m: f64) -> Vec<[u32; 2]> {
    let active = near_others(poses, clusters, skin_m);
    let Some(grid) = Grid::new(poses, clusters, &active, skin_m) else {
        return Vec::new();
    };
    let of_chunk = |some: &[u32]| {
        let mut pairs = Vec::new();
        for &i in some {
            let first = pairs.len();
            let (pose, cluster) = (&poses[i as usize], clusters[i as usize]);
            grid.add_above(i, pose, cluster, skin_m, &mut pairs);
            pairs[first..].sort_unstable();
        }
        pairs
    };
    let chunks: Vec<Vec<[u32; 2]>> = active.par_chunks(CHUNK).map(of_chunk).collect();
    chunks.concat()
}

/// Particles that another cluster may reach, in ascending order.
fn near_others(poses: &[Pose], clusters: &[u32], skin_m: f64) -> Vec<u32> {
    let count = clusters.iter().max().map_or(0, |&last| last as usize + 1);
    let mut sizes = vec![0_u32; count];
    let mut bounds = vec![Bounds::EMPTY; count];
    let around = |pose: &Pose| Bounds::of([pose.place()]).grown(pose.radius_m() + 0.5 * skin_m);
    for (pose, &cluster) in poses.iter().zip(clusters) {
        let bounds = &mut bounds[cluster as usize];
        sizes[cluster as usize] += 1;
        *bounds = bounds.with(&around(pose));
    }
    // All small clusters count as one object that a large one may be near to.
    let mut small = Bounds::EMPTY;
    let mut large: Vec<usize> = Vec::new();
    for cluster in 0..count {
        if sizes[cluster] >= SMALL {
            large.push(cluster);
        } else if sizes[cluster] > 0 {
            small = small.with(&bounds[cluster]);
        }
    }
    let mut meets = vec![Bounds::EMPTY; count];
    large.sort_by(|&a, &b| {
        bounds[a].low[0]
            .total_cmp(&bounds[b].low[0])
            .then(a.cmp(&b))
    });
    for (n, &a) in large.iter().enumerate() {
        meets[a] = meets[a].with(&bounds[a].common(&small));
        for &b in large[n + 1..]
            .iter()
            .take_while(|&&b| bounds[b].low[0] <= bounds[a].high[0])
        {
            let common = bounds[a].common(&bounds[b]);
            meets[a] = meets[a].with(&common);
            meets[b] = meets[b].with(&common);
        }
    }
    let is_near = |i: usize| {
        let cluster = clusters[i] as usize;
        if sizes[cluster] < SMALL {
            return true;
        }
        around(&poses[i]).overlaps(&meets[cluster])
    };
    (0..poses.len())
        .filter(|&i| is_near(i))
        .map(|i| i as u32)
        .collect()
}

/// Grid of cells as wide as the largest particle with its skin, and the particles in each.
struct Grid {
    origin: [f64; 3],
    per_width: f64,
    counts: [usize; 3],
    /// For each cell, the first of its particles in `standing`, followed by the total number.
    starts: Vec<u32>,
    /// Sorted by cell.
    standing: Vec<Standing>,
}

/// Data of a particle in a cell: a copy, so that the particles of a cell are contiguous in memory.
#[derive(Clone, Copy, Default)]
struct Standing {
    /// As in its pose.
    position_m: [f64; 4],
    particle: u32,
    cluster: u32,
}

impl Grid {
    /// None if there are fewer than two particles.
    fn new(poses: &[Pose], clusters: &[u32], active: &[u32], skin_m: f64) -> Option<Self> {
        if active.len() < 2 {
            return None;
        }
        let poses_of = || active.iter().map(|&i| &poses[i as usize]);
        let bounds = Bounds::of(poses_of().map(Pose::place));
        let largest = poses_of().map(Pose::radius_m).fold(0.0, f64::max);
        let mut width = 2.0 * largest + skin_m;
        let counts_of = |width: f64| {
            [0, 1, 2].map(|k| ((bounds.high[k] - bounds.low[k]) / width).min(1e6) as usize + 1)
        };
        let room = CELLS_PER_PARTICLE * active.len() + 64;
        let product = |counts: [usize; 3]| counts.iter().map(|&n| n as f64).product::<f64>();
        while product(counts_of(width)) > room as f64 {
            width *= 1.25;
        }
        let mut grid = Self {
            origin: bounds.low,
            per_width: 1.0 / width,
            counts: counts_of(width),
            starts: Vec::new(),
            standing: vec![Standing::default(); active.len()],
        };
        let cells: Vec<u32> = active
            .iter()
            .map(|&i| grid.number(grid.cell(&poses[i as usize])) as u32)
            .collect();
        let mut starts = vec![0_u32; grid.counts.iter().product::<usize>() + 1];
        for &cell in &cells {
            starts[cell as usize + 1] += 1;
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        for (&cell, &i) in cells.iter().zip(active) {
            let place = &mut next[cell as usize];
            grid.standing[*place as usize] = Standing {
                position_m: poses[i as usize].position_m,
                particle: i,
                cluster: clusters[i as usize],
            };
            *place += 1;
        }
        grid.starts = starts;
        Some(grid)
    }

    fn cell(&self, pose: &Pose) -> [usize; 3] {
        [0, 1, 2].map(|k| {
            let along = (pose.position_m[k] - self.origin[k]) * self.per_width;
            (along as usize).min(self.counts[k] - 1)
        })
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    /// Adds the pairs of a particle with near particles of other clusters that have a larger index,
    /// in no order.
    fn add_above(&self, i: u32, pose: &Pose, cluster: u32, skin_m: f64, pairs: &mut Vec<[u32; 2]>) {
        let [x, y, z] = self.cell(pose);
        let around = |at: usize, k: usize| at.saturating_sub(1)..(at + 2).min(self.counts[k]);
        let reach = pose.radius_m() + skin_m;
        let [px, py, pz, _] = pose.position_m;
        let xs = around(x, 0);
        for z in around(z, 2) {
            for y in around(y, 1) {
                // Neighbouring cells along x are contiguous.
                let first = self.starts[self.number([xs.start, y, z])] as usize;
                let end = self.starts[self.number([xs.end - 1, y, z]) + 1] as usize;
                for other in &self.standing[first..end] {
                    let [ox, oy, oz, radius] = other.position_m;
                    let apart = [ox - px, oy - py, oz - pz];
                    let near = reach + radius;
                    let square = apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2];
                    if square < near * near && other.particle > i && other.cluster != cluster {
                        pairs.push([i, other.particle]);
                    }
                }
            }
        }
    }
}
