//! Books of what contacts do to the patches of walls.

use nalgebra::Vector3;

use super::motion::surface_velocity_m_s;
use crate::state::bridges::WallBridge;
use crate::state::meetings::{Meeting, Meetings, Met};
use crate::state::particles::Particles;
use crate::state::sleep::FrozenWallContact;
use crate::state::walls::{Wall, WallContact};
use dem_physics::contact::patch_book::PatchStep;

/// Force of a wall on a particle in a recorded contact, N.
type ForceN<'a> = &'a dyn Fn(&Wall, &WallContact) -> Vector3<f64>;

/// Books the contacts at these meetings after a step of `dt`, s, before a kick of `kick_s`, s. The
/// walls still have the contacts of the step before, with these forces.
pub(super) fn book_patches(
    walls: &mut [Wall],
    (particles, force_n): (&Particles, ForceN<'_>),
    meetings: &[Meetings],
    [dt, kick_s]: [f64; 2],
) {
    for some in meetings {
        let number = some.of.0;
        if walls[number].book.is_none() {
            continue;
        }
        for pair @ (meeting, _) in some.all.iter().zip(&some.met) {
            let step = step(walls, number, (particles, force_n), pair, dt);
            let centre = particles.poses[meeting.particle as usize].place();
            let foot = centre + Vector3::from(meeting.there.normal) * meeting.there.distance_m;
            let wall = &mut walls[number];
            book(wall, foot, meeting.there.normal, &step, kick_s);
        }
    }
}

/// Books what a contact has done in a step before a kick of `kick_s`, s, at a point of a wall, m,
/// with the normal into it, both in space.
fn book(wall: &mut Wall, point: Vector3<f64>, inward: [f64; 3], step: &PatchStep, kick_s: f64) {
    let patch = patch_at(wall, point, inward);
    if let Some(book) = &mut wall.book {
        book.of(patch).add(step, kick_s);
    }
}

/// Number of the patch of a wall at a point, m, with the normal into it, both in space.
fn patch_at(wall: &Wall, point: Vector3<f64>, inward: [f64; 3]) -> u64 {
    let (shape, frame, model) = (&wall.model.shape, &wall.frame, &wall.model.book);
    let model = model.as_ref();
    model.map_or(0, |model| {
        model.patch_at(shape, frame, point.into(), inward)
    })
}

/// What a contact has done to the wall of this number in a step of `dt`, s.
fn step(
    walls: &[Wall],
    number: usize,
    (particles, force_n): (&Particles, ForceN<'_>),
    (meeting, met): (&Meeting, &Met),
    dt: f64,
) -> PatchStep {
    let (wall, i) = (&walls[number], meeting.particle as usize);
    let old_wall = meeting.old_wall.map_or(wall, |old| &walls[old as usize]);
    let old = meeting.old.map(|old| &old_wall.touching[old as usize]);
    let [before_n, overlap_before_m] = old.map_or([0.0; 2], |old| {
        let force = force_n(old_wall, old);
        [
            Vector3::from(old.normal).dot(&force),
            old.history.overlap_m(),
        ]
    });
    let normal = Vector3::from(met.touch.normal);
    let arm = met.point - particles.poses[i].place();
    let motion = &particles.motions[i];
    let [velocity, spin] = [motion.velocity_m_s, motion.spin_rad_s].map(Vector3::from);
    let along = velocity + spin.cross(&arm) - surface_velocity_m_s(wall, particles, &met.touch, 0);
    PatchStep {
        normal_before_n: before_n,
        closing_m: met.touch.history.overlap_m() - overlap_before_m,
        slid_m: dt * (along - normal * along.dot(&normal)).norm(),
        lost_j: met.lost_j,
        ..PatchStep::of(&wall.frame, met.forces[0], normal)
    }
}

/// Books the bodies that sleep on walls at this time, s, before a kick of `kick_s`, s: they press,
/// and a belt carries those that ride on it from patch to patch.
pub(super) fn book_sleepers(
    walls: &mut [Wall],
    touches: &[FrozenWallContact],
    [time_s, kick_s]: [f64; 2],
) {
    for kept in touches {
        let wall = &mut walls[kept.wall];
        if wall.book.is_none() {
            continue;
        }
        let normal = Vector3::from(kept.touch.normal);
        let carried = Vector3::from(wall.model.surface_velocity_m_s) * (time_s - kept.at_s);
        let foot = Vector3::from(wall.frame.to_space(kept.foot_m)) + carried;
        let step = PatchStep::of(&wall.frame, kept.push.force_n.into(), normal);
        book(wall, foot, (-normal).into(), &step, kick_s);
    }
}

/// Books the pull of a liquid bridge on a wall before a kick of `kick_s`, s.
pub(crate) fn book_bridge(
    wall: &mut Wall,
    particles: &Particles,
    bridge: &WallBridge,
    kick_s: f64,
) {
    if wall.book.is_none() {
        return;
    }
    let pose = &particles.poses[bridge.particle as usize];
    let normal = Vector3::from(bridge.normal);
    let foot = pose.place() - normal * (pose.radius_m() + bridge.gap_m);
    let step = PatchStep::of(&wall.frame, bridge.load.force_n.into(), normal);
    book(wall, foot, (-normal).into(), &step, kick_s);
}
