//! Bonds break in any order; clusters equal those of a full search from scratch.

use std::collections::VecDeque;

use dem_engine::state::bonds::Bonds;
use dem_engine::state::clusters::{Clusters, Split};
use proptest::prelude::*;

use super::{between, bonds, chain};

/// The smallest particle connected to each particle, by breadth-first search.
fn breadth_first(particles: usize, bonds: &Bonds) -> Vec<u32> {
    let mut smallest = vec![u32::MAX; particles];
    for seed in 0..particles as u32 {
        if smallest[seed as usize] != u32::MAX {
            continue;
        }
        smallest[seed as usize] = seed;
        let mut queue = VecDeque::from([seed]);
        while let Some(p) = queue.pop_front() {
            for (at, [a, b]) in bonds.ends.iter().enumerate() {
                if bonds.is_broken(at) || ![*a, *b].contains(&p) {
                    continue;
                }
                let other = (a + b - p) as usize;
                if smallest[other] == u32::MAX {
                    smallest[other] = seed;
                    queue.push_back(other as u32);
                }
            }
        }
    }
    smallest
}

/// The smallest particle of the cluster of each particle.
fn smallest_of(clusters: &Clusters) -> Vec<u32> {
    let id = |p: &u32| *p as usize;
    clusters
        .of_particle
        .iter()
        .map(|c| clusters.of_particle.iter().position(|d| d == c).unwrap() as u32)
        .inspect(|p| assert!(id(p) < clusters.of_particle.len()))
        .collect()
}

/// Invariants of any clusters: each particle belongs to the cluster in whose list it is; pieces add
/// up to the cluster from which they broke off; clusters are numbered by smallest particle.
fn assert_consistent(clusters: &Clusters) {
    let mut listed = 0;
    for id in clusters.living() {
        let members = clusters.members(id);
        assert!(members.is_sorted() && !members.is_empty());
        assert!(
            members
                .iter()
                .all(|p| clusters.of_particle[*p as usize] == id)
        );
        assert_eq!(
            members.len(),
            clusters.history[id as usize].particles as usize
        );
        listed += members.len();
    }
    assert_eq!(listed, clusters.of_particle.len());
    for (id, cluster) in clusters.history.iter().enumerate() {
        let children = clusters
            .history
            .iter()
            .filter(|c| c.parent == Some(id as u32));
        let counts: Vec<u32> = children.clone().map(|c| c.particles).collect();
        match cluster.ended_s {
            None => assert!(counts.is_empty()),
            Some(ended_s) => {
                assert!(counts.len() > 1);
                assert_eq!(counts.iter().sum::<u32>(), cluster.particles);
                assert!(children.clone().all(|c| c.created_s == ended_s));
                assert!(clusters.members(id as u32).is_empty());
            }
        }
        assert!(cluster.parent.is_none_or(|parent| (parent as usize) < id));
    }
}

/// Breaks some bonds, searches, and compares. Returns the number of particles that had to be
/// visited.
fn break_and_compare(
    clusters: &mut Clusters,
    bonds: &mut Bonds,
    broken: &[u32],
    time_s: f64,
) -> Vec<Split> {
    let before = clusters.clone();
    for bond in broken {
        bonds.set_broken(*bond as usize);
    }
    let damaged = clusters.damaged_by(broken, bonds);
    let searched: usize = damaged.iter().map(|id| clusters.members(*id).len()).sum();
    let splits = clusters.update(time_s, &damaged, bonds);
    assert_eq!(clusters.visited - before.visited, searched as u64);
    assert_eq!(
        smallest_of(clusters),
        breadth_first(clusters.of_particle.len(), bonds)
    );
    assert_consistent(clusters);

    assert!(splits.is_sorted_by_key(|split| split.parent));
    assert!(splits.iter().flat_map(|s| &s.children).is_sorted());
    for split in &splits {
        assert!(damaged.contains(&split.parent));
        let mut of_children: Vec<u32> = split
            .children
            .iter()
            .flat_map(|c| clusters.members(*c))
            .copied()
            .collect();
        let firsts = split.children.iter().map(|c| clusters.members(*c)[0]);
        assert!(firsts.is_sorted());
        of_children.sort_unstable();
        assert_eq!(of_children, before.members(split.parent));
        for child in &split.children {
            assert_eq!(clusters.history[*child as usize].parent, Some(split.parent));
            assert_eq!(clusters.history[*child as usize].created_s, time_s);
            assert!(*child as usize >= before.history.len());
        }
    }
    for id in before.living() {
        if !splits.iter().any(|split| split.parent == id) {
            assert_eq!(clusters.members(id), before.members(id));
            let mut expected = before.history[id as usize];
            if damaged.contains(&id) {
                expected.unbroken_since_s = time_s;
            }
            assert_eq!(clusters.history[id as usize], expected);
        }
    }
    splits
}

proptest! {
    #[test]
    fn clusters_are_those_of_a_search_from_scratch(
        particles in 1_u32..40,
        pairs in prop::collection::vec(prop::array::uniform2(0_u32..40), 0..90),
        order in prop::collection::vec(any::<prop::sample::Index>(), 0..60),
        steps in prop::collection::vec(1_usize..9, 1..12),
    ) {
        let within = pairs.into_iter().filter(|[a, b]| *a.max(b) < particles);
        let mut bonds = bonds(within);
        let mut clusters = Clusters::new(particles as usize, &bonds);
        prop_assert_eq!(smallest_of(&clusters), breadth_first(particles as usize, &bonds));
        assert_consistent(&clusters);
        let mut left: Vec<u32> = (0..bonds.len() as u32).collect();
        let mut order = order.into_iter();
        for (time, count) in steps.into_iter().enumerate() {
            let mut broken = Vec::new();
            for index in order.by_ref().take(count) {
                if !left.is_empty() {
                    broken.push(left.swap_remove(index.index(left.len())));
                }
            }
            break_and_compare(&mut clusters, &mut bonds, &broken, 1.0 + time as f64);
            let saved = postcard::to_stdvec(&clusters).unwrap();
            let mut resumed: Clusters = postcard::from_bytes(&saved).unwrap();
            resumed.rebuild(&bonds).unwrap();
            for id in 0..clusters.history.len() as u32 {
                prop_assert_eq!(resumed.members(id), clusters.members(id));
            }
        }
        // All remaining bonds at once.
        break_and_compare(&mut clusters, &mut bonds, &left, 100.0);
        prop_assert_eq!(clusters.living().count(), particles as usize);
    }
}

/// A ring with one broken bond is still one piece; with two, it is two.
#[test]
fn damaged_is_not_broken() {
    let mut bonds = bonds(chain(0, 6).chain([[0, 5]]));
    let mut clusters = Clusters::new(6, &bonds);
    let first = between(&bonds, 1, 2);
    assert!(break_and_compare(&mut clusters, &mut bonds, &[first], 1.0).is_empty());
    assert_eq!(clusters.of_particle, [0; 6]);
    let second = between(&bonds, 4, 5);
    let splits = break_and_compare(&mut clusters, &mut bonds, &[second], 2.0);
    assert_eq!(
        splits,
        [Split {
            parent: 0,
            children: vec![1, 2]
        }]
    );
    assert_eq!(clusters.of_particle, [1, 1, 2, 2, 2, 1]);
    // Already known: nothing changes, and ended clusters stay ended.
    assert!(clusters.update(3.0, &[0, 1, 1, 2, 99], &bonds).is_empty());
}

/// A case for which algorithm 2 as printed is wrong: two clusters found apart that a later bond
/// joins.
#[test]
fn clusters_that_meet_late_are_one() {
    let mut bonds = bonds([[0, 3], [1, 4], [3, 4]]);
    let clusters = Clusters::new(5, &bonds);
    assert_eq!(clusters.of_particle, [0, 0, 1, 0, 0]);
    bonds.set_broken(2);
    let clusters = Clusters::new(5, &bonds);
    assert_eq!(clusters.of_particle, [0, 1, 2, 0, 1]);
}

/// A thousand bodies, one of them damaged.
#[test]
fn only_damaged_clusters_are_looked_at() {
    let count = 1000;
    let mut bonds = bonds((0..count).flat_map(|body| chain(20 * body, 20)));
    let mut clusters = Clusters::new(20 * count as usize, &bonds);
    assert_eq!(clusters.visited, 20_000);
    let bond = between(&bonds, 20 * 77 + 4, 20 * 77 + 5);
    bonds.set_broken(bond as usize);
    let damaged = clusters.damaged_by(&[bond], &bonds);
    assert_eq!(damaged, [77]);
    let splits = clusters.update(1.0, &damaged, &bonds);
    assert_eq!(
        splits,
        [Split {
            parent: 77,
            children: vec![1000, 1001]
        }]
    );
    assert_eq!(clusters.visited, 20_020);
    // The next time, only the piece is searched.
    let bond = between(&bonds, 20 * 77 + 1, 20 * 77 + 2);
    bonds.set_broken(bond as usize);
    let damaged = clusters.damaged_by(&[bond], &bonds);
    clusters.update(2.0, &damaged, &bonds);
    assert_eq!(clusters.visited, 20_025);
}

/// A chain of a million, cut at every hundredth bond: no long chains of names build up.
#[test]
fn a_long_chain_is_searched_in_one_go() {
    let count = 1_000_000;
    let mut bonds = bonds(chain(0, count));
    let mut clusters = Clusters::new(count as usize, &bonds);
    assert_eq!(clusters.history.len(), 1);
    for bond in (99..bonds.len()).step_by(100) {
        bonds.set_broken(bond);
    }
    let splits = clusters.update(1.0, &[0], &bonds);
    assert_eq!(splits[0].children.len(), 10_000);
}

#[test]
fn bodies_that_come_later_are_clusters_of_their_own() {
    let mut all = bonds(chain(0, 4));
    let mut clusters = Clusters::new(4, &all);
    let cut = between(&all, 1, 2);
    break_and_compare(&mut clusters, &mut all, &[cut], 1.0);
    let mut all = bonds(chain(0, 4).chain(chain(4, 3)).chain([[8, 9]]));
    all.set_broken(1);
    clusters.extend(2.0, 10, &all);
    assert_consistent(&clusters);
    assert_eq!(clusters.of_particle, [1, 1, 2, 2, 3, 3, 3, 4, 5, 5]);
    assert_eq!(
        (clusters.history[3].created_s, clusters.history[3].parent),
        (2.0, None)
    );
    assert_eq!(clusters.visited, 4 + 4 + 6);
    let cut = between(&all, 4, 5);
    let splits = break_and_compare(&mut clusters, &mut all, &[cut], 3.0);
    assert_eq!(
        splits,
        [Split {
            parent: 3,
            children: vec![6, 7]
        }]
    );
}

#[test]
fn what_does_not_belong_together_is_not_resumed() {
    let bonds = bonds(chain(0, 4));
    let clusters = Clusters::new(4, &bonds);
    let rebuilt = |of_particle: &[u32]| {
        let mut clusters = clusters.clone();
        clusters.of_particle = of_particle.to_vec();
        clusters.rebuild(&bonds)
    };
    assert!(rebuilt(&[0; 4]).is_some());
    assert!(rebuilt(&[0, 0, 0, 1]).is_none());
    assert!(rebuilt(&[0; 3]).is_none());
}
