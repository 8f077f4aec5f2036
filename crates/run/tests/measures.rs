//! Measures: of entire bodies, clumps or clusters; of contacts; of heaps.

mod bulk;
mod contacts;
mod heap_shapes;
mod heaps;
mod refused;
mod swinging;
mod utilisation;
mod whole;

use std::collections::BTreeMap;

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::bodies::renumber;
use dem_engine::step::{drift, exchange, interact};
use dem_io::Result;
use dem_plan::measure::{Probe, place_watches, probes, read_probes, renumber as renumber_probes};
use dem_plan::{Plan, plan};
use dem_scene::Scene;

use crate::helpers::scene;
use dem_scene::read_bodies;

pub(crate) fn try_plan(scene: &Scene) -> Result<Plan> {
    plan(scene, read_bodies(scene).unwrap(), 1, true)
}

/// A scene under simulation, and its measures.
pub(crate) struct Measured {
    pub(crate) state: State,
    pub(crate) probes: Vec<Probe>,
    bodies: Vec<PlacedBody>,
}

impl Measured {
    pub(crate) fn new(text: &str) -> Self {
        let scene = scene(text);
        let plan = try_plan(&scene).unwrap();
        let probes = probes(&scene, &plan);
        let mut state = plan.state;
        place_watches(&probes, &mut state);
        let bodies = plan.bodies;
        Self {
            state,
            probes,
            bodies,
        }
    }

    /// First half of a step, after which all values can be read.
    pub(crate) fn interact(&mut self) {
        interact(&mut self.state);
    }

    /// Feeding, removal and replacement. Returns whether anything changed.
    pub(crate) fn replace(&mut self) -> bool {
        exchange(&mut self.state);
        if self.state.scratch.events.renumberings.is_empty() {
            return false;
        }
        let renumbered = std::mem::take(&mut self.state.scratch.events.renumberings);
        for by in &renumbered {
            renumber(&mut self.bodies, by);
        }
        renumber_probes(&mut self.probes, &renumbered, &self.bodies, &mut self.state);
        true
    }

    pub(crate) fn advance(&mut self) {
        drift(&mut self.state);
    }

    /// All values by name.
    pub(crate) fn read(&mut self) -> BTreeMap<String, f64> {
        place_all(&self.state.clumps, &mut self.state.particles);
        let balance = balance(&mut self.state);
        let values = read_probes(&mut self.probes, &self.state, &balance);
        let names = self.probes.iter().map(|probe| probe.name.clone());
        names.zip(values).collect()
    }

    /// Steps until this time, s, and reads only there. Returns the results by name.
    pub(crate) fn run(&mut self, end_s: f64) -> BTreeMap<String, f64> {
        loop {
            self.interact();
            if self.state.time_s >= end_s {
                self.read();
                let results = self.probes.iter().map(Probe::result);
                return results.map(|result| (result.name, result.value)).collect();
            }
            self.replace();
            self.advance();
        }
    }
}

#[track_caller]
pub(crate) fn assert_near(value: f64, wanted: f64, off: f64) {
    assert!((value - wanted).abs() <= off, "{value} for {wanted}, {off}");
}
