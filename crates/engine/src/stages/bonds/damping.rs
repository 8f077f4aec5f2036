//! Forces of damped bonds on the particles: viscous, and those of structural damping, which a
//! viscous force stands for in each step (`structural_damping.rs`).
//!
//! Velocities are known half a step before the forces (leapfrog). The kick is therefore split
//! (Strang 1968): half of it by all other forces F, then the decay of velocities by damping alone
//! over the step, then the other half by F. With the step dt, and G = dt M^-1 C at the present
//! positions,
//!
//!   w = v_(n-1/2) + dt/2 M^-1 F_n,   v_(n+1/2) = R(G) w + dt/2 M^-1 F_n,
//!
//! where R approximates exp(-G) to second order by the stages of Runge, Kutta and Chebyshev
//! ([`Chebyshev`]), as many as keep R between 0 and 1, so that it only ever takes energy. The error
//! is of second order in the step in any network of bonds, and each stage keeps momenta.
//!
//! Where damping is weak, one stage is enough: that of velocities at the time of the forces,
//!
//!   D_n = -C (v_(n-1/2) + dt/2 M^-1 (F_n + D_(n-1))),
//!
//! predicted with the damping of the last step, which is of second order too. Where it is not weak,
//! but at most [`ONE_STAGE`], D_(n-1) is replaced by the running mean
//!
//!   P_(n-1) = q P_(n-2) + (1 - q) D_(n-1),
//!
//! which is of second order as well, and stable up to 1 + q instead of 1. Here q follows from the
//! largest eigenvalue: see `memory`.
//!
//! Beyond that, up to [`MOST`], one stage with a longer memory is enough: D_n = -C y_n, where the
//! velocities y_n follow from w, the last three y and the last three D (`physics/remembered.rs`).
//! What is remembered is velocities and, in their prediction only, forces: so that D_n keeps both
//! momenta. It begins, and begins anew once what it holds is of other particles, with a step by
//! stages. Stronger damping takes the stages in every step.
//!
//! **Stability.** With symmetric K and C the scheme is stable up to the same step as without
//! damping of bonds. With B = (1 + R)/2 and A = dt^2 M^-1 K, z^n u is a solution if
//!
//!   (z - 1)^2 B^-1 u + z A u + 2 (z - 1) (B^-1 - 1) u = 0.
//!
//! With the quadratic forms a of A and b of B^-1 in u, of norm 1, b z^2 + (a - 2) z + 2 - b = 0:
//! |z| is at most 1 if b is at least 1 and a at most 4, and z = -1 where A has the eigenvalue 4.
//! With one stage, where q is 0 without a mean, z^n u is a solution only if a equals minus a mean
//! over the eigenvalues g of G, with weights of u, of
//!
//!   f(z, g) = (z - 1) (2 z^2 + ((3 - q) g - 2 - 2 q) z + 2 q - (1 + q) g)
//!             / (z ((2 - g) z + g - 2 q)).
//!
//! For g below 1 + q, f has no pole outside the unit circle, and its imaginary part has the sign of
//! that of z there, as it has on the circle (where it is at least g |Im z|); for real z it is
//! positive beyond 1 and below -4 beyond -1. So a between 0 and 4 leaves no z outside. The same
//! holds with the longer memory, where
//!
//!   f(z, g) = (z - 1)^2 / z + g (z^2 - 1) / (2 z N(1/z)):
//!
//! N, see there, has a positive real part on the unit circle, and hence outside, where f has no
//! pole, and Im f, g Im z Re 1/N on the circle, has the sign of Im z. Dashpots of contacts, which F
//! contains with the velocity of half a step ago, change the last condition alone: see
//! [`crate::check::limit`].
//!
//! With coefficients that change from step to step, as those of structural damping, the first proof
//! fails, but not its result: with the synchronous velocities v_n, the other forces keep
//! v M v + x K (1 - A/4) x, which has no negative part up to the undamped limit, and R only lowers
//! v M v. So does damping in one stage, over all steps: with the velocities u = w + dt/2 M^-1
//! D_(n-1) that it goes by and P = dt u C u, a step takes at least 5/8 P_n - 1/8 P_(n-1) where G is
//! at most 1/2.

use super::forces::any_bond;
use super::viscous_kernel::damping_wrenches;
use crate::stages::chunks::CHUNK;
use crate::stages::chunks::ordered_sum;
use crate::stages::clumps::rigid_parts::predict_rigid_parts;
use crate::stages::motion::kick_and_drift::{Forces, for_each_awake};
use crate::stages::motion::supports::predict_held;
use crate::stages::stage::{Need, Saving, Stage};
use crate::state::State;
use crate::state::bonds::BondRule;
use crate::state::particles::{Motion, Wrench};
use crate::threads::for_each;
use dem_physics::chebyshev::Chebyshev;
use dem_physics::remembered::{MOST, Remembered};

/// ns per bond of a body of 25,547 particles: see doc/inside/leave-out.md.
const BOND_DAMPING_NS: f64 = 43.3;

/// Largest eigenvalue of G up to which one stage needs no running mean.
pub const WEAK: f64 = 2.88 / 3.4;

/// Largest eigenvalue of G up to which damping takes one stage with a mean at most.
pub const ONE_STAGE: f64 = 1.43;

/// The same where coefficients change from step to step.
const ONE_STAGE_IF_CHANGING: f64 = 0.5;

/// Damping of bonds.
pub const BOND_DAMPING: Stage = Stage {
    bytes: |state| {
        let stages = state.scratch.damping_stages.iter();
        let predicted = state.scratch.predicted.iter();
        size_of_val(&state.bonds.damping[..])
            + size_of_val(&state.bond_resistance[..])
            + size_of_val(&state.mean_resistance[..])
            + state.damping_memory.bytes()
            + stages.map(|stage| size_of_val(&stage[..])).sum::<usize>()
            + predicted
                .map(|motions| size_of_val(&motions[..]))
                .sum::<usize>()
    },
    saving: |state| {
        let of_bonds = Saving::of(state.bonds.len(), size_of::<[f64; 4]>(), BOND_DAMPING_NS)?;
        // Without the running mean and the memory, which not all need.
        let of_particle = 4 * size_of::<Wrench>() + 2 * size_of::<Motion>();
        Some(Saving {
            bytes: of_bonds.bytes + state.particles.free * of_particle,
            ..of_bonds
        })
    },
    ..Stage::new("bond damping", |state, _| {
        Need::of(
            any_bond(state, BondRule::is_damped),
            || "bonds are damped".to_owned(),
            "no bond is damped: no relative velocities",
        )
    })
};

/// Weight q of the running mean of damping in that of the next step, for this largest eigenvalue of
/// G: so that what alternates from step to step by damping alone keeps at most four fifths in each,
/// -4/5 being a root of 2 z^2 + ((3 - q) g - 2 - 2 q) z + 2 q - (1 + q) g. It is at most 0.6.
fn memory(largest: f64) -> f64 {
    if largest > WEAK {
        (3.4 * largest - 2.88) / (3.6 - 0.2 * largest)
    } else {
        0.0
    }
}

/// Sets the damping forces of bonds: those that, over the kick, have the impulse of its damping.
/// Returns the number of bonds computed, in one stage.
pub(crate) fn compute_bond_damping(state: &mut State) -> usize {
    if state.bond_resistance.is_empty() {
        return 0;
    }
    // The first kick is half as long as those that follow, which are to have the same stages.
    let largest = state.kick_s().max(state.time_step_s) * state.damping_rate_1_s;
    let changes = !state.scratch.damping_now.is_empty();
    let is_one_stage = largest
        <= if changes {
            ONE_STAGE_IF_CHANGING
        } else {
            ONE_STAGE
        };
    let is_remembered = !is_one_stage && !changes && largest <= MOST;
    if !is_remembered {
        state.damping_memory.clear();
    }
    if is_one_stage {
        // Structural damping has predicted them already.
        if state.scratch.damping_now.is_empty() {
            predict_as_damped_before(state);
        }
        let mut force = std::mem::take(&mut state.bond_resistance);
        damp(state, 0, &mut force);
        state.bond_resistance = force;
    } else if is_remembered && !state.damping_memory.is_empty() {
        damp_as_remembered(state, &Remembered::covering(largest));
    } else {
        damp_in_stages(state, largest);
        if is_remembered {
            begin_memory(state);
        }
    }
    remember(state, if is_one_stage { memory(largest) } else { 0.0 });
    state.scratch.structural_share = structural_share(state);
    let partitions = state.scratch.partitions.iter();
    partitions.map(|partition| partition.computed.damped).sum()
}

/// Renews the running means of damping forces, with this weight of the means before, if they are or
/// have been needed.
fn remember(state: &mut State, memory: f64) {
    if state.mean_resistance.is_empty() {
        if memory > 0.0 {
            state.mean_resistance.clone_from(&state.bond_resistance);
        }
        return;
    }
    let (last, asleep) = (&state.bond_resistance, &state.particles.asleep);
    let chunks = state.mean_resistance.chunks_mut(CHUNK).enumerate();
    for_each(chunks, |(chunk, means)| {
        for_each_awake(chunk * CHUNK, means, asleep, |i, mean| {
            *mean = sum(mean, memory, [(1.0 - memory, &last[..])], i);
        });
    });
}

/// Damps in one stage, with the memory of the last steps.
fn damp_as_remembered(state: &mut State, factors: &Remembered) {
    let last = std::mem::take(&mut state.bond_resistance);
    let mut memory = std::mem::take(&mut state.damping_memory);
    let mut expected = std::mem::take(&mut state.scratch.damping_stages[0]);
    let [second, mut third] = memory.forces;
    let lists: [&[Wrench]; 3] = [&last, &second, &third];
    let others = [0, 1, 2].map(|k| (factors.damping[k], lists[k]));
    let asleep = &state.particles.asleep;
    let chunks = expected.chunks_mut(CHUNK).enumerate();
    for_each(chunks, |(chunk, expected)| {
        for_each_awake(chunk * CHUNK, expected, asleep, |i, expected| {
            *expected = sum(expected, 0.0, others, i);
        });
    });
    predict(state, &expected);
    state.scratch.damping_stages[0] = expected;
    let earlier = &memory.motions;
    let (predicted, asleep) = (&mut state.scratch.predicted[0], &state.particles.asleep);
    let chunks = predicted.chunks_mut(CHUNK).enumerate();
    for_each(chunks, |(chunk, predicted)| {
        for_each_awake(chunk * CHUNK, predicted, asleep, |i, motion| {
            for k in 0..3 {
                let mut velocity_m_s = factors.present * motion.velocity_m_s[k];
                let mut spin_rad_s = factors.present * motion.spin_rad_s[k];
                for (factor, earlier) in factors.velocities.iter().zip(earlier) {
                    velocity_m_s += factor * earlier[i].velocity_m_s[k];
                    spin_rad_s += factor * earlier[i].spin_rad_s[k];
                }
                motion.velocity_m_s[k] = velocity_m_s;
                motion.spin_rad_s[k] = spin_rad_s;
            }
        });
    });
    damp(state, 0, &mut third);
    memory.motions.rotate_right(1);
    std::mem::swap(&mut memory.motions[0], &mut state.scratch.predicted[0]);
    memory.forces = [last, second];
    state.bond_resistance = third;
    state.damping_memory = memory;
}

/// Begins the memory with this step, as if the steps before had been as it is.
fn begin_memory(state: &mut State) {
    let of_bonds = std::mem::take(&mut state.bond_resistance);
    predict(state, &of_bonds);
    state.bond_resistance = of_bonds;
    for i in 0..state.particles.free {
        if state.particles.sleeps(i) {
            state.scratch.predicted[0][i] = Motion::default();
        }
    }
    let memory = &mut state.damping_memory;
    for motions in &mut memory.motions {
        motions.clone_from(&state.scratch.predicted[0]);
    }
    for forces in &mut memory.forces {
        forces.clone_from(&state.bond_resistance);
    }
}

fn damp_in_stages(state: &mut State, largest: f64) {
    let kick_s = state.kick_s();
    let known = state.scratch.stages.take();
    let known = known.filter(|(covered, _)| *covered == largest);
    let (_, stages) = known.unwrap_or_else(|| (largest, Chebyshev::covering(largest)));
    predict(state, &[]);
    let mut force = std::mem::take(&mut state.bond_resistance);
    let [mut before, mut now, mut first] = std::mem::take(&mut state.scratch.damping_stages);
    damp(state, 0, &mut first);
    go_on(state, &mut now, 0.0, [(stages.first * kick_s, &first)]);
    for (stages_left, stage) in (0..stages.others.len()).rev().zip(&stages.others) {
        damp(state, 1, &mut force);
        if stages_left > 0 {
            let others: [(f64, &[Wrench]); 3] = [
                (stage.last, &now),
                (stage.force * kick_s, &force),
                (stage.first_force * kick_s, &first),
            ];
            go_on(state, &mut before, stage.before, others);
            std::mem::swap(&mut before, &mut now);
        } else {
            let others: [(f64, &[Wrench]); 3] = [
                (stage.last / kick_s, &now),
                (stage.before / kick_s, &before),
                (stage.first_force, &first),
            ];
            let asleep = &state.particles.asleep;
            let chunks = force.chunks_mut(CHUNK).enumerate();
            for_each(chunks, |(chunk, force)| {
                for_each_awake(chunk * CHUNK, force, asleep, |i, force| {
                    *force = sum(force, stage.force, others, i);
                });
            });
        }
    }
    state.bond_resistance = force;
    state.scratch.damping_stages = [before, now, first];
    state.scratch.stages = Some((largest, stages));
}

/// Predicts the motions of the free particles at the time of their poses, with the damping of bonds
/// of the last step, or its running mean if that is not weak.
pub(super) fn predict_as_damped_before(state: &mut State) {
    let means = std::mem::take(&mut state.mean_resistance);
    let last = std::mem::take(&mut state.bond_resistance);
    predict(state, if means.is_empty() { &last } else { &means });
    state.mean_resistance = means;
    state.bond_resistance = last;
}

/// Part of what damping of bonds takes in this step that structural damping takes: all but what the
/// viscous forces take in the middle of the decay.
fn structural_share(state: &mut State) -> f64 {
    if state.scratch.damping_now.is_empty() {
        return 0.0;
    }
    if state.bonds.damping.is_empty() {
        return 1.0;
    }
    let half_s = 0.5 * state.kick_s();
    predict(state, &[]);
    let of_bonds = std::mem::take(&mut state.bond_resistance);
    let mut viscous = std::mem::take(&mut state.scratch.damping_stages[0]);
    go_on(state, &mut viscous, 0.0, [(half_s, &of_bonds)]);
    let with_structural = std::mem::take(&mut state.scratch.damping_now);
    damp(state, 1, &mut viscous);
    state.scratch.damping_now = with_structural;
    let motions = &state.scratch.predicted[1];
    let asleep = |i: usize| state.particles.sleeps(i);
    let [all_w, viscous_w] = [&of_bonds, &viscous].map(|list| {
        ordered_sum(list.len(), |i| match asleep(i) {
            true => 0.0,
            false => -motions[i].power_w(&list[i]),
        })
    });
    state.bond_resistance = of_bonds;
    state.scratch.damping_stages[0] = viscous;
    if all_w > 0.0 {
        (1.0 - viscous_w / all_w).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Predicts the motions of the free particles at the time of their poses, with this damping of
/// bonds, one for each or none.
fn predict(state: &mut State, of_bonds: &[Wrench]) {
    let half_s = 0.5 * state.previous_time_step_s;
    let mut predicted = std::mem::take(&mut state.scratch.predicted[0]);
    let p = &state.particles;
    let resisting = [of_bonds, &state.scratch.particle_resistance];
    let forces = Forces::of(p, resisting, state.model.gravity_m_s2, half_s);
    predicted.resize(p.free, Motion::default());
    let chunks = predicted.chunks_mut(CHUNK).enumerate();
    for_each(chunks, |(chunk, predicted)| {
        for_each_awake(chunk * CHUNK, predicted, &p.asleep, |i, motion| {
            *motion = p.motions[i];
            forces.kick(i, motion);
        });
    });
    predict_held(state, half_s, &mut predicted);
    predict_rigid_parts(state, of_bonds, &[], &mut predicted);
    state.scratch.predicted[0] = predicted;
}

/// Multiplies impulses of damping by a factor, adds multiples of others, and sets the motions of
/// the next stage: those predicted, with these impulses.
fn go_on<const N: usize>(
    state: &mut State,
    impulses: &mut [Wrench],
    factor: f64,
    others: [(f64, &[Wrench]); N],
) {
    let [start, mut next] = std::mem::take(&mut state.scratch.predicted);
    next.resize(start.len(), Motion::default());
    let asleep = &state.particles.asleep;
    let chunks = impulses.chunks_mut(CHUNK).zip(next.chunks_mut(CHUNK));
    for_each(chunks.enumerate(), |(chunk, (impulses, next))| {
        let first = chunk * CHUNK;
        for_each_awake(first, next, asleep, |i, motion| {
            let impulse = &mut impulses[i - first];
            *impulse = sum(impulse, factor, others, i);
            *motion = start[i];
            for k in 0..3 {
                motion.velocity_m_s[k] += motion.inverse_mass * impulse.force_n[k];
                motion.spin_rad_s[k] += motion.inverse_inertia * impulse.torque_n_m[k];
            }
        });
    });
    predict_held(state, 0.0, &mut next);
    predict_rigid_parts(state, &[], impulses, &mut next);
    state.scratch.predicted = [start, next];
}

/// A wrench times a factor, plus multiples of those of particle `i` in lists. What counts 0 times
/// is not read: it may be of another step.
#[inline(always)]
fn sum<const N: usize>(
    wrench: &Wrench,
    factor: f64,
    others: [(f64, &[Wrench]); N],
    i: usize,
) -> Wrench {
    let mut sum = Wrench::default();
    if factor != 0.0 {
        add_multiple(&mut sum, factor, wrench);
    }
    for (factor, list) in others {
        if factor != 0.0 {
            add_multiple(&mut sum, factor, &list[i]);
        }
    }
    sum
}

#[inline(always)]
fn add_multiple(sum: &mut Wrench, factor: f64, wrench: &Wrench) {
    for k in 0..4 {
        sum.force_n[k] += factor * wrench.force_n[k];
        sum.torque_n_m[k] += factor * wrench.torque_n_m[k];
    }
}

/// Sets `forces` to the damping of bonds between ends with the motions of this stage.
fn damp(state: &mut State, stage: usize, forces: &mut [Wrench]) {
    let scratch = &mut state.scratch;
    scratch.damping_passes += 1;
    let coefficients = match scratch.damping_now.is_empty() {
        true => &state.bonds.damping,
        false => &scratch.damping_now,
    };
    damping_wrenches(
        &state.bonds,
        coefficients,
        &state.particles.poses,
        &scratch.predicted[stage],
        &mut scratch.partitions,
        forces,
    );
}
