//! Supports: degrees of freedom that are fixed or have a prescribed motion.

use dem_scene::{Factor, Hold};
use serde::{Deserialize, Serialize};

use super::renumbered::{NewNumbers, Renumbered};

/// A support on some particles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupSupport {
    /// Along x, y, z, then about x, y, z; None: free. Length 6.
    pub holds: [Option<Hold>; 6],
    /// Course over time.
    pub factor: Factor,
    /// The particles.
    pub held: Vec<HeldParticle>,
    /// Time from which on the degrees of freedom are free, s; infinite: never.
    pub end_s: f64,
}

/// Action of a support at a kick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SupportPhase {
    /// Holds the degrees of freedom in the next step.
    Holds,
    /// Held them in the previous step and releases them now.
    LetsGo,
    /// Released them before.
    Over,
}

impl GroupSupport {
    /// Its action at the kick at `time_s` between the previous step and the next, `steps_s`: it
    /// holds in the steps whose middle is before its end.
    pub fn phase(&self, time_s: f64, [before_s, after_s]: [f64; 2]) -> SupportPhase {
        // The kicks before and after a step use the same numbers, so they agree to the bit.
        let holds = |until_s: f64, step_s: f64| until_s - 0.5 * step_s < self.end_s;
        match [holds(time_s, before_s), holds(time_s + after_s, after_s)] {
            [_, true] => SupportPhase::Holds,
            [true, false] => SupportPhase::LetsGo,
            [false, false] => SupportPhase::Over,
        }
    }
}

/// A held particle, in the step of the last kick.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct HeldParticle {
    /// Its number.
    pub particle: u32,
    /// Velocity and spin before the kick. Length 6.
    pub before: [f64; 6],
    /// Reactions of the support in the half steps before and after the kick, N and N m: the first
    /// is that at the time of the poses; they differ if a bond of the particle has just broken.
    /// Length 6 each.
    pub reactions: [[f64; 6]; 2],
}

impl Renumbered for GroupSupport {
    fn renumber(&mut self, by: &NewNumbers<'_>) {
        self.held.retain_mut(|held| {
            let now = by.of(held.particle);
            held.particle = now.unwrap_or(held.particle);
            now.is_some()
        });
    }
}
