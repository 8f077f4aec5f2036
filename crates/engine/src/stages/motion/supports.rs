//! Supports: degrees of freedom that are fixed or have a prescribed motion, and the reactions.

use dem_scene::Hold;

use super::loads::on_particles;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::events::Break;
use crate::state::loads::factor_at;
use crate::state::particles::{Motion, Particles};
use crate::state::supports::{GroupSupport, HeldParticle, SupportPhase};

/// Supports.
pub const SUPPORTS: Stage = Stage {
    bytes: |state| {
        let supports = state.supports.iter();
        supports.map(|support| size_of_val(&support.held[..])).sum()
    },
    ..Stage::new("supports", |state, _| {
        let particles = state.supports.iter().map(|support| support.held.len());
        Need::of(
            !state.supports.is_empty(),
            || on_particles(particles.sum()),
            "no supports",
        )
    })
};

/// Records the motion of the held particles before the kick, and before bonds break: a break gives
/// its ends their half of the kick at once.
pub(crate) fn remember_held(state: &mut State) -> usize {
    remember(&mut state.supports, &state.particles.motions);
    0
}

/// Sets held degrees of freedom to the prescribed velocities. Returns the number of particles.
pub(crate) fn hold_supports(state: &mut State) -> usize {
    let steps_s = state.steps_s();
    let broken = &state.scratch.events.broken;
    hold(
        &mut state.supports,
        &mut state.particles,
        broken,
        state.time_s,
        steps_s,
    );
    state
        .supports
        .iter()
        .map(|support| support.held.len())
        .sum()
}

/// Records the motion of the held particles before the kick.
pub fn remember(supports: &mut [GroupSupport], motions: &[Motion]) {
    for support in supports {
        for held in &mut support.held {
            held.before = six(&motions[held.particle as usize]);
        }
    }
}

/// Sets held degrees of freedom to the velocities prescribed for the drift from `time_s` to
/// `time_s + time_step_s`, and records the reactions in a kick that covers half of the previous
/// step and half of the next, `steps_s`. The bonds that are `broken` acted in the first half only.
pub fn hold(
    supports: &mut [GroupSupport],
    particles: &mut Particles,
    broken: &[Break],
    time_s: f64,
    steps_s: [f64; 2],
) {
    let [before_s, time_step_s] = steps_s;
    let kick_s = 0.5 * (before_s + time_step_s);
    for support in supports {
        let phase = support.phase(time_s, steps_s);
        if phase != SupportPhase::Holds {
            let_go(support, phase, particles, broken, steps_s);
            continue;
        }
        let mut prescribed = prescribed(support, time_s, time_step_s);
        for (k, hold) in support.holds.iter().enumerate() {
            if let Some(Hold::Bar {
                impedance_n_s_m,
                incident_m_s,
            }) = *hold
            {
                let wave_m_s = incident_m_s * factor_at(&support.factor, time_s);
                let moving = Moving {
                    own: &support.held,
                    particles,
                    broken,
                    along: k,
                };
                let kick = [before_s, kick_s];
                prescribed[k] = Some(moving.bar_velocity_m_s(impedance_n_s_m, wave_m_s, kick));
            }
        }
        for held in &mut support.held {
            let i = held.particle as usize;
            let parted = of_broken(broken, held.particle);
            let motion = &mut particles.motions[i];
            let mass = 1.0 / motion.inverse_mass;
            let inertia = 1.0 / motion.inverse_inertia;
            for (k, prescribed) in prescribed.iter().enumerate() {
                let (now, inert) = if k < 3 {
                    (&mut motion.velocity_m_s[k], mass)
                } else {
                    (&mut motion.spin_rad_s[k - 3], inertia)
                };
                if let Some(prescribed) = prescribed {
                    let impulse = inert * (prescribed - *now) + 0.5 * before_s * parted[k];
                    let after = impulse / kick_s;
                    held.reactions[0][k] = after - parted[k];
                    held.reactions[1][k] = after;
                    *now = *prescribed;
                }
            }
        }
    }
}

/// The particles of a support that move together along one axis.
struct Moving<'a> {
    own: &'a [HeldParticle],
    particles: &'a Particles,
    broken: &'a [Break],
    along: usize,
}

impl Moving<'_> {
    /// Their velocity after a kick, if the end of a bar of this impedance is glued to them and its
    /// incident wave moves at `wave_m_s`: it exerts Z (2 v_I - v) with the mean v of the velocities
    /// before and after the kick, which is stable for every Z.
    fn bar_velocity_m_s(
        &self,
        impedance_n_s_m: f64,
        wave_m_s: f64,
        [before_s, kick_s]: [f64; 2],
    ) -> f64 {
        let k = self.along;
        let (mut mass_kg, mut before, mut free) = (0.0, 0.0, 0.0);
        for held in self.own {
            let motion = &self.particles.motions[held.particle as usize];
            let own_kg = 1.0 / motion.inverse_mass;
            mass_kg += own_kg;
            before += own_kg * held.before[k];
            let parted = of_broken(self.broken, held.particle)[k];
            free += own_kg * motion.velocity_m_s[k] - 0.5 * before_s * parted;
        }
        if mass_kg == 0.0 {
            return 0.0;
        }
        let impulse = kick_s * impedance_n_s_m;
        let driven = free + impulse * (2.0 * wave_m_s - 0.5 * before / mass_kg);
        driven / (mass_kg + 0.5 * impulse)
    }
}

/// Sets held degrees of freedom of predicted motions to what the support prescribes at the time of
/// the poses; those that it lets go of now had their velocity until now.
/// Those at the end of a bar move together, and the bar acts on them for `bar_s`.
pub(crate) fn predict_held(state: &State, bar_s: f64, predicted: &mut [Motion]) {
    let steps_s = state.steps_s();
    for support in &state.supports {
        let phase = support.phase(state.time_s, steps_s);
        if phase == SupportPhase::Over {
            continue;
        }
        let prescribed = match phase {
            SupportPhase::Holds => prescribed(support, state.time_s, state.time_step_s),
            _ => [None; 6],
        };
        for (k, hold) in support.holds.iter().enumerate() {
            if let (
                SupportPhase::Holds,
                Some(Hold::Bar {
                    impedance_n_s_m,
                    incident_m_s,
                }),
            ) = (phase, hold)
            {
                let wave_m_s = incident_m_s * factor_at(&support.factor, state.time_s);
                predict_bar(support, k, [bar_s * impedance_n_s_m, wave_m_s], predicted);
            }
        }
        let is_bar = |k: usize| matches!(support.holds[k], Some(Hold::Bar { .. }));
        for held in &support.held {
            let motion = &mut predicted[held.particle as usize];
            for k in (0..6).filter(|&k| support.holds[k].is_some() && !is_bar(k)) {
                let before = held.before[k];
                let after = prescribed[k].unwrap_or(before);
                // A support that moves from the start has done so since just before it.
                let now = match steps_s[0] > 0.0 {
                    true => velocity_at_kick(before, after, steps_s),
                    false => after,
                };
                match k {
                    0..3 => motion.velocity_m_s[k] = now,
                    _ => motion.spin_rad_s[k - 3] = now,
                }
            }
        }
    }
}

/// Gives the particles at the end of a bar their common velocity along axis `k`, after the bar has
/// acted on them. `impulse`: its impedance times the time for which it has, kg.
fn predict_bar(
    support: &GroupSupport,
    k: usize,
    [impulse, wave_m_s]: [f64; 2],
    predicted: &mut [Motion],
) {
    let (mut mass_kg, mut momentum) = (0.0, 0.0);
    for held in &support.held {
        let motion = &predicted[held.particle as usize];
        mass_kg += 1.0 / motion.inverse_mass;
        momentum += motion.velocity_m_s[k] / motion.inverse_mass;
    }
    let now_m_s = (momentum + 2.0 * impulse * wave_m_s) / (mass_kg + impulse);
    for held in &support.held {
        predicted[held.particle as usize].velocity_m_s[k] = now_m_s;
    }
}

/// Velocities and spins that a support prescribes in the step from `time_s` on; none: free, or what
/// a bar does, which depends on the forces.
fn prescribed(support: &GroupSupport, time_s: f64, time_step_s: f64) -> [Option<f64>; 6] {
    let factor = &support.factor;
    support.holds.map(|hold| match hold? {
        Hold::Fixed => Some(0.0),
        Hold::Velocity(v) => Some(v * factor_at(factor, time_s + 0.5 * time_step_s)),
        Hold::Displacement(d) => {
            let gain = factor_at(factor, time_s + time_step_s) - factor_at(factor, time_s);
            Some(d * gain / time_step_s)
        }
        Hold::Bar { .. } => None,
    })
}

/// Gives the degrees of freedom of a support that has ended their own half of the kick at which it
/// releases them. In the step before, the support held them and exerted the reaction.
fn let_go(
    support: &mut GroupSupport,
    phase: SupportPhase,
    particles: &mut Particles,
    broken: &[Break],
    [before_s, time_step_s]: [f64; 2],
) {
    let kick_s = 0.5 * (before_s + time_step_s);
    for held in &mut support.held {
        held.reactions = [[0.0; 6]; 2];
        if phase == SupportPhase::Over {
            continue;
        }
        let parted = of_broken(broken, held.particle);
        let motion = &mut particles.motions[held.particle as usize];
        let mass = 1.0 / motion.inverse_mass;
        let inertia = 1.0 / motion.inverse_inertia;
        for k in (0..6).filter(|&k| support.holds[k].is_some()) {
            let (now, inert) = if k < 3 {
                (&mut motion.velocity_m_s[k], mass)
            } else {
                (&mut motion.spin_rad_s[k - 3], inertia)
            };
            let impulse = inert * (*now - held.before[k]) - 0.5 * before_s * parted[k];
            let acting = impulse / kick_s;
            held.reactions[0][k] = -(acting + parted[k]);
            *now = held.before[k] + 0.5 * time_step_s * acting / inert;
        }
    }
}

/// Force and torque that bonds exerted on a particle until they broke, N and N m.
fn of_broken(broken: &[Break], particle: u32) -> [f64; 6] {
    let mut sum = [0.0; 6];
    for (_, on_end) in broken
        .iter()
        .flat_map(|b| &b.ends)
        .filter(|(end, _)| *end == particle)
    {
        for (sum, on_end) in sum.iter_mut().zip(on_end) {
            *sum += on_end;
        }
    }
    sum
}

/// Velocity of a held degree of freedom at the moment of a kick: the velocity before it plus the
/// part of the change that belongs to the previous step.
///
/// At the first step it is the velocity before the kick: a support that moves from the start begins
/// after that moment, with a jump.
pub fn velocity_at_kick(before: f64, after: f64, steps_s: [f64; 2]) -> f64 {
    let [before_s, after_s] = steps_s;
    before + (after - before) * before_s / (before_s + after_s)
}

/// Work of the reactions in the half steps before and after a kick, J: their powers, plus the
/// remaining change of kinetic energy, as prescribed velocities may jump. So a jump is recorded
/// with its actual work, not with the velocity after it.
pub(crate) fn reactions_work_j(
    supports: &[GroupSupport],
    particles: &Particles,
    time_s: f64,
    steps_s: [f64; 2],
) -> [f64; 2] {
    let mut work = [0.0; 2];
    for support in supports {
        let GroupSupport { holds, held, .. } = support;
        if support.phase(time_s, steps_s) != SupportPhase::Holds {
            // Released degrees of freedom do not jump, and a support that has ended exerts nothing.
            let of_one = |held: &HeldParticle| {
                (0..6)
                    .map(|k| held.reactions[0][k] * held.before[k])
                    .sum::<f64>()
            };
            work[0] += 0.5 * steps_s[0] * held.iter().map(of_one).sum::<f64>();
            continue;
        }
        for held in held {
            let i = held.particle as usize;
            let motion = &particles.motions[i];
            let after = six(motion);
            for k in (0..6).filter(|&k| holds[k].is_some()) {
                let per_inert = if k < 3 {
                    motion.inverse_mass
                } else {
                    motion.inverse_inertia
                };
                let now = velocity_at_kick(held.before[k], after[k], steps_s);
                let jump = |by: f64| 0.5 * by * by / per_inert;
                let [early, late] = held.reactions.map(|reaction| reaction[k]);
                work[0] += 0.5 * steps_s[0] * early * held.before[k] + jump(now - held.before[k]);
                work[1] += 0.5 * steps_s[1] * late * after[k] - jump(after[k] - now);
            }
        }
    }
    work
}

/// Velocity and spin of a particle.
fn six(motion: &Motion) -> [f64; 6] {
    let [vx, vy, vz] = motion.velocity_m_s;
    let [wx, wy, wz] = motion.spin_rad_s;
    [vx, vy, vz, wx, wy, wz]
}
