//! What bonds have been through, as files of bodies and frames hold it: summed loads, plastic
//! deformation and elements of flat joints in the axes of the scene, directions without load in the
//! axes of the particles before they turned; each from the particle with the smaller number in the
//! file to the one with the larger.

use dem_io::body::{Body, JointBond, PlasticBond, SummedBond};
use dem_io::{Diagnostic, Result};
use nalgebra::{UnitQuaternion, Vector3};

use super::bodies::PlacedBody;
use super::bonds::{BondLaw, Bonds};
use super::particles::Pose;
use dem_physics::bond::flat_joint::{Element, FlatJointLaw, elements, elements_from, first_edge};
use dem_physics::bond::incremental::History;
use dem_physics::bond::plasticity::{PlasticDeformation, StressFree};
use dem_physics::rigid::rotation_vector;
use dem_physics::rotation::numbers;

/// Direction of bond `at` without load. `is_reversed`: its particles have the opposite order in the
/// file.
pub fn direction_of(bonds: &Bonds, at: usize, is_reversed: bool) -> [f64; 3] {
    (sign(is_reversed) * bonds.direction(at)).into()
}

/// Summed load of bond `at`, of a scene with incremental bonds.
pub fn sum_of(bonds: &Bonds, at: usize, is_reversed: bool) -> SummedBond {
    let History {
        shear_force,
        moment,
    } = bonds.histories.sums[at];
    SummedBond {
        shear_n: (sign(is_reversed) * shear_force).into(),
        moment_n_m: (sign(is_reversed) * moment).into(),
    }
}

fn sign(is_reversed: bool) -> f64 {
    if is_reversed { -1.0 } else { 1.0 }
}

/// Two values in the order of the other end of the bond.
fn ends_in_order<T>([a, b]: [T; 2], is_reversed: bool) -> [T; 2] {
    if is_reversed { [b, a] } else { [a, b] }
}

/// Plastic deformation of bond `at`, of a scene in which bonds can yield. `is_reversed`: its
/// particles have the opposite order in the file.
pub fn plastic_of(bonds: &Bonds, at: usize, poses: &[Pose], is_reversed: bool) -> PlasticBond {
    let plastic = &bonds.histories.plastics[at];
    let frame = bonds.frame_of(at, poses);
    let sign = sign(is_reversed);
    let stored = |own: [f64; 3]| (sign * (frame * Vector3::from(own))).into();
    PlasticBond {
        turns_rad: ends_in_order(plastic.turned.map(rotation_vector), is_reversed),
        elongation_m: plastic.elongation_m,
        slip_m: stored(plastic.slip_m),
        twist_rad: plastic.twist_rad,
        bend_rad: stored(plastic.bend_rad),
        work_j: plastic.work_j,
    }
}

/// Elements of bond `at`, of a scene with flat joints, by their order in the file; those of a bond
/// of another model are none.
pub fn joint_of(bonds: &Bonds, at: usize, poses: &[Pose], is_reversed: bool) -> JointBond {
    let Some(law) = bonds.rules[bonds.rule_of(at)].law.flat_joint() else {
        return JointBond::default();
    };
    let own = &bonds.histories.joints[at].elements;
    let edge = first_edge(&law, own, &bonds.direction(at));
    let is_broken = bonds.is_broken(at);
    let failed = own.iter().map(|element| is_broken || !element.is_bonded);
    let frame = bonds.frame_of(at, poses);
    let has_slid = |element: &&Element| element.slip_m != [0.0; 3];
    let slips = own.iter().filter(|_| own.iter().any(|e| has_slid(&e)));
    let slips = slips.map(|element| {
        let slip = frame * Vector3::from(element.slip_m);
        (sign(is_reversed) * slip).into()
    });
    JointBond {
        first_edge: (frame * edge).into(),
        failed: in_order(failed.collect(), &law, is_reversed),
        slips_m: in_order(slips.collect(), &law, is_reversed),
    }
}

/// Values of elements from the other end of the bond: their sectors follow each other the other way
/// round.
fn in_order<T>(mut values: Vec<T>, law: &FlatJointLaw, is_reversed: bool) -> Vec<T> {
    if is_reversed {
        let rings = values.chunks_mut(law.circumferential_elements as usize);
        rings.for_each(<[T]>::reverse);
    }
    values
}

/// Turns the particles of a body that has just been placed, with this rotation, as far as they have
/// turned since its bonds were without load.
pub fn turn_particles(
    poses: &mut [Pose],
    body: &Body,
    placed: &PlacedBody,
    rotation: &UnitQuaternion<f64>,
) {
    for (turn, &i) in body.turns_rad.iter().zip(&placed.particles) {
        let since = UnitQuaternion::from_scaled_axis(Vector3::from(*turn));
        poses[i as usize].turned = numbers(&(rotation * since));
    }
}

/// Gives the bonds of a body that has just been placed, with this rotation, what they have been
/// through.
///
/// # Errors
/// Their kind has no plasticity, other elements, or another formulation.
pub fn restore(
    bonds: &mut Bonds,
    body: &Body,
    placed: &PlacedBody,
    poses: &[Pose],
    rotation: &UnitQuaternion<f64>,
) -> Result<()> {
    for (n, &original) in placed.bonds.iter().enumerate() {
        let (at, original) = (placed.first_bond + n, original as usize);
        let [a, _] = body.bonds[original];
        let is_reversed = placed.particles[a as usize] != bonds.ends[at][0];
        let within = |error: Diagnostic| error.within(&format!("bond {original}"));
        if let Some(direction) = body.bond_directions.get(original) {
            let direction = sign(is_reversed) * Vector3::from(*direction).normalize();
            bonds.set_direction(at, &direction);
            if let Some(law) = bonds.rules[bonds.rule_of(at)].law.flat_joint() {
                // Those of the line of centres lie across another direction.
                bonds.histories.joints[at].elements =
                    elements(&law, bonds.radius_m(at), &direction);
            }
        }
        if let Some(sum) = body.bond_sums.get(original) {
            load(bonds, at, sum, rotation, is_reversed).map_err(within)?;
        }
        if let Some(plastic) = body.bond_plastics.get(original) {
            deform(bonds, at, plastic, poses, rotation, is_reversed).map_err(within)?;
        }
        if let Some(joint) = body.bond_joints.get(original) {
            fail(bonds, at, joint, poses, rotation, is_reversed).map_err(within)?;
        }
    }
    Ok(())
}

/// Gives a bond the load that it had summed.
fn load(
    bonds: &mut Bonds,
    at: usize,
    stored: &SummedBond,
    rotation: &UnitQuaternion<f64>,
    is_reversed: bool,
) -> Result<()> {
    if *stored == SummedBond::default() {
        return Ok(());
    }
    if bonds.rules[bonds.rule_of(at)].law != BondLaw::Incremental {
        return Err(Diagnostic::input(
            "",
            "its load was summed step by step, and its kind of bonds computes loads from positions",
            "give it formulation = \"incremental\", or remove the arrays 'summed_...' from the file",
        ));
    }
    let own = |stored: [f64; 3]| sign(is_reversed) * (rotation * Vector3::from(stored));
    bonds.histories.sums[at] = History {
        shear_force: own(stored.shear_n),
        moment: own(stored.moment_n_m),
    };
    Ok(())
}

fn deform(
    bonds: &mut Bonds,
    at: usize,
    stored: &PlasticBond,
    poses: &[Pose],
    rotation: &UnitQuaternion<f64>,
    is_reversed: bool,
) -> Result<()> {
    if *stored == PlasticBond::default() {
        return Ok(());
    }
    if bonds.rules[bonds.rule_of(at)].law.plasticity().is_none() {
        return Err(Diagnostic::input(
            "",
            "it has yielded, and its kind of bonds has no plasticity",
            "add a table plasticity to it, or remove the arrays 'plastic_...' from the file",
        ));
    }
    let turns = ends_in_order(stored.turns_rad, is_reversed);
    let turns = turns.map(|turn| UnitQuaternion::from_scaled_axis(Vector3::from(turn)));
    bonds.histories.plastics[at].turned = turns.map(|turn| numbers(&turn));
    let to_frame = bonds.frame_of(at, poses).inverse() * rotation;
    let own = |stored: [f64; 3]| (sign(is_reversed) * (to_frame * Vector3::from(stored))).into();
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
            turned: bonds.histories.plastics[at].turned,
        },
    };
    bonds.set_stress_free(at, &bond);
    Ok(())
}

fn fail(
    bonds: &mut Bonds,
    at: usize,
    stored: &JointBond,
    poses: &[Pose],
    rotation: &UnitQuaternion<f64>,
    is_reversed: bool,
) -> Result<()> {
    if !stored.failed.contains(&true) {
        return Ok(());
    }
    let law = bonds.rules[bonds.rule_of(at)].law.flat_joint();
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
    let to_frame = bonds.frame_of(at, poses).inverse() * rotation;
    let edge = to_frame * Vector3::from(stored.first_edge);
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
    let slips = stored.slips_m[..count.min(stored.slips_m.len())].to_vec();
    for (element, slip) in elements.iter_mut().zip(in_order(slips, &law, is_reversed)) {
        element.slip_m = (sign(is_reversed) * (to_frame * Vector3::from(slip))).into();
    }
    bonds.histories.joints[at].elements = elements;
    Ok(())
}
