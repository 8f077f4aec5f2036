//! What bonds have been through, as files of bodies and frames hold it: histories in the axes of
//! the scene, directions without load in the axes of the particles before they turned; each from
//! the particle with the smaller number in the file to the one with the larger.

use dem_io::body::{Body, BondColumn};
use dem_io::{Diagnostic, Result};
use nalgebra::{UnitQuaternion, Vector3};

use super::bodies::PlacedBody;
use super::bonds::{Bonds, Histories, StoredBond, sign};
use super::particles::Pose;
use dem_physics::rotation::numbers;

/// Direction of bond `at` without load. `is_reversed`: its particles have the opposite order in the
/// file.
pub fn direction_of(bonds: &Bonds, at: usize, is_reversed: bool) -> [f64; 3] {
    (sign(is_reversed) * bonds.direction(at)).into()
}

/// The histories of these bonds as the columns of a file; none if no rule has a law with a history.
/// `is_reversed` tells of the n-th whether its particles have the opposite order in the file.
pub fn histories_of(
    bonds: &Bonds,
    some: &[u32],
    poses: &[Pose],
    is_reversed: &dyn Fn(usize) -> bool,
) -> Vec<BondColumn> {
    let unturned = UnitQuaternion::identity();
    let bond = |n: usize| stored_bond(bonds, some[n] as usize, poses, &unturned, is_reversed(n));
    bonds.histories.stored(some, &bond)
}

fn stored_bond(
    bonds: &Bonds,
    at: usize,
    poses: &[Pose],
    rotation: &UnitQuaternion<f64>,
    is_reversed: bool,
) -> StoredBond {
    StoredBond {
        rule: bonds.rules[bonds.rule_of(at)].clone(),
        direction: bonds.direction(at),
        radius_m: bonds.radius_m(at),
        levers_m: bonds.levers_m(at),
        ends: bonds.ends[at].map(|end| poses[end as usize].end()),
        frame: bonds.frame_of(at, poses),
        rotation: *rotation,
        is_reversed,
        is_broken: bonds.is_broken(at),
    }
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
/// Their kind has no plasticity, other elements, or another formulation; no law has such a history.
pub fn restore(
    bonds: &mut Bonds,
    body: &Body,
    placed: &PlacedBody,
    poses: &[Pose],
    rotation: &UnitQuaternion<f64>,
) -> Result<()> {
    let file = &body.bond_histories;
    if let Some(column) = file
        .iter()
        .find(|column| !Histories::is_known(&column.name))
    {
        return Err(Diagnostic::input(
            "",
            format!("no kind of bonds has the history '{}'", column.name),
            "use a newer version of this program, or remove this array from the file",
        ));
    }
    for (n, &original) in placed.bonds.iter().enumerate() {
        let (at, original) = (placed.first_bond + n, original as usize);
        let [a, _] = body.bonds[original];
        let is_reversed = placed.particles[a as usize] != bonds.ends[at][0];
        if let Some(direction) = body.bond_directions.get(original) {
            let direction = Vector3::from(*direction).normalize();
            bonds.set_direction(at, &(sign(is_reversed) * direction));
            let bond = stored_bond(bonds, at, poses, rotation, is_reversed);
            bonds.histories.set_direction(at, &bond);
        }
        if !file.is_empty() {
            let mut bond = stored_bond(bonds, at, poses, rotation, is_reversed);
            (bonds.histories.restore(at, file, original, &mut bond))
                .map_err(|error| error.within(&format!("bond {original}")))?;
            bonds.set_levers_m(at, bond.levers_m);
        }
    }
    Ok(())
}
