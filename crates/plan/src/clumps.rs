//! Templates of rigid clumps, from the bodies of a scene, and the clumps that exist at the start.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use dem_io::{Body, Diagnostic, Result};
use dem_scene::{BodyEntry, ClumpMass, Scene, StartAs};
use nalgebra::{UnitQuaternion, Vector3};

use super::bodies::{place_body, stays_rigid};
use super::contacts::Kinds;
use dem_engine::stages::population::inlets::angular_momentum;
use dem_engine::state::bonds::Bonds;
use dem_engine::state::clumps::{
    Clump, Scatter, Template, breaks_from_n_m, reach_m, slender_body, sub_spheres,
};
use dem_engine::state::particles::Particles;
use dem_physics::rotation::numbers;
use dem_physics::rotation::rotation;
use dem_physics::shape::inertia::{of_spheres, of_union};
use dem_physics::shape::outer_layer::{FRACTION_OF_SMALLEST, HIDDEN, outer_layer};

/// Names of the bodies that are templates: those that start as clumps, come through inlets, or are
/// daughters.
pub(super) fn templates_of(scene: &Scene) -> BTreeSet<String> {
    let clumps = scene.bodies.iter();
    let clumps = clumps.filter(|(_, entry)| matches!(entry.start_as, StartAs::Clump(_)));
    let by_inlets = scene.inlets.values().flat_map(|inlet| &inlet.bodies);
    let daughters = scene
        .bodies
        .keys()
        .filter(|name| scene.parent_of(name).is_some());
    clumps
        .map(|(name, _)| name.clone())
        .chain(by_inlets.map(|(name, _)| name.clone()))
        .chain(daughters.cloned())
        .collect()
}

/// Bodies with bonds that always stay rigid clumps, and the number of their bonds.
pub(super) fn unused_bonds(scene: &Scene, read: &BTreeMap<String, Body>) -> Vec<(String, usize)> {
    let with_bonds = read.iter().map(|(name, body)| (name, body.bonds.len()));
    with_bonds
        .filter(|(name, bonds)| *bonds > 0 && stays_rigid(scene, name))
        .map(|(name, bonds)| (name.clone(), bonds))
        .collect()
}

/// Templates, in the order of their names, from bodies that have been read. `ball_m`: see
/// [`ball_m`].
pub(super) fn templates(
    scene: &Scene,
    names: &BTreeSet<String>,
    read: &mut BTreeMap<String, Body>,
    ball_m: f64,
) -> Result<Vec<Arc<Template>>> {
    let mut templates: Vec<Arc<Template>> = Vec::new();
    for name in names {
        if let Some(body) = read.remove(name) {
            let mut template = template(scene, name, &body)?;
            // Bodies from the same file share their arrays and the result of the search for outer
            // spheres, which takes longest.
            let same = |other: &&Arc<Template>| {
                other.scale == template.scale && other.spheres == template.spheres
            };
            if let Some(other) = templates.iter().rev().find(same) {
                template.share(other);
                template.outer = Arc::clone(&other.outer);
            } else {
                template.outer = Arc::new(outer(&template, ball_m));
            }
            templates.push(Arc::new(template));
        }
    }
    Ok(templates)
}

/// Radius, m, of a ball that fits everything that clumps can touch at the point of contact: see
/// [`outer_layer`]. 0 if the scene has walls of triangles, whose edges may be arbitrarily sharp.
pub(super) fn ball_m(scene: &Scene, read: &BTreeMap<String, Body>) -> f64 {
    let radii = read.values().flat_map(|body| &body.radii).copied();
    let smallest_m = radii.fold(f64::INFINITY, f64::min);
    let smallest_m = smallest_m.min(smallest_daughter_m(scene, read));
    let of_walls_m = scene.walls.values().map(|wall| wall.shape.inner_radius_m());
    of_walls_m.fold(FRACTION_OF_SMALLEST * smallest_m, f64::min)
}

/// Radius of the smallest daughter of a daughter that is replaced in turn, m: volumes of daughters
/// add up to that of what they replace.
fn smallest_daughter_m(scene: &Scene, read: &BTreeMap<String, Body>) -> f64 {
    let by_law = scene.replacement.values().filter_map(|rule| rule.breakage);
    let by_law = by_law.map(|breakage| 0.5 * breakage.smallest_size_m);
    let rules = scene.replacement.values();
    let daughters = rules.filter_map(|rule| rule.daughters.as_ref());
    let radii = daughters.flat_map(|daughters| {
        let classes = daughters.classes.iter();
        let bodies = classes.filter_map(|class| read.get(&class.body));
        bodies.filter_map(|body| {
            let volume: f64 = body.radii.iter().map(|radius| radius.powi(3)).sum();
            let smallest_m = body.radii.iter().copied().fold(f64::INFINITY, f64::min);
            Some(smallest_m * daughters.smallest_size_m? / (2.0 * volume.cbrt()))
        })
    });
    radii.chain(by_law).fold(f64::INFINITY, f64::min)
}

/// The spheres of a template that something in the scene can touch.
fn outer(template: &Template, ball_m: f64) -> Vec<u32> {
    let spheres = template.spheres.iter();
    let (centres, touching): (Vec<[f64; 3]>, Vec<f64>) = spheres
        .map(|sphere| (sphere.place_m, template.scale * sphere.radius_m))
        .unzip();
    outer_layer(&centres, &touching, HIDDEN, ball_m)
}

/// A template without its outer spheres.
pub(super) fn template(scene: &Scene, name: &str, body: &Body) -> Result<Template> {
    let entry = &scene.bodies[name];
    // In the axes of its file: each clump has its own position and orientation.
    let in_file = BodyEntry {
        position_m: [0.0; 3],
        rotation_rad: [0.0; 3],
        velocity_m_s: [0.0; 3],
        angular_velocity_rad_s: [0.0; 3],
        ..entry.clone()
    };
    let (mut particles, mut bonds) = (Particles::default(), Bonds::default());
    let placed = place_body(scene, name, &in_file, body, &mut particles, &mut bonds)?;
    let centres: Vec<[f64; 3]> = particles.poses.iter().map(|p| p.place().into()).collect();
    let radii: Vec<f64> = particles
        .poses
        .iter()
        .map(dem_engine::state::particles::Pose::radius_m)
        .collect();
    let masses: Vec<f64> = particles
        .motions
        .iter()
        .map(|m| 1.0 / m.inverse_mass)
        .collect();
    let inertias: Vec<f64> = particles
        .motions
        .iter()
        .map(|m| 1.0 / m.inverse_inertia)
        .collect();
    let settings = match entry.start_as {
        StartAs::Clump(settings) => settings,
        StartAs::Bonded => Default::default(),
    };
    let properties = match settings.mass {
        ClumpMass::Spheres => of_spheres(&centres, &masses, &inertias),
        ClumpMass::Union => of_union(&centres, &radii, particles.density_kg_m3(0)),
    };
    let spheres = sub_spheres(particles.poses.iter().zip(&particles.motions), &properties);
    let mut file_number = vec![0; spheres.len()];
    for (number, &i) in (0..).zip(&placed.particles) {
        file_number[i as usize] = number;
    }
    let modulus = entry
        .bond_kind
        .as_ref()
        .and_then(|kind| scene.bonds[kind].failure.weibull_modulus);
    // Each body has its own factors.
    bonds.forget_scatter();
    Ok(Template {
        body: name.to_owned(),
        mass_kg: properties.mass_kg,
        moments_kg_m2: properties.moments_kg_m2,
        axes: properties.axes,
        centre_m: properties.centre_m,
        reach_m: reach_m(&spheres),
        outer: Arc::default(),
        scale: settings.scale,
        material: scene
            .materials
            .keys()
            .position(|material| *material == entry.material)
            .unwrap_or(0) as u8,
        breaks_from_n_m: breaks_from_n_m(&bonds, &spheres),
        slender: slender_body(
            &bonds,
            &spheres,
            (properties.mass_kg, properties.moments_kg_m2),
        ),
        bonds: Arc::new(bonds),
        file_number: Arc::new(file_number),
        ids: Vec::new(),
        scatter: modulus.map(|modulus| Scatter {
            seed: scene.run.seed,
            modulus,
        }),
        bonds_of_file: Arc::new(placed.bonds),
        landing: Default::default(),
        spheres: Arc::new(spheres),
    })
}

/// Clumps that exist at the start: bodies that start as clumps, do not come through an inlet, and
/// are no daughters.
pub(super) fn standing(scene: &Scene, templates: &[Arc<Template>]) -> Vec<Clump> {
    let by_inlets = scene.inlets.values();
    let by_inlets = by_inlets.flat_map(|inlet| inlet.bodies.iter().map(|(name, _)| name));
    let by_inlets: BTreeSet<&String> = by_inlets.collect();
    let comes_later = |name: &String| by_inlets.contains(name) || scene.parent_of(name).is_some();
    (0..)
        .zip(templates)
        .filter(|(_, template)| !comes_later(&template.body))
        .map(|(number, template)| {
            let entry = &scene.bodies[&template.body];
            let as_file = UnitQuaternion::from_scaled_axis(Vector3::from(entry.rotation_rad));
            let turned = numbers(&(as_file * rotation(template.axes)));
            let place =
                as_file * Vector3::from(template.centre_m) + Vector3::from(entry.position_m);
            Clump {
                template: number,
                place_m: place.into(),
                turned,
                velocity_m_s: entry.velocity_m_s,
                angular_momentum: angular_momentum(template, turned, entry.angular_velocity_rad_s),
                ..Clump::default()
            }
        })
        .collect()
}

/// Checks that the scene defines contacts between all clumps and their fragments, and with the
/// other bodies.
pub(super) fn need_pairs(
    scene: &Scene,
    kinds: &Kinds<'_>,
    templates: &[Arc<Template>],
) -> Result<()> {
    let numbered = templates.iter().enumerate();
    let number_of: BTreeMap<&str, usize> = numbered.map(|(n, t)| (&t.body[..], n)).collect();
    let described = scene.bodies.iter().map(|(name, entry)| {
        let material = kinds.material(&entry.material);
        (name, material, number_of.get(&name[..]))
    });
    let described: Vec<_> = described.collect();
    for (n, template) in templates.iter().enumerate() {
        let own = usize::from(template.material);
        let by_inlet = (scene.inlets.values()).any(|inlet| inlet.feeds(&template.body));
        if by_inlet || scene.replacement.contains_key(&template.body) {
            let who = || format!("the bodies '{}' and their pieces need", template.body);
            kinds.need(scene, [own; 2], who)?;
        }
        for (name, material, number) in &described {
            let is_later_or_stands = number.is_none_or(|&other| other > n);
            if is_later_or_stands {
                let who = || format!("the bodies '{}' and '{name}' need", template.body);
                kinds.need(scene, [own, *material], who)?;
            }
        }
    }
    Ok(())
}

/// Refuses replacement of bodies without bonds.
pub(super) fn refuse_unbreakable(scene: &Scene, templates: &[Arc<Template>]) -> Result<()> {
    for template in templates {
        let rule = scene.replacement.get(&template.body);
        let becomes_cluster = rule.is_some_and(|rule| !rule.breaks_whole());
        if becomes_cluster && template.bonds.is_empty() {
            return Err(Diagnostic::input(
                format!("{}: [replacement.{}]", scene.source, template.body),
                "the body has no bonds, so it cannot break",
                "make it with bonds: dem-pack --bond-range 1.1",
            ));
        }
    }
    Ok(())
}
