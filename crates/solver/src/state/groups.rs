//! Particles by cluster, and boxes around large clusters: known from one neighbour search to the
//! next.

use std::sync::Arc;

use rayon::prelude::*;

use super::balls::{BLOCK, BOXES, Ball, Blocks, BoxColumns, around, box_columns};
use super::clumps::Clumps;
use super::rigid_balls::{ClumpReference, Placement, RigidBalls, RigidBody};
use crate::geometry::Bounds;

/// Clusters with fewer particles are small.
const SMALL: usize = 16;

/// What is searched.
#[derive(Clone, Copy)]
pub(crate) struct Searched<'a> {
    /// One for each particle. Those of the spheres of large clumps follow from `clumps` instead.
    pub(crate) balls: &'a [Ball],
    /// Cluster of each particle.
    pub(crate) clusters: &'a [u32],
    /// For each particle whether it seeks. None: all seek.
    pub(crate) seeks: Option<&'a [bool]>,
    /// The clumps, and where they were at their last search.
    pub(crate) clumps: Option<(&'a Clumps, &'a [ClumpReference])>,
}

/// What the last neighbour search knew of the clusters.
#[derive(Debug, Clone, Default)]
pub struct KnownClusters {
    /// Cluster of each particle.
    of_particle: Vec<u32>,
    /// The particles of each cluster.
    pub(crate) groups: Groups,
    /// Boxes around the large ones, by the lower end of the box along x.
    pub(crate) large: Vec<LargeCluster>,
    /// These boxes by columns.
    pub(crate) columns: Vec<BoxColumns>,
    /// The balls of each template, once a large clump of it has been searched for.
    templates: Vec<Option<Arc<RigidBalls>>>,
}

/// A cluster of many balls.
#[derive(Debug, Clone)]
pub struct LargeCluster {
    /// Its number.
    pub(crate) group: u32,
    /// Box around its balls, in space.
    pub(crate) bounds: Bounds,
    /// Boxes around blocks of its balls: in its own axes if it is rigid, otherwise in space.
    pub(crate) blocks: Arc<Blocks>,
    /// If it is a clump.
    pub(crate) rigid: Option<RigidBody>,
    /// Whether any of its balls seeks.
    pub(crate) seeks: bool,
}

/// Whether a cluster of this number of particles is large. Balls of large clumps follow from their
/// templates.
pub(crate) fn is_large(spheres: usize) -> bool {
    spheres >= SMALL
}

impl KnownClusters {
    /// Updates the boxes of the clusters of which a ball seeks. Those of the others are those of
    /// the last time.
    pub(crate) fn update(&mut self, searched: &Searched<'_>) {
        let all_new = !self.are_those_of(searched.clusters);
        if all_new {
            self.of_particle = searched.clusters.to_vec();
            self.groups = Groups::new(searched.clusters);
            self.large = self.all_large(searched.clumps.map(|(clumps, _)| clumps));
        }
        let groups = &self.groups;
        self.large.par_iter_mut().for_each(|large| {
            let members = groups.members(large.group);
            let seeks = |&i: &u32| searched.seeks.is_none_or(|seeks| seeks[i as usize]);
            large.seeks = members.iter().any(seeks);
            if large.seeks || all_new {
                large.find_boxes(members, searched);
            }
        });
        self.large.sort_unstable_by(|a, b| {
            let low = |large: &LargeCluster| large.bounds.low[0];
            low(a).total_cmp(&low(b)).then(a.group.cmp(&b.group))
        });
        let boxes = |some: &[LargeCluster]| box_columns(some.iter().map(|large| large.bounds));
        self.columns.clear();
        self.columns.extend(self.large.chunks(BOXES).map(boxes));
    }

    /// Whether these are the clusters of the particles, as known.
    pub(crate) fn are_those_of(&self, clusters: &[u32]) -> bool {
        self.of_particle == clusters
    }

    /// The large clusters, without boxes in space.
    fn all_large(&mut self, clumps: Option<&Clumps>) -> Vec<LargeCluster> {
        let Self {
            groups, templates, ..
        } = self;
        let rigid = |group: u32| {
            let clumps = clumps?;
            let clump = clumps.carrier_of(groups.members(group)[0] as usize)?;
            let number = clumps.all[clump].template as usize;
            templates.resize(templates.len().max(number + 1), None);
            let new = || Arc::new(RigidBalls::new(&clumps.templates[number]));
            let balls = templates[number].get_or_insert_with(new);
            Some(RigidBody::new(clump, Arc::clone(balls)))
        };
        let large = groups.all().filter(|&group| groups.is_large(group));
        let numbers: Vec<u32> = large.collect();
        let rigid: Vec<Option<RigidBody>> = numbers.iter().copied().map(rigid).collect();
        let all = numbers.into_iter().zip(rigid);
        all.map(|(group, rigid)| LargeCluster::new(group, rigid))
            .collect()
    }

    /// What stays known when the particles get new numbers.
    pub(crate) fn renumbered(self) -> Self {
        Self {
            templates: self.templates,
            ..Self::default()
        }
    }

    /// Radius of the largest ball of a template, m, if its balls are known.
    pub(crate) fn largest_m(&self, template: usize) -> Option<f64> {
        let balls = self.templates.get(template)?.as_ref()?;
        Some(balls.largest_m)
    }

    /// Whether a particle is in one of the large clusters, as of the last search.
    pub(crate) fn is_in_large(&self, i: u32) -> bool {
        let cluster = self.of_particle.get(i as usize);
        cluster.is_some_and(|&cluster| self.groups.is_large(cluster))
    }
}

impl LargeCluster {
    fn new(group: u32, rigid: Option<RigidBody>) -> Self {
        let blocks = rigid.as_ref().map(|body| Arc::clone(&body.balls.blocks));
        Self {
            group,
            bounds: Bounds::EMPTY,
            blocks: blocks.unwrap_or_default(),
            rigid,
            seeks: true,
        }
    }

    fn find_boxes(&mut self, members: &[u32], searched: &Searched<'_>) {
        if let (Some(body), Some((_, references))) = (&mut self.rigid, searched.clumps) {
            body.put_at(&references[body.clump]);
            let whole = &self.blocks.bounds;
            self.bounds = body.to_space.of_box(whole, body.allowance_m);
        } else {
            // Blocks of a cluster that is no clump are its own: this does not copy them.
            let blocks = Arc::make_mut(&mut self.blocks);
            blocks.find(members, searched.balls);
            self.bounds = blocks.bounds;
        }
    }

    /// From its axes to space. None: its boxes and balls are in space.
    pub(crate) fn to_space(&self) -> Option<&Placement> {
        self.rigid.as_ref().map(|body| &body.to_space)
    }

    /// What is added to the boxes and balls in its axes, m.
    pub(crate) fn allowance_m(&self) -> f64 {
        self.rigid.as_ref().map_or(0.0, |body| body.allowance_m)
    }

    /// A ball of its axes in space.
    pub(crate) fn in_space(&self, ball: &Ball) -> Ball {
        self.rigid
            .as_ref()
            .map_or(*ball, |body| body.in_space(ball))
    }

    /// The members of a block.
    pub(crate) fn members<'a>(&self, block: usize, groups: &'a Groups) -> &'a [u32] {
        let all = groups.members(self.group);
        &all[BLOCK * block..all.len().min(BLOCK * (block + 1))]
    }

    /// Numbers and balls of a block, in space.
    pub(crate) fn balls_of<'a>(
        &'a self,
        block: usize,
        balls: &'a [Ball],
        groups: &'a Groups,
    ) -> impl Iterator<Item = (u32, Ball)> + 'a {
        let members = self.members(block, groups).iter().enumerate();
        members.map(move |(lane, &i)| match &self.rigid {
            Some(body) => (i, body.ball(block, lane)),
            None => (i, balls[i as usize]),
        })
    }

    /// Its balls that reach into a box in space.
    pub(crate) fn within<'a>(
        &'a self,
        room: &'a Bounds,
        balls: &'a [Ball],
        groups: &'a Groups,
    ) -> impl Iterator<Item = (u32, Ball)> + 'a {
        let boxes = self.blocks.boxes.iter().enumerate();
        let reaching = boxes.filter(|(_, bounds)| match self.to_space() {
            Some(to_space) => to_space.of_box(bounds, self.allowance_m()).overlaps(room),
            None => bounds.overlaps(room),
        });
        reaching
            .flat_map(|(block, _)| self.balls_of(block, balls, groups))
            .filter(|(_, ball)| around(ball).overlaps(room))
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
        is_large(self.members(cluster).len())
    }
}
