//! Where clusters may meet: boxes around them.

use rayon::prelude::*;

use super::groups::Groups;
use crate::geometry::Bounds;
use crate::state::references::Ball;

/// Number of balls, in the order of a cluster, that have a box of their own. Near ones follow one
/// another.
const BLOCK: usize = 16;

/// A cluster of many balls.
pub(super) struct Large {
    pub(super) group: u32,
    /// Box around its balls.
    pub(super) bounds: Bounds,
    /// Boxes around each [`BLOCK`] of its balls.
    blocks: Vec<Bounds>,
    /// Whether any of its balls seeks.
    pub(super) seeks: bool,
}

impl Large {
    /// Its balls that reach into a box.
    pub(super) fn within<'a>(
        &'a self,
        room: &'a Bounds,
        balls: &'a [Ball],
        groups: &'a Groups,
    ) -> impl Iterator<Item = u32> + 'a {
        let blocks = groups.members(self.group).chunks(BLOCK).zip(&self.blocks);
        blocks
            .filter(|(_, bounds)| bounds.overlaps(room))
            .flat_map(|(members, _)| members)
            .copied()
            .filter(|&i| around(&balls[i as usize]).overlaps(room))
    }
}

/// Boxes around clusters.
pub(super) struct Meetings {
    /// Large clusters, by the lower end of their boxes along x.
    pub(super) large: Vec<Large>,
    /// Small clusters; all are given if all seek.
    small: Vec<u32>,
    /// Box around all small clusters, and around those that seek.
    of_small: [Bounds; 2],
    all_seek: bool,
}

impl Meetings {
    pub(super) fn new(balls: &[Ball], groups: &Groups, seeks: Option<&[bool]>) -> Self {
        let seeks_any =
            |members: &[u32]| seeks.is_none_or(|seeks| members.iter().any(|&i| seeks[i as usize]));
        let box_of = |members: &[u32]| {
            let boxes = members.iter().map(|&i| around(&balls[i as usize]));
            boxes.fold(Bounds::EMPTY, |all, one| all.with(&one))
        };
        let (large, small): (Vec<u32>, Vec<u32>) = groups
            .all()
            .filter(|&group| !groups.members(group).is_empty())
            .partition(|&group| groups.is_large(group));
        let mut large: Vec<Large> = large
            .into_par_iter()
            .map(|group| {
                let members = groups.members(group);
                let blocks: Vec<Bounds> = members.chunks(BLOCK).map(box_of).collect();
                Large {
                    group,
                    bounds: blocks.iter().fold(Bounds::EMPTY, |all, one| all.with(one)),
                    blocks,
                    seeks: seeks_any(members),
                }
            })
            .collect();
        large.sort_by(|a, b| {
            let low = |large: &Large| large.bounds.low[0];
            low(a).total_cmp(&low(b)).then(a.group.cmp(&b.group))
        });
        let mut of_small = [Bounds::EMPTY; 2];
        for &group in &small {
            let members = groups.members(group);
            let bounds = box_of(members);
            of_small[0] = of_small[0].with(&bounds);
            if seeks_any(members) {
                of_small[1] = of_small[1].with(&bounds);
            }
        }
        Self {
            large,
            small,
            of_small,
            all_seek: seeks.is_none(),
        }
    }

    /// The balls that may be in a pair with one of a small cluster, ascending.
    pub(super) fn with_small(&self, balls: &[Ball], groups: &Groups) -> Vec<u32> {
        let [all, seeking] = &self.of_small;
        let mut active = Vec::new();
        let mut where_sought = *seeking;
        for large in &self.large {
            let small = if large.seeks { all } else { seeking };
            let common = large.bounds.common(small);
            where_sought = where_sought.with(&common);
            active.extend(large.within(&common, balls, groups));
        }
        let of_small = self.small.iter().flat_map(|&group| groups.members(group));
        let may_meet =
            |i: &&u32| self.all_seek || around(&balls[**i as usize]).overlaps(&where_sought);
        active.extend(of_small.filter(may_meet));
        active.sort_unstable();
        active
    }
}

pub(super) fn around(&[x, y, z, radius_m]: &Ball) -> Bounds {
    Bounds {
        low: [x - radius_m, y - radius_m, z - radius_m],
        high: [x + radius_m, y + radius_m, z + radius_m],
    }
}
