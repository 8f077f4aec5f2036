//! What a stage of the step says of itself. Each stands at the top of its own file; the order in
//! which they are done stands in `step.rs`.

use dem_scene::Scene;

use crate::state::State;

/// A stage of the step.
#[derive(Debug, Clone, Copy)]
pub struct Stage {
    /// As it stands in reports.
    pub name: &'static str,
    /// The stage in whose time its own is: it is done there, for some of the same items.
    pub within: Option<&'static str>,
    /// Whether a planned scene needs it, and why.
    pub need: fn(&State, &Scene) -> Need,
    /// Bytes of the arrays that it alone needs, as they are filled now.
    pub bytes: fn(&State) -> usize,
    /// What leaving it out of a state saves. None: it depends on what the bodies would do.
    pub saving: fn(&State) -> Option<Saving>,
}

impl PartialEq for Stage {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// Of stages whose cost depends on what the bodies would do.
pub const NO_SAVING: fn(&State) -> Option<Saving> = |_| None;

/// Whether a scene needs a stage.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Need {
    /// It does, for this reason.
    Needed(String),
    /// It does not, for this reason.
    LeftOut(&'static str),
}

impl Need {
    /// Needed or not, each with its reason.
    pub fn of(needed: bool, why: impl FnOnce() -> String, why_not: &'static str) -> Self {
        if needed {
            Self::Needed(why())
        } else {
            Self::LeftOut(why_not)
        }
    }
}

/// What a stage that is left out would take if the scene asked for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saving {
    /// Bytes of its arrays.
    pub bytes: usize,
    /// ns per step on one thread, by what its items take on the machine of doc/leave-out.md.
    pub ns: f64,
}

impl Saving {
    /// Of so many items, each with these bytes and this time, ns. None: there are no items.
    pub fn of(items: usize, bytes: usize, ns: f64) -> Option<Self> {
        (items > 0).then(|| Self {
            bytes: items * bytes,
            ns: items as f64 * ns,
        })
    }
}
