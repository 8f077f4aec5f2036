//! Division of particles and bonds among threads.
//!
//! A partition is a range of particles. It computes every bond that has an end in its range, in the
//! order of the bonds; bonds across the border of two partitions are computed by both. Broken
//! bonds, bonds of sleeping bodies and bonds within rigid parts belong to no partition. So no two
//! threads write to the same place, and the order of every sum is the same for any number of
//! partitions.

use std::ops::Range;

use super::bonds::Bonds;
use super::rigid_parts::{FREE, is_within_part};

/// Work is divided again when one in this many of the computed bonds is broken.
pub(crate) const STALE: u64 = 64;

/// What is not computed.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Idle<'a> {
    /// For each particle whether it sleeps. Empty: none does.
    pub(crate) asleep: &'a [bool],
    /// For each particle the number of its rigid part: see
    /// [`super::rigid_parts::RigidParts::of_particle`].
    pub(crate) part_of: &'a [u32],
}

impl Idle<'_> {
    fn sleeps(&self, i: usize) -> bool {
        self.asleep.get(i).is_some_and(|asleep| *asleep)
    }

    /// Whether a bond is skipped: it is broken, its body sleeps, or both ends are in one rigid
    /// part.
    fn leaves_out(&self, bonds: &Bonds, at: usize) -> bool {
        let ends = bonds.ends[at];
        bonds.is_broken(at) || self.sleeps(ends[0] as usize) || is_within_part(self.part_of, ends)
    }
}

/// Bonds of one rule that a partition computes.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// Number in [`Bonds::rules`].
    pub rule: usize,
    /// The bonds.
    pub which: BondSelection,
}

/// Selection of the bonds of a batch.
#[derive(Debug, Clone, PartialEq)]
pub enum BondSelection {
    /// Consecutive bonds, none of them broken; their first ends are in the partition.
    Run(Range<usize>),
    /// Listed bonds; their first ends are in the partition.
    Own(Vec<u32>),
    /// Listed bonds; only their second ends are in the partition.
    Border(Vec<u32>),
}

/// The work of one thread at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Partition {
    /// Its particles.
    pub particles: Range<usize>,
    /// Those of them that are awake: as numbers within the partition.
    pub awake: Vec<Range<usize>>,
    /// Its bonds, border bonds first, so that each particle gets its bonds in their order.
    pub batches: Vec<Batch>,
    /// Its own bonds that have reached their strength in this step, in order.
    pub failing: Vec<u32>,
    /// Number of bonds that it has computed in this step.
    pub computed: Computed,
}

/// Number of bonds that a partition has computed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Computed {
    /// Forces, by the total formulation.
    pub total: usize,
    /// Comparisons with the strength.
    pub compared: usize,
    /// Those of them with a cohesion.
    pub frictional: usize,
    /// Damping forces.
    pub damped: usize,
}

impl BondSelection {
    /// Number of bonds that are listed individually.
    pub fn listed(&self) -> usize {
        match self {
            Self::Run(_) => 0,
            Self::Own(list) | Self::Border(list) => list.len(),
        }
    }

    /// Number of bonds; border bonds are counted by the partition that owns them.
    pub fn count(&self) -> usize {
        match self {
            Self::Run(range) => range.len(),
            Self::Own(list) => list.len(),
            Self::Border(_) => 0,
        }
    }
}

impl Partition {
    /// Number of bonds whose first end is in the partition, as computed.
    pub fn own_bonds(&self) -> usize {
        self.batches.iter().map(|batch| batch.which.count()).sum()
    }
}

/// Divides particles and bonds into `count` partitions with about the same number of bonds each;
/// fewer if there are not enough particles.
pub fn divide(bonds: &Bonds, particles: usize, count: usize) -> Vec<Partition> {
    divide_busy(bonds, particles, count, Idle::default())
}

/// Number of the particles and bonds that are not idle.
pub(crate) fn count_busy(bonds: &Bonds, particles: usize, idle: Idle<'_>) -> usize {
    let awake = (0..particles).filter(|&i| !idle.sleeps(i)).count();
    let computed = (0..bonds.len()).filter(|&at| !idle.leaves_out(bonds, at));
    awake + computed.count()
}

/// Divides the particles and bonds that are not idle.
pub(crate) fn divide_busy(
    bonds: &Bonds,
    particles: usize,
    count: usize,
    idle: Idle<'_>,
) -> Vec<Partition> {
    let first_bond = first_bonds(bonds, particles);
    // A particle costs about a third of a bond.
    let mut done = 0;
    let mut work = vec![0];
    for i in 0..particles {
        if idle.part_of.get(i).is_some_and(|part| *part != FREE) {
            done += 1;
        } else if !idle.sleeps(i) {
            done += 3 * (first_bond[i + 1] - first_bond[i]) + 1;
        }
        work.push(done);
    }
    let between = (1..count).map(|k| {
        let wanted = done * k / count;
        work.partition_point(|before| *before < wanted)
    });
    let mut starts: Vec<usize> = [0].into_iter().chain(between).chain([particles]).collect();
    starts.dedup();
    let mut partitions: Vec<Partition> = starts
        .windows(2)
        .map(|w| Partition {
            particles: w[0]..w[1],
            awake: awake_ranges(w[0]..w[1], idle),
            batches: Vec::new(),
            failing: Vec::new(),
            computed: Computed::default(),
        })
        .collect();
    add_batches(bonds, &mut partitions, &first_bond, idle);
    partitions
}

/// The awake particles of a partition, as numbers within it.
fn awake_ranges(particles: Range<usize>, idle: Idle<'_>) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for i in particles.clone().filter(|&i| !idle.sleeps(i)) {
        let at = i - particles.start;
        match ranges.last_mut() {
            Some(last) if last.end == at => last.end += 1,
            _ => ranges.push(at..at + 1),
        }
    }
    ranges
}

/// Reassigns the bonds to the partitions, without those that have broken since and idle ones.
pub(crate) fn divide_anew(bonds: &Bonds, partitions: &mut [Partition], idle: Idle<'_>) {
    let particles = partitions
        .last()
        .map_or(0, |partition| partition.particles.end);
    let first_bond = first_bonds(bonds, particles);
    for partition in partitions.iter_mut() {
        partition.batches.clear();
    }
    add_batches(bonds, partitions, &first_bond, idle);
}

/// For each particle the first of the bonds whose first end it is, followed by the number of bonds.
/// Length particles + 1.
pub(crate) fn first_bonds(bonds: &Bonds, particles: usize) -> Vec<usize> {
    let mut first_bond = vec![0_usize; particles + 1];
    for &[a, _] in &bonds.ends {
        first_bond[a as usize + 1] += 1;
    }
    for p in 0..particles {
        first_bond[p + 1] += first_bond[p];
    }
    first_bond
}

fn add_batches(bonds: &Bonds, partitions: &mut [Partition], first_bond: &[usize], idle: Idle<'_>) {
    add_borders(bonds, partitions, idle);
    for partition in partitions {
        let own = first_bond[partition.particles.start]..first_bond[partition.particles.end];
        for (rule, range) in bonds.runs(own) {
            let whole: Vec<u32> = range
                .clone()
                .filter(|&at| !idle.leaves_out(bonds, at))
                .map(|at| at as u32)
                .collect();
            if whole.is_empty() {
                continue;
            }
            let which = if whole.len() == range.len() {
                BondSelection::Run(range)
            } else {
                BondSelection::Own(whole)
            };
            partition.batches.push(Batch { rule, which });
        }
    }
}

/// Assigns each bond whose ends lie in two partitions to the partition of its second end as well.
fn add_borders(bonds: &Bonds, partitions: &mut [Partition], idle: Idle<'_>) {
    let mut of_first = 0;
    for (at, &[a, b]) in bonds.ends.iter().enumerate() {
        while partitions[of_first].particles.end <= a as usize {
            of_first += 1;
        }
        if (b as usize) < partitions[of_first].particles.end || idle.leaves_out(bonds, at) {
            continue;
        }
        let of_second = partitions.partition_point(|s| s.particles.end <= b as usize);
        let rule = bonds.rule_of(at);
        let batches = &mut partitions[of_second].batches;
        match batches.last_mut() {
            Some(Batch {
                rule: last,
                which: BondSelection::Border(list),
            }) if *last == rule => list.push(at as u32),
            _ => batches.push(Batch {
                rule,
                which: BondSelection::Border(vec![at as u32]),
            }),
        }
    }
}
