//! Breaks bonds that have reached their strength. Each is first checked again individually,
//! including its strain rate where strength depends on it.

use super::damage::{Loss, growth_of, is_crushed, softened};
use super::forces::{any_bond, bonds_to_come};
use crate::stages::chunks::CHUNK;
use crate::stages::stage::{Need, Saving, Stage};
use crate::state::State;
use crate::state::bonds::{BondRule, Bonds};
use crate::state::events::{Break, Events};
use crate::state::particles::Particles;
use crate::state::partitions::Partition;
use crate::state::partitions::{Idle, STALE, divide_anew};
use dem_physics::bond::failure::{Cause, Factors, cause, stresses, utilisation};
use dem_physics::bond::rate_strengthening::LargestRate;
use rayon::prelude::*;

/// ns per bond of a body of 25,547 particles: see doc/inside/leave-out.md.
const FAILURE_NS: f64 = 2.1;
const SCATTER_NS: f64 = 1.2;

/// Comparison of bonds with their strength.
pub const FAILURE: Stage = Stage {
    saving: |state| Saving::of(state.bonds.len(), 0, FAILURE_NS),
    ..Stage::new("failure", |state, _| {
        Need::of(
            state.bonds.rules.iter().any(|rule| rule.criteria.is_some()),
            || "bonds have strengths".to_owned(),
            "no bond has a strength",
        )
    })
};

/// Strengths that depend on the strain rate.
pub const RATES: Stage = Stage {
    within: Some(FAILURE.name),
    bytes: |state| size_of_val(&state.bonds.histories.largest_rates[..]),
    ..Stage::new("rate strengthening", |state, _| {
        let why = match any_bond(state, BondRule::keeps_largest_factor) {
            true => "bonds keep the largest factor",
            false => "only for bonds that would break without it",
        };
        Need::of(
            state.bonds.strengthen_with_rate(),
            || why.to_owned(),
            "no rate strengthening asked for",
        )
    })
};

/// Bonds that soften beyond their strength.
pub(crate) const DAMAGE: Stage = Stage {
    within: Some(FAILURE.name),
    bytes: |state| {
        size_of_val(&state.bonds.histories.damages[..]) + size_of_val(&state.bonds.damaged[..])
    },
    ..Stage::new("damage of bonds", |state, _| {
        Need::of(
            any_bond(state, |rule| rule.law.fracture_energy_j_m2().is_some()),
            || "bonds have a fracture energy".to_owned(),
            "no bond has a fracture energy",
        )
    })
};

/// Strengths that vary from bond to bond.
pub const SCATTER: Stage = Stage {
    within: Some(FAILURE.name),
    bytes: |state| size_of_val(&state.bonds.strength_factors[..]),
    saving: |state| Saving::of(state.bonds.len(), size_of::<f64>(), SCATTER_NS),
    ..Stage::new("strength scatter", |state, _| {
        let mut templates = state.clumps.templates.iter();
        let will_be = bonds_to_come(state) > 0 && templates.any(|t| t.scatter.is_some());
        Need::of(
            state.bonds.strengths_scatter() || will_be,
            || "a factor for each bond".to_owned(),
            "no Weibull modulus given",
        )
    })
};

/// Strengths that rise with pressure.
pub const FRICTION: Stage = Stage {
    within: Some(FAILURE.name),
    ..Stage::new("friction of bonds", |state, _| {
        Need::of(
            any_bond(state, |rule| {
                rule.criteria
                    .is_some_and(|criteria| criteria.is_frictional())
            }),
            || "bonds have a cohesion and a friction angle".to_owned(),
            "no bond has a cohesion",
        )
    })
};

/// Breaks the bonds that have reached their strength. Returns the number of bonds compared with
/// their strength.
pub(crate) fn break_failed_bonds(state: &mut State) -> usize {
    keep_largest_rates(&mut state.bonds, &state.particles);
    let compared = state
        .scratch
        .partitions
        .iter()
        .map(|partition| partition.computed.compared)
        .sum();
    let scratch = &mut state.scratch;
    // A partition lists its bonds of the total formulation before those with a history.
    let listed = scratch.partitions.iter().flat_map(|s| &s.failing);
    let mut failing: Vec<u32> = listed.chain(&scratch.crushed).copied().collect();
    failing.sort_unstable();
    failing.dedup();
    let drift_s = state.previous_time_step_s;
    let (bonds, particles) = (&mut state.bonds, &mut state.particles);
    state.ledger.damaged_j += break_bonds(bonds, particles, &failing, drift_s, &mut scratch.events);
    let broken = &scratch.events.broken;
    state.broken_count += broken.len() as u64;
    for broken in broken {
        state.broken_by_cause.count(broken.cause);
    }
    if !broken.is_empty() {
        leave_out_broken(state);
    }
    compared
}

/// Raises the largest strain rates of bonds that keep them to the present ones.
fn keep_largest_rates(bonds: &mut Bonds, particles: &Particles) {
    if bonds.histories.largest_rates.is_empty() {
        return;
    }
    let mut all = std::mem::take(&mut bonds.histories.largest_rates);
    let raise = |(chunk, rates): (usize, &mut [LargestRate])| {
        let first = chunk * CHUNK;
        let keepers = bonds
            .runs(first..first + rates.len())
            .filter(|(rule, _)| bonds.rules[*rule].keeps_largest_factor());
        for at in keepers.flat_map(|(_, run)| run) {
            if !bonds.is_broken(at) && !particles.sleeps(bonds.ends[at][0] as usize) {
                let rate_1_s = bonds.strain_rate_1_s(at, &particles.poses, &particles.motions);
                let kept = &mut rates[at - first].0;
                *kept = kept.max(rate_1_s);
            }
        }
    };
    all.par_chunks_mut(CHUNK).enumerate().for_each(raise);
    bonds.histories.largest_rates = all;
}

/// Number of bonds checked whose strength depends on the strain rate, or of all if some keep their
/// largest factor.
pub(crate) fn count_rates(state: &mut State) -> usize {
    let kept = state.bonds.histories.largest_rates.len();
    kept.max(state.scratch.events.work.rates)
}

/// Number of bonds compared with an individual strength.
pub(crate) fn count_scattered(state: &mut State) -> usize {
    if !state.bonds.strengths_scatter() {
        return 0;
    }
    state
        .scratch
        .partitions
        .iter()
        .map(|partition| partition.computed.compared)
        .sum()
}

/// Number of bonds compared with a cohesion.
pub(crate) fn count_frictional(state: &mut State) -> usize {
    let partitions = state.scratch.partitions.iter();
    partitions
        .map(|partition| partition.computed.frictional)
        .sum()
}

/// Divides the work again once enough bonds have broken since the last division.
fn leave_out_broken(state: &mut State) {
    let computed: usize = state
        .scratch
        .partitions
        .iter()
        .map(Partition::own_bonds)
        .sum();
    let broken = state.broken_count - state.broken_removed;
    let asleep = state.sleep.as_ref().map_or(0, |sleep| sleep.bonds);
    let whole = state.bonds.len() as u64 - broken - asleep - state.rigid_parts.bonds;
    if (computed as u64 - whole) * STALE >= computed as u64 {
        let idle = Idle {
            asleep: &state.particles.asleep,
            part_of: &state.rigid_parts.of_particle,
        };
        divide_anew(&state.bonds, &mut state.scratch.partitions, idle);
    }
}

/// Breaks these bonds, in their order, if they fail, or damages them if they have a fracture
/// energy. Adds breaks to the events, with the number of bonds checked whose strength depends on
/// the strain rate. Returns the energy that bonds lost by their damage, J.
///
/// A bond that breaks at its strength acts until this moment: its ends get their half of the kick,
/// after the drift of `drift_s`, and its force is subtracted from the wrenches that move them on.
/// The force of a damaged bond is that of its new damage in all of the kick.
pub(crate) fn break_bonds(
    bonds: &mut Bonds,
    particles: &mut Particles,
    failing: &[u32],
    drift_s: f64,
    events: &mut Events,
) -> f64 {
    let by_rate = |at: &&u32| {
        let rule = &bonds.rules[bonds.rule_of(**at as usize)];
        rule.strengthening.is_some()
    };
    events.work.rates = failing.iter().filter(by_rate).count();
    // All are checked before the first is removed: a break changes the velocities of its ends, and
    // strain rates depend on velocities.
    let losses: Vec<(usize, Option<[f64; 2]>, Loss)> = failing
        .iter()
        .map(|&at| (at as usize, strengthened(bonds, at as usize, particles)))
        .filter_map(|(at, by)| Some((at, by, loss(bonds, at, particles, drift_s, by)?)))
        .collect();
    let mut spent_j = 0.0;
    for (at, strengthened, loss) in losses {
        let kick_s = if loss.released_j > 0.0 {
            0.5 * drift_s
        } else {
            0.0
        };
        let ends = take_away(bonds, particles, at, &loss, kick_s);
        spent_j += loss.spent_j;
        let Some(cause) = loss.broke else {
            bonds.set_damage(at, loss.damage);
            continue;
        };
        bonds.set_broken(at);
        let [a, b] = bonds.ends[at].map(|end| particles.poses[end as usize].place());
        events.broken.push(Break {
            bond: at as u32,
            place_m: (0.5 * (a + b)).into(),
            cause,
            released_j: loss.released_j,
            strengthened,
            ends,
        });
    }
    spent_j
}

/// The strain rate that determines the strength of a bond, 1/s, and the factor on it. None: its
/// strength does not depend on the rate.
fn strengthened(bonds: &Bonds, at: usize, particles: &Particles) -> Option<[f64; 2]> {
    bonds.rules[bonds.rule_of(at)].strengthening.as_ref()?;
    let rate_1_s = bonds.strain_rate_1_s(at, &particles.poses, &particles.motions);
    let factor = bonds.dynamic_increase_factor(at, rate_1_s);
    Some([bonds.deciding_rate_1_s(at, rate_1_s), factor])
}

/// What a bond so strengthened loses in the kick after a drift of `drift_s`. None: it has not
/// reached its strength.
fn loss(
    bonds: &Bonds,
    at: usize,
    particles: &Particles,
    drift_s: f64,
    strengthened: Option<[f64; 2]>,
) -> Option<Loss> {
    let rule = &bonds.rules[bonds.rule_of(at)];
    let criteria = rule.criteria?;
    let factors = Factors {
        scatter: bonds.undamaged_strength_factor(at),
        rate: strengthened.map_or(1.0, |[_, factor]| factor),
    };
    let forces = bonds.forces(at, &particles.poses);
    let at_once = |cause: Cause| Loss {
        broke: Some(cause),
        damage: 1.0,
        force_on_b: forces.force_on_b,
        torques: forces.torques,
        released_j: forces.energy.total(),
        spent_j: 0.0,
    };
    if rule.law.flat_joint().is_some() {
        let joint = bonds.histories.joints.get(at);
        let failed = joint.filter(|joint| joint.has_failed());
        return failed.and_then(|joint| joint.last_failure).map(at_once);
    }
    if rule.law.fracture_energy_j_m2().is_some() {
        if is_crushed(bonds, at, &particles.poses) {
            return Some(at_once(Cause::Compression));
        }
        let growth = growth_of(bonds, at, particles, &criteria, factors)?;
        if growth.at_once {
            return Some(at_once(growth.cause));
        }
        return Some(softened(bonds, at, particles, &forces, growth, drift_s));
    }
    let stresses = stresses(&forces.load, bonds.radius_m(at));
    (utilisation(&criteria, &stresses, factors) >= 1.0)
        .then(|| at_once(cause(&criteria, &stresses, factors)))
}

/// Takes what a bond loses away from its ends, after so much of the kick, s. Returns the forces
/// that acted in that part of it.
fn take_away(
    bonds: &Bonds,
    particles: &mut Particles,
    at: usize,
    loss: &Loss,
    kick_s: f64,
) -> [(u32, [f64; 6]); 2] {
    let ends = bonds.ends[at].map(|end| end as usize);
    let on_ends = [-loss.force_on_b, loss.force_on_b];
    for ((end, force), torque) in ends.into_iter().zip(on_ends).zip(loss.torques) {
        particles.wrenches[end].add(&-force, &-torque);
        let motion = &mut particles.motions[end];
        let per_mass = kick_s * motion.inverse_mass;
        let per_inertia = kick_s * motion.inverse_inertia;
        for k in 0..3 {
            motion.velocity_m_s[k] += per_mass * force[k];
            motion.spin_rad_s[k] += per_inertia * torque[k];
        }
    }
    let acted = if kick_s > 0.0 { 1.0 } else { 0.0 };
    [0, 1].map(|end| {
        let [fx, fy, fz]: [f64; 3] = on_ends[end].into();
        let [tx, ty, tz]: [f64; 3] = loss.torques[end].into();
        (
            ends[end] as u32,
            [fx, fy, fz, tx, ty, tz].map(|x| acted * x),
        )
    })
}
