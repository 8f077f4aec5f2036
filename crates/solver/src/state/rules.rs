//! When bodies come, go, and become others: what the scene says of regions, replacement, inlets and
//! outlets, and how far that has come.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::regions::Region;

/// When a clump becomes a bonded cluster (BPRM: Platzer 2022, section 4.5.4).
#[derive(Debug, Clone, PartialEq)]
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
#[derive(Debug, Clone, Copy, PartialEq)]
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Feed {
    /// Bodies per second.
    Number(f64),
    /// kg/s.
    Mass(f64),
}

/// Where bodies come from.
#[derive(Debug, Clone, PartialEq)]
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
    /// How far it has come.
    pub progress: InletProgress,
}

impl Inlet {
    /// Number of bodies that should have come by now and have not: more than one waits for a place.
    pub fn owed(&self, time_s: f64) -> u32 {
        let [start_s, end_s] = self.between_s;
        let since_s = time_s.min(end_s) - start_s;
        if since_s < 0.0 {
            return 0;
        }
        let per_s = match self.feed {
            Feed::Number(per_s) => per_s,
            Feed::Mass(_) if self.progress.bodies == 0 => 0.0,
            Feed::Mass(kg_s) => kg_s / self.progress.mass_kg * f64::from(self.progress.bodies),
        };
        // The first is due at once, and none at the end.
        let should = if time_s < end_s {
            (since_s * per_s).floor() + 1.0
        } else {
            (since_s * per_s).ceil()
        };
        (should.min(f64::from(self.count)) as u32).saturating_sub(self.progress.bodies)
    }
}

/// How far an inlet has come.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct InletProgress {
    /// Bodies that have come.
    pub bodies: u32,
    /// Their mass, kg.
    pub mass_kg: f64,
    /// Places that were looked at for the next body and were taken.
    pub tries: u32,
    /// Step at which a place is looked for again.
    pub next_try: u64,
    /// Bodies that had to wait for a place.
    pub delayed: u32,
}

/// Where bodies go.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlet {
    /// Its name in the scene.
    pub name: String,
    /// Number in [`Rules::regions`].
    pub region: usize,
    /// What is outside of the region goes; else what is inside.
    pub removes_outside: bool,
    /// Bodies and fragments that it has removed.
    pub removed: OutletTotals,
}

/// What an outlet has removed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct OutletTotals {
    /// Bodies and fragments.
    pub bodies: u32,
    /// Their mass, kg.
    pub mass_kg: f64,
}

/// All of it.
#[derive(Debug, Clone, Default)]
pub struct Rules {
    /// Regions, in the order of their names.
    pub regions: Vec<Region>,
    /// For each template, when its clumps become clusters. None: never.
    pub triggers: Vec<Option<Trigger>>,
    /// For each template of the scene, when clusters that come from it become clumps again. None:
    /// never.
    pub restores: Vec<Option<Restore>>,
    /// For each cluster that was a clump, the template of the scene that it comes from, and its
    /// [instance](super::clumps::Clump::instance).
    pub base_of_cluster: BTreeMap<u32, (u32, u32)>,
    /// For each template that is a fragment, after those of the scene: the template of the scene
    /// that it comes from.
    pub base_of_fragment: Vec<u32>,
    /// Clusters that became clumps again so far.
    pub restored: u32,
    /// For each template, whether bodies of it start as bonded clusters; and how they stand.
    pub starts: Vec<Start>,
    /// Inlets, in the order of their names.
    pub inlets: Vec<Inlet>,
    /// Outlets, in the order of their names.
    pub outlets: Vec<Outlet>,
    /// Seed of the scene.
    pub seed: u64,
    /// Bodies that came so far through inlets.
    pub instances: u32,
    /// Clumps that have become clusters so far.
    pub replaced: u32,
    /// Bonds that were there times steps, and those that were left out because their bodies were
    /// clumps.
    pub bond_steps: [u64; 2],
}

/// How bodies of a template start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// As bonded clusters; else as clumps.
    pub bonded: bool,
    /// How the scene turns the body: unit quaternion x, y, z, w, from the axes of its file to
    /// space.
    pub turned: [f64; 4],
}

impl Rules {
    /// Takes a new template of a fragment of the template `base` of the scene. It is replaced as
    /// that is, but not by the time, which has come already.
    pub fn add_fragment(&mut self, base: usize) {
        let trigger = self.triggers[base].clone().map(|trigger| Trigger {
            time_s: None,
            ..trigger
        });
        let asks =
            |t: &Trigger| t.enters.is_some() || t.force_n.is_some() || t.impact_energy_j.is_some();
        self.triggers.push(trigger.filter(asks));
        self.starts.push(Start {
            bonded: false,
            turned: [0.0, 0.0, 0.0, 1.0],
        });
        self.base_of_fragment.push(base as u32);
    }

    /// The template of the scene that a template comes from.
    pub fn base(&self, template: u32) -> u32 {
        let of_scene = self.restores.len() as u32;
        match template.checked_sub(of_scene) {
            Some(fragment) => self.base_of_fragment[fragment as usize],
            None => template,
        }
    }

    /// Whether there is anything to be done.
    pub fn are_none(&self) -> bool {
        self.inlets.is_empty()
            && self.outlets.is_empty()
            && self.triggers.iter().all(Option::is_none)
    }
}
