//! When bodies come, go, and become others: what the scene says of regions, replacement, inlets and
//! outlets.

use serde::Serialize;

use super::population::InletProgress;
use super::regions::Region;

/// When a clump becomes a bonded cluster (BPRM: Platzer 2022, section 4.5.4).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trigger {
    /// Its centre of mass is in this region: number in [`Rules::regions`].
    pub enters: Option<usize>,
    /// Contacts push it with more than this together, N.
    pub force_n: Option<f64>,
    /// Contacts have taken more than this from its motion so far, J.
    pub impact_energy_j: Option<f64>,
    /// From this time on, s.
    pub time_s: Option<f64>,
    /// All of these have to be true at once; else one is enough.
    pub needs_all: bool,
}

/// When a cluster becomes a clump again.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Restore {
    /// Its centre of mass is outside of this region: number in [`Rules::regions`].
    pub leaves: usize,
    /// It has so many particles at least.
    pub min_particles: u32,
    /// Its bonds hold less than this per mass, J/kg.
    pub strain_energy_j_kg: f64,
    /// Its particles move against each other more slowly than this, root mean square, m/s.
    pub inner_speed_m_s: f64,
}

/// How fast bodies come.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum Feed {
    /// Bodies per second.
    Number(f64),
    /// kg/s.
    Mass(f64),
}

/// Where bodies come from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Inlet {
    /// Its name in the scene.
    pub name: String,
    /// Templates and their proportions by number, which add up to 1.
    pub templates: Vec<(u32, f64)>,
    /// Where centres of mass are put: number in [`Rules::regions`].
    pub region: usize,
    /// How fast.
    pub feed: Feed,
    /// m/s. Length 3.
    pub velocity_m_s: [f64; 3],
    /// rad/s. Length 3.
    pub spin_rad_s: [f64; 3],
    /// Turned at random, or as the scene's body.
    pub random_orientation: bool,
    /// First and last time, s.
    pub between_s: [f64; 2],
    /// Largest number of bodies.
    pub count: u32,
}

impl Inlet {
    /// Number of bodies that should have come by now and have not: more than one waits for a place.
    pub fn owed(&self, progress: &InletProgress, time_s: f64) -> u32 {
        let [start_s, end_s] = self.between_s;
        let since_s = time_s.min(end_s) - start_s;
        if since_s < 0.0 {
            return 0;
        }
        let per_s = match self.feed {
            Feed::Number(per_s) => per_s,
            Feed::Mass(_) if progress.bodies == 0 => 0.0,
            Feed::Mass(kg_s) => kg_s / progress.mass_kg * f64::from(progress.bodies),
        };
        // The first is due at once, and none at the end.
        let should = if time_s < end_s {
            (since_s * per_s).floor() + 1.0
        } else {
            (since_s * per_s).ceil()
        };
        (should.min(f64::from(self.count)) as u32).saturating_sub(progress.bodies)
    }
}

/// Where bodies go.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outlet {
    /// Its name in the scene.
    pub name: String,
    /// Number in [`Rules::regions`].
    pub region: usize,
    /// What is outside of the region goes; else what is inside.
    pub removes_outside: bool,
}

/// All of it.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Rules {
    /// Regions, in the order of their names.
    pub regions: Vec<Region>,
    /// For each template, when its clumps become clusters. None: never.
    pub triggers: Vec<Option<Trigger>>,
    /// For each template, when clusters that come from it become clumps again. None: never.
    pub restores: Vec<Option<Restore>>,
    /// For each template, whether bodies of it start as bonded clusters; and how they stand.
    pub starts: Vec<Start>,
    /// Inlets, in the order of their names.
    pub inlets: Vec<Inlet>,
    /// Outlets, in the order of their names.
    pub outlets: Vec<Outlet>,
    /// Seed of the scene.
    pub seed: u64,
}

/// How bodies of a template start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Start {
    /// As bonded clusters; else as clumps.
    pub bonded: bool,
    /// How the scene turns the body: unit quaternion x, y, z, w, from the axes of its file to
    /// space.
    pub turned: [f64; 4],
}

impl Rules {
    /// When a fragment of a template that became a clump becomes a cluster: as the body does, but
    /// not by the time, which has come already. None: never.
    pub fn trigger_of_fragment(&self, base: usize) -> Option<Trigger> {
        let trigger = self.triggers.get(base)?.clone()?;
        let asks = trigger.enters.is_some()
            || trigger.force_n.is_some()
            || trigger.impact_energy_j.is_some();
        asks.then_some(Trigger {
            time_s: None,
            ..trigger
        })
    }

    /// Whether there is nothing to be done.
    pub fn are_none(&self) -> bool {
        self.inlets.is_empty()
            && self.outlets.is_empty()
            && self.triggers.iter().all(Option::is_none)
    }
}
