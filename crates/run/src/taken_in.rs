//! The largest energy that particles of a body took in, beside that which replaces them.

use std::collections::BTreeMap;

use dem_io::units::significant;
use serde::{Deserialize, Serialize};

use dem_engine::state::State;
use dem_results::summary::TakenIn;

/// Largest energies that particles took in, by body: for daughters in one impact, or all if they
/// are summed, J/kg; for a trigger by impact energy, J.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Taken {
    daughters_j_kg: BTreeMap<String, f64>,
    trigger_j: BTreeMap<String, f64>,
}

impl Taken {
    /// Reads the clumps.
    pub(super) fn look(&mut self, state: &State) {
        let rules = &state.model.rules;
        let by_energy = |trigger: &Option<dem_engine::state::rules::Trigger>| {
            (trigger.as_ref()).is_some_and(|trigger| trigger.impact_energy_j.is_some())
        };
        if !rules.make_daughters() && !rules.triggers.iter().any(by_energy) {
            return;
        }
        for clump in &state.clumps.all {
            let base = state.base_of(clump.template) as usize;
            let template = state.clumps.template(clump);
            if let Some(rule) = rules.daughters.get(base).and_then(Option::as_ref) {
                let before_j = if rule.sums_impacts {
                    clump.intake.before_j
                } else {
                    0.0
                };
                let specific_j_kg = (before_j + clump.intake.impact_j) / template.mass_kg;
                note(&mut self.daughters_j_kg, &template.body, specific_j_kg);
            }
            if rules.triggers.get(base).is_some_and(by_energy) {
                note(&mut self.trigger_j, &template.body, clump.impact_energy_j);
            }
        }
    }

    /// Records a particle that daughters replaced, and the energy that it had taken in, J/kg.
    pub(super) fn note_broken(&mut self, body: &str, specific_j_kg: f64) {
        note(&mut self.daughters_j_kg, body, specific_j_kg);
    }

    /// For the summary, by body.
    pub(super) fn summary(&self, state: &State) -> BTreeMap<String, TakenIn> {
        let both = self
            .daughters_j_kg
            .iter()
            .filter_map(|(name, largest_j_kg)| {
                let taken = TakenIn {
                    largest_j_kg: *largest_j_kg,
                    needed_j_kg: needed_j_kg(state, name)?,
                };
                Some((name.clone(), taken))
            });
        both.collect()
    }

    /// The end of a sentence about a body whose daughters did not come.
    pub(super) fn instead_of_daughters(&self, body: &str) -> String {
        let largest = self.daughters_j_kg.get(body).copied().unwrap_or(0.0);
        format!(
            "; the largest took in {} J/kg. Under a given motion of walls this rises with the Young's modulus of the materials, so soft ones hide breakage",
            significant(largest, 3)
        )
    }

    /// The same for a trigger by impact energy; empty without one.
    pub(super) fn instead_of_trigger(&self, body: &str) -> String {
        self.trigger_j.get(body).map_or(String::new(), |largest_j| {
            format!(
                "; the largest impact energy was {} J",
                significant(*largest_j, 3)
            )
        })
    }
}

/// Least energy over mass that replaces a particle of a body by daughters, or its median, J/kg.
/// None: daughters never replace it.
pub(super) fn needed_j_kg(state: &State, body: &str) -> Option<f64> {
    let templates = state.clumps.templates.iter();
    let mut rules = templates.zip(&state.model.rules.daughters);
    let (_, rule) = rules.find(|(template, _)| template.body == body)?;
    rule.as_ref().map(|rule| rule.needed_j_kg)
}

fn note(of_body: &mut BTreeMap<String, f64>, body: &str, value: f64) {
    match of_body.get_mut(body) {
        Some(largest) => *largest = largest.max(value),
        None => drop(of_body.insert(body.to_owned(), value)),
    }
}
