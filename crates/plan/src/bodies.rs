//! Bodies of a scene at their initial positions.

use std::collections::BTreeMap;
use std::ops::Add;
use std::path::PathBuf;

use dem_io::body::About;
use dem_io::body::files::body_files;
use dem_io::body::mass::volume_m3;
use dem_io::units::significant;
use dem_io::{Body, Diagnostic, Result};
use dem_scene::{
    BodyEntry, BodySource, BondDamping, BondKind, BondModel as SceneModel, ClumpMass,
    ClumpSettings, Formulation, JointElements, Replacement, Scene, StartAs, WholeMass,
};
use nalgebra::{UnitQuaternion, Vector3};

use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::bonds::{BondLaw, BondRule, Bonds, moment_ratios, share_moment_ratios};
use dem_engine::state::order::spatial_order;
use dem_engine::state::particles::{Particles, Pose};
use dem_engine::state::stored_bonds::{restore, turn_particles};
use dem_physics::bond::damage::Damage;
use dem_physics::bond::damping::{DampingCoefficients, DampingModel, reduced};
use dem_physics::bond::damping_models::{Chen, ChenByMode, ModeRatios, Platzer};
use dem_physics::bond::failure::{Criteria, EquivalentStress, has_strength};
use dem_physics::bond::flat_joint::{FlatJoint, FlatJointLaw, elements, moment_ratio};
use dem_physics::bond::incremental::History;
use dem_physics::bond::pair::frequencies;
use dem_physics::bond::plasticity::{PlasticDeformation, Plasticity};
use dem_physics::bond::scatter::{body_key, strength_factor};
use dem_physics::bond::stiffness::{BondModel, BondShape, Stiffness, stiffness};
use dem_physics::bond::total::direction;
use dem_physics::shape::inertia::of_union;

/// Largest rounding error of a coordinate as a fraction of a radius: with it, a strain of a
/// thousandth is accurate to a thousandth.
const ROUNDING: f64 = 1e-6;
/// A length in a file counts as the rest length of the bond in its initial position if the two
/// differ by less than this fraction.
const SAME_LENGTH: f64 = 1e-9;

/// Particles and bonds of all bodies of a scene, at their initial positions.
///
/// # Errors
/// Bonds without a rule; no density; a bond without length; masses or stiffnesses that are out of
/// range.
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
///
/// # Errors
/// As [`place_bodies`].
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
                .map_err(|error| within(error, scene, name, entry, |files| files.last()))?;
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
    let becomes_cluster = |rule: &Replacement| rule.daughters.is_none();
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
            .map_err(|error| within(error, scene, name, entry, |files| files.first()))?;
    }
    set_moving(entry, particles, first_particle);
    Ok(PlacedBody {
        name: name.to_owned(),
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
fn sphere_density_kg_m3(scene: &Scene, name: &str, entry: &BodyEntry, body: &Body) -> Result<f64> {
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

fn place_bonds(
    body: &Body,
    kind: &BondKind,
    rule: usize,
    (seed, body_key): (u64, u64),
    particles: &Particles,
    placed: &mut PlacedBody,
    bonds: &mut Bonds,
) -> Result<()> {
    let mut sorted: Vec<([u32; 2], u32)> = (0..)
        .zip(&body.bonds)
        .map(|(original, ends)| {
            let [a, b] = ends.map(|end| placed.particles[end as usize]);
            ([a.min(b), a.max(b)], original)
        })
        .collect();
    sorted.sort_unstable();
    bonds.reserve_exact(body.bonds.len());
    placed.bonds.reserve_exact(body.bonds.len());
    let first = bonds.len();
    let damped = bonds.rules.iter().any(|rule| rule.damped);
    let incremental = bonds
        .rules
        .iter()
        .any(|rule| rule.law == BondLaw::Incremental);
    let mut rules = bonds.rules.iter();
    let any_softens = rules.any(|rule| rule.law.fracture_energy_j_m2().is_some());
    let mut ratios = bonds.moment_ratios_of(rule);
    for (ends, original) in sorted {
        placed.bonds.push(original);
        let original = original as usize;
        let [a, b] = ends.map(|end| end as usize);
        let radii = [a, b].map(|end| particles.poses[end].radius_m());
        let apart = particles.poses[b].place() - particles.poses[a].place();
        let distance = apart.norm();
        let given = body.bond_lengths[original];
        let at_rest = (given - distance).abs() <= SAME_LENGTH * distance;
        let plastic = body.bond_plastics.get(original);
        let elongation_m = plastic.map_or(0.0, |plastic| plastic.elongation_m);
        let shape = BondShape {
            length_m: if at_rest { distance } else { given } - elongation_m,
            radius_m: match kind.radius_factor {
                Some(factor) => factor * radii[0].min(radii[1]),
                None => body.bond_radii[original],
            },
            end_radii_m: radii,
        };
        let answer = stiffness(
            model(kind.model),
            &shape,
            kind.young_modulus_pa,
            kind.poisson_ratio,
        );
        check_bond(original, distance, &answer, particles, [a, b])?;
        let own_ratios = moment_ratios(&answer, shape.radius_m);
        check_ratios(original, ratios.get_or_insert(own_ratios), &own_ratios)?;
        bonds.push(
            ends,
            direction(&apart).into(),
            shape.radius_m,
            &answer,
            rule,
        );
        if damped {
            bonds.damping.resize(bonds.len() - 1, [0.0; 4]);
            bonds
                .damping
                .push(damping(kind, &answer, particles, [a, b]));
        }
        if let Some(modulus) = kind.failure.weibull_modulus {
            bonds.strength_factors.resize(bonds.len() - 1, 1.0);
            let pair = body.bonds[original].map(u64::from);
            bonds
                .strength_factors
                .push(strength_factor(seed, body_key, pair, modulus));
        } else if !bonds.strength_factors.is_empty() {
            bonds.strength_factors.push(1.0);
        }
        if any_softens {
            let factor = bonds.strength_factor(bonds.len() - 1);
            bonds.damages.push(Damage::none(&answer, factor));
        }
        let damage = body.bond_damages.get(original).copied().unwrap_or(0.0);
        damage_last(original, bonds, rule, damage)?;
    }
    if incremental {
        bonds.histories.resize(bonds.len(), History::default());
    }
    add_joints(bonds, first, rule);
    if bonds
        .rules
        .iter()
        .any(|rule| rule.law.plasticity().is_some())
    {
        bonds.plastics.resize(bonds.len(), PlasticDeformation::NONE);
    }
    Ok(())
}

/// Gives the last bond, with this number in its file, the damage that it has there.
fn damage_last(number: usize, bonds: &mut Bonds, rule: usize, damage: f64) -> Result<()> {
    if bonds.rules[rule].law.fracture_energy_j_m2().is_some() {
        check_fracture_energy(number, bonds, &bonds.rules[rule])?;
    } else if damage > 0.0 {
        return Err(Diagnostic::input(
            format!("bond {number}"),
            format!("it is damaged ({damage}), and its kind of bonds has no fracture_energy"),
            "add fracture_energy to its failure table, or remove the array 'damage' from the file",
        ));
    }
    if damage > 0.0 {
        bonds.set_damage(bonds.len() - 1, damage);
    }
    Ok(())
}

/// Adds the elements of the bonds from `first` on, which follow this rule, if there are flat
/// joints.
fn add_joints(bonds: &mut Bonds, first: usize, rule: usize) {
    if bonds
        .rules
        .iter()
        .all(|rule| rule.law.flat_joint().is_none())
    {
        return;
    }
    bonds.joints.resize(bonds.len(), FlatJoint::default());
    if let Some(law) = bonds.rules[rule].law.flat_joint() {
        for at in first..bonds.len() {
            let elements = elements(&law, bonds.radius_m(at), &bonds.direction(at));
            bonds.joints[at].elements = elements;
        }
    }
}

/// Whether the last bond, with this number in its file, stores less than its fracture energy when
/// it reaches a strength, apart from scatter.
fn check_fracture_energy(number: usize, bonds: &Bonds, rule: &BondRule) -> Result<()> {
    let at = bonds.len() - 1;
    let energy_j_m2 = rule.law.fracture_energy_j_m2().unwrap_or_default();
    let factor = bonds.undamaged_strength_factor(at);
    let ratios = bonds.opening_ratios(at).into_iter().flatten();
    let least = ratios.fold(f64::INFINITY, f64::min) * factor * factor;
    if least > 1.0 {
        return Ok(());
    }
    Err(Diagnostic::input(
        format!("bond {number}"),
        format!(
            "{} m long, it stores {} J/m2 when it reaches its strength, not less than its fracture_energy of {} J/m2",
            significant(bonds.initial_length_m(at), 4),
            significant(energy_j_m2 / least, 4),
            significant(energy_j_m2, 4),
        ),
        "give more fracture energy or less strength, pack smaller spheres, or leave fracture_energy out: such bonds break at once",
    ))
}

/// Whether a bond of a body's file has a direction, and a frequency in the range of floating-point
/// numbers.
fn check_bond(
    number: usize,
    distance_m: f64,
    answer: &Stiffness,
    particles: &Particles,
    ends: [usize; 2],
) -> Result<()> {
    if distance_m == 0.0 {
        return Err(Diagnostic::input(
            format!("bond {number}"),
            "its two particles are at the same place",
            "move one of them, or remove the bond",
        ));
    }
    let step_s = frequencies(
        answer,
        ends.map(|end| particles.motions[end].inverse_mass),
        ends.map(|end| particles.motions[end].inverse_inertia),
    )
    .critical_step_s();
    let is_usable = |x: f64| x.is_normal() && x > 0.0;
    if [distance_m, step_s, answer.normal]
        .into_iter()
        .all(is_usable)
    {
        return Ok(());
    }
    Err(Diagnostic::input(
        format!("bond {number}"),
        format!(
            "{distance_m:.3e} m long and {:.3e} N/m stiff, it would need a time step of {step_s:.3e} s, which is too small to integrate",
            answer.normal
        ),
        "check the units of places, radii, density and modulus",
    ))
}

/// Whether a bond of a body's file has the ratios of its stiffnesses in common with those of its
/// kind.
fn check_ratios(number: usize, of_kind: &[f64; 2], own: &[f64; 2]) -> Result<()> {
    if share_moment_ratios(of_kind, own) {
        return Ok(());
    }
    let [torsion, bending] = own.map(|ratio| significant(ratio, 4));
    let [torsion_before, bending_before] = of_kind.map(|ratio| significant(ratio, 4));
    Err(Diagnostic::input(
        format!("bond {number}"),
        format!(
            "its torsional over its bending stiffness is {torsion}, and bending over normal stiffness and radius squared {bending}, where bonds of its kind have {torsion_before} and {bending_before}"
        ),
        "choose a model whose ratios do not vary from bond to bond, or give these bonds a kind of their own",
    ))
}

fn model(model: SceneModel) -> BondModel {
    match model {
        SceneModel::Parallel {
            stiffness_ratio: kappa,
        } => BondModel::Parallel { kappa },
        SceneModel::Pin {
            stiffness_ratio: kappa,
        } => BondModel::Pin { kappa },
        SceneModel::Rojek {
            stiffness_ratio: kappa,
        } => BondModel::Rojek { kappa },
        SceneModel::EulerBernoulli => BondModel::EulerBernoulli,
        SceneModel::Timoshenko => BondModel::Timoshenko,
        SceneModel::ElasticSolid => BondModel::ElasticSolid,
        SceneModel::ShearCoefficient { alpha } => BondModel::ShearCoefficient { alpha },
        SceneModel::FlatJoint {
            stiffness_ratio: kappa,
            elements,
        } => BondModel::FlatJoint {
            kappa,
            moment_ratio: moment_ratio(&joint_law(elements)),
        },
    }
}

fn joint_law(elements: JointElements) -> FlatJointLaw {
    FlatJointLaw {
        radial_elements: elements.radial,
        circumferential_elements: elements.circumferential,
        friction: elements.friction,
    }
}

/// The law of a kind of bonds, of which the scene allows one.
fn law(kind: &BondKind) -> BondLaw {
    let strength_pa = |strength: Option<f64>| strength.unwrap_or(f64::INFINITY);
    if let SceneModel::FlatJoint { elements, .. } = kind.model {
        BondLaw::FlatJoint(joint_law(elements))
    } else if kind.formulation == Formulation::Incremental {
        BondLaw::Incremental
    } else if let Some(plasticity) = kind.plasticity {
        BondLaw::ElastoPlastic(Plasticity {
            yield_strengths_pa: [
                plasticity.normal_yield_strength_pa,
                plasticity.shear_yield_strength_pa,
                plasticity.torsion_yield_strength_pa,
                plasticity.bending_yield_strength_pa,
            ]
            .map(strength_pa),
            hardening_ratio: plasticity.hardening_ratio,
        })
    } else if let Some(fracture_energy_j_m2) = kind.failure.fracture_energy_j_m2 {
        BondLaw::Softening {
            fracture_energy_j_m2,
        }
    } else {
        BondLaw::Elastic
    }
}

fn rule(kind: &BondKind) -> BondRule {
    let failure = &kind.failure;
    let strength_pa = |strength: Option<f64>| strength.unwrap_or(f64::INFINITY);
    let criteria = Criteria {
        tensile_strength_pa: strength_pa(failure.tensile_strength_pa),
        compressive_strength_pa: strength_pa(failure.compressive_strength_pa),
        shear_strength_pa: strength_pa(failure.shear_strength_pa),
        cohesion_pa: strength_pa(failure.cohesion_pa),
        friction_tangent: failure.friction_angle_rad.map_or(0.0, f64::tan),
        von_mises_strength_pa: strength_pa(failure.von_mises_strength_pa),
        equivalent_stress: equivalent_stress(failure.equivalent_stress),
    };
    let undamped = BondDamping {
        per_mode: kind.damping.per_mode,
        structural_damping: kind.damping.structural_damping,
        ..BondDamping::default()
    };
    BondRule {
        law: law(kind),
        damped: kind.damping != undamped,
        structural_damping: kind.damping.structural_damping,
        criteria: has_strength(&criteria).then_some(criteria),
        strengthening_from_1_s: failure.rate_strengthening_from_1_s,
        strain_rate_measure: failure.strain_rate_measure,
        contact_beside: kind.contact_beside_bond,
    }
}

fn equivalent_stress(asked: dem_scene::EquivalentStress) -> EquivalentStress {
    match asked {
        dem_scene::EquivalentStress::AxialInTension => EquivalentStress::AxialInTension,
        dem_scene::EquivalentStress::TensileEdge => EquivalentStress::TensileEdge,
        dem_scene::EquivalentStress::BondInTension => EquivalentStress::BondInTension,
        dem_scene::EquivalentStress::ForcesOnly => EquivalentStress::ForcesOnly,
    }
}

fn damping(
    kind: &BondKind,
    answer: &Stiffness,
    particles: &Particles,
    ends: [usize; 2],
) -> [f64; 4] {
    let damping = &kind.damping;
    let reduced = reduced(
        ends.map(|end| particles.motions[end].inverse_mass),
        ends.map(|end| particles.motions[end].inverse_inertia),
    );
    let damping_ratio = damping.damping_ratio;
    let by_ratio: &dyn DampingModel = if damping.per_mode {
        &ChenByMode { damping_ratio }
    } else {
        &Chen { damping_ratio }
    };
    let by_coefficient = Platzer {
        coefficient_n_s_m: damping.damping_coefficient_n_s_m,
        moment_factor: damping.torque_factor,
    };
    let by_mode = ModeRatios {
        normal: damping.normal_damping_ratio,
        shear: damping.shear_damping_ratio,
        torsion: damping.torsion_damping_ratio,
        bending: damping.bending_damping_ratio,
    };
    let models: [&dyn DampingModel; 3] = [by_ratio, &by_coefficient, &by_mode];
    let coefficients = models.map(|model| model.coefficients(answer, &reduced));
    let all = coefficients
        .into_iter()
        .fold(DampingCoefficients::default(), Add::add);
    all.into()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A kind of bonds stores two ratios of stiffnesses for all of its bonds: a model whose ratios
    /// vary is refused instead of computed with those of another bond.
    #[test]
    fn bonds_of_other_ratios_are_refused() {
        let of = |torsion: f64, bending: f64| {
            let stiffness = Stiffness {
                normal: 1e6,
                shear: 4e5,
                torsion,
                bending,
                levers_m: [1e-3; 2],
            };
            moment_ratios(&stiffness, 1e-3)
        };
        let round = of(0.19, 0.25);
        check_ratios(1, &round, &of(0.19 * (1.0 + 1e-12), 0.25)).unwrap();
        check_ratios(1, &of(0.0, 0.0), &of(0.0, 0.0)).unwrap();
        for other in [of(0.2, 0.25), of(0.19, 0.26), of(0.0, 0.0)] {
            let said = check_ratios(7, &round, &other).unwrap_err().to_string();
            assert!(
                said.starts_with("bond 7: its torsional over its bending"),
                "{said}"
            );
        }
    }
}
