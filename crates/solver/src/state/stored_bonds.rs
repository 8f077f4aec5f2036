//! What bonds have been through, as files of bodies and frames hold it: plastic deformation and
//! failed elements in the axes of the scene, each from the particle with the smaller number in the
//! file to the one with the larger.

use dem_io::body::{Body, JointBond, PlasticBond};
use dem_io::{Diagnostic, Result};
use nalgebra::{UnitQuaternion, Vector3};

use super::bodies::PlacedBody;
use super::bonds::Bonds;
use super::particles::Pose;
use crate::physics::bond::flat_joint::{FlatJointLaw, elements_from, first_edge};
use crate::physics::bond::plasticity::{PlasticDeformation, StressFree};

/// Plastic deformation of bond `at`, of a scene in which bonds can yield. `is_reversed`: its
/// particles have the opposite order in the file.
pub(crate) fn plastic_of(
    bonds: &Bonds,
    at: usize,
    poses: &[Pose],
    is_reversed: bool,
) -> PlasticBond {
    let plastic = &bonds.plastics[at];
    let frame = bonds.frame_of(at, poses);
    let sign = if is_reversed { -1.0 } else { 1.0 };
    let stored = |own: [f64; 3]| (sign * (frame * Vector3::from(own))).into();
    PlasticBond {
        elongation_m: plastic.elongation_m,
        slip_m: stored(plastic.slip_m),
        twist_rad: plastic.twist_rad,
        bend_rad: stored(plastic.bend_rad),
        work_j: plastic.work_j,
    }
}

/// Elements of bond `at`, of a scene with flat joints, by their order in the file; those of a bond
/// of another model are none.
pub(crate) fn joint_of(bonds: &Bonds, at: usize, poses: &[Pose], is_reversed: bool) -> JointBond {
    let Some(law) = bonds.rules[bonds.rule_of(at)].flat_joint else {
        return JointBond::default();
    };
    let own = &bonds.joints[at].elements;
    let edge = first_edge(&law, own, &bonds.direction(at));
    let is_broken = bonds.is_broken(at);
    let failed = own.iter().map(|element| is_broken || !element.is_bonded);
    JointBond {
        first_edge: (bonds.frame_of(at, poses) * edge).into(),
        failed: in_order(failed.collect(), &law, is_reversed),
    }
}

/// Flags of elements from the other end of the bond: their sectors follow each other the other way
/// round.
fn in_order(mut flags: Vec<bool>, law: &FlatJointLaw, is_reversed: bool) -> Vec<bool> {
    if is_reversed {
        let rings = flags.chunks_mut(law.circumferential_elements as usize);
        rings.for_each(<[bool]>::reverse);
    }
    flags
}

/// Gives the bonds of a body that has just been placed, with this rotation, what they have been
/// through.
///
/// # Errors
/// Their kind has no plasticity, or other elements.
pub(crate) fn restore(
    bonds: &mut Bonds,
    body: &Body,
    placed: &PlacedBody,
    rotation: &UnitQuaternion<f64>,
) -> Result<()> {
    for (n, &original) in placed.bonds.iter().enumerate() {
        let (at, original) = (placed.first_bond + n, original as usize);
        let [a, _] = body.bonds[original];
        let is_reversed = placed.particles[a as usize] != bonds.ends[at][0];
        let within = |error: Diagnostic| error.within(&format!("bond {original}"));
        if let Some(plastic) = body.bond_plastics.get(original) {
            deform(bonds, at, plastic, rotation, is_reversed).map_err(within)?;
        }
        if let Some(joint) = body.bond_joints.get(original) {
            fail(bonds, at, joint, rotation, is_reversed).map_err(within)?;
        }
    }
    Ok(())
}

fn deform(
    bonds: &mut Bonds,
    at: usize,
    stored: &PlasticBond,
    rotation: &UnitQuaternion<f64>,
    is_reversed: bool,
) -> Result<()> {
    if *stored == PlasticBond::default() {
        return Ok(());
    }
    if bonds.rules[bonds.rule_of(at)].plasticity.is_none() {
        return Err(Diagnostic::input(
            "",
            "it has yielded, and its kind of bonds has no plasticity",
            "add a table plasticity to it, or remove the arrays 'plastic_...' from the file",
        ));
    }
    let sign = if is_reversed { -1.0 } else { 1.0 };
    let own = |stored: [f64; 3]| (sign * (rotation * Vector3::from(stored))).into();
    let longer = 1.0 + stored.elongation_m / bonds.stress_free_length_m(at);
    let bond = StressFree {
        levers_m: bonds.levers_m(at).map(|lever| longer * lever),
        direction: bonds.direction(at),
        plastic: PlasticDeformation {
            elongation_m: stored.elongation_m,
            slip_m: own(stored.slip_m),
            twist_rad: stored.twist_rad,
            bend_rad: own(stored.bend_rad),
            work_j: stored.work_j,
            ..PlasticDeformation::NONE
        },
    };
    bonds.set_stress_free(at, &bond);
    Ok(())
}

fn fail(
    bonds: &mut Bonds,
    at: usize,
    stored: &JointBond,
    rotation: &UnitQuaternion<f64>,
    is_reversed: bool,
) -> Result<()> {
    if !stored.failed.contains(&true) {
        return Ok(());
    }
    let law = bonds.rules[bonds.rule_of(at)].flat_joint;
    let count = law.map_or(0, |law| law.count());
    // Bonds with more elements in the same file lengthen the list of each.
    let (own, surplus) = stored.failed.split_at(count.min(stored.failed.len()));
    let fits = own.len() == count && !surplus.contains(&true);
    let Some(law) = law.filter(|_| fits) else {
        return Err(Diagnostic::input(
            "",
            format!(
                "elements of its flat joint of {} have failed, and its kind of bonds has {count}",
                stored.failed.len()
            ),
            "give it the radial_elements and circumferential_elements with which the file was written, or remove the array 'failed_elements' from the file",
        ));
    };
    let direction = bonds.direction(at);
    let edge = rotation * Vector3::from(stored.first_edge);
    let across = edge - direction * direction.dot(&edge);
    let Some(edge) = across.try_normalize(1e-3) else {
        return Err(Diagnostic::input(
            "",
            "the edge of its first element lies along the bond",
            "remove the array 'failed_elements' from the file",
        ));
    };
    let mut elements = elements_from(&law, bonds.radius_m(at), &direction, &edge);
    let failed = in_order(own.to_vec(), &law, is_reversed);
    for (element, failed) in elements.iter_mut().zip(failed) {
        element.is_bonded = !failed;
    }
    bonds.joints[at].elements = elements;
    Ok(())
}
