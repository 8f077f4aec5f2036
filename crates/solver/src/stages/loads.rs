//! Loads on sets of particles, and the course of loads and motions over time.

use dem_io::scene::Factor;

use crate::interpolation::interpolated;
use crate::state::particles::{Motion, Pose, Wrench};

/// A load on some particles, the same on each.
#[derive(Debug, Clone, PartialEq)]
pub struct SetLoad {
    /// The particles.
    pub particles: Vec<u32>,
    /// On each, N. Length 3.
    pub force_n: [f64; 3],
    /// On each, N m. Length 3.
    pub torque_n_m: [f64; 3],
    /// Over time.
    pub factor: Factor,
    /// From this time on it is zero, s; infinite: never.
    pub end_s: f64,
}

impl SetLoad {
    /// What the load is multiplied by in the kick at `time_s`, which makes up for half of the step
    /// before and half of the one to come, `steps_s`. Where the load ends in between, its share of
    /// that time: so its impulse is the same whatever the steps.
    fn factor_in_kick(&self, time_s: f64, steps_s: [f64; 2]) -> f64 {
        let factor = factor_at(&self.factor, time_s);
        if self.end_s.is_infinite() {
            return factor;
        }
        let [from_s, until_s] = [time_s - 0.5 * steps_s[0], time_s + 0.5 * steps_s[1]];
        factor * ((self.end_s - from_s) / (until_s - from_s)).clamp(0.0, 1.0)
    }
}

/// Value of a factor at a time.
pub fn factor_at(factor: &Factor, time_s: f64) -> f64 {
    match factor {
        Factor::One => 1.0,
        Factor::Ramp { until_s } => (time_s / until_s).clamp(0.0, 1.0),
        Factor::Table(points) => interpolated(points, time_s).unwrap_or(1.0),
    }
}

/// Adds the loads of the kick at this time to the wrenches. `steps_s`: the step before and the one
/// to come.
pub fn add_loads(loads: &[SetLoad], time_s: f64, steps_s: [f64; 2], wrenches: &mut [Wrench]) {
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

/// Power of the loads of the kick at this time on particles moving so, W.
pub fn loads_power_w(loads: &[SetLoad], time_s: f64, steps_s: [f64; 2], motions: &[Motion]) -> f64 {
    let power = |load: &SetLoad| {
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

/// Force of all loads of the kick at this time together, N, and their torque about a point, N m.
pub fn loads_resultant(
    loads: &[SetLoad],
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
pub fn add_resultant(
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
