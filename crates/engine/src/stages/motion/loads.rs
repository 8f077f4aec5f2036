//! Loads on particle groups, and the course of loads and motions over time.

use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::loads::GroupLoad;
use crate::state::particles::{Motion, Pose, Wrench};

/// Loads.
pub const LOADS: Stage = Stage {
    bytes: |state| {
        let loads = state.loads.iter();
        loads.map(|load| size_of_val(&load.particles[..])).sum()
    },
    ..Stage::new("loads", |state, _| {
        let particles = state.loads.iter().map(|load| load.particles.len());
        Need::of(
            !state.loads.is_empty(),
            || on_particles(particles.sum()),
            "no loads",
        )
    })
};

pub(super) fn on_particles(count: usize) -> String {
    format!("on {count} particle{}", if count == 1 { "" } else { "s" })
}

/// Adds the loads to the wrenches. Returns the number of particles on which they act.
pub(crate) fn apply_loads(state: &mut State) -> usize {
    let steps_s = state.steps_s();
    add_loads(
        &state.loads,
        state.time_s,
        steps_s,
        &mut state.particles.wrenches,
    );
    state.loads.iter().map(|load| load.particles.len()).sum()
}

/// Adds the loads of the kick at this time to the wrenches. `steps_s`: the previous step and the
/// next.
pub fn add_loads(loads: &[GroupLoad], time_s: f64, steps_s: [f64; 2], wrenches: &mut [Wrench]) {
    for load in loads {
        let factor = load.factor_in_kick(time_s, steps_s);
        for &particle in &load.particles {
            let wrench = &mut wrenches[particle as usize];
            for k in 0..3 {
                wrench.force_n[k] += factor * load.force_n[k];
                wrench.torque_n_m[k] += factor * load.torque_n_m[k];
            }
        }
    }
}

/// Power of the loads of the kick at this time on particles with these motions, W.
pub fn loads_power_w(
    loads: &[GroupLoad],
    time_s: f64,
    steps_s: [f64; 2],
    motions: &[Motion],
) -> f64 {
    let power = |load: &GroupLoad| {
        let of_one = |&particle: &u32| {
            let motion = &motions[particle as usize];
            (0..3)
                .map(|k| {
                    load.force_n[k] * motion.velocity_m_s[k]
                        + load.torque_n_m[k] * motion.spin_rad_s[k]
                })
                .sum::<f64>()
        };
        load.factor_in_kick(time_s, steps_s) * load.particles.iter().map(of_one).sum::<f64>()
    };
    loads.iter().map(power).sum()
}

/// Resultant force of all loads of the kick at this time, N, and their torque about a point, N m.
pub fn loads_resultant(
    loads: &[GroupLoad],
    time_s: f64,
    steps_s: [f64; 2],
    poses: &[Pose],
    about_m: [f64; 3],
) -> [[f64; 3]; 2] {
    let mut total = [[0.0; 3]; 2];
    for load in loads {
        let factor = load.factor_in_kick(time_s, steps_s);
        for &particle in &load.particles {
            let force = load.force_n.map(|f| factor * f);
            let torque = load.torque_n_m.map(|t| factor * t);
            add_resultant(
                &mut total,
                &poses[particle as usize],
                force,
                torque,
                about_m,
            );
        }
    }
    total
}

/// Adds a force and a torque at a particle to a resultant about a point.
pub(crate) fn add_resultant(
    total: &mut [[f64; 3]; 2],
    pose: &Pose,
    force: [f64; 3],
    torque: [f64; 3],
    about_m: [f64; 3],
) {
    let [x, y, z] = [0, 1, 2].map(|k| pose.position_m[k] - about_m[k]);
    let moment = [
        y * force[2] - z * force[1],
        z * force[0] - x * force[2],
        x * force[1] - y * force[0],
    ];
    for k in 0..3 {
        total[0][k] += force[k];
        total[1][k] += torque[k] + moment[k];
    }
}
