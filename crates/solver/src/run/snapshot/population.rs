//! What a checkpoint holds of a scene in which bodies come, go, and become others: all particles,
//! bonds, clumps and bodies, as no plan knows them.

use std::collections::BTreeMap;
use std::sync::Arc;

use dem_io::{Diagnostic, Result};
use serde::{Deserialize, Serialize};

use crate::state::State;
use crate::state::bodies::PlacedBody;
use crate::state::bonds::Bonds;
use crate::state::clumps::{Clump, Template};
use crate::state::particles::{Motion, Particles, Pose, Wrench};
use crate::state::partitions::divide;
use crate::state::rules::{InletProgress, OutletTotals};

/// Everything that is there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Population {
    poses: Vec<Pose>,
    motions: Vec<Motion>,
    free: usize,
    bonds: Bonds,
    clumps: Vec<Clump>,
    near: Vec<u32>,
    /// Templates of fragments, and the templates of the scene that they come from.
    fragments: Vec<(Template, u32)>,
    base_of_cluster: BTreeMap<u32, (u32, u32)>,
    restored: u32,
    bodies: Vec<PlacedBody>,
    materials: Vec<u8>,
    lost_by_gone_j: [f64; 2],
    inlets: Vec<InletProgress>,
    outlets: Vec<OutletTotals>,
    instances: u32,
    replaced: u32,
    bond_steps: [u64; 2],
}

impl Population {
    /// None where the plan knows all.
    pub(super) fn taken(state: &State, bodies: &[PlacedBody]) -> Option<Self> {
        if state.clumps.templates.is_empty() && state.rules.are_none() {
            return None;
        }
        let contacts = state.contacts.as_ref();
        Some(Self {
            poses: state.particles.poses.clone(),
            motions: state.particles.motions.clone(),
            free: state.particles.free,
            bonds: Bonds {
                rules: Vec::new(),
                ..state.bonds.clone()
            },
            clumps: state.clumps.all.clone(),
            near: state.clumps.near.clone(),
            fragments: (state.rules.base_of_fragment.iter())
                .zip(&state.clumps.templates[state.rules.restores.len()..])
                .map(|(base, template)| ((**template).clone(), *base))
                .collect(),
            base_of_cluster: state.rules.base_of_cluster.clone(),
            restored: state.rules.restored,
            bodies: bodies.to_vec(),
            materials: contacts.map_or(Vec::new(), |c| c.materials.clone()),
            lost_by_gone_j: contacts.map_or([0.0; 2], |c| c.lost_by_gone_j),
            inlets: state
                .rules
                .inlets
                .iter()
                .map(|inlet| inlet.progress)
                .collect(),
            outlets: state
                .rules
                .outlets
                .iter()
                .map(|outlet| outlet.removed)
                .collect(),
            instances: state.rules.instances,
            replaced: state.rules.replaced,
            bond_steps: state.rules.bond_steps,
        })
    }

    /// Puts it into a state that has been planned from the same scene. Contacts and clusters are
    /// put back by others, after this.
    ///
    /// # Errors
    /// The scene has other templates, inlets or outlets.
    pub(super) fn restore(&self, state: &mut State, bodies: &mut Vec<PlacedBody>) -> Result<()> {
        let count = self.poses.len();
        let rules = state.bonds.rules.len();
        let templates = state.clumps.templates.len() + self.fragments.len();
        let fits = self.motions.len() == count
            && self.free <= count
            && self.inlets.len() == state.rules.inlets.len()
            && self.outlets.len() == state.rules.outlets.len()
            && (self.clumps.iter()).all(|clump| (clump.template as usize) < templates)
            && (self.fragments.iter())
                .all(|(_, base)| (*base as usize) < state.clumps.templates.len())
            && (self.bonds.ends.iter().flatten()).all(|&end| (end as usize) < self.free)
            && self.bonds.rule_runs.iter().all(|&(_, rule)| rule < rules);
        if !fits {
            return Err(Diagnostic::input(
                "",
                "this checkpoint belongs to a run with other bodies, inlets or outlets than the scene has now",
                "give the scene and the bodies that the run began with, or start again without --resume",
            ));
        }
        state.particles = Particles {
            poses: self.poses.clone(),
            motions: self.motions.clone(),
            wrenches: vec![Wrench::default(); count],
            free: self.free,
            asleep: Vec::new(),
        };
        let rules = std::mem::take(&mut state.bonds.rules);
        state.bonds = Bonds {
            rules,
            ..self.bonds.clone()
        };
        state.clumps.all.clone_from(&self.clumps);
        state.clumps.near.clone_from(&self.near);
        for (template, base) in &self.fragments {
            let mut template = template.clone();
            template.bonds.rules.clone_from(&state.bonds.rules);
            state.clumps.templates.push(Arc::new(template));
            state.rules.add_fragment(*base as usize);
        }
        state
            .rules
            .base_of_cluster
            .clone_from(&self.base_of_cluster);
        state.rules.restored = self.restored;
        state.partitions = divide(&state.bonds, self.free, state.threads);
        let damped = state.bonds.rules.iter().any(|rule| rule.damped);
        state.bond_resistance = if damped {
            vec![Wrench::default(); self.free]
        } else {
            Vec::new()
        };
        if let Some(contacts) = &mut state.contacts {
            contacts.materials.clone_from(&self.materials);
            contacts.lost_by_gone_j = self.lost_by_gone_j;
            contacts.lost_j = vec![[0.0; 2]; count];
        }
        for (inlet, come) in state.rules.inlets.iter_mut().zip(&self.inlets) {
            inlet.progress = *come;
        }
        for (outlet, gone) in state.rules.outlets.iter_mut().zip(&self.outlets) {
            outlet.removed = *gone;
        }
        state.rules.instances = self.instances;
        state.rules.replaced = self.replaced;
        state.rules.bond_steps = self.bond_steps;
        bodies.clone_from(&self.bodies);
        Ok(())
    }
}
