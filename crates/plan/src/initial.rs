//! Initial state of particle groups: displacement from the rest positions of their bonds, and
//! motion.

use std::collections::BTreeMap;

use dem_io::{Diagnostic, Result};
use dem_scene::{Initial, Scene};
use nalgebra::Vector3;

use super::bodies::check_place;
use super::groups::{held_degrees_of_freedom, particles_of};
use dem_engine::state::State;
use dem_engine::state::bodies::{PlacedBody, called};

/// Names of motions along and about the axes in messages.
const MOTIONS: [&str; 6] = [
    "m/s along x",
    "m/s along y",
    "m/s along z",
    "rad/s about x",
    "rad/s about y",
    "rad/s about z",
];

/// Applies the state of `[initial]` in addition to the initial state of the bodies: first all
/// displacements, then the motions.
///
/// # Errors
/// A displacement that incremental bonds would ignore, that moves bonded particles to one position
/// or particles too far away; a motion of a degree of freedom that a support holds.
pub(super) fn start(
    scene: &Scene,
    groups: &BTreeMap<String, Vec<u32>>,
    bodies: &[PlacedBody],
    state: &mut State,
) -> Result<()> {
    if scene.initial.is_empty() {
        return Ok(());
    }
    for (name, initial) in &scene.initial {
        let place = format!("{}: [initial.{name}]", scene.source);
        displace(&place, initial, groups, bodies, state)?;
    }
    refuse_short_bonds(scene, bodies, state)?;
    let held = held_degrees_of_freedom(state.supports.iter());
    for (name, initial) in &scene.initial {
        let place = format!("{}: [initial.{name}]", scene.source);
        set_moving(&place, initial, groups, &held, state)?;
    }
    Ok(())
}

fn displace(
    place: &str,
    initial: &Initial,
    groups: &BTreeMap<String, Vec<u32>>,
    bodies: &[PlacedBody],
    state: &mut State,
) -> Result<()> {
    let by_m = Vector3::from(initial.displacement_m);
    if by_m == Vector3::zeros() {
        return Ok(());
    }
    if !state.bonds.histories.sums.is_empty() {
        return Err(Diagnostic::input(
            place,
            "displacement would not strain bonds of the formulation \"incremental\", which know \
             only how they have moved since the start",
            "write formulation = \"total\" in [bonds], or remove displacement",
        ));
    }
    for &i in particles_of(groups, &initial.group) {
        let pose = &mut state.particles.poses[i as usize];
        pose.put_at((pose.place() + by_m).into());
        check_place(pose, || called(bodies, &state.clumps, i))
            .map_err(|error| error.within(place))?;
    }
    Ok(())
}

/// Refuses bonded particles at the same position, where their bond has no direction.
fn refuse_short_bonds(scene: &Scene, bodies: &[PlacedBody], state: &State) -> Result<()> {
    let poses = &state.particles.poses;
    let is_short = |pair: &&[u32; 2]| {
        let [a, b] = **pair;
        let [a, b] = [&poses[a as usize], &poses[b as usize]];
        let least_m = super::contacts::ROUNDING * a.radius_m().min(b.radius_m());
        (b.place() - a.place()).norm() <= least_m
    };
    let Some(&[a, b]) = state.bonds.ends.iter().find(is_short) else {
        return Ok(());
    };
    let [a, b] = [a, b].map(|i| called(bodies, &state.clumps, i));
    Err(Diagnostic::input(
        format!("{}: [initial]", scene.source),
        format!("{a} and {b}, which a bond joins, are displaced to the same place"),
        "displace them less",
    ))
}

/// Adds a velocity, and the motion of a rigid body about the centre of mass of the set.
fn set_moving(
    place: &str,
    initial: &Initial,
    groups: &BTreeMap<String, Vec<u32>>,
    held: &BTreeMap<u32, [bool; 6]>,
    state: &mut State,
) -> Result<()> {
    let particles = particles_of(groups, &initial.group);
    let p = &mut state.particles;
    let (mut mass_kg, mut moment) = (0.0, Vector3::zeros());
    for &i in particles {
        let one_kg = 1.0 / p.motions[i as usize].inverse_mass;
        mass_kg += one_kg;
        moment += one_kg * p.poses[i as usize].place();
    }
    let centre = moment / mass_kg;
    let spin = Vector3::from(initial.angular_velocity_rad_s);
    for i in particles {
        let arm = p.poses[*i as usize].place() - centre;
        let [vx, vy, vz]: [f64; 3] =
            (Vector3::from(initial.velocity_m_s) + spin.cross(&arm)).into();
        let six = [vx, vy, vz, spin.x, spin.y, spin.z];
        let is_held = held.get(i).copied().unwrap_or_default();
        if let Some(k) = (0..6).find(|&k| is_held[k] && six[k] != 0.0) {
            return Err(Diagnostic::input(
                place,
                format!(
                    "it gives a particle of '{}' {} {}, where a support holds it",
                    initial.group, six[k], MOTIONS[k]
                ),
                "set particles in motion that can move, or let the support move them",
            ));
        }
        let motion = &mut p.motions[*i as usize];
        for k in 0..3 {
            motion.velocity_m_s[k] += six[k];
            motion.spin_rad_s[k] += six[k + 3];
        }
    }
    Ok(())
}
