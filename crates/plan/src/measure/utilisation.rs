//! Loads of single bonds, and how near they are to failure.

use std::ops::Range;

use rayon::prelude::*;

use dem_engine::stages::bonds::forces::NEARLY;
use dem_engine::stages::bonds::utilisation_kernel::squared_utilisations;
use dem_engine::stages::chunks::CHUNK;
use dem_engine::stages::ledger::totals::motions_before_kick;
use dem_engine::state::State;
use dem_engine::state::particles::Motion;
use dem_physics::bond::BondLoad;
use dem_physics::bond::damage::utilisation_of_damaged;
use dem_physics::bond::failure::{Factors, stresses, utilisation};

/// Strain rate of a bond, and the utilisation of the strength that it has at that rate. Both are
/// those of the failure check: an intact bond that can break has a utilisation below 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DynamicUtilisation {
    /// By the `strain_rate_measure` of the bond, 1/s.
    pub strain_rate_1_s: f64,
    /// Ratio of dynamic to static strength, 1 or more (Platzer 2022, eq. 20).
    pub increase_factor: f64,
    /// Largest ratio of stress to dynamic strength; 0 if the bond cannot break.
    pub utilisation: f64,
}

impl DynamicUtilisation {
    /// Of a broken bond.
    pub const BROKEN: Self = Self {
        strain_rate_1_s: 0.0,
        increase_factor: 1.0,
        utilisation: 0.0,
    };

    /// Of a bond under this load, with the motions of all particles before the kick.
    pub(crate) fn under(state: &State, at: usize, load: &BondLoad, motions: &[Motion]) -> Self {
        let bonds = &state.bonds;
        if bonds.is_broken(at) {
            return Self::BROKEN;
        }
        let strain_rate_1_s = bonds.strain_rate_1_s(at, &state.particles.poses, motions);
        let increase_factor = bonds.dynamic_increase_factor(at, strain_rate_1_s);
        Self {
            strain_rate_1_s,
            increase_factor,
            utilisation: utilisation_at(state, at, load, increase_factor),
        }
    }
}

/// Strain rates and dynamic utilisations of all bonds, as the failure check of this step has found
/// them, between a kick and the drift after it. None: the bond is broken.
pub fn dynamic_utilisations(state: &State) -> Vec<Option<DynamicUtilisation>> {
    let motions = motions_before_kick(state);
    let of_bond = |at: usize| {
        let load = load(state, at);
        DynamicUtilisation::under(state, at, &load, &motions)
    };
    let is_intact = |at: usize| !state.bonds.is_broken(at);
    let all = 0..state.bonds.len();
    all.map(|at| is_intact(at).then(|| of_bond(at))).collect()
}

/// Load of a bond: zero if it is broken.
pub fn load(state: &State, at: usize) -> BondLoad {
    if state.bonds.is_broken(at) {
        return BondLoad::default();
    }
    state.bonds.forces(at, &state.particles.poses).load
}

/// Ratio of stress to strength of a bond, before any rate strengthening; 0 if it is broken or
/// cannot break.
pub fn bond_utilisation(state: &State, at: usize) -> f64 {
    utilisation_under(state, at, &load(state, at))
}

/// Largest [utilisation](bond_utilisation) of the bonds with an end among these particles. Those
/// below 1e-150 count as 0.
pub(super) fn largest_utilisation(state: &State, is_in: &[bool]) -> f64 {
    let all = state.bonds.len();
    let chunks = (0..all.div_ceil(CHUNK)).into_par_iter();
    let of_chunk = |chunk: usize| {
        let range = chunk * CHUNK..all.min((chunk + 1) * CHUNK);
        let runs = state.bonds.runs(range);
        runs.map(|(rule, run)| largest_of_rule(state, is_in, rule, run))
            .fold(0.0, f64::max)
    };
    chunks.map(of_chunk).reduce(|| 0.0, f64::max)
}

/// The same of at most [`CHUNK`] bonds of a rule: their squares tell which of them are to be
/// evaluated.
fn largest_of_rule(state: &State, is_in: &[bool], rule: usize, run: Range<usize>) -> f64 {
    let bonds = &state.bonds;
    let is_counted = |at: usize| bonds.ends[at].iter().any(|&end| is_in[end as usize]);
    let mut squares = [f64::INFINITY; CHUNK];
    let squares = &mut squares[..run.len()];
    if !bonds.rules[rule].law.is_single() {
        squared_utilisations(bonds, &state.particles.poses, rule, run.clone(), squares);
    }
    let mut most = 0.0_f64;
    for (at, square) in run.clone().zip(&mut *squares) {
        if !is_counted(at) {
            *square = 0.0;
        } else if bonds.was_damaged(at) {
            *square = f64::INFINITY;
        } else {
            *square /= bonds.strength_factor(at).powi(2);
            most = most.max(*square);
        }
    }
    run.zip(squares)
        .filter(|(_, square)| **square > 0.0 && **square >= NEARLY * most)
        .map(|(at, _)| bond_utilisation(state, at))
        .fold(0.0, f64::max)
}

/// Utilisation of a bond under a given load.
pub fn utilisation_under(state: &State, at: usize, load: &BondLoad) -> f64 {
    utilisation_at(state, at, load, 1.0)
}

/// As [`utilisation_under`], with this factor on the strengths that rise with the strain rate.
fn utilisation_at(state: &State, at: usize, load: &BondLoad, rate: f64) -> f64 {
    let bonds = &state.bonds;
    if bonds.rules[bonds.rule_of(at)].law.flat_joint().is_some() && !bonds.is_broken(at) {
        return bonds.element_utilisation(at, &state.particles.poses);
    }
    match &bonds.rules[bonds.rule_of(at)].criteria {
        Some(criteria) if !bonds.is_broken(at) => {
            let now = stresses(load, bonds.radius_m(at));
            let scatter = bonds.undamaged_strength_factor(at);
            let factors = Factors { scatter, rate };
            if !bonds.was_damaged(at) {
                return utilisation(criteria, &now, factors);
            }
            let ends = bonds.ends[at].map(|end| state.particles.poses[end as usize].end());
            let intact = bonds.forces_if_damaged(at, &ends, 0.0).load;
            let intact = stresses(&intact, bonds.radius_m(at));
            let ratios = bonds.opening_ratios(at);
            utilisation_of_damaged(
                criteria,
                [&intact, &now],
                factors,
                &ratios,
                bonds.damage(at),
            )
        }
        _ => 0.0,
    }
}
