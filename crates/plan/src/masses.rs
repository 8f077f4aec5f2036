//! Masses of the bodies of a scene, compared with those of their shapes.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use dem_io::body::About;
use dem_io::body::inertia::MassProperties;
use dem_io::body::mass::{BodyMass, percent_text};
use dem_io::units::significant;
use dem_scene::{Scene, WholeMass};
use nalgebra::{UnitQuaternion, Vector3};

use crate::bodies::material_density_kg_m3;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::clumps::Template;
use dem_engine::state::particles::Particles;
use dem_physics::rotation::numbers;
use dem_physics::rotation::rotation;
use dem_physics::shape::inertia::of_spheres;

/// Smallest difference that is reported, percent.
const WORTH_A_NOTE: f64 = 5.0;
/// Foams aside, no solid is lighter, kg/m3.
pub const LIGHTEST_KG_M3: f64 = 20.0;
/// No solid is heavier, kg/m3.
pub const HEAVIEST_KG_M3: f64 = 23_000.0;

/// Mass of each body of a scene, by name: in its initial state, or as in its file if it comes
/// through an inlet. `about`: information on the bodies.
pub(crate) fn masses(
    scene: &Scene,
    about: &BTreeMap<String, About>,
    templates: &[Arc<Template>],
    bodies: &[PlacedBody],
    particles: &Particles,
) -> BTreeMap<String, BodyMass> {
    let fed = scene.inlets.values().flat_map(|inlet| &inlet.bodies);
    let fed: BTreeSet<&String> = fed.map(|(name, _)| name).collect();
    let of_templates = templates.iter().map(|template| {
        let is_fed = fed.contains(&template.body);
        (&template.body, of_template(scene, template, is_fed))
    });
    let of_bodies = bodies.iter();
    let of_bodies = of_bodies.map(|body| (&body.name, of_particles(body, particles)));
    let mut masses = BTreeMap::new();
    for (name, properties) in of_templates.chain(of_bodies) {
        let (Some(entry), Some(about)) = (scene.bodies.get(name), about.get(name)) else {
            continue;
        };
        let fill = match entry.whole_mass {
            Some(WholeMass::Density(density)) => Some(density),
            _ => material_density_kg_m3(scene, entry, about),
        };
        let mass = BodyMass::new(&properties, fill, about.shape_volume_m3);
        masses.insert(name.clone(), mass);
    }
    masses
}

fn of_template(scene: &Scene, template: &Template, is_fed: bool) -> MassProperties {
    let in_file = MassProperties {
        mass_kg: template.mass_kg,
        centre_m: template.centre_m,
        moments_kg_m2: template.moments_kg_m2,
        axes: template.axes,
    };
    match scene.bodies.get(&template.body).filter(|_| !is_fed) {
        None => in_file,
        Some(entry) => {
            let turn = UnitQuaternion::from_scaled_axis(Vector3::from(entry.rotation_rad));
            let centre = turn * Vector3::from(in_file.centre_m) + Vector3::from(entry.position_m);
            MassProperties {
                centre_m: centre.into(),
                axes: numbers(&(turn * rotation(in_file.axes))),
                ..in_file
            }
        }
    }
}

fn of_particles(body: &PlacedBody, particles: &Particles) -> MassProperties {
    let own = || body.particles.iter().map(|&i| i as usize);
    let centres: Vec<[f64; 3]> = own().map(|i| particles.poses[i].place().into()).collect();
    let inert = own().map(|i| &particles.motions[i]);
    let (masses, inertias): (Vec<f64>, Vec<f64>) = inert
        .map(|motion| (1.0 / motion.inverse_mass, 1.0 / motion.inverse_inertia))
        .unzip();
    of_spheres(&centres, &masses, &inertias)
}

/// Bodies whose mass differs from that of their shape although the scene does not set it: a
/// sentence each.
pub(crate) fn notes(scene: &Scene, masses: &BTreeMap<String, BodyMass>) -> Vec<String> {
    let is_said = |name: &String| (scene.bodies.get(name)).is_some_and(|b| b.whole_mass.is_some());
    let unsaid = masses.iter().filter(|(name, _)| !is_said(name));
    let note = |(name, mass): (&String, &BodyMass)| {
        let percent = mass.difference_percent.filter(|d| d.abs() > WORTH_A_NOTE)?;
        let density = significant(mass.fill_density_kg_m3?, 6);
        Some(format!(
            "body '{name}' weighs {} kg, {} against its shape filled with {density} kg/m3: bodies.{name}.body_density = \"{density} kg/m3\" gives it that mass",
            significant(mass.mass_kg, 4),
            percent_text(percent),
        ))
    };
    unsaid.filter_map(note).collect()
}

/// Densities that are hardly those of a solid in kg/m3, written or by the mass of a body: a
/// sentence
/// each. `bodies`: those of the state.
pub(crate) fn odd_densities(scene: &Scene, state: &State, bodies: &[PlacedBody]) -> Vec<String> {
    let of_materials = scene.materials.iter().filter_map(|(name, material)| {
        Some((format!("materials.{name}.density"), material.density_kg_m3?))
    });
    let of_bodies = scene
        .bodies
        .iter()
        .filter_map(|(name, body)| match body.whole_mass {
            Some(WholeMass::Density(density)) => {
                Some((format!("bodies.{name}.body_density"), density))
            }
            _ => None,
        });
    let written = of_materials.chain(of_bodies);
    let written = written.map(|(key, density)| {
        let is = format!("{key} is {} kg/m3", significant(density, 4));
        (is, density, "1.3 g/cm3 are 1300 kg/m3")
    });
    let by_mass = scene.bodies.iter().filter_map(|(name, body)| {
        let Some(WholeMass::Mass(mass_kg)) = body.whole_mass else {
            return None;
        };
        let density = sphere_density_kg_m3(name, state, bodies)?;
        let is = format!(
            "bodies.{name}.mass is {} kg, which gives its spheres {} kg/m3",
            significant(mass_kg, 4),
            significant(density, 4)
        );
        Some((is, density, "check its unit, a number alone is in kg"))
    });
    let sentence = |(is, density, remedy): (String, f64, &str)| {
        if density < LIGHTEST_KG_M3 {
            Some(format!(
                "{is}, less than that of any solid but foam: {remedy}"
            ))
        } else if density > HEAVIEST_KG_M3 {
            Some(format!(
                "{is}, more than the 22600 kg/m3 of the heaviest solid: {remedy}"
            ))
        } else {
            None
        }
    };
    written.chain(by_mass).filter_map(sentence).collect()
}

/// Density of the spheres of a body, kg/m3. None: it is not in the state.
pub(crate) fn sphere_density_kg_m3(
    name: &str,
    state: &State,
    bodies: &[PlacedBody],
) -> Option<f64> {
    let templates = &state.clumps.templates;
    if let Some(template) = templates.iter().find(|template| template.body == name) {
        return Some(template.sphere_density_kg_m3());
    }
    let body = bodies.iter().find(|body| body.name == name)?;
    Some(
        state
            .particles
            .density_kg_m3(*body.particles.first()? as usize),
    )
}
