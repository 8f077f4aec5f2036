//! Particles by cluster, and boxes around large clusters: known from one neighbour search to the
//! next.

use rayon::prelude::*;

use crate::geometry::Bounds;

/// Centre x, y, z and radius, m.
pub type Ball = [f64; 4];

/// Clusters with fewer particles are small.
const SMALL: usize = 16;
/// Number of balls, in the order of a cluster, that have a box of their own. Near ones follow one
/// another.
pub(crate) const BLOCK: usize = 16;
/// Number of boxes that are compared at once.
pub(crate) const BOXES: usize = 8;

/// A ball that overlaps none.
pub(crate) const NOWHERE: Ball = [f64::INFINITY, 0.0, 0.0, 0.0];

/// What the last neighbour search knew of the clusters.
#[derive(Debug, Clone, Default)]
pub struct KnownClusters {
    /// Cluster of each particle.
    of_particle: Vec<u32>,
    /// The particles of each cluster.
    pub(crate) groups: Groups,
    /// Boxes around the large ones, by the lower end of the box along x.
    pub(crate) large: Vec<LargeCluster>,
}

/// A cluster of many balls.
#[derive(Debug, Clone)]
pub struct LargeCluster {
    /// Its number.
    pub(crate) group: u32,
    /// Box around its balls.
    pub(crate) bounds: Bounds,
    /// Boxes around each [`BLOCK`] of its balls.
    pub(crate) blocks: Vec<Bounds>,
    /// The same, [`BOXES`] at once, by columns: the lower ends along x, y and z, then the upper
    /// ones, m. Filled up with empty boxes.
    pub(crate) boxes: Vec<[[f64; BOXES]; 6]>,
    /// Whether any of its balls seeks.
    pub(crate) seeks: bool,
}

impl KnownClusters {
    /// Updates the boxes of the clusters of which a ball seeks. The balls of the others are those
    /// of the last time. `clusters`, `seeks`: one for each ball; without `seeks` all seek.
    pub(crate) fn update(&mut self, balls: &[Ball], clusters: &[u32], seeks: Option<&[bool]>) {
        let all_new = self.of_particle != clusters;
        if all_new {
            self.of_particle = clusters.to_vec();
            self.groups = Groups::new(clusters);
            let groups = &self.groups;
            let large = groups.all().filter(|&group| groups.is_large(group));
            self.large = large.map(LargeCluster::new).collect();
        }
        let groups = &self.groups;
        self.large.par_iter_mut().for_each(|large| {
            let members = groups.members(large.group);
            large.seeks = seeks.is_none_or(|seeks| members.iter().any(|&i| seeks[i as usize]));
            if large.seeks || all_new {
                large.find_boxes(members, balls);
            }
        });
        self.large.sort_by(|a, b| {
            let low = |large: &LargeCluster| large.bounds.low[0];
            low(a).total_cmp(&low(b)).then(a.group.cmp(&b.group))
        });
    }

    /// Whether a particle is in one of the large clusters, as of the last search.
    pub(crate) fn is_in_large(&self, i: u32) -> bool {
        let cluster = self.of_particle.get(i as usize);
        cluster.is_some_and(|&cluster| self.groups.is_large(cluster))
    }
}

impl LargeCluster {
    fn new(group: u32) -> Self {
        Self {
            group,
            bounds: Bounds::EMPTY,
            blocks: Vec::new(),
            boxes: Vec::new(),
            seeks: true,
        }
    }

    fn find_boxes(&mut self, members: &[u32], balls: &[Ball]) {
        let blocks = members.chunks(BLOCK).map(|some| box_of(some, balls));
        self.blocks.clear();
        self.blocks.extend(blocks);
        let blocks = self.blocks.iter();
        self.bounds = blocks.fold(Bounds::EMPTY, |all, one| all.with(one));
        self.boxes.clear();
        self.boxes
            .extend(self.blocks.chunks(BOXES).map(box_columns));
    }

    /// Numbers and boxes of its blocks that reach into a box.
    pub(crate) fn blocks_within<'a>(
        &'a self,
        room: &'a Bounds,
    ) -> impl Iterator<Item = (usize, &'a Bounds)> {
        let blocks = self.blocks.iter().enumerate();
        blocks.filter(|(_, bounds)| bounds.overlaps(room))
    }

    /// The members of a block.
    pub(crate) fn members<'a>(&self, block: usize, groups: &'a Groups) -> &'a [u32] {
        let all = groups.members(self.group);
        &all[BLOCK * block..all.len().min(BLOCK * (block + 1))]
    }

    /// Its balls that reach into a box.
    pub(crate) fn within<'a>(
        &'a self,
        room: &'a Bounds,
        balls: &'a [Ball],
        groups: &'a Groups,
    ) -> impl Iterator<Item = u32> + 'a {
        let blocks = self.blocks_within(room);
        blocks
            .flat_map(|(block, _)| self.members(block, groups))
            .copied()
            .filter(|&i| around(&balls[i as usize]).overlaps(room))
    }
}

/// Some boxes by columns: see [`LargeCluster::boxes`].
fn box_columns(some: &[Bounds]) -> [[f64; BOXES]; 6] {
    let Bounds { low, high } = Bounds::EMPTY;
    let mut columns = [low[0], low[1], low[2], high[0], high[1], high[2]].map(|c| [c; BOXES]);
    for (n, bounds) in some.iter().enumerate() {
        for k in 0..3 {
            columns[k][n] = bounds.low[k];
            columns[3 + k][n] = bounds.high[k];
        }
    }
    columns
}

/// The box around the balls with these numbers.
pub(crate) fn box_of(some: &[u32], balls: &[Ball]) -> Bounds {
    // Four numbers at once, by comparisons that are one operation each: the fourth is not used.
    let (mut low, mut high) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
    for &i in some {
        let ball = balls[i as usize];
        for k in 0..4 {
            let (before, after) = (ball[k] - ball[3], ball[k] + ball[3]);
            low[k] = if before < low[k] { before } else { low[k] };
            high[k] = if after > high[k] { after } else { high[k] };
        }
    }
    let ([x0, y0, z0, _], [x1, y1, z1, _]) = (low, high);
    Bounds {
        low: [x0, y0, z0],
        high: [x1, y1, z1],
    }
}

/// The box around a ball.
pub(crate) fn around(&[x, y, z, radius_m]: &Ball) -> Bounds {
    Bounds {
        low: [x - radius_m, y - radius_m, z - radius_m],
        high: [x + radius_m, y + radius_m, z + radius_m],
    }
}

/// The particles of each cluster.
#[derive(Debug, Clone, Default)]
pub struct Groups {
    /// Particles, sorted by cluster, then by number.
    members: Vec<u32>,
    /// Start of each cluster in `members`, followed by the total number.
    starts: Vec<u32>,
}

impl Groups {
    /// `clusters`: one for each particle.
    pub(crate) fn new(clusters: &[u32]) -> Self {
        let count = clusters.iter().max().map_or(0, |&last| last as usize + 1);
        let mut starts = vec![0_u32; count + 1];
        for &cluster in clusters {
            starts[cluster as usize + 1] += 1;
        }
        for cluster in 0..count {
            starts[cluster + 1] += starts[cluster];
        }
        let mut next = starts.clone();
        let mut members = vec![0; clusters.len()];
        for (i, &cluster) in (0..).zip(clusters) {
            let place = &mut next[cluster as usize];
            members[*place as usize] = i;
            *place += 1;
        }
        Self { members, starts }
    }

    /// All clusters, some of which may have no particle.
    pub(crate) fn all(&self) -> std::ops::Range<u32> {
        0..self.starts.len().saturating_sub(1) as u32
    }

    /// The particles of a cluster, ascending.
    pub(crate) fn members(&self, cluster: u32) -> &[u32] {
        let [start, end] = [0, 1].map(|k| self.starts[cluster as usize + k] as usize);
        &self.members[start..end]
    }

    pub(crate) fn is_large(&self, cluster: u32) -> bool {
        self.members(cluster).len() >= SMALL
    }
}
