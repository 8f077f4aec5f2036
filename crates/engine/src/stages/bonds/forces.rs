//! Bond forces on the particles, total formulation.

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::stages::bonds::blocks::{
    BondGroup, blocks_of, coming_second_ends, fetch_soon_of, for_each_partition, separations,
};
use crate::stages::chunks::CHUNK;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::bonds::{BLOCK, BondBlock, BondRule, Bonds, bending_stiffness};
use crate::state::particles::{Pose, Wrench};
use crate::state::partitions::{Batch, BondSelection, Computed, Partition};
use dem_physics::bond::failure::Screen;
use dem_physics::bond::stiffness::Stiffness;
use dem_physics::bond::total::{BondResponse, bond_response};
use dem_physics::lanes::{LaneWork, Lanes, MOST, with_most_lanes};
use dem_physics::number::{Rotation, Vec3};

use LaneChoice::{AsManyLanes, OneLane};

/// Bond forces.
pub const BONDS: Stage = Stage {
    bytes: |state| {
        let batches = state
            .scratch
            .partitions
            .iter()
            .flat_map(|partition| &partition.batches);
        size_of_val(&state.bonds.ends[..])
            + size_of_val(&state.bonds.blocks[..])
            + batches.map(|batch| 4 * batch.which.listed()).sum::<usize>()
    },
    ..Stage::new("bond forces", |state, _| {
        let now = state.bonds.len();
        let of_clumps = bonds_of_clumps(state);
        if bonds_to_come(state) == 0 && of_clumps > 0 {
            return Need::of(now > 0, || bonds_text(now), "clumps are never replaced");
        }
        let why = || match of_clumps {
            0 => bonds_text(now),
            _ => format!("{now} bonds at the start; those of a clump, once it is replaced"),
        };
        Need::of(now + bonds_to_come(state) > 0, why, "no body has bonds")
    })
};

fn bonds_text(count: usize) -> String {
    format!("{count} bonds")
}

/// Bonds of all templates of clumps, each counted once.
fn bonds_of_clumps(state: &State) -> usize {
    state
        .clumps
        .templates
        .iter()
        .map(|template| template.bonds.len())
        .sum()
}

/// Bonds of all templates if clumps can become clusters, otherwise 0.
pub(super) fn bonds_to_come(state: &State) -> usize {
    let can_bond = !state.model.rules.triggers.iter().all(Option::is_none)
        || state.model.rules.starts.iter().any(|start| start.bonded);
    if can_bond { bonds_of_clumps(state) } else { 0 }
}

/// Whether there are bonds, or can be later, and a rule meets the condition.
pub(crate) fn any_bond(state: &State, is_so: impl Fn(&BondRule) -> bool) -> bool {
    state.bonds.len() + bonds_to_come(state) > 0 && state.bonds.rules.iter().any(is_so)
}

/// Sets the wrenches to 0 if there are no bonds. Otherwise the bond forces, which come first, set
/// them.
pub(crate) fn clear_wrenches(state: &mut State) -> usize {
    if state.bonds.is_empty() {
        let p = &mut state.particles;
        bond_wrenches(
            &state.bonds,
            &p.poses,
            &mut state.scratch.partitions,
            &mut p.wrenches,
        );
    }
    0
}

/// Sets the wrenches to the bond forces. Returns the number of bonds computed.
pub(crate) fn compute_bonds(state: &mut State) -> usize {
    if state.bonds.is_empty() {
        return 0;
    }
    let p = &mut state.particles;
    let partitions = &mut state.scratch.partitions;
    bond_wrenches(&state.bonds, &p.poses, partitions, &mut p.wrenches);
    state
        .scratch
        .partitions
        .iter()
        .map(|partition| partition.computed.total)
        .sum()
}

/// Square of the utilisation from which a bond is checked individually: less than 1, to allow for
/// rounding.
pub const NEARLY: f64 = 1.0 - 1e-9;

/// Slightly more than 1, to allow for rounding of the differences that identify weak bonds.
const ROUNDED_UP: f64 = 1.0 + 1e-14;

/// Sets the wrenches to the bond forces. `partitions` cover all particles; their `failing` lists
/// the bonds of the total formulation that have reached their strength.
pub fn bond_wrenches(
    bonds: &Bonds,
    poses: &[Pose],
    partitions: &mut [Partition],
    wrenches: &mut [Wrench],
) {
    each_partition(bonds, poses, partitions, wrenches, AsManyLanes);
}

/// The bond forces, one bond at a time.
pub fn bond_wrenches_one_by_one(
    bonds: &Bonds,
    poses: &[Pose],
    partitions: &mut [Partition],
    wrenches: &mut [Wrench],
) {
    each_partition(bonds, poses, partitions, wrenches, OneLane);
}

/// Has the work of each partition done.
fn each_partition(
    bonds: &Bonds,
    poses: &[Pose],
    partitions: &mut [Partition],
    wrenches: &mut [Wrench],
    lanes: LaneChoice,
) {
    for_each_partition(partitions, wrenches, &|partition, wrenches| {
        let work = PartitionWork {
            bonds,
            poses,
            partition,
            wrenches,
        };
        work.done(lanes);
    });
}

/// Largest ratio of change of length to initial length of the unbroken bonds.
pub fn largest_strain(bonds: &Bonds, poses: &[Pose]) -> f64 {
    most_strained(bonds, poses).map_or(0.0, |(strain, _)| strain)
}

/// Ratio of change of length to initial length of a bond.
pub(crate) fn bond_strain(bonds: &Bonds, poses: &[Pose], at: usize) -> f64 {
    let [a, b] = bonds.ends[at].map(|end| poses[end as usize].place());
    ((b - a).norm() / bonds.initial_length_m(at) - 1.0).abs()
}

/// The bond with the largest strain, and that strain. None: all bonds are broken.
pub fn most_strained(bonds: &Bonds, poses: &[Pose]) -> Option<(f64, usize)> {
    (0..bonds.len())
        .into_par_iter()
        .with_min_len(CHUNK)
        .filter(|&at| !bonds.is_broken(at))
        .map(|at| (bond_strain(bonds, poses, at), at))
        .reduce_with(|one, other| if other.0 > one.0 { other } else { one })
}

/// Largest strain at the edge of a bond, broken or not: of elongation and bending together, or of
/// shear and torsion together.
pub fn edge_strain(bonds: &Bonds, at: usize, poses: &[Pose]) -> f64 {
    let (strained, radius_m) = (bonds.deformation(at, poses), bonds.radius_m(at));
    let normal_m = strained.normal_n.abs() + radius_m * strained.bending_n_m;
    let shear_m = strained.shear_n + radius_m * strained.torsion_n_m;
    normal_m.max(shear_m) / bonds.initial_length_m(at)
}

/// The intact bond with the largest [edge](edge_strain) strain, and that strain: what a damaged
/// bond is opened by is no strain. Ten times as costly as [`most_strained`].
pub fn most_strained_edge(bonds: &Bonds, poses: &[Pose]) -> Option<(f64, usize)> {
    (0..bonds.len())
        .into_par_iter()
        .with_min_len(CHUNK)
        .filter(|&at| !bonds.is_broken(at) && !bonds.was_damaged(at))
        .map(|at| (edge_strain(bonds, at, poses), at))
        .reduce_with(|one, other| if other.0 > one.0 { other } else { one })
}

/// The intact bond that has flowed most, and its plastic strain at the edge: of elongation and
/// bending together, or of slip and twist together. None: no bond yields.
pub fn most_yielded(bonds: &Bonds) -> Option<(f64, usize)> {
    let norm = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt();
    let strain = |at: usize| {
        let (plastic, radius_m) = (&bonds.histories.plastics[at], bonds.radius_m(at));
        let normal_m = plastic.elongation_m.abs() + radius_m * norm(plastic.bend_rad);
        let shear_m = norm(plastic.slip_m) + radius_m * plastic.twist_rad.abs();
        normal_m.max(shear_m) / bonds.initial_length_m(at)
    };
    let whole = (0..bonds.histories.plastics.len()).filter(|&at| !bonds.is_broken(at));
    let strains = whole.map(|at| (strain(at), at));
    strains.reduce(|one, other| if other.0 > one.0 { other } else { one })
}

struct PartitionWork<'a> {
    bonds: &'a Bonds,
    poses: &'a [Pose],
    partition: &'a mut Partition,
    /// Wrenches of the particles of the partition.
    wrenches: &'a mut [Wrench],
}

/// How many bonds are computed at once. The results are the same bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LaneChoice {
    AsManyLanes,
    OneLane,
}

/// One batch of a partition's work: compiled for itself, so that each kind has its own stack frame.
struct BatchWork<'w, 'a, const FRICTIONAL: bool>(&'w mut PartitionWork<'a>, &'w Batch);

impl<const FRICTIONAL: bool> LaneWork for BatchWork<'_, '_, FRICTIONAL> {
    #[inline(always)]
    fn with<T: Lanes>(self, proof: T::Proof) {
        self.0.of_batch::<T, FRICTIONAL>(proof, self.1);
    }
}

impl PartitionWork<'_> {
    fn done(mut self, lanes: LaneChoice) {
        self.partition.computed = Computed::default();
        self.partition.failing.clear();
        for awake in &self.partition.awake {
            self.wrenches[awake.clone()].fill(Wrench::default());
        }
        let batches = std::mem::take(&mut self.partition.batches);
        for batch in &batches {
            let rule = &self.bonds.rules[batch.rule];
            let frictional = rule
                .criteria
                .is_some_and(|criteria| criteria.is_frictional());
            match (rule.law.is_single(), frictional) {
                (true, _) => {}
                (false, false) => self.batch::<false>(batch, lanes),
                (false, true) => self.batch::<true>(batch, lanes),
            }
        }
        self.partition.batches = batches;
    }

    fn batch<const FRICTIONAL: bool>(&mut self, batch: &Batch, lanes: LaneChoice) {
        let work = BatchWork::<FRICTIONAL>(self, batch);
        match lanes {
            AsManyLanes => with_most_lanes(work),
            OneLane => work.with::<f64>(()),
        }
    }

    /// Forces of the bonds of a batch, by the total formulation. `FRICTIONAL`: their strength is
    /// that of Mohr and Coulomb.
    #[inline(always)]
    fn of_batch<T: Lanes, const FRICTIONAL: bool>(
        &mut self,
        proof: T::Proof,
        Batch { rule, which }: &Batch,
    ) {
        let bonds = self.bonds;
        let kind = Kind::of(bonds, *rule);
        let computed = &mut self.partition.computed;
        computed.total += which.count();
        computed.compared += if kind.screen.is_some() {
            which.count()
        } else {
            0
        };
        if FRICTIONAL {
            computed.frictional += which.count();
        }
        match which {
            BondSelection::Run(range) => {
                for block in blocks_of(range) {
                    self.fetch_coming(block);
                    let eight = BondGroup::of_block(bonds, block, range);
                    let numbers = &bonds.blocks[block];
                    self.of_eight::<T, FRICTIONAL>(proof, &kind, &eight, numbers, true);
                }
            }
            BondSelection::Own(list) | BondSelection::Border(list) => {
                let own = matches!(which, BondSelection::Own(_));
                for some in list.chunks(BLOCK) {
                    let eight = BondGroup::of_list(bonds, some);
                    let numbers = &BondBlock::of(bonds, eight.numbers);
                    self.of_eight::<T, FRICTIONAL>(proof, &kind, &eight, numbers, own);
                }
            }
        }
    }

    /// Prefetches what the bonds that follow a block soon need.
    #[inline(always)]
    fn fetch_coming(&self, block: usize) {
        let start = self.partition.particles.start;
        for b in coming_second_ends(self.bonds, block) {
            fetch_soon_of(self.poses, b);
            fetch_soon_of(self.wrenches, b.wrapping_sub(start));
        }
    }

    /// Eight bonds, whose first ends are in the partition if they are its `own`.
    #[inline(always)]
    fn of_eight<T: Lanes, const FRICTIONAL: bool>(
        &mut self,
        proof: T::Proof,
        kind: &Kind,
        eight: &BondGroup,
        numbers: &BondBlock,
        own: bool,
    ) {
        let Partition {
            particles, failing, ..
        } = &mut *self.partition;
        for first in (0..BLOCK).step_by(T::COUNT) {
            if !eight.any_wanted::<T>(first) {
                continue;
            }
            let found = kind.forces::<T, FRICTIONAL>(proof, eight, numbers, first, self.poses);
            eight.add(
                first,
                found.force_on_b,
                found.torques,
                self.wrenches,
                particles.start,
            );
            if own && (found.any_beyond || !self.bonds.strength_factors.is_empty()) {
                let beyond = &found.beyond[..T::COUNT];
                list_failing(self.bonds, eight, numbers, first, beyond, failing);
            }
        }
    }
}

/// Forces of bonds on their ends, and how far the bonds exceed their strength: lane by lane.
struct Found<T> {
    force_on_b: Vec3<T>,
    torques: [Vec3<T>; 2],
    /// Square of the utilisation minus [`NEARLY`], times (pi r^3)^2; below 0 if the bond cannot
    /// break.
    beyond: [f64; MOST],
    /// Whether any of these is not below 0.
    any_beyond: bool,
}

/// Properties that the bonds of a rule share.
pub(super) struct Kind {
    torsion_per_bending: f64,
    bending_per_normal: f64,
    pub(super) screen: Option<Screen>,
}

impl Kind {
    pub(super) fn of(bonds: &Bonds, rule: usize) -> Self {
        Self {
            torsion_per_bending: bonds.torsion_per_bending[rule],
            bending_per_normal: bonds.bending_per_normal[rule],
            screen: bonds.rules[rule].criteria.as_ref().map(Screen::new),
        }
    }

    /// Forces of the bonds from `first` on, one for each lane, by the total formulation.
    #[inline(always)]
    pub(super) fn response<T: Lanes>(
        &self,
        proof: T::Proof,
        eight: &BondGroup,
        numbers: &BondBlock,
        first: usize,
        poses: &[Pose],
    ) -> BondResponse<T> {
        let ends = &eight.ends[first..first + T::COUNT];
        let apart = separations(proof, ends, poses);
        let normal = T::load(proof, &numbers.normal, first);
        let radius_m = T::load(proof, &numbers.radii_m, first);
        let bending = bending_stiffness(normal, radius_m, self.bending_per_normal);
        let stiffness = Stiffness {
            normal,
            shear: T::load(proof, &numbers.shear, first),
            torsion: bending.scale(self.torsion_per_bending),
            bending,
            levers_m: [
                T::load(proof, &numbers.levers_m[0], first),
                T::load(proof, &numbers.levers_m[1], first),
            ],
        };
        let direction = Vec3(
            T::load(proof, &numbers.direction[0], first),
            T::load(proof, &numbers.direction[1], first),
            T::load(proof, &numbers.direction[2], first),
        );
        let turned = [
            turns(proof, |lane| poses[ends[lane][0] as usize].turned),
            turns(proof, |lane| poses[ends[lane][1] as usize].turned),
        ];
        bond_response(&stiffness, direction, apart, turned)
    }

    /// The response of eight bonds, and how far they exceed their strength.
    #[inline(always)]
    fn forces<T: Lanes, const FRICTIONAL: bool>(
        &self,
        proof: T::Proof,
        eight: &BondGroup,
        numbers: &BondBlock,
        first: usize,
        poses: &[Pose],
    ) -> Found<T> {
        let response = self.response(proof, eight, numbers, first, poses);
        let (mut beyond, mut any_beyond) = ([-1.0; MOST], false);
        if let Some(screen) = &self.screen {
            let radius_m = T::load(proof, &numbers.radii_m, first);
            let [used, factor] =
                screen.utilisation_and_factor::<T, FRICTIONAL>(&response.load, radius_m);
            let excess = used - factor.scale(NEARLY);
            any_beyond = excess.zero().above(excess) != 0xff >> (MOST - T::COUNT);
            beyond = excess.values();
        }
        Found {
            force_on_b: response.force_on_b,
            torques: response.torques,
            beyond,
            any_beyond,
        }
    }
}

/// Rotations from quaternions x, y, z, w.
#[inline(always)]
fn turns<T: Lanes>(proof: T::Proof, rows: impl Fn(usize) -> [f64; 4]) -> Rotation<T> {
    let [x, y, z, w] = T::columns(proof, rows);
    Rotation(Vec3(x, y, z), w)
}

/// Lists the bonds that have reached their strength, before any rate strengthening, and perhaps
/// some that nearly have.
#[inline(always)]
fn list_failing(
    bonds: &Bonds,
    eight: &BondGroup,
    numbers: &BondBlock,
    first: usize,
    beyond: &[f64],
    failing: &mut Vec<u32>,
) {
    for (i, beyond) in (first..).zip(beyond) {
        let at = eight.numbers[i];
        let strengthened = bonds.strength_factors.get(at).map_or(0.0, |factor| {
            let volume = PI * numbers.radii_m[i].powi(3);
            NEARLY * volume * volume * (factor * factor - ROUNDED_UP)
        });
        if *beyond >= strengthened && eight.wanted.contains(&i) {
            failing.push(at as u32);
        }
    }
}
