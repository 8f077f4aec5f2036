//! Measures that the plan recognises as impossible.

use std::collections::BTreeMap;

use dem_io::body::mass::BodyMass;
use dem_io::{Diagnostic, Result};
use dem_scene::Scene;

use super::measurement::{Measurement, Planned};
use dem_engine::state::State;

/// Refuses a force or a contact if nothing can touch, a contact between two groups with common
/// particles, and what each measurement refuses.
pub(crate) fn refuse_valueless(
    scene: &Scene,
    groups: &BTreeMap<String, Vec<u32>>,
    state: &State,
    masses: &BTreeMap<String, BodyMass>,
) -> Result<()> {
    let planned = Planned {
        scene,
        groups,
        state,
        masses,
    };
    for (name, measure) in &scene.measures {
        let refuse = |problem: String, remedy: &str| {
            let place = format!("{}: [measures.{name}]", scene.source);
            Err(Diagnostic::input(place, problem, remedy))
        };
        let (of, measurement) = (&measure.of, Measurement::of(measure));
        if measurement.recorded.is_some() && state.contacts.is_none() {
            return refuse(
                format!(
                    "\"{}\" is of contacts, and nothing can touch",
                    measure.quantity_name()
                ),
                "say in [contacts] how materials meet, or ask for a reaction of supports",
            );
        }
        if let Some((problem, remedy)) = (measurement.refusal)(measure, &planned) {
            return refuse(problem, remedy);
        }
        if let Some(with) = &measure.with
            && let Some(shared) = shared(of, with, scene, groups)
        {
            return refuse(
                format!("\"{of}\" and \"{with}\" share {shared}"),
                "measure the contact of two that have no particle in common",
            );
        }
    }
    Ok(())
}

/// Human-readable description of what two objects of the scene have in common.
fn shared(
    of: &str,
    with: &str,
    scene: &Scene,
    groups: &BTreeMap<String, Vec<u32>>,
) -> Option<String> {
    if of == "all" && !scene.walls.contains_key(with) {
        return Some(format!("all particles of \"{with}\""));
    }
    let [of, with] = [of, with].map(|name| groups.get(name).map_or(&[][..], Vec::as_slice));
    let both = of.iter().filter(|i| with.binary_search(i).is_ok()).count();
    match both {
        0 => None,
        1 => Some("a particle".to_owned()),
        _ => Some(format!("{both} particles")),
    }
}
