//! Particles by cluster, and boxes around large clusters: known from one neighbour search to the
//! next.

use std::sync::Arc;

use super::rigid_balls::{ClumpReference, Placement, RigidBalls, RigidBody};
use crate::state::clumps::Clumps;
use crate::threads::for_each;
use dem_physics::geometry::Bounds;
use dem_physics::geometry::balls::{BLOCK, BOXES, Ball, Blocks, BoxColumns, around, box_columns};

/// Clusters with fewer particles are small.
const SMALL: usize = 16;
/// Large clusters whose boxes a task updates.
const UPDATED_AT_ONCE: usize = 8;

/// What is searched.
#[derive(Clone, Copy)]
pub(crate) struct Searched<'a> {
    /// One for each particle. Those of the spheres of large clumps follow from `clumps` instead.
    pub(crate) balls: &'a [Ball],
    /// Cluster of each particle.
    pub(crate) clusters: &'a [u32],
    /// Number of clusters that the scene has had so far, if these are its clusters: it uses no
    /// number twice.
    pub(crate) clusters_ever: Option<usize>,
    /// For each particle whether it seeks. None: all seek.
    pub(crate) seeks: Option<&'a [bool]>,
    /// For each particle whether it sleeps: those that do are not searched. Empty: none does.
    pub(crate) asleep: &'a [bool],
    /// The clumps, and where they were at their last search.
    pub(crate) clumps: Option<(&'a Clumps, &'a [ClumpReference])>,
}

impl Searched<'_> {
    /// Whether a particle seeks.
    #[inline(always)]
    pub(crate) fn is_seeking(&self, i: u32) -> bool {
        self.seeks.is_none_or(|seeks| seeks[i as usize])
    }

    /// Whether a cluster of these particles sleeps.
    pub(crate) fn sleeps(&self, members: &[u32]) -> bool {
        let sleeps = |&i: &u32| self.asleep.get(i as usize).is_some_and(|asleep| *asleep);
        members.first().is_some_and(sleeps)
    }
}

/// What the last neighbour search knew of the clusters.
#[derive(Debug, Clone, Default)]
pub struct KnownClusters {
    /// Cluster of each particle.
    of_particle: Vec<u32>,
    /// See [`Searched::clusters_ever`].
    clusters_ever: Option<usize>,
    /// The particles of each cluster.
    pub(crate) groups: Groups,
    /// Those before the clusters changed last.
    former_groups: Groups,
    /// The large ones, by number.
    pub(crate) large: Vec<LargeCluster>,
    /// The lower ends of their boxes along x, m, ascending, and their places in `large`.
    by_low_end_m: Vec<(f64, u32)>,
    /// Their boxes by columns, in the order of `by_low_end_m`.
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
    /// Whether its boxes are yet to be found.
    is_new: bool,
}

/// Whether a cluster of this number of particles is large. Balls of large clumps follow from their
/// templates.
pub(crate) fn is_large(spheres: usize) -> bool {
    spheres >= SMALL
}

impl KnownClusters {
    /// Updates the boxes of the clusters that are new, or of which a ball seeks. Others keep those
    /// of the last time.
    pub(crate) fn update(&mut self, searched: &Searched<'_>) {
        if !self.are_those_of(searched) {
            self.group_again(searched);
        }
        let groups = &self.groups;
        let update = |large: &mut LargeCluster| {
            let members = groups.members(large.group);
            let sleeps = searched.sleeps(members);
            // The spheres of a clump seek together.
            let some = if large.rigid.is_some() {
                &members[..1]
            } else {
                members
            };
            large.seeks = !sleeps && some.iter().any(|&i| searched.is_seeking(i));
            if large.seeks || large.is_new && !sleeps {
                large.find_boxes(members, searched);
                large.is_new = false;
            }
        };
        for_each(self.large.chunks_mut(UPDATED_AT_ONCE), |some| {
            some.iter_mut().for_each(update);
        });
        self.sort_boxes(searched);
    }

    /// Sorts the large clusters that are awake by the lower ends of their boxes.
    fn sort_boxes(&mut self, searched: &Searched<'_>) {
        let Self {
            groups,
            large,
            by_low_end_m: order,
            columns,
            ..
        } = self;
        order.clear();
        let awake = (0..).zip(&*large);
        let awake = awake.filter(|(_, large)| !searched.sleeps(groups.members(large.group)));
        order.extend(awake.map(|(place, large)| (large.bounds.low[0], place)));
        order.sort_unstable_by(|(a_m, a), (b_m, b)| a_m.total_cmp(b_m).then(a.cmp(b)));
        let box_of = |&(_, place): &(f64, u32)| large[place as usize].bounds;
        let boxes = |some: &[(f64, u32)]| box_columns(some.iter().map(box_of));
        columns.clear();
        columns.extend(order.chunks(BOXES).map(boxes));
    }

    /// Number of the large clusters that are awake.
    pub(crate) fn awake_large(&self) -> usize {
        self.by_low_end_m.len()
    }

    /// The `n`th large cluster that is awake, in the order of the lower ends of the boxes along x.
    #[inline(always)]
    pub(crate) fn nth_along_x(&self, n: usize) -> &LargeCluster {
        &self.large[self.by_low_end_m[n].1 as usize]
    }

    /// Sorts the particles by their present clusters. Large clusters whose particles are the same
    /// as before stay.
    fn group_again(&mut self, searched: &Searched<'_>) {
        self.of_particle.clear();
        self.of_particle.extend_from_slice(searched.clusters);
        self.clusters_ever = searched.clusters_ever;
        std::mem::swap(&mut self.groups, &mut self.former_groups);
        self.groups.set(searched.clusters);
        let Self {
            groups,
            former_groups,
            large,
            templates,
            ..
        } = self;
        let clumps = searched.clumps.map(|(clumps, _)| clumps);
        let carrier_of = |group: u32| clumps?.carrier_of(*groups.members(group).first()? as usize);
        large.retain(|large| {
            let group = large.group;
            let clump = large.rigid.as_ref().map(|body| body.clump);
            groups.all().contains(&group)
                && groups.members(group) == former_groups.members(group)
                && carrier_of(group) == clump
        });
        let known = large.len();
        for group in groups.all().filter(|&group| groups.is_large(group)) {
            let place = large[..known].binary_search_by_key(&group, |large| large.group);
            if place.is_err() {
                let rigid = clumps.zip(carrier_of(group));
                let rigid = rigid.map(|(clumps, clump)| rigid_body(clumps, clump, templates));
                large.push(LargeCluster::new(group, rigid));
            }
        }
        large.sort_unstable_by_key(|large| large.group);
    }

    /// Whether the clusters of the particles are those that are known. Those of a scene change only
    /// when there are new ones, or when the particles get new numbers, after which none is known.
    pub(crate) fn are_those_of(&self, searched: &Searched<'_>) -> bool {
        let are_same = || self.of_particle == searched.clusters;
        if searched.clusters_ever.is_none() {
            return are_same();
        }
        let are_known = self.clusters_ever == searched.clusters_ever;
        debug_assert!(!are_known || are_same());
        are_known
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

/// A clump, with the balls of its template, which are found once.
fn rigid_body(
    clumps: &Clumps,
    clump: usize,
    templates: &mut Vec<Option<Arc<RigidBalls>>>,
) -> RigidBody {
    let number = clumps.all[clump].template as usize;
    templates.resize(templates.len().max(number + 1), None);
    let new = || Arc::new(RigidBalls::new(&clumps.templates[number]));
    let balls = templates[number].get_or_insert_with(new);
    RigidBody::new(clump, Arc::clone(balls))
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
            is_new: true,
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
    /// The smallest number of a cluster. Those of bodies that have left a process are not looked
    /// at again.
    first: u32,
    /// Particles, sorted by cluster, then by number.
    members: Vec<u32>,
    /// Start of each cluster from `first` on in `members`, followed by the total number.
    starts: Vec<u32>,
}

impl Groups {
    /// Sorts the particles anew. `clusters`: one for each particle.
    fn set(&mut self, clusters: &[u32]) {
        let Self {
            first,
            members,
            starts,
        } = self;
        *first = clusters.iter().copied().min().unwrap_or(0);
        let last = clusters.iter().max();
        let count = last.map_or(0, |&last| (last - *first) as usize + 1);
        let place_of = |cluster: u32| (cluster - *first) as usize;
        starts.clear();
        starts.resize(count + 1, 0);
        for &cluster in clusters {
            starts[place_of(cluster)] += 1;
        }
        // The end of each, from which its start is reached when its particles have been placed.
        for cluster in 1..=count {
            starts[cluster] += starts[cluster - 1];
        }
        members.clear();
        members.resize(clusters.len(), 0);
        for i in (0..clusters.len()).rev() {
            let place = &mut starts[place_of(clusters[i])];
            *place -= 1;
            members[*place as usize] = i as u32;
        }
    }

    /// All clusters, some of which may have no particle.
    pub(crate) fn all(&self) -> std::ops::Range<u32> {
        self.first..self.first + self.starts.len().saturating_sub(1) as u32
    }

    /// The particles of a cluster, ascending.
    pub(crate) fn members(&self, cluster: u32) -> &[u32] {
        let at = (cluster - self.first) as usize;
        let [start, end] = [0, 1].map(|k| self.starts[at + k] as usize);
        &self.members[start..end]
    }

    pub(crate) fn is_large(&self, cluster: u32) -> bool {
        is_large(self.members(cluster).len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes around the large clusters, by their numbers.
    fn boxes(known: &KnownClusters) -> Vec<(u32, Bounds, Vec<Bounds>)> {
        let of = |large: &LargeCluster| (large.group, large.bounds, large.blocks.boxes.clone());
        let mut all: Vec<_> = known.large.iter().map(of).collect();
        all.sort_by_key(|(group, ..)| *group);
        all
    }

    #[test]
    fn when_a_cluster_breaks_the_others_keep_their_boxes() {
        // Two rows of 40 balls, of which the first has moved and broken in two.
        let place =
            |n: usize, shift: f64| [n as f64 + shift, if n < 40 { 0.0 } else { 9.0 }, 0.0, 1.0];
        let before: Vec<Ball> = (0..80).map(|n| place(n, 0.0)).collect();
        let clusters: Vec<u32> = (0..80).map(|n| n / 40).collect();
        let after: Vec<Ball> = (0..80)
            .map(|n| place(n, if n < 40 { 0.5 } else { 0.0 }))
            .collect();
        let broken: Vec<u32> = (0..80).map(|n| if n < 20 { 2 } else { n / 40 }).collect();
        let seeks: Vec<bool> = (0..80).map(|n| n < 40).collect();
        let searched = Searched {
            balls: &before,
            clusters: &clusters,
            clusters_ever: None,
            seeks: None,
            asleep: &[],
            clumps: None,
        };
        let mut known = KnownClusters::default();
        known.update(&searched);
        let blocks_of_second = |known: &KnownClusters| -> Vec<Arc<Blocks>> {
            let second = known.large.iter().filter(|large| large.group == 1);
            second.map(|large| Arc::clone(&large.blocks)).collect()
        };
        let whole = blocks_of_second(&known);
        let [all, some] = [None, Some(&seeks[..])].map(|seeks| Searched {
            balls: &after,
            clusters: &broken,
            clusters_ever: None,
            seeks,
            asleep: &[],
            clumps: None,
        });
        known.update(&some);
        let mut anew = KnownClusters::default();
        anew.update(&all);
        assert_eq!(boxes(&known), boxes(&anew));
        assert_eq!(known.large.len(), 3);
        let kept = blocks_of_second(&known);
        assert!([&whole, &kept].map(Vec::len) == [1, 1] && Arc::ptr_eq(&whole[0], &kept[0]));
        let seeking = known.large.iter().filter(|large| large.seeks);
        assert!(seeking.map(|large| large.group).all(|group| group != 1));
    }

    #[test]
    fn clusters_of_a_scene_are_known_until_there_are_more_or_particles_get_new_numbers() {
        let balls = [[0.0, 0.0, 0.0, 1.0]; 40];
        let searched = |clusters, clusters_ever| Searched {
            balls: &balls,
            clusters,
            clusters_ever,
            seeks: None,
            asleep: &[],
            clumps: None,
        };
        let (whole, broken) = ([0; 40], [[1; 20], [2; 20]].concat());
        let mut known = KnownClusters::default();
        assert!(!known.are_those_of(&searched(&whole, Some(1))));
        known.update(&searched(&whole, Some(1)));
        assert!(known.are_those_of(&searched(&whole, Some(1))));
        assert!(!known.are_those_of(&searched(&broken, Some(3))));
        known.update(&searched(&broken, Some(3)));
        let groups = known.large.iter().map(|large| large.group);
        assert_eq!(groups.collect::<Vec<_>>(), [1, 2]);
        assert!(!known.renumbered().are_those_of(&searched(&broken, Some(3))));
    }
}
