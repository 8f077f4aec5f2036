//! Where clusters may meet small ones.

use crate::state::search::buffers::PairBuffers;
use crate::state::search::clusters::{KnownClusters, LargeCluster, Searched};
use dem_physics::geometry::Bounds;
use dem_physics::geometry::balls::{Ball, around, box_of};

/// Lists the balls that may be in a pair with one of a small cluster, ascending by number, and
/// those of them that are of small clusters.
pub(super) fn list_with_small(
    searched: &Searched<'_>,
    known: &KnownClusters,
    buffers: &mut PairBuffers,
) {
    let PairBuffers {
        small_clusters: small,
        of_small,
        active,
        ..
    } = buffers;
    let groups = &known.groups;
    let is_small = |&group: &u32| {
        let members = groups.members(group);
        !groups.is_large(group) && !members.is_empty() && !searched.sleeps(members)
    };
    small.clear();
    small.extend(groups.all().filter(is_small));
    of_small.clear();
    active.clear();
    if small.is_empty() {
        return;
    }
    let balls = searched.balls;
    let [all, seeking] = bounds_of(small, known, searched);
    let mut where_sought = seeking;
    let sleeps = |large: &LargeCluster| searched.sleeps(groups.members(large.group));
    for large in known.large.iter().filter(|large| !sleeps(large)) {
        let others = if large.seeks { &all } else { &seeking };
        let common = large.bounds.common(others);
        if common == Bounds::EMPTY {
            continue;
        }
        where_sought = where_sought.with(&common);
        active.extend(large.within(&common, balls, groups));
    }
    let members = small.iter().flat_map(|&group| groups.members(group));
    let members = members.map(|&i| (i, balls[i as usize]));
    // All are given if all seek.
    let may_meet =
        |(_, ball): &(u32, Ball)| searched.seeks.is_none() || around(ball).overlaps(&where_sought);
    of_small.extend(members.filter(may_meet));
    active.extend_from_slice(of_small);
    active.sort_unstable_by_key(|(i, _)| *i);
}

/// The box around all of these clusters, and around those that seek.
fn bounds_of(some: &[u32], known: &KnownClusters, searched: &Searched<'_>) -> [Bounds; 2] {
    let mut around_small = [Bounds::EMPTY; 2];
    for &group in some {
        let members = known.groups.members(group);
        let bounds = box_of(members, searched.balls);
        around_small[0] = around_small[0].with(&bounds);
        if members.iter().any(|&i| searched.is_seeking(i)) {
            around_small[1] = around_small[1].with(&bounds);
        }
    }
    around_small
}
