//! Where clusters may meet small ones.

use crate::geometry::Bounds;
use crate::state::balls::{Ball, around, box_of};
use crate::state::groups::KnownClusters;

/// Small clusters, and the boxes around them.
pub(super) struct Meetings<'a> {
    known: &'a KnownClusters,
    /// Small clusters; all are given if all seek.
    small: Vec<u32>,
    /// Box around all small clusters, and around those that seek.
    of_small: [Bounds; 2],
    all_seek: bool,
}

impl<'a> Meetings<'a> {
    pub(super) fn new(balls: &[Ball], known: &'a KnownClusters, seeks: Option<&[bool]>) -> Self {
        let groups = &known.groups;
        let seeks_any =
            |members: &[u32]| seeks.is_none_or(|seeks| members.iter().any(|&i| seeks[i as usize]));
        let is_small = |&group: &u32| !groups.is_large(group) && !groups.members(group).is_empty();
        let small: Vec<u32> = groups.all().filter(is_small).collect();
        let mut of_small = [Bounds::EMPTY; 2];
        for &group in &small {
            let members = groups.members(group);
            let bounds = box_of(members, balls);
            of_small[0] = of_small[0].with(&bounds);
            if seeks_any(members) {
                of_small[1] = of_small[1].with(&bounds);
            }
        }
        Self {
            known,
            small,
            of_small,
            all_seek: seeks.is_none(),
        }
    }

    /// The balls that may be in a pair with one of a small cluster, ascending by number.
    pub(super) fn with_small(&self, balls: &[Ball]) -> Vec<(u32, Ball)> {
        if self.small.is_empty() {
            return Vec::new();
        }
        let groups = &self.known.groups;
        let [all, seeking] = &self.of_small;
        let mut active = Vec::new();
        let mut where_sought = *seeking;
        for large in &self.known.large {
            let small = if large.seeks { all } else { seeking };
            let common = large.bounds.common(small);
            if common == Bounds::EMPTY {
                continue;
            }
            where_sought = where_sought.with(&common);
            active.extend(large.within(&common, balls, groups));
        }
        let of_small = self.small.iter().flat_map(|&group| groups.members(group));
        let of_small = of_small.map(|&i| (i, balls[i as usize]));
        let may_meet =
            |(_, ball): &(u32, Ball)| self.all_seek || around(ball).overlaps(&where_sought);
        active.extend(of_small.filter(may_meet));
        active.sort_unstable_by_key(|(i, _)| *i);
        active
    }
}
