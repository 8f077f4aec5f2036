//! Rigid parts of bonded bodies in the time step: forces on their spheres act on the parts, and the
//! spheres move with them.

use nalgebra::{Matrix3, Vector3};

use crate::stages::chunks::CHUNK;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::particles::{Motion, Particles, Pose, Wrench};
use crate::state::rigid_parts::{RigidPart, RigidParts};
use dem_physics::rigid::rotation_vector;
use dem_physics::rotation;
use dem_physics::rotation::numbers;
use dem_physics::rotation::rotation as rotation_of;

/// Rigid parts of bonded bodies.
pub(crate) const RIGID_PARTS: Stage = Stage {
    bytes: |state| state.rigid_parts.bytes(),
    ..Stage::new("rigid parts", |state, _| {
        let (zones, parts) = (state.model.rules.zones.len(), &state.rigid_parts);
        Need::of(
            zones > 0,
            || {
                format!(
                    "{} at the start, of {} spheres; {} bonds within them are not computed",
                    parts.all.len(),
                    spheres(parts),
                    parts.bonds
                )
            },
            "no body is bonded in a region only",
        )
    })
};

/// Sums the forces on the spheres of rigid parts, and replaces them by those with which the spheres
/// move as the parts do. Returns the number of their spheres.
pub(crate) fn gather_rigid_parts(state: &mut State) -> usize {
    take_broken_impulses(state);
    let particles = &mut state.particles;
    for part in &mut state.rigid_parts.all {
        note_hits(part, particles, &state.bonds);
        gather(part, particles, &state.bond_resistance);
    }
    spheres(&state.rigid_parts)
}

/// Records whether what acts on a part, contacts and bonds, would break its own bonds.
fn note_hits(part: &mut RigidPart, particles: &Particles, bonds: &Bonds) {
    let breaks_from_n_m = part.breaks_from_n_m(bonds);
    if breaks_from_n_m.is_infinite() {
        return;
    }
    let centre = Vector3::from(part.place_m);
    let mut moment = Matrix3::zeros();
    for &i in &part.members {
        let force = vector(particles.wrenches[i as usize].force_n);
        let arm = particles.poses[i as usize].place() - centre;
        moment += force * arm.transpose();
    }
    let touched = (moment != Matrix3::zeros()).then_some(&moment);
    part.hits.note(touched, breaks_from_n_m);
}

/// Gives the part the impulse that a bond which broke in this kick had on one of its spheres: see
/// [`crate::stages::bonds::breakage`].
fn take_broken_impulses(state: &mut State) {
    let half_s = 0.5 * state.previous_time_step_s;
    for (end, on_end) in state.scratch.events.broken.iter().flat_map(|b| b.ends) {
        let number = state.rigid_parts.of(end) as usize;
        let Some(part) = state.rigid_parts.all.get_mut(number) else {
            continue;
        };
        let [fx, fy, fz, tx, ty, tz] = on_end;
        let force = Vector3::new(fx, fy, fz);
        let arm = state.particles.poses[end as usize].place() - Vector3::from(part.place_m);
        let torque = Vector3::new(tx, ty, tz) + arm.cross(&force);
        for k in 0..3 {
            part.velocity_m_s[k] += half_s * force[k] / part.mass_kg;
            part.angular_momentum[k] += half_s * torque[k];
        }
    }
}

/// Force on a part, N, and torque about its centre of mass, N m, of all `lists` of wrenches, each
/// with one for each particle, or empty. Or impulses, N s and N m s.
fn forces_on(part: &RigidPart, poses: &[Pose], lists: [&[Wrench]; 2]) -> [Vector3<f64>; 2] {
    let centre = Vector3::from(part.place_m);
    let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
    for &i in &part.members {
        let i = i as usize;
        let arm = poses[i].place() - centre;
        for wrench in lists.iter().filter_map(|list| list.get(i)) {
            let on_sphere = vector(wrench.force_n);
            force += on_sphere;
            torque += vector(wrench.torque_n_m) + arm.cross(&on_sphere);
        }
    }
    [force, torque]
}

/// Gives the spheres of rigid parts the motions of the parts at the time of their poses: predicted
/// from the forces with this damping of bonds, and these impulses; each one for each particle, or
/// none.
pub(crate) fn predict_rigid_parts(
    state: &State,
    of_bonds: &[Wrench],
    impulses: &[Wrench],
    predicted: &mut [Motion],
) {
    let half_s = 0.5 * state.previous_time_step_s;
    let gravity = Vector3::from(state.model.gravity_m_s2);
    let (poses, wrenches) = (&state.particles.poses, &state.particles.wrenches);
    for part in &state.rigid_parts.all {
        let [force, torque] = forces_on(part, poses, [wrenches, of_bonds]);
        let [push, twist] = forces_on(part, poses, [impulses, &[]]);
        let velocity = half_s * (force / part.mass_kg + gravity) + push / part.mass_kg;
        let angular = half_s * torque + twist;
        let motion = [
            Vector3::from(part.velocity_m_s) + velocity,
            Vector3::from(part.angular_momentum) + angular,
        ];
        part.set_motions_of(motion, poses, predicted);
    }
}

/// Sums the forces on a part. Each sphere gets the motion of the part, and a wrench that
/// accelerates it, together with its damping of bonds, as the part is accelerated.
fn gather(part: &mut RigidPart, particles: &mut Particles, of_bonds: &[Wrench]) {
    let centre = Vector3::from(part.place_m);
    let lists = [&particles.wrenches[..], of_bonds];
    let [force, torque] = forces_on(part, &particles.poses, lists);
    part.set_motions(&particles.poses, &mut particles.motions);
    let (faster, spun) = (force / part.mass_kg, part.spun_by(&torque));
    for (&i, sphere) in part.members.iter().zip(&part.spheres) {
        let i = i as usize;
        let arm = particles.poses[i].place() - centre;
        let mut wrench = Wrench::default();
        wrench.add(
            &(sphere.mass_kg * (faster + spun.cross(&arm))),
            &(sphere.inertia_kg_m2 * spun),
        );
        if let Some(resists) = of_bonds.get(i) {
            wrench.add(&-vector(resists.force_n), &-vector(resists.torque_n_m));
        }
        particles.wrenches[i] = wrench;
    }
    part.force_n = force.into();
    part.torque_n_m = torque.into();
}

/// Updates the velocities of rigid parts. Returns the number of their spheres.
pub(crate) fn kick_rigid_parts(state: &mut State) -> usize {
    let kick_s = state.kick_s();
    for part in &mut state.rigid_parts.all {
        for (k, gravity) in state.model.gravity_m_s2.iter().enumerate() {
            part.velocity_m_s[k] += kick_s * (part.force_n[k] / part.mass_kg + gravity);
            part.angular_momentum[k] += kick_s * part.torque_n_m[k];
        }
    }
    0
}

/// Moves rigid parts, and puts their spheres in place, which have moved on as free ones.
pub(crate) fn drift_rigid_parts(state: &mut State) -> usize {
    let dt_s = state.time_step_s;
    let moved_m = &mut state.scratch.chunks_moved_m;
    for part in &mut state.rigid_parts.all {
        let fastest_m_s = drift(part, &mut state.particles, dt_s, moved_m);
        state.fastest_m_s = state.fastest_m_s.max(fastest_m_s);
    }
    0
}

/// Moves a part and its spheres over `dt_s`. Returns the largest speed of a sphere, m/s.
fn drift(
    part: &mut RigidPart,
    particles: &mut Particles,
    dt_s: f64,
    chunks_moved_m: &mut [f64],
) -> f64 {
    let (centre_before, before) = (Vector3::from(part.place_m), rotation_of(part.turned));
    for k in 0..3 {
        part.place_m[k] += dt_s * part.velocity_m_s[k];
    }
    rotation::drift(
        &mut part.turned,
        part.angular_momentum,
        part.moments_kg_m2,
        dt_s,
    );
    let now = rotation_of(part.turned);
    let turn = rotation_vector(numbers(&(now * before.inverse())));
    let spin_rad_s = turn.map(|angle| angle / dt_s);
    let centre = Vector3::from(part.place_m);
    let [from_own, to_space] = [before, now].map(|turned| turned.to_rotation_matrix());
    let mut fastest_m_s = 0.0_f64;
    for (&i, sphere) in part.members.iter().zip(&part.spheres) {
        let own = Vector3::from(sphere.place_m);
        let place = centre + to_space * own;
        // Contacts and bonds use the displacement in the step.
        let velocity = (place - (centre_before + from_own * own)) / dt_s;
        let speed_m_s = velocity.norm();
        fastest_m_s = fastest_m_s.max(speed_m_s);
        let chunk = &mut chunks_moved_m[i as usize / CHUNK];
        *chunk = chunk.max(speed_m_s * dt_s);
        let (pose, motion) = (
            &mut particles.poses[i as usize],
            &mut particles.motions[i as usize],
        );
        pose.put_at(place.into());
        pose.turned = numbers(&(now * rotation_of(sphere.turned)));
        motion.velocity_m_s = velocity.into();
        motion.spin_rad_s = spin_rad_s;
    }
    fastest_m_s
}

fn spheres(parts: &RigidParts) -> usize {
    parts.all.iter().map(|part| part.members.len()).sum()
}

fn vector([x, y, z, _]: [f64; 4]) -> Vector3<f64> {
    Vector3::new(x, y, z)
}
