//! Bonds of bodies that have more or fewer spheres across than the body in which the bonds were
//! calibrated: [`size_correction`].

use std::collections::BTreeMap;

use dem_io::units::significant;
use dem_io::{Body, Diagnostic, Result};
use dem_physics::bond::bearing_section::{FEWEST_ACROSS, size_correction};
use dem_scene::{BondKind, Scene};

use super::bodies::stays_rigid;

/// The scene with a kind of bonds of its own for each body whose bonds are corrected. `read`: bodies
/// by name.
///
/// # Errors
/// A body that does not say how many spheres it has across, or has too few.
pub(super) fn corrected(mut scene: Scene, read: &BTreeMap<String, Body>) -> Result<Scene> {
    for (name, body) in read {
        if body.bonds.is_empty() || stays_rigid(&scene, name) {
            continue;
        }
        let of_body = scene
            .bodies
            .get(name)
            .and_then(|entry| entry.bond_kind.clone());
        let Some(kind_name) = of_body else { continue };
        let kind = scene
            .bonds
            .get(&kind_name)
            .filter(|kind| kind.size_correction);
        let both = kind.and_then(|kind| Some((kind.clone(), kind.calibrated_across?)));
        let Some((mut kind, calibrated_across)) = both else {
            continue;
        };
        let across = across(&scene, name, body)?;
        let factor = size_correction(calibrated_across, across);
        scene.notes.push(format!(
            "body '{name}': {} spheres across, its bonds were calibrated with {}: their modulus and strengths count {} times (size_correction)",
            significant(across, 3),
            significant(calibrated_across, 3),
            significant(factor, 4)
        ));
        strengthen(&mut kind, factor);
        let own = format!("{kind_name} of {name}");
        scene.bonds.insert(own.clone(), kind);
        if let Some(entry) = scene.bodies.get_mut(name) {
            entry.bond_kind = Some(own);
        }
    }
    Ok(scene)
}

/// Spheres across the thinnest part of a body whose bonds are corrected.
fn across(scene: &Scene, name: &str, body: &Body) -> Result<f64> {
    let refuse = |problem: String, remedy: &str| {
        Err(Diagnostic::input(
            format!("{}: [bodies.{name}]", scene.source),
            problem,
            remedy,
        ))
    };
    let (least, off) = (significant(FEWEST_ACROSS, 2), "or remove size_correction");
    match body.about.particles_across {
        None => refuse(
            "its bonds have size_correction, and its file does not say how many spheres it has across".to_owned(),
            &format!("make it with dem-pack, {off}"),
        ),
        Some(across) if across < FEWEST_ACROSS => refuse(
            format!(
                "its bonds have size_correction, which holds from {least} spheres across on, and it has {}",
                significant(across, 3)
            ),
            &format!("take smaller spheres, {off}"),
        ),
        Some(across) => Ok(across),
    }
}

/// Multiplies modulus, strengths and fracture energy.
fn strengthen(kind: &mut BondKind, factor: f64) {
    kind.young_modulus_pa *= factor;
    let failure = &mut kind.failure;
    let mut all = vec![
        &mut failure.tensile_strength_pa,
        &mut failure.compressive_strength_pa,
        &mut failure.shear_strength_pa,
        &mut failure.cohesion_pa,
        &mut failure.von_mises_strength_pa,
        &mut failure.fracture_energy_j_m2,
    ];
    if let Some(plasticity) = &mut kind.plasticity {
        all.extend([
            &mut plasticity.normal_yield_strength_pa,
            &mut plasticity.shear_yield_strength_pa,
            &mut plasticity.torsion_yield_strength_pa,
            &mut plasticity.bending_yield_strength_pa,
        ]);
    }
    all.into_iter().flatten().for_each(|value| *value *= factor);
}
