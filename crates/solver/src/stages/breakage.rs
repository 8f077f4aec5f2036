//! Breaks bonds that have reached their strength. Each is first checked again individually,
//! including its strain rate where strength depends on it.

use super::bonds::{any_bond, bonds_to_come};
use super::stage::{NO_SAVING, Need, Saving, Stage};
use crate::physics::bond::failure::{Cause, Factors, cause, stresses, utilisation};
use crate::physics::bond::total::BondForces;
use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::events::Break;
use crate::state::particles::Particles;
use crate::state::partitions::Partition;
use crate::state::partitions::divide_anew;

/// ns per bond of a body of 25,547 particles: see doc/leave-out.md.
const FAILURE_NS: f64 = 2.1;
const SCATTER_NS: f64 = 1.2;
/// Work is divided again when one in this many of the computed bonds is broken.
const STALE: u64 = 64;

/// Comparison of bonds with their strength.
pub const FAILURE: Stage = Stage {
    name: "failure",
    within: None,
    need: |state, _| {
        Need::of(
            state.bonds.rules.iter().any(|rule| rule.criteria.is_some()),
            || "bonds have strengths".to_owned(),
            "no bond has a strength",
        )
    },
    bytes: |_| 0,
    saving: |state| Saving::of(state.bonds.len(), 0, FAILURE_NS),
};

/// Strengths that depend on the strain rate.
pub const RATES: Stage = Stage {
    name: "rate strengthening",
    within: Some(FAILURE.name),
    need: |state, _| {
        Need::of(
            state.bonds.strengthen_with_rate(),
            || "only for bonds that would break without it".to_owned(),
            "no rate strengthening asked for",
        )
    },
    bytes: |_| 0,
    saving: NO_SAVING,
};

/// Strengths that vary from bond to bond.
pub const SCATTER: Stage = Stage {
    name: "strength scatter",
    within: Some(FAILURE.name),
    need: |state, _| {
        let mut templates = state.clumps.templates.iter();
        let will_be = bonds_to_come(state) > 0 && templates.any(|t| t.scatter.is_some());
        Need::of(
            !state.bonds.strength_factors.is_empty() || will_be,
            || "a factor for each bond".to_owned(),
            "no Weibull modulus given",
        )
    },
    bytes: |state| size_of_val(&state.bonds.strength_factors[..]),
    saving: |state| Saving::of(state.bonds.len(), size_of::<f64>(), SCATTER_NS),
};

/// Strengths that rise with pressure.
pub const FRICTION: Stage = Stage {
    name: "friction of bonds",
    within: Some(FAILURE.name),
    need: |state, _| {
        Need::of(
            any_bond(state, |rule| {
                rule.criteria
                    .is_some_and(|criteria| criteria.is_frictional())
            }),
            || "bonds have a cohesion and a friction angle".to_owned(),
            "no bond has a cohesion",
        )
    },
    bytes: |_| 0,
    saving: NO_SAVING,
};

/// Breaks the bonds that have reached their strength. Returns the number of bonds compared with
/// their strength.
pub(crate) fn break_failed_bonds(state: &mut State) -> usize {
    let compared = state
        .scratch
        .partitions
        .iter()
        .map(|partition| partition.computed.compared)
        .sum();
    let broken = &mut state.scratch.events.broken;
    state.scratch.events.work.rates = break_bonds(
        &mut state.bonds,
        &mut state.particles,
        &state.scratch.partitions,
        0.5 * state.previous_time_step_s,
        broken,
    );
    state.broken_count += broken.len() as u64;
    for broken in broken.iter() {
        state.broken_by_cause.count(broken.cause);
    }
    if !broken.is_empty() {
        leave_out_broken(state);
    }
    compared
}

/// Number of bonds checked whose strength depends on the strain rate.
pub(crate) fn count_rates(state: &mut State) -> usize {
    state.scratch.events.work.rates
}

/// Number of bonds compared with an individual strength.
pub(crate) fn count_scattered(state: &mut State) -> usize {
    if state.bonds.strength_factors.is_empty() {
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
    let whole = state.bonds.len() as u64 - broken - asleep;
    if (computed as u64 - whole) * STALE >= computed as u64 {
        divide_anew(
            &state.bonds,
            &mut state.scratch.partitions,
            &state.particles.asleep,
        );
    }
}

/// Breaks the bonds that the partitions list, if they fail, and adds them to `broken`, in the order
/// of the bonds.
///
/// The bond acts until this moment: its ends get their half of the kick, `half_kick_s`, and its
/// force is subtracted from the wrenches that move them on. Returns the number of bonds checked
/// whose strength depends on the strain rate.
pub(crate) fn break_bonds(
    bonds: &mut Bonds,
    particles: &mut Particles,
    partitions: &[Partition],
    half_kick_s: f64,
    broken: &mut Vec<Break>,
) -> usize {
    // A partition lists its bonds of the total formulation before those of the incremental one.
    let mut failing: Vec<u32> = partitions
        .iter()
        .flat_map(|s| &s.failing)
        .copied()
        .collect();
    failing.sort_unstable();
    let by_rate = |at: &&u32| {
        let rule = &bonds.rules[bonds.rule_of(**at as usize)];
        rule.strengthening_from_1_s.is_some()
    };
    let rates = failing.iter().filter(by_rate).count();
    // All are checked before the first is removed: a break changes the velocities of its ends, and
    // strain rates depend on velocities.
    let failing: Vec<(usize, BondForces, Cause)> = failing
        .into_iter()
        .filter_map(|at| {
            let at = at as usize;
            let forces = bonds.forces(at, &particles.poses);
            fails(bonds, at, particles, &forces).map(|cause| (at, forces, cause))
        })
        .collect();
    for (at, forces, cause) in failing {
        broken.push(remove(bonds, particles, at, &forces, cause, half_kick_s));
    }
    rates
}

fn fails(bonds: &Bonds, at: usize, particles: &Particles, forces: &BondForces) -> Option<Cause> {
    let rule = &bonds.rules[bonds.rule_of(at)];
    let criteria = rule.criteria?;
    let stresses = stresses(&forces.load, bonds.radius_m(at));
    let rate = rule.strengthening_from_1_s.map_or(1.0, |_| {
        let rate_1_s = bonds.strain_rate_1_s(at, &particles.poses, &particles.motions);
        bonds.dynamic_increase_factor(at, rate_1_s)
    });
    let scatter = bonds.strength_factor(at);
    let factors = Factors { scatter, rate };
    (utilisation(&criteria, &stresses, factors) >= 1.0)
        .then(|| cause(&criteria, &stresses, factors))
}

fn remove(
    bonds: &mut Bonds,
    particles: &mut Particles,
    at: usize,
    forces: &BondForces,
    cause: Cause,
    half_kick_s: f64,
) -> Break {
    let ends = bonds.ends[at].map(|end| end as usize);
    let on_ends = [-forces.force_on_b, forces.force_on_b];
    for ((end, force), torque) in ends.into_iter().zip(on_ends).zip(forces.torques) {
        particles.wrenches[end].add(&-force, &-torque);
        let motion = &mut particles.motions[end];
        let per_mass = half_kick_s * motion.inverse_mass;
        let per_inertia = half_kick_s * motion.inverse_inertia;
        for k in 0..3 {
            motion.velocity_m_s[k] += per_mass * force[k];
            motion.spin_rad_s[k] += per_inertia * torque[k];
        }
    }
    bonds.set_broken(at);
    let [a, b] = ends.map(|end| particles.poses[end].place());
    Break {
        bond: at as u32,
        place_m: (0.5 * (a + b)).into(),
        cause,
        released_j: forces.energy.total(),
        ends: [0, 1].map(|end| {
            let [fx, fy, fz]: [f64; 3] = on_ends[end].into();
            let [tx, ty, tz]: [f64; 3] = forces.torques[end].into();
            (ends[end] as u32, [fx, fy, fz, tx, ty, tz])
        }),
    }
}
