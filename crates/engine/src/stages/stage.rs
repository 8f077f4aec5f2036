//! Description of a stage of the step. Each stage is declared at the top of its own file; their
//! order is in `step.rs`.

use dem_scene::Scene;

use crate::state::State;

/// A stage of the step.
#[derive(Debug, Clone, Copy)]
pub struct Stage {
    /// Name in reports.
    pub name: &'static str,
    /// The stage whose time includes that of this one: this one is done there, for some of the same
    /// items.
    pub within: Option<&'static str>,
    /// Whether a planned scene needs it, and the reason.
    pub need: fn(&State, &Scene) -> Need,
    /// Bytes of the arrays that only this stage needs, at their present size.
    pub bytes: fn(&State) -> usize,
    /// The saving if a state leaves it out. None: it depends on what the bodies would do.
    pub saving: fn(&State) -> Option<Saving>,
}

impl PartialEq for Stage {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Stage {
    /// A stage that stands alone, has no arrays of its own, and whose saving is not known.
    pub const fn new(name: &'static str, need: fn(&State, &Scene) -> Need) -> Self {
        Self {
            name,
            within: None,
            need,
            bytes: |_| 0,
            saving: |_| None,
        }
    }
}

/// Whether a scene needs a stage.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Need {
    /// Needed, for this reason.
    Needed(String),
    /// Not needed, for this reason.
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

/// Cost of a skipped stage if the scene needed it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saving {
    /// Bytes of its arrays.
    pub bytes: usize,
    /// Time per step on one thread, ns, from its cost per item on the machine of
    /// doc/inside/leave-out.md.
    pub ns: f64,
}

impl Saving {
    /// The saving for this number of items, each with these bytes and this time, ns. None: there
    /// are no items.
    pub fn of(items: usize, bytes: usize, ns: f64) -> Option<Self> {
        (items > 0).then(|| Self {
            bytes: items * bytes,
            ns: items as f64 * ns,
        })
    }
}
