//! Bodies of a scene at their initial positions.

use std::collections::BTreeMap;
use std::path::PathBuf;

use dem_io::body::About;
use dem_io::body::files::body_files;
use dem_io::body::mass::volume_m3;
use dem_io::{Body, Diagnostic, Result};
use dem_scene::{
    BodyEntry, BodySource, ClumpMass, ClumpSettings, Replacement, Scene, StartAs, WholeMass,
};
use nalgebra::{UnitQuaternion, Vector3};

use super::bond_kinds::rule;
use super::bonds::place_bonds;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::bonds::Bonds;
use dem_engine::state::particles::{Particles, Pose};
use dem_engine::state::stored_bonds::{restore, turn_particles};
use dem_physics::bond::scatter::body_key;
use dem_physics::geometry::spatial_order::spatial_order;
use dem_physics::shape::inertia::of_union;

/// Largest rounding error of a coordinate as a fraction of a radius: with it, a strain of a
/// thousandth is accurate to a thousandth.
const ROUNDING: f64 = 1e-6;

/// Particles and bonds of all bodies of a scene, at their initial positions.
///
/// # Errors
/// No rule for bonds; no density; a bond without length; masses or stiffnesses out of range.
pub fn place_bodies(
    scene: &Scene,
    mut read: BTreeMap<String, Body>,
) -> Result<(Particles, Bonds, Vec<PlacedBody>)> {
    let mut particles = Particles::default();
    let mut bonds = Bonds::default();
    let mut placed = Vec::new();
    bonds.rules = scene.bonds.values().map(rule).collect();
    particles.reserve_exact(read.values().map(|body| body.radii.len()).sum());
    let has_bonds = |name: &String| (scene.bodies.get(name)).is_some_and(|b| b.bond_kind.is_some());
    let bonded = read.iter().filter(|(name, _)| has_bonds(name));
    bonds.reserve_exact(bonded.map(|(_, body)| body.bonds.len()).sum());
    for (name, entry) in &scene.bodies {
        if let Some(body) = read.remove(name) {
            let (particles, bonds) = (&mut particles, &mut bonds);
            placed.push(place_body(scene, name, entry, &body, particles, bonds)?);
        }
    }
    Ok((particles, bonds, placed))
}

/// Adds the particles and bonds of one body of a scene.
pub(super) fn place_body(
    scene: &Scene,
    name: &str,
    entry: &BodyEntry,
    body: &Body,
    particles: &mut Particles,
    bonds: &mut Bonds,
) -> Result<PlacedBody> {
    if bonds.rules.is_empty() {
        bonds.rules = scene.bonds.values().map(rule).collect();
    }
    let mut one = place_particles(scene, name, entry, body, particles)?;
    let rotation = UnitQuaternion::from_scaled_axis(Vector3::from(entry.rotation_rad));
    turn_particles(&mut particles.poses, body, &one, &rotation);
    let of_kind = entry.bond_kind.as_ref();
    let rule = of_kind.and_then(|kind| scene.bonds.keys().position(|known| known == kind));
    match (rule, of_kind.and_then(|kind| scene.bonds.get(kind))) {
        (Some(rule), Some(kind)) => {
            one.first_bond = bonds.len();
            let seed = (scene.run.seed, body_key(name, 0));
            place_bonds(body, kind, rule, seed, particles, &mut one, bonds)
                .and_then(|()| restore(bonds, body, &one, &particles.poses, &rotation))
                .map_err(|error| within(error, scene, name, entry, <[std::path::PathBuf]>::last))?;
        }
        _ if !body.bonds.is_empty() && !stays_rigid(scene, name) => {
            return Err(Diagnostic::input(
                format!("{}: [bodies.{name}]", scene.source),
                format!(
                    "the body has {} bonds, and no kind of bonds is named",
                    body.bonds.len()
                ),
                "add bonds = \"NAME\" and a table [bonds.NAME]",
            ));
        }
        _ => {}
    }
    Ok(one)
}

/// Whether a body always stays a rigid clump, so that its bonds are unused.
pub(super) fn stays_rigid(scene: &Scene, name: &str) -> bool {
    let start = scene.bodies.get(name).map(|entry| entry.start_as);
    let becomes_cluster = |rule: &Replacement| !rule.breaks_whole();
    matches!(start, Some(StartAs::Clump(_)))
        && !scene.replacement.get(name).is_some_and(becomes_cluster)
}

/// The same message for a body of the scene and, if it comes from a file, for that one of its
/// `files` that causes it.
fn within(
    error: Diagnostic,
    scene: &Scene,
    name: &str,
    entry: &BodyEntry,
    which: impl Fn(&[PathBuf]) -> Option<&PathBuf>,
) -> Diagnostic {
    let place = format!("{}: [bodies.{name}]", scene.source);
    let BodySource::File(path) = &entry.source else {
        return error.within(&place);
    };
    let files = body_files(path).unwrap_or_default();
    let file = which(&files).map(|file| file.display().to_string());
    error
        .within(&file.unwrap_or_else(|| "standard input".to_owned()))
        .within(&place)
}

fn place_particles(
    scene: &Scene,
    name: &str,
    entry: &BodyEntry,
    body: &Body,
    particles: &mut Particles,
) -> Result<PlacedBody> {
    let density = sphere_density_kg_m3(scene, name, entry, body)?;
    let rotation = UnitQuaternion::from_scaled_axis(Vector3::from(entry.rotation_rad));
    let turned = entry.rotation_rad != [0.0; 3];
    let shift = Vector3::from(entry.position_m);
    let places: Vec<[f64; 3]> = body
        .positions
        .iter()
        .map(|&place| {
            let place = Vector3::from(place);
            let place = if turned { rotation * place } else { place };
            (place + shift).into()
        })
        .collect();
    let order = spatial_order(&places);
    let first_particle = particles.len();
    let mut numbers = vec![0_u32; order.len()];
    particles.reserve_exact(order.len());
    for (at, &original) in order.iter().enumerate() {
        numbers[original as usize] = (first_particle + at) as u32;
        let original = original as usize;
        particles.push_sphere(places[original], body.radii[original], density);
        let i = first_particle + at;
        particles.ids[i] = (first_particle + original) as u32;
        check_particle(original, particles, i)
            .map_err(|error| within(error, scene, name, entry, <[std::path::PathBuf]>::first))?;
    }
    set_moving(entry, particles, first_particle);
    Ok(PlacedBody {
        name: name.to_owned(),
        came_as: None,
        first_particle,
        particles: numbers,
        first_bond: 0,
        bonds: Vec::new(),
    })
}

/// The density for comparison with a body's shape: that of its material, or the one in its file,
/// kg/m3.
pub(crate) fn material_density_kg_m3(
    scene: &Scene,
    entry: &BodyEntry,
    about: &About,
) -> Option<f64> {
    let material = scene.materials.get(&entry.material);
    let given = material.and_then(|material| material.density_kg_m3);
    given.or(about.particle_density_kg_m3)
}

/// Density of the spheres of a body, kg/m3: that of its material, or the one that gives the mass in
/// the scene.
pub(crate) fn sphere_density_kg_m3(
    scene: &Scene,
    name: &str,
    entry: &BodyEntry,
    body: &Body,
) -> Result<f64> {
    let place = || format!("{}: [bodies.{name}]", scene.source);
    let mass_kg = match entry.whole_mass {
        None => {
            let density = material_density_kg_m3(scene, entry, &body.about);
            return density.ok_or_else(|| {
                Diagnostic::input(
                    format!("{}: [materials.{}]", scene.source, entry.material),
                    format!("no density, and the file of body '{name}' names none"),
                    "add density = \"2050 kg/m3\"",
                )
            });
        }
        Some(WholeMass::Mass(mass_kg)) => mass_kg,
        Some(WholeMass::Density(density)) => {
            let volume = body.about.shape_volume_m3.ok_or_else(|| {
                Diagnostic::input(
                    place(),
                    "body_density is that of a shape, whose volume the body's file does not name",
                    "give it a mass, such as mass = \"0.4 kg\"; or use a .vtp that dem-pack wrote",
                )
            })?;
            density * volume
        }
    };
    let volume_m3 = match entry.start_as {
        StartAs::Clump(ClumpSettings {
            mass: ClumpMass::Union,
            ..
        }) => of_union(&body.positions, &body.radii, 1.0).mass_kg,
        _ => body.radii.iter().map(|radius| volume_m3(*radius)).sum(),
    };
    Ok(mass_kg / volume_m3)
}

/// Whether mass and moment of inertia of a particle of a body's file are in the range of
/// floating-point numbers.
fn check_particle(number: usize, particles: &Particles, i: usize) -> Result<()> {
    let inert = [
        particles.motions[i].inverse_mass,
        particles.motions[i].inverse_inertia,
    ];
    let pose = &particles.poses[i];
    let is_placed = pose.position_m.iter().all(|x| x.is_finite());
    if is_placed && inert.into_iter().all(f64::is_normal) {
        return check_place(pose, || format!("particle {number}"));
    }
    Err(Diagnostic::input(
        format!("particle {number}"),
        format!(
            "its radius of {:.3e} m and mass of {:.3e} kg are outside the range of floating-point numbers",
            particles.poses[i].radius_m(),
            1.0 / inert[0]
        ),
        "check the units of places, radii and density",
    ))
}

/// Whether a particle, described by `who`, is near enough to the origin for its position to be
/// accurate.
pub(super) fn check_place(pose: &Pose, who: impl Fn() -> String) -> Result<()> {
    let farthest_m = pose.place().amax();
    let rounded_m = f64::EPSILON * farthest_m;
    if rounded_m <= ROUNDING * pose.radius_m() {
        return Ok(());
    }
    Err(Diagnostic::input(
        who(),
        format!(
            "{farthest_m:.3e} m from the origin its coordinates are rounded by {rounded_m:.1e} m, more than {ROUNDING:e} of its radius of {:.3e} m",
            pose.radius_m()
        ),
        "move the scene to the origin, or check the units of places and radii",
    ))
}

/// Velocities of the particles from `first` on, which move as one rigid body.
fn set_moving(entry: &BodyEntry, particles: &mut Particles, first: usize) {
    let spin = Vector3::from(entry.angular_velocity_rad_s);
    let velocity = Vector3::from(entry.velocity_m_s);
    let mut moment = Vector3::zeros();
    let mut mass = 0.0;
    for i in first..particles.len() {
        let one = 1.0 / particles.motions[i].inverse_mass;
        moment += one * particles.poses[i].place();
        mass += one;
    }
    let centre = moment / mass;
    for i in first..particles.len() {
        let arm = particles.poses[i].place() - centre;
        let motion = &mut particles.motions[i];
        motion.velocity_m_s = (velocity + spin.cross(&arm)).into();
        motion.spin_rad_s = spin.into();
    }
}
