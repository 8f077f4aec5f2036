//! Loads of single bonds, and how near they are to failure.

use std::ops::Range;

use dem_scene::{ALL, Scene};

use rayon::prelude::*;

use super::Probe;
use super::measurement::{Measurement, Settles};
use super::view::View;
use dem_engine::stages::bonds::NEARLY;
use dem_engine::stages::chunks::CHUNK;
use dem_engine::stages::totals::motions_before_kick;
use dem_engine::stages::utilisation::squared_utilisations;
use dem_engine::state::State;
use dem_engine::state::particles::Motion;
use dem_physics::bond::BondLoad;
use dem_physics::bond::damage::utilisation_of_damaged;
use dem_physics::bond::failure::{Factors, stresses, utilisation};

pub(super) const MEASUREMENTS: &[Measurement] = &[
    Measurement {
        settles: Settles::IfHeld,
        ..Measurement::new("elastic_energy", elastic_j)
    },
    Measurement {
        refusal: |measure, planned| {
            let (of, scene) = (&measure.of, planned.scene);
            let is_group = of != ALL && !scene.bodies.contains_key(of);
            (is_group && loses_bonds(scene)).then(|| {
                (
                    format!(
                        "\"{of}\" is a group, which forgets particles that leave or become rigid, and their broken bonds"
                    ),
                    "name a body in \"of\", or all",
                )
            })
        },
        ..Measurement::new("broken_bonds", broken_bonds)
    },
    Measurement {
        settles: Settles::IfHeld,
        ..Measurement::new("largest_utilisation", |probe, view| {
            largest_utilisation(view.state, &probe.members.marked(view.state))
        })
    },
    Measurement {
        missing: |probe| Some(no_intact_bond(probe)),
        ..Measurement::new("largest_strain_rate", |probe, view| {
            largest(probe, view, f64::NAN, |bond| bond.strain_rate_1_s)
        })
    },
    Measurement::new("largest_dynamic_increase_factor", |probe, view| {
        largest(probe, view, 1.0, |bond| bond.increase_factor)
    }),
    Measurement::new("largest_dynamic_utilisation", |probe, view| {
        largest(probe, view, 0.0, |bond| bond.utilisation)
    }),
    Measurement {
        missing: |probe| Some(no_intact_bond(probe)),
        ..Measurement::new("fraction_below_dynamic_utilisation", |probe, view| {
            let limit = probe.measure.limit.unwrap_or(f64::NAN);
            let [below, all] = over_intact(probe, view, [0.0, 0.0], |[below, all], bond| {
                let is_below = u8::from(bond.utilisation < limit);
                [below + f64::from(is_below), all + 1.0]
            });
            below / all
        })
    },
];

fn no_intact_bond(probe: &Probe) -> String {
    format!("\"{}\" has no intact bond", probe.measure.of)
}

/// Whether bonds of this scene are removed while it runs.
fn loses_bonds(scene: &Scene) -> bool {
    let mut rules = scene.replacement.values();
    !scene.outlets.is_empty() || rules.any(|rule| rule.restore.is_some())
}

/// Elastic energy of the bonds, J.
fn elastic_j(probe: &Probe, view: &View<'_>) -> f64 {
    if probe.members.are_all {
        return view.balance.elastic_j();
    }
    let (bonds, poses) = (&view.state.bonds, &view.state.particles.poses);
    over_bonds(probe, view.state, 0.0, |sum, at, ends_in| {
        if bonds.is_broken(at) {
            return sum;
        }
        sum + 0.5 * ends_in * bonds.forces(at, poses).energy.total()
    })
}

/// Broken bonds since the start, those of what has left included.
fn broken_bonds(probe: &Probe, view: &View<'_>) -> f64 {
    let state = view.state;
    if probe.members.name == ALL {
        return state.broken_count as f64;
    }
    let mut bodies = state.model.bodies.iter();
    let body = bodies.position(|body| body.name == probe.members.name);
    let gone = body.and_then(|body| state.population.broken_gone.get(body));
    let gone = gone.copied().unwrap_or(0) as f64;
    over_bonds(probe, state, gone, |sum, at, _| {
        sum + f64::from(u8::from(state.bonds.is_broken(at)))
    })
}

/// Folds over the bonds that have an end in the set, with the number of ends in it.
fn over_bonds<T>(probe: &Probe, state: &State, start: T, next: impl Fn(T, usize, f64) -> T) -> T {
    let is_in = probe.members.marked(state);
    let mut value = start;
    for (at, ends) in state.bonds.ends.iter().enumerate() {
        let ends_in = ends.iter().filter(|&&end| is_in[end as usize]).count();
        if ends_in > 0 {
            value = next(value, at, ends_in as f64);
        }
    }
    value
}

/// Folds over the intact bonds that have an end in the set.
fn over_intact<T>(
    probe: &Probe,
    view: &View<'_>,
    start: T,
    next: impl Fn(T, &DynamicUtilisation) -> T,
) -> T {
    let bonds = view.bonds();
    over_bonds(probe, view.state, start, |value, at, _| match &bonds[at] {
        Some(bond) => next(value, bond),
        None => value,
    })
}

/// The largest value of the intact bonds that have an end in the set, and at least `least`.
fn largest(probe: &Probe, view: &View<'_>, least: f64, of: fn(&DynamicUtilisation) -> f64) -> f64 {
    over_intact(probe, view, least, |largest, bond| largest.max(of(bond)))
}

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
fn largest_utilisation(state: &State, is_in: &[bool]) -> f64 {
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
    if !bonds.rules[rule].is_single() {
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

/// The same with this factor on the strengths that rise with the strain rate.
fn utilisation_at(state: &State, at: usize, load: &BondLoad, rate: f64) -> f64 {
    let bonds = &state.bonds;
    if bonds.rules[bonds.rule_of(at)].flat_joint.is_some() && !bonds.is_broken(at) {
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
