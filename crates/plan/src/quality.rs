//! The quality of bonded bodies: warnings of the programs that made them, those about bodies that
//! no program has looked at, and bodies with few particles across.

use std::collections::BTreeMap;

use dem_io::Body;
use dem_io::body::few_across;
use dem_io::disjoint::DisjointSets;
use dem_io::units::significant;
use dem_scene::{BodySource, BondKind, Scene};
use nalgebra::Vector3;

use super::bodies::{sphere_density_kg_m3, stays_rigid};
use super::bond_kinds::rule;
use dem_engine::stages::search::neighbours::near_pairs;
use dem_engine::state::clusters::sizes::{Sphere, box_lengths_m};
use dem_engine::state::particles::Pose;

/// As dem-pack: number of bonds per particle below which a body is hardly rigid.
const ENOUGH_BONDS: f64 = 3.0;
/// A body of fewer spheres is written by hand, and no packing.
const FEWEST: usize = 20;
/// Overlap over the smaller radius from which two spheres stand nearly in the same place.
const DOUBLED: f64 = 1.8;
/// Length of a bond over that of most others from which it joins no neighbours.
const FAR: f64 = 3.0;
/// Width of a chain of spheres over the largest diameter.
const CHAIN: f64 = 1.05;
/// Radius of a bond over that of the smaller sphere from which it is no neck between the two.
const THICK: f64 = 2.0;
/// Bonds are calibrated for spheres whose mean diameter differs by at most this fraction.
const SAME_DIAMETER: f64 = 0.1;
/// And in a body whose inverse number of spheres across differs by at most this: with 10 across and
/// 15, or 6.7 and 4.2, modulus and strength differ by some 15 %.
const SAME_ACROSS: f64 = 0.02;

/// Particles across from which a test measures the material that its bonds and spheres make: moduli
/// of packings then scatter by less than 2 % (doc/sphere-size.md).
const ENOUGH_IN_A_TEST: f64 = 5.0;

/// What is said about the quality of the bodies of a scene, a sentence each.
#[derive(Debug, Default)]
pub(super) struct Quality {
    pub(super) warnings: Vec<String>,
    /// On specimens of tests, whose results hold for bonds with spheres of this size.
    pub(super) notes: Vec<String>,
    /// On bodies with few particles across, whose results depend on the particles.
    pub(super) coarse: Vec<String>,
    /// Whether all bodies that can break are granulates.
    pub(super) is_granular: bool,
}

/// The quality of all bodies that can deform or break. `read`: bodies by name.
pub(super) fn of_bodies(scene: &Scene, read: &BTreeMap<String, Body>) -> Quality {
    let mut quality = Quality::default();
    let mut breakable = 0;
    let mut granulates = 0;
    for (name, body) in read {
        if body.bonds.is_empty() || stays_rigid(scene, name) {
            continue;
        }
        let named = named(scene, name);
        breakable += 1;
        let about = &body.about;
        let coarse = match about.particles_across {
            Some(_) => about.coarse(),
            None => few_across_box(body),
        };
        let by = about.program.as_deref().unwrap_or_default();
        let by = by.split(' ').next().filter(|by| !by.is_empty());
        let by = by.unwrap_or("the program that made it");
        let said = about.warnings.iter();
        (quality.warnings).extend(said.map(|text| format!("{named}: {by} warned: {text}")));
        if about.program.is_none() && about.warnings.is_empty() {
            let seen = faults(body).into_iter();
            (quality.warnings).extend(seen.map(|text| format!("{named}: {text}")));
        }
        if let Some(kind) = bond_kind(scene, name) {
            let can_be_hit = !scene.contacts.is_empty();
            let seen = unbreakable_row(kind, body).filter(|_| can_be_hit);
            let seen = seen.into_iter().chain(thick_bond(kind, body));
            (quality.warnings).extend(seen.map(|text| format!("{named}: {text}")));
        }
        let coarse = match calibrated(scene, name, body) {
            Calibrated::No => coarse,
            Calibrated::Here => None,
            Calibrated::Elsewhere(across) => Some(across),
        };
        if let Some(note) = granulate(scene, name, body) {
            quality.notes.push(format!("{named}: {note}"));
            granulates += 1;
            continue;
        }
        match (coarse, specimen_across(scene, name, body)) {
            (None, _) => {}
            (Some(text), None) => quality.coarse.push(format!("{named}: {text}")),
            (Some(_), Some(across)) => quality.notes.push(format!(
                "{named}: {} particles across: modulus and strength of the test are those of these bonds with spheres of this size; dem-run calibrate finds the bonds for a measured curve",
                significant(across, 2)
            )),
        }
    }
    quality.is_granular = granulates > 0 && granulates == breakable;
    quality
}

/// The bonds of a body. None: it has none.
fn bond_kind<'a>(scene: &'a Scene, name: &str) -> Option<&'a BondKind> {
    scene.bonds.get(scene.bodies.get(name)?.bond_kind.as_ref()?)
}

/// A sentence on a row of spheres with bonds that do not break when they are bent.
fn unbreakable_row(kind: &BondKind, body: &Body) -> Option<String> {
    let criteria = rule(kind).criteria?;
    let leaves_bending_out =
        criteria.von_mises_strength_pa.is_finite() && !criteria.count_bending();
    let is_long = body.radii.len() >= FEWEST && is_row(body);
    (is_long && leaves_bending_out).then(|| {
        "it is a single row of bonds, and with equivalent_stress = \"forces-only\" bending and torsion alone do not break them; write equivalent_stress = \"tensile-edge\", or tensile_strength".to_owned()
    })
}

/// A sentence on bonds much thicker than their spheres.
fn thick_bond(kind: &BondKind, body: &Body) -> Option<String> {
    let smaller_m = |[a, b]: &[u32; 2]| body.radii[*a as usize].min(body.radii[*b as usize]);
    let (radii, place) = match kind.radius_factor {
        Some(factor) => (vec![factor], "radius_factor"),
        None => {
            let each = body.bonds.iter().zip(&body.bond_radii);
            let ratios = each.map(|(ends, radius_m)| radius_m / smaller_m(ends));
            (ratios.collect(), "the radii of its bonds")
        }
    };
    let most = radii.into_iter().fold(0.0, f64::max);
    (most > THICK).then(|| {
        format!(
            "a bond is {} times as thick as the smaller of its spheres, and its bending stiffness goes with the fourth power of this: check {place}; {THICK} or less is expected",
            significant(most, 3)
        )
    })
}

/// A sentence on a body whose bonds cannot hold a sphere that hangs on one of them: it falls apart
/// into its spheres, which are grains and not a resolution of pieces.
fn granulate(scene: &Scene, name: &str, body: &Body) -> Option<String> {
    let entry = scene.bodies.get(name)?;
    let failure = &bond_kind(scene, name)?.failure;
    let strengths = [failure.tensile_strength_pa, failure.von_mises_strength_pa];
    let strength_pa = strengths.into_iter().flatten().reduce(f64::min)?;
    let density_kg_m3 = sphere_density_kg_m3(scene, name, entry, body).ok()?;
    let gravity_m_s2 = Vector3::from(scene.run.gravity_m_s2).norm();
    // Weight of a sphere over its section.
    let weight_pa = 2.0 / 3.0 * density_kg_m3 * gravity_m_s2 * body.mean_diameter_m();
    (strength_pa < weight_pa).then(|| {
        format!(
            "its bonds of {} Pa do not hold the {} Pa of a sphere that hangs on one: its spheres count as grains, whose size does not make the result coarse",
            significant(strength_pa, 3),
            significant(weight_pa, 3)
        )
    })
}

/// Particles across a body whose test measures what its bonds and spheres make. None: it is in no
/// test, or too few are across.
fn specimen_across(scene: &Scene, name: &str, body: &Body) -> Option<f64> {
    scene.test.as_ref().filter(|test| test.body == name)?;
    let across = body.about.particles_across?;
    (across.round() >= ENOUGH_IN_A_TEST).then_some(across)
}

/// A body and its file, if it is from one, for a sentence.
fn named(scene: &Scene, name: &str) -> String {
    let source = scene.bodies.get(name).map(|entry| &entry.source);
    match source {
        Some(BodySource::File(path)) => format!("body '{name}' ({})", path.display()),
        _ => format!("body '{name}'"),
    }
}

/// With what the bonds of a body were calibrated.
enum Calibrated {
    /// Not, or with spheres of another size.
    No,
    /// With its spheres, in a body of about as many across, or corrected for others.
    Here,
    /// With its spheres, in a body of more or fewer across: what that means.
    Elsewhere(String),
}

fn calibrated(scene: &Scene, name: &str, body: &Body) -> Calibrated {
    let kind = bond_kind(scene, name);
    if kind.is_some_and(|kind| kind.size_correction) {
        return Calibrated::Here;
    }
    let mean_m = body.mean_diameter_m();
    let is_same = kind
        .and_then(|kind| kind.calibrated_diameter_m)
        .is_some_and(|calibrated_m| (mean_m / calibrated_m - 1.0).abs() <= SAME_DIAMETER);
    if !is_same {
        return Calibrated::No;
    }
    let across = body.about.particles_across;
    let both = across.zip(kind.and_then(|kind| kind.calibrated_across));
    match both.filter(|(here, there)| (1.0 / here - 1.0 / there).abs() > SAME_ACROSS) {
        None => Calibrated::Here,
        Some((here, there)) => Calibrated::Elsewhere(format!(
            "{} particles across; its bonds were calibrated in a body of {}: modulus and strength can be 10 % to 20 % off, as bonds near faces bear less; write size_correction = true for these bonds, calibrate in this body, or scale the spheres with it",
            significant(here, 3),
            significant(there, 3)
        )),
    }
}

/// Warnings about a body that no program has looked at.
fn faults(body: &Body) -> Vec<String> {
    let count = body.radii.len();
    let mut warnings = Vec::new();
    let mut sets = DisjointSets::new(count);
    for [a, b] in &body.bonds {
        sets.join(*a, *b);
    }
    let (mut pieces, mut largest) = (0, 0);
    for particle in 0..count as u32 {
        if sets.root(particle) == particle {
            pieces += 1;
            largest = largest.max(sets.size(particle) as usize);
        }
    }
    if pieces > 1 {
        warnings.push(format!(
            "it is in {pieces} pieces: {} of {count} particles are not bonded to the largest; add bonds that join them, or make each piece a body of its own",
            count - largest
        ));
    }
    warnings.extend(doubled(body));
    warnings.extend(far_bond(body));
    if packing_thickness_m(body).is_none() {
        return warnings;
    }
    let bonds = body.bonds.len() as f64 / count as f64;
    if bonds < ENOUGH_BONDS {
        warnings.push(format!(
            "{} bonds per particle, fewer than {ENOUGH_BONDS} are hardly rigid; join more neighbours",
            significant(bonds, 3)
        ));
    }
    warnings
}

/// Spheres that stand nearly in the same place as another: their mass counts twice.
fn doubled(body: &Body) -> Option<String> {
    let pose = |(place, radius_m): (&[f64; 3], &f64)| {
        let [x, y, z] = *place;
        Pose {
            position_m: [x, y, z, *radius_m],
            turned: [0.0, 0.0, 0.0, 1.0],
        }
    };
    let poses: Vec<Pose> = body.positions.iter().zip(&body.radii).map(pose).collect();
    let each: Vec<u32> = (0..poses.len() as u32).collect();
    let mut pairs = near_pairs(&poses, &each, 0.0);
    pairs.retain(|pair| {
        let [a, b] = pair.map(|i| &poses[i as usize]);
        let [one_m, other_m] = [a, b].map(Pose::radius_m);
        let overlap_m = one_m + other_m - (a.place() - b.place()).norm();
        overlap_m > DOUBLED * one_m.min(other_m)
    });
    let [j, i] = *pairs.first()?;
    let such = match pairs.len() {
        1 => String::new(),
        many => format!(", the first of {many} such pairs"),
    };
    Some(format!(
        "its particles {j} and {i} stand nearly in the same place{such}: their mass counts twice; remove one of them"
    ))
}

/// The bond that is longest beside the others, over the radii of its particles.
fn far_bond(body: &Body) -> Option<String> {
    let length = |&[a, b]: &[u32; 2]| {
        let [a, b] = [a, b].map(|i| i as usize);
        let apart_m = (Vector3::from(body.positions[a]) - Vector3::from(body.positions[b])).norm();
        apart_m / (body.radii[a] + body.radii[b])
    };
    let mut lengths: Vec<f64> = body.bonds.iter().map(length).collect();
    let longest = (0..lengths.len()).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))?;
    let (most, [a, b]) = (lengths[longest], body.bonds[longest]);
    let middle = lengths.len() / 2;
    let usual = *lengths.select_nth_unstable_by(middle, f64::total_cmp).1;
    (most > FAR * usual.max(1.0)).then(|| {
        format!(
            "a bond joins particles {a} and {b}, which are {} times the sum of their radii apart, others about {}: they are no neighbours; remove this bond",
            significant(most, 3),
            significant(usual, 3)
        )
    })
}

/// A sentence on a packing with few particles across its box.
fn few_across_box(body: &Body) -> Option<String> {
    let thickness_m = packing_thickness_m(body)?;
    let volume = |radius: &f64| radius.powi(3);
    let cubes: f64 = body.radii.iter().map(volume).sum();
    let mean_m = 2.0 * body.radii.iter().map(|r| r * volume(r)).sum::<f64>() / cubes;
    let side = "the thinnest side of its box";
    few_across(thickness_m / mean_m, side, thickness_m)
}

/// Whether the bonds of a body join its spheres to one row, straight, bent or closed.
fn is_row(body: &Body) -> bool {
    let mut bonds = vec![0_u32; body.radii.len()];
    for end in body.bonds.iter().flatten() {
        bonds[*end as usize] += 1;
    }
    bonds.into_iter().all(|count| count <= 2)
}

/// The smallest length of the box of a body whose spheres fill a shape, m. None: it is a bar of
/// single spheres or of a few, whose bonds are the material.
fn packing_thickness_m(body: &Body) -> Option<f64> {
    let spheres: Vec<Sphere> = (body.positions.iter().zip(&body.radii))
        .map(|(place, radius)| Sphere::of_unit_density(*place, *radius))
        .collect();
    let [_, width_m, thickness_m] = box_lengths_m(&spheres);
    let diameter_m = 2.0 * body.radii.iter().copied().fold(0.0, f64::max);
    let is_packing = spheres.len() >= FEWEST && width_m > CHAIN * diameter_m && !is_row(body);
    is_packing.then_some(thickness_m)
}
