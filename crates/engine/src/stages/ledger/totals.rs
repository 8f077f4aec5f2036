//! Totals of a state: velocities at the time of its positions, kinetic and elastic energy, momenta.

use crate::stages::chunks::{CHUNK, ordered_sum, ordered_sums};
use crate::stages::clumps::motion::synchronous;
use crate::stages::motion::loads::add_resultant;
use crate::stages::motion::supports::velocity_at_kick;
use crate::state::State;
use crate::state::clumps::Clumps;
use crate::state::ledger::momenta_of;
use crate::state::particles::{Motion, Particles};
use crate::state::supports::GroupSupport;
use crate::state::supports::SupportPhase;
use rayon::prelude::*;

/// Velocities and spins at the time of the poses, between a kick and the drift after it. One per
/// particle.
pub fn synchronous_motions(state: &State) -> Vec<Motion> {
    let p = &state.particles;
    let mut motions = synchronous_motions_of_free(state);
    for clump in synchronous(state) {
        let motion_at = clump.motion(state.clumps.template(&clump));
        let spheres = &p.poses[state.clumps.spheres_of(&clump)];
        motions.extend(spheres.iter().map(|pose| motion_at(&pose.place())));
    }
    motions
}

/// As [`synchronous_motions`], for free particles only.
pub fn synchronous_motions_of_free(state: &State) -> Vec<Motion> {
    let p = &state.particles;
    let [of_bonds, on_particles] = state.resistances();
    let back = |i: usize| {
        let mut motion = p.motions[i];
        if p.sleeps(i) {
            return motion;
        }
        let half_s = 0.5 * state.time_step_s;
        let (per_mass, per_inertia) = (
            half_s * motion.inverse_mass,
            half_s * motion.inverse_inertia,
        );
        for wrenches in [&p.wrenches, of_bonds, on_particles] {
            if let Some(wrench) = wrenches.get(i) {
                for k in 0..3 {
                    motion.velocity_m_s[k] -= per_mass * wrench.force_n[k];
                    motion.spin_rad_s[k] -= per_inertia * wrench.torque_n_m[k];
                }
            }
        }
        for k in 0..3 {
            motion.velocity_m_s[k] -= half_s * state.model.gravity_m_s2[k];
        }
        motion
    };
    let mut motions: Vec<Motion> = (0..p.free)
        .into_par_iter()
        .with_min_len(CHUNK)
        .map(back)
        .collect();
    let steps_s = state.steps_s();
    let holds =
        |support: &&GroupSupport| support.phase(state.time_s, steps_s) == SupportPhase::Holds;
    for support in state.supports.iter().filter(holds) {
        for held in &support.held {
            let after = &p.motions[held.particle as usize];
            let motion = &mut motions[held.particle as usize];
            for k in 0..3 {
                if support.holds[k].is_some() {
                    motion.velocity_m_s[k] =
                        velocity_at_kick(held.before[k], after.velocity_m_s[k], steps_s);
                }
                if support.holds[k + 3].is_some() {
                    motion.spin_rad_s[k] =
                        velocity_at_kick(held.before[k + 3], after.spin_rad_s[k], steps_s);
                }
            }
        }
    }
    motions
}

/// Velocities half a step before the poses, between a kick and the drift after it: those with which
/// the bonds of this step have been compared with their strength. One per particle.
pub fn motions_before_kick(state: &State) -> Vec<Motion> {
    let mut motions = synchronous_motions(state);
    // In a static equilibrium nothing moves, and there is no step.
    if state.time_step_s > 0.0 {
        let back = state.previous_time_step_s / state.time_step_s;
        for (motion, after) in motions.iter_mut().zip(&state.particles.motions) {
            for (now, after) in motion.velocity_m_s.iter_mut().zip(after.velocity_m_s) {
                *now -= back * (after - *now);
            }
        }
    }
    // The ends of a bond that broke in this step have had its half of the kick after the
    // comparison.
    for (end, on_end) in state.scratch.events.broken.iter().flat_map(|b| b.ends) {
        let half_s = 0.5 * state.previous_time_step_s;
        let motion = &mut motions[end as usize];
        for (velocity, force_n) in motion.velocity_m_s.iter_mut().zip(on_end) {
            *velocity -= half_s * motion.inverse_mass * force_n;
        }
    }
    motions
}

/// Kinetic energy of the free particles with these motions, J.
pub fn kinetic_energy(particles: &Particles, motion: impl Fn(usize) -> Motion + Sync) -> f64 {
    ordered_sum(particles.free, |i| particles.kinetic_j(i, &motion(i)))
}

/// Momentum and angular momentum about a point, N s and N m s, and the sums of the magnitudes of
/// their parts.
pub fn momenta(
    particles: &Particles,
    clumps: &Clumps,
    about_m: [f64; 3],
) -> ([[f64; 3]; 2], [f64; 2]) {
    let mut sums = ordered_sums(particles.free, |i| {
        let (pose, motion) = (&particles.poses[i], &particles.motions[i]);
        let mass = 1.0 / motion.inverse_mass;
        let inertia = 1.0 / motion.inverse_inertia;
        let momentum = motion.velocity_m_s.map(|v| mass * v);
        let spin = motion.spin_rad_s.map(|w| inertia * w);
        let mut part = [[0.0; 3]; 2];
        add_resultant(&mut part, pose, momentum, spin, about_m);
        let magnitude = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let [p, l] = part;
        [
            p[0],
            p[1],
            p[2],
            l[0],
            l[1],
            l[2],
            magnitude(p),
            magnitude(l),
        ]
    });
    for clump in &clumps.all {
        let template = clumps.template(clump);
        let mass = template.mass_kg;
        let mut parts = momenta_of(
            mass,
            clump.place_m,
            clump.velocity_m_s,
            clump.angular_momentum,
            about_m,
        );
        // Includes the parts on either side of the centre, as for a bonded body: otherwise a clump
        // in straight flight would have only rounding errors.
        let gyration_m = (0.5 * template.moments_kg_m2.iter().sum::<f64>() / mass).sqrt();
        parts[7] += gyration_m * parts[6];
        for (sum, part) in sums.iter_mut().zip(parts) {
            *sum += part;
        }
    }
    let [px, py, pz, lx, ly, lz, momentum, angular_momentum] = sums;
    ([[px, py, pz], [lx, ly, lz]], [momentum, angular_momentum])
}
