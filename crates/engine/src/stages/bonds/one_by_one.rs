//! Bonds that are computed one at a time: those with a history.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::stages::bonds::blocks::for_each_partition;
use crate::state::bonds::{BondRule, Bonds};
use crate::state::particles::{Pose, Wrench};
use crate::state::partitions::{Batch, BondSelection, Partition};
use dem_physics::bond::failure::{Factors, stresses, utilisation};

/// Adds the forces of the bonds with these rules to the wrenches, and those that have reached their
/// strength to the partitions' lists. Returns their number.
pub(super) fn add_single_wrenches(
    bonds: &Bonds,
    poses: &[Pose],
    partitions: &mut [Partition],
    wrenches: &mut [Wrench],
    is_one: fn(&BondRule) -> bool,
) -> usize {
    let count = AtomicUsize::new(0);
    for_each_partition(partitions, wrenches, &|partition, wrenches| {
        let of_partition = of_partition(bonds, poses, partition, wrenches, is_one);
        count.fetch_add(of_partition, Ordering::Relaxed);
    });
    count.into_inner()
}

fn of_partition(
    bonds: &Bonds,
    poses: &[Pose],
    partition: &mut Partition,
    wrenches: &mut [Wrench],
    is_one: fn(&BondRule) -> bool,
) -> usize {
    let Partition {
        particles: own,
        batches,
        failing,
        computed,
        ..
    } = partition;
    let mut count = 0;
    for Batch { rule, which } in batches.iter() {
        let rule = &bonds.rules[*rule];
        if !is_one(rule) {
            continue;
        }
        count += which.count();
        if let Some(criteria) = &rule.criteria {
            computed.compared += which.count();
            if criteria.is_frictional() {
                computed.frictional += which.count();
            }
        }
        let mut add = |at: usize| {
            if bonds.is_broken(at) {
                return;
            }
            let [a, b] = bonds.ends[at].map(|end| end as usize);
            let forces = bonds.forces(at, poses);
            if own.contains(&a) {
                wrenches[a - own.start].add(&-forces.force_on_b, &forces.torques[0]);
                if rule.law.flat_joint().is_some() {
                    if bonds.histories.joints[at].has_failed() {
                        failing.push(at as u32);
                    }
                } else if let Some(criteria) = &rule.criteria {
                    let stresses = stresses(&forces.load, bonds.radius_m(at));
                    let factors = Factors::scattered(bonds.strength_factor(at));
                    if utilisation(criteria, &stresses, factors) >= 1.0 {
                        failing.push(at as u32);
                    }
                }
            }
            if own.contains(&b) {
                wrenches[b - own.start].add(&forces.force_on_b, &forces.torques[1]);
            }
        };
        match which {
            BondSelection::Own(list) | BondSelection::Border(list) => {
                list.iter().for_each(|&at| add(at as usize));
            }
            BondSelection::Run(range) => range.clone().for_each(&mut add),
        }
    }
    count
}
