//! Bodies that bounce otherwise once clusters have replaced their clumps.

use dem_io::units::significant;
use dem_scene::Scene;

use dem_engine::state::State;
use dem_engine::state::clumps::Template;
use dem_physics::contact::restitution::{damping_ratio, restitution};

/// Difference of two restitutions from which it is said.
const SMALLEST_DIFFERENCE: f64 = 0.1;

/// Restitution of a body whose contacts are damped for one of `layers` equal parts of the mass that
/// they stop: the damping ratio is smaller by the root. Its bonds are much stiffer than the
/// contacts.
pub fn bonded_restitution(of_contact: f64, layers: f64) -> f64 {
    restitution(damping_ratio(of_contact) / layers.sqrt())
}

/// The mass of a body over that of the spheres with which it lands flat.
fn layers(template: &Template) -> f64 {
    let masses = template.outer.iter();
    let masses = masses.map(|&n| template.spheres[n as usize].mass_kg);
    let mean_kg = masses.sum::<f64>() / template.outer.len() as f64;
    template.mass_kg / (mean_kg * f64::from(template.landing().together.max(1)))
}

/// A sentence for each body that lands on a face at another part of its speed as a clump than as
/// the cluster that replaces it.
pub(super) fn notes(scene: &Scene, state: &State) -> Vec<String> {
    let replaced = state.clumps.templates.iter();
    let replaced = replaced.filter(|template| {
        let rule = scene.replacement.get(&template.body);
        !template.bonds.is_empty() && rule.is_some_and(|rule| !rule.breaks_whole())
    });
    let mut notes: Vec<String> = Vec::new();
    for template in replaced {
        let Some(material) = scene.materials.keys().nth(template.material.into()) else {
            continue;
        };
        let is_there = |name: &String| {
            scene.walls.values().any(|wall| wall.material == *name)
                || scene.bodies.values().any(|body| body.material == *name)
        };
        let own = scene.contacts.iter();
        let own = own.filter(|contact| contact.materials.contains(material));
        let own = own.filter(|contact| contact.materials.iter().all(is_there));
        let least = own
            .map(|contact| contact.restitution)
            .min_by(f64::total_cmp);
        let Some(rigid) = least else { continue };
        let layers = layers(template);
        let bonded = bonded_restitution(rigid, layers);
        if bonded - rigid < SMALLEST_DIFFERENCE {
            continue;
        }
        let note = format!(
            "body '{}' rebounds from a flat landing at {} of its speed as a clump, and at about {} as the cluster that replaces it: contacts of bonded spheres are damped for the mass of one sphere, and each stops that of {} (doc/inside/contacts.md, Contacts of clumps)",
            template.body,
            significant(rigid, 2),
            significant(bonded, 2),
            significant(layers, 2),
        );
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    notes
}
