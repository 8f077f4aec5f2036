//! Supports: degrees of freedom that are held or moved as prescribed, and what it takes to do so.

use dem_io::scene::{Factor, Hold};

use super::loads::factor_at;
use crate::state::particles::{Motion, Particles};

/// A support on some particles.
#[derive(Debug, Clone, PartialEq)]
pub struct SetSupport {
    /// Along x, y, z, then about x, y, z; None: free. Length 6.
    pub holds: [Option<Hold>; 6],
    /// Over time.
    pub factor: Factor,
    /// The particles.
    pub held: Vec<Held>,
}

/// A particle that is held, in the step that was kicked last.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Held {
    /// Which.
    pub particle: u32,
    /// Velocity and spin before the kick. Length 6.
    pub before: [f64; 6],
    /// What the support exerts, N and N m. Length 6.
    pub reaction: [f64; 6],
}

/// Notes how the held particles move before the kick.
pub fn remember(supports: &mut [SetSupport], motions: &[Motion]) {
    for support in supports {
        for held in &mut support.held {
            held.before = six(&motions[held.particle as usize]);
        }
    }
}

/// Gives held freedoms the velocities that are prescribed for the drift from `time_s` to `time_s + time_step_s`, and notes the reactions
/// that this takes in a kick of `kick_s`.
pub fn hold(
    supports: &mut [SetSupport],
    particles: &mut Particles,
    time_s: f64,
    time_step_s: f64,
    kick_s: f64,
) {
    for SetSupport {
        holds,
        factor,
        held,
    } in supports
    {
        let prescribed = holds.map(|hold| {
            hold.map(|hold| match hold {
                Hold::Fixed => 0.0,
                Hold::Velocity(v) => v * factor_at(factor, time_s + 0.5 * time_step_s),
                Hold::Displacement(d) => {
                    let gain = factor_at(factor, time_s + time_step_s) - factor_at(factor, time_s);
                    d * gain / time_step_s
                }
            })
        });
        for held in held {
            let i = held.particle as usize;
            let motion = &mut particles.motions[i];
            let mass = 1.0 / particles.inverse_masses[i];
            let inertia = 1.0 / particles.inverse_inertias[i];
            for (k, prescribed) in prescribed.iter().enumerate() {
                let (now, inert) = if k < 3 {
                    (&mut motion.velocity_m_s[k], mass)
                } else {
                    (&mut motion.spin_rad_s[k - 3], inertia)
                };
                if let Some(prescribed) = prescribed {
                    held.reaction[k] = inert * (prescribed - *now) / kick_s;
                    *now = *prescribed;
                }
            }
        }
    }
}

/// Power of the reactions, W, on the motions before the kick and after it.
pub fn reactions_power_w(supports: &[SetSupport], motions: &[Motion]) -> [f64; 2] {
    let mut power = [0.0; 2];
    for held in supports.iter().flat_map(|support| &support.held) {
        let after = six(&motions[held.particle as usize]);
        for k in 0..6 {
            power[0] += held.reaction[k] * held.before[k];
            power[1] += held.reaction[k] * after[k];
        }
    }
    power
}

/// Velocity and spin of a particle.
fn six(motion: &Motion) -> [f64; 6] {
    let [vx, vy, vz] = motion.velocity_m_s;
    let [wx, wy, wz] = motion.spin_rad_s;
    [vx, vy, vz, wx, wy, wz]
}
