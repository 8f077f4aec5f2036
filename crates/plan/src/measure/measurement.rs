//! How a quantity is measured.

use std::collections::BTreeMap;

use dem_engine::state::State;
use dem_engine::state::watches::Recorded;
use dem_io::body::mass::BodyMass;
use dem_scene::{Measure, Scene};

use super::probe::Probe;
use super::view::View;

/// How a quantity is measured, and what is said of its values.
#[derive(Debug)]
pub struct Measurement {
    /// Its name in the list of the scene, the first if it is a vector.
    pub(super) name: &'static str,
    /// Its value in its unit.
    pub(super) read: fn(&Probe, &View<'_>) -> f64,
    /// What is recorded for it in every step, so that it is not read. None: it is read.
    pub recorded: Option<Recorded>,
    /// Whether it needs the initial positions of bodies.
    pub(super) counts_from_start: bool,
    /// Whether it needs to know which particles are bonded together.
    pub(crate) needs_clusters: bool,
    /// Whether its value is expected to settle.
    pub settles: Settles,
    /// What it means that it is 0 throughout.
    pub if_zero: IfZero,
    /// Reason why it has no value, although something is left of what it measures.
    pub(super) missing: fn(&Probe) -> Option<String>,
    /// Problem and remedy of a measure that cannot have a value.
    pub(super) refusal: fn(&Measure, &Planned<'_>) -> Option<(String, &'static str)>,
    /// Reason to doubt it in a scene.
    pub(crate) doubt: fn(&Scene) -> Option<&'static str>,
}

/// Whether a quantity is expected to have a constant value in the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Settles {
    /// No.
    Never,
    /// That of a held body or a servo.
    IfHeld,
    /// Yes.
    Always,
    /// Yes, within some percent: that of a filling or a heap, which may creep.
    Roughly,
}

/// What it means that a quantity is 0 throughout a run.
#[derive(Debug, Clone, Copy)]
pub enum IfZero {
    /// Nothing.
    Fine,
    /// Perhaps that nothing touched what it measures.
    Untouched,
    /// This is doubtful.
    Doubt(fn(&Measure) -> Option<String>),
    /// This is mentioned.
    Note(fn(&Measure) -> Option<String>),
}

/// What is known of a scene before its first step.
pub(super) struct Planned<'a> {
    pub(super) scene: &'a Scene,
    /// Particles of each name.
    pub(super) groups: &'a BTreeMap<String, Vec<u32>>,
    pub(super) state: &'a State,
    /// Masses of the bodies.
    pub(super) masses: &'a BTreeMap<String, BodyMass>,
}

impl Measurement {
    /// The measurement of a quantity of this name.
    pub(super) const fn new(name: &'static str, read: fn(&Probe, &View<'_>) -> f64) -> Self {
        Self {
            name,
            read,
            recorded: None,
            counts_from_start: false,
            needs_clusters: false,
            settles: Settles::Never,
            if_zero: IfZero::Fine,
            missing: |_| None,
            refusal: |_, _| None,
            doubt: |_| None,
        }
    }
}
