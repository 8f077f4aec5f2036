//! Which particles and bonds each thread works on.
//!
//! A partition is a range of particles. It computes every bond that has an end in its range, in the
//! order of the bonds; bonds across the border of two partitions are computed by both. Bonds that
//! are broken or of bodies that sleep belong to none. So no two threads write to the same place,
//! and every sum keeps its order for any number of partitions.

use std::ops::Range;

use super::bonds::Bonds;

/// Bonds of one rule that a partition computes.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// Which of [`Bonds::rules`] they follow.
    pub rule: usize,
    /// Which they are.
    pub which: BondSelection,
}

/// Which bonds a batch holds.
#[derive(Debug, Clone, PartialEq)]
pub enum BondSelection {
    /// One after another, none of them broken; their first ends are in the partition.
    Run(Range<usize>),
    /// These; their first ends are in the partition.
    Own(Vec<u32>),
    /// These; only their second ends are in the partition.
    Border(Vec<u32>),
}

/// What one thread works on at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Partition {
    /// Its particles.
    pub particles: Range<usize>,
    /// Those of them that do not sleep: as numbers within the partition.
    pub awake: Vec<Range<usize>>,
    /// Its bonds: those of the border first, so that each particle meets its bonds in their order.
    pub batches: Vec<Batch>,
    /// Bonds of its own that have reached their strength in this step, in order.
    pub failing: Vec<u32>,
    /// How many bonds it has computed in this step.
    pub computed: Computed,
}

/// How many bonds a partition has computed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Computed {
    /// Forces, by the total formulation.
    pub total: usize,
    /// Forces, by the incremental one.
    pub incremental: usize,
    /// Compared with their strength.
    pub compared: usize,
    /// Damping forces.
    pub damped: usize,
}

impl BondSelection {
    /// How many of them are listed one by one.
    pub fn listed(&self) -> usize {
        match self {
            Self::Run(_) => 0,
            Self::Own(list) | Self::Border(list) => list.len(),
        }
    }

    /// Number of bonds; those of a border are counted by the partition whose own they are.
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
/// fewer where there are not enough particles.
pub fn divide(bonds: &Bonds, particles: usize, count: usize) -> Vec<Partition> {
    divide_awake(bonds, particles, count, &[])
}

/// Divides those particles and bonds that are not `asleep` (one for each particle; empty: none is).
pub fn divide_awake(
    bonds: &Bonds,
    particles: usize,
    count: usize,
    asleep: &[bool],
) -> Vec<Partition> {
    let first_bond = first_bonds(bonds, particles);
    // A particle costs about a third of a bond.
    let mut done = 0;
    let mut work = vec![0];
    for i in 0..particles {
        if !sleeps(asleep, i) {
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
            awake: awake_ranges(w[0]..w[1], asleep),
            batches: Vec::new(),
            failing: Vec::new(),
            computed: Computed::default(),
        })
        .collect();
    add_batches(bonds, &mut partitions, &first_bond, asleep);
    partitions
}

fn sleeps(asleep: &[bool], i: usize) -> bool {
    asleep.get(i).is_some_and(|asleep| *asleep)
}

/// The particles of a partition that do not sleep, as numbers within it.
fn awake_ranges(particles: Range<usize>, asleep: &[bool]) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for i in particles.clone().filter(|&i| !sleeps(asleep, i)) {
        let at = i - particles.start;
        match ranges.last_mut() {
            Some(last) if last.end == at => last.end += 1,
            _ => ranges.push(at..at + 1),
        }
    }
    ranges
}

/// Gives the partitions their bonds once more, without those that have broken since and those of
/// bodies that sleep.
pub fn divide_anew(bonds: &Bonds, partitions: &mut [Partition], asleep: &[bool]) {
    let particles = partitions
        .last()
        .map_or(0, |partition| partition.particles.end);
    let first_bond = first_bonds(bonds, particles);
    for partition in partitions.iter_mut() {
        partition.batches.clear();
    }
    add_batches(bonds, partitions, &first_bond, asleep);
}

/// For each particle the first of the bonds that it is the first end of; and at the end the number
/// of bonds. Length particles + 1.
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

fn add_batches(bonds: &Bonds, partitions: &mut [Partition], first_bond: &[usize], asleep: &[bool]) {
    add_borders(bonds, partitions, asleep);
    for partition in partitions {
        let own = first_bond[partition.particles.start]..first_bond[partition.particles.end];
        for (rule, range) in bonds.runs(own) {
            let whole: Vec<u32> = range
                .clone()
                .filter(|&at| !is_left_out(bonds, at, asleep))
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

/// Whether nobody computes a bond: it is broken, or its body sleeps.
fn is_left_out(bonds: &Bonds, at: usize, asleep: &[bool]) -> bool {
    bonds.is_broken(at) || sleeps(asleep, bonds.ends[at][0] as usize)
}

/// Gives each bond whose ends lie in two partitions to the partition of its second end as well.
fn add_borders(bonds: &Bonds, partitions: &mut [Partition], asleep: &[bool]) {
    let mut of_first = 0;
    for (at, &[a, b]) in bonds.ends.iter().enumerate() {
        while partitions[of_first].particles.end <= a as usize {
            of_first += 1;
        }
        if (b as usize) < partitions[of_first].particles.end || is_left_out(bonds, at, asleep) {
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
