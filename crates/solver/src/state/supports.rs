//! Supports: degrees of freedom that are held or moved as prescribed.

use dem_scene::{Factor, Hold};
use serde::{Deserialize, Serialize};

/// A support on some particles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupSupport {
    /// Along x, y, z, then about x, y, z; None: free. Length 6.
    pub holds: [Option<Hold>; 6],
    /// Over time.
    pub factor: Factor,
    /// The particles.
    pub held: Vec<HeldParticle>,
    /// From this time on the freedoms are free, s; infinite: never.
    pub end_s: f64,
}

/// What a support does at a kick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SupportPhase {
    /// Holds the freedoms in the step to come.
    Holds,
    /// Held them in the step before and holds them no more.
    LetsGo,
    /// Has let go of them before.
    Over,
}

impl GroupSupport {
    /// What it does at the kick at `time_s` between the step before and the one to come, `steps_s`:
    /// it holds in the steps whose middle comes before its end.
    pub fn phase(&self, time_s: f64, [before_s, after_s]: [f64; 2]) -> SupportPhase {
        // Both kicks beside a step reckon with the same numbers, so they agree to the bit.
        let holds = |until_s: f64, step_s: f64| until_s - 0.5 * step_s < self.end_s;
        match [holds(time_s, before_s), holds(time_s + after_s, after_s)] {
            [_, true] => SupportPhase::Holds,
            [true, false] => SupportPhase::LetsGo,
            [false, false] => SupportPhase::Over,
        }
    }
}

/// A particle that is held, in the step that was kicked last.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct HeldParticle {
    /// Which.
    pub particle: u32,
    /// Velocity and spin before the kick. Length 6.
    pub before: [f64; 6],
    /// What the support exerts in the half steps before and after the kick, N and N m: the first is
    /// that at the time of the poses; they differ where a bond of the particle has just broken.
    /// Length 6 each.
    pub reactions: [[f64; 6]; 2],
}
