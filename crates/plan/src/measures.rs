//! Measures that the plan recognises as impossible.

use std::collections::BTreeMap;

use dem_io::body::mass::BodyMass;
use dem_io::{Diagnostic, Result};
use dem_scene::{ALL, Measure, Quantity, Scene};

use dem_engine::state::State;

/// Smallest number of particles for which an angle of repose has a meaning.
pub(crate) const FEWEST_IN_HEAP: usize = 50;
/// Smallest number of cells with something in them for which a mixing index has a meaning.
pub(crate) const FEWEST_MIXED_CELLS: usize = 10;

/// Refuses a force or a contact if nothing can touch, a contact between two groups with common
/// particles, a slope of a heap of few particles, bulking of what has no shape, and broken bonds
/// of a group whose particles can leave.
///
/// # Errors
/// Names the measure.
pub(super) fn refuse_valueless(
    scene: &Scene,
    groups: &BTreeMap<String, Vec<u32>>,
    state: &State,
    masses: &BTreeMap<String, BodyMass>,
) -> Result<()> {
    for (name, measure) in &scene.measures {
        let refuse = |problem: String, remedy: &str| {
            let place = format!("{}: [measures.{name}]", scene.source);
            Err(Diagnostic::input(place, problem, remedy))
        };
        let (of, quantity) = (&measure.of, measure.quantity);
        let is_force = matches!(quantity, Quantity::Force(_) | Quantity::ForceMagnitude);
        if (is_force || quantity.is_of_contact()) && state.contacts.is_none() {
            return refuse(
                format!(
                    "\"{}\" is of contacts, and nothing can touch",
                    quantity.name()
                ),
                "say in [contacts] how materials meet, or ask for a reaction of supports",
            );
        }
        let has_shape = || {
            masses
                .get(of)
                .is_some_and(|mass| mass.solid_density_kg_m3.is_some())
        };
        if quantity == Quantity::BulkingFactor && !has_shape() {
            return refuse(
                format!("\"{of}\" is no body with a shape of known volume"),
                "name one body in \"of\", whose file says its shape_volume_m3 (a .vtp of dem-pack)",
            );
        }
        if quantity == Quantity::BrokenBonds && loses_bonds(scene) && is_group(of, scene) {
            return refuse(
                format!(
                    "\"{of}\" is a group, which forgets particles that leave or become rigid, and their broken bonds"
                ),
                "name a body in \"of\", or all",
            );
        }
        if let Some(with) = &measure.with
            && let Some(shared) = shared(of, with, scene, groups)
        {
            return refuse(
                format!("\"{of}\" and \"{with}\" share {shared}"),
                "measure the contact of two that have no particle in common",
            );
        }
        if let Some(count) = few(measure, scene, groups, state) {
            return refuse(
                format!(
                    "an angle of repose needs {FEWEST_IN_HEAP} particles or more, and \"{of}\" has {count}"
                ),
                "name a larger heap, or ask for a position",
            );
        }
    }
    Ok(())
}

/// Whether bonds of this scene are removed while it runs.
fn loses_bonds(scene: &Scene) -> bool {
    let mut rules = scene.replacement.values();
    !scene.outlets.is_empty() || rules.any(|rule| rule.restore.is_some())
}

fn is_group(of: &str, scene: &Scene) -> bool {
    of != ALL && !scene.bodies.contains_key(of)
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

/// Number of particles of a measure of slope, if they are too few and no more can be added.
fn few(
    measure: &Measure,
    scene: &Scene,
    groups: &BTreeMap<String, Vec<u32>>,
    state: &State,
) -> Option<usize> {
    if measure.quantity != Quantity::AngleOfRepose {
        return None;
    }
    let of = &measure.of;
    let means = |name: &String| of == "all" || name == of;
    let mut fed = scene.inlets.values().flat_map(|inlet| &inlet.bodies);
    if fed.any(|(name, _)| means(name)) {
        return None;
    }
    let standing = groups.get(of).map_or(0, Vec::len);
    let clumps = state.clumps.templates.iter();
    let clumps = clumps.filter(|template| means(&template.body));
    let count = standing + clumps.map(|template| template.spheres.len()).sum::<usize>();
    (count < FEWEST_IN_HEAP).then_some(count)
}
