//! Walls: their motion, and their contacts with particles.

pub(crate) mod carrying;
mod driven;
pub mod joints;
mod meeting;
mod motion;
pub(super) mod patches;

use nalgebra::Vector3;

use self::joints::join_walls;
use self::meeting::Place;
pub use self::motion::fastest_point_m_s;
pub(crate) use self::motion::{
    drift_walls, has_moved, moves, plan_wall_motions, surface_velocity_m_s, will_move,
};
use self::patches::{book_patches, book_sleepers};
use super::stage::{Need, Stage};
use crate::stages::contacts::forces::{StoredEnergy, StoredForce};
use crate::state::State;
use crate::state::contacts::{ContactHistory, Contacts};
use crate::state::meetings::{Meeting, Meetings, Met};
use crate::state::particles::{Particles, Pose};
use crate::state::walls::{Wall, WallContact, WallLoad};
use crate::threads;
use dem_physics::contact::kinematics::{ContactKinematics, WallPoint, wall_contact_kinematics};
use dem_physics::contact::law::ContactKind;
use dem_physics::geometry::{Frame, Touch};
use dem_physics::number::Vec3;

/// Contacts with walls, and their motion.
pub const WALLS: Stage = Stage {
    bytes: |state| {
        let of_wall = |wall: &Wall| {
            let book = wall.book.as_ref().map_or(0, |book| book.bytes());
            size_of_val(wall) + size_of_val(&wall.near[..]) + size_of_val(&wall.touching[..]) + book
        };
        state.walls.iter().map(of_wall).sum()
    },
    ..Stage::new("walls", |state, _| {
        let walls = state.walls.len();
        Need::of(walls > 0, || format!("{walls}"), "no walls")
    })
};

/// Finds where particles touch walls, or did in the previous step. Walls that meet act as one
/// surface.
pub(crate) fn find_wall_contacts(state: &mut State) -> usize {
    if state.contacts.is_some() {
        let (walls, particles) = (&state.walls, &state.particles);
        let meetings = set_chunks(walls, &mut state.scratch.meetings);
        let find = |some: &mut Meetings| find_meetings(&walls[some.of.0], particles, some);
        for_each(meetings, near_walls(walls), find);
        if meetings.iter().any(|some| some.of.0 != meetings[0].of.0) {
            join_walls(walls, meetings, particles, &mut state.scratch.joints);
        }
    }
    0
}

/// Adds the wall forces to the wrenches. Returns the number of particles near walls.
pub(crate) fn compute_wall_contacts(state: &mut State) -> usize {
    let kick_s = state.kick_s();
    if let Some(contacts) = &mut state.contacts {
        wall_wrenches(
            &mut state.walls,
            contacts,
            &mut state.particles,
            &mut state.scratch.meetings,
            [state.previous_time_step_s, kick_s],
        );
        if let Some(sleep) = &state.sleep {
            book_sleepers(&mut state.walls, &sleep.touches, [state.time_s, kick_s]);
        }
        if let Some(clusters) = (state.clusters.as_ref()).filter(|_| contacts.islands.is_open()) {
            let met = state.scratch.meetings[..chunks(&state.walls)].iter();
            for met in met.flat_map(|some| &some.met) {
                let piece = clusters.of_particle[met.touch.particle as usize];
                (contacts.islands).lose_at_walls(piece, met.lost_j[0] + met.lost_j[1]);
            }
        }
    }
    near_walls(&state.walls)
}

/// Number of particles near walls.
fn near_walls(walls: &[Wall]) -> usize {
    walls.iter().map(|wall| wall.near.len()).sum()
}

/// Number of chunks of the particles near walls.
pub(super) fn chunks(walls: &[Wall]) -> usize {
    let of_wall = |wall: &Wall| wall.near.len().div_ceil(CHUNK);
    walls.iter().map(of_wall).sum()
}

/// Velocity of a wall at a point, m/s, without that of its surface along itself.
pub(super) fn velocity_at(wall: &Wall, point: &Vector3<f64>) -> Vector3<f64> {
    let [velocity, spin] = [wall.velocities_m_s[0], wall.spins_rad_s[0]].map(Vector3::from);
    velocity + spin.cross(&(point - Vector3::from(wall.frame.position_m)))
}

/// Particles handled by one task.
const CHUNK: usize = 256;
/// Fewer particles near walls than this are left to one thread, which has them in its cache.
const FEW: usize = 4 * CHUNK;
/// A contact that moves to another flat part of a wall keeps its history if the cosine of the angle
/// between the normals exceeds this.
pub(super) const SAME_WAY: f64 = 0.9;

/// Lists the particles whose surface is less than `skin_m` from a wall, where none sleeps.
pub(crate) fn list_near(walls: &mut [Wall], particles: &Particles, skin_m: f64) {
    for wall in walls {
        wall.near = {
            let is_near = nearness(wall, skin_m);
            let numbered = (0..).zip(&particles.poses);
            let near = numbered.filter(|(_, pose)| is_near(pose));
            near.map(|(i, _)| i).collect()
        };
    }
}

/// Test whether the surface of a sphere is less than `skin_m` from a wall.
pub(crate) fn nearness(wall: &Wall, skin_m: f64) -> impl Fn(&Pose) -> bool + Sync {
    let is_reached = reaches(wall);
    move |pose| is_reached(pose.place().into(), pose.radius_m() + skin_m)
}

/// A point of a wall, m, and the unit vector out of it, if it is a plane.
pub(crate) fn plane_in_space(wall: &Wall) -> Option<[Vector3<f64>; 2]> {
    let plane = wall.model.shape.plane()?;
    let point = wall.frame.to_space(plane.point_m());
    let normal = wall.frame.direction_to_space(plane.normal());
    Some([point.into(), normal.into()])
}

/// Test whether a wall is nearer to a point than a distance, m.
pub(crate) fn reaches(wall: &Wall) -> impl Fn([f64; 3], f64) -> bool + Sync {
    let bounds = wall.model.shape.bounds();
    let in_space = wall.bounds_in_space();
    let to_wall = wall.frame.all_to_wall();
    let plane = plane_in_space(wall);
    move |point, reach_m| {
        // A plane is infinite: it needs neither box nor frame.
        if let Some([on_plane, normal]) = &plane {
            return (Vector3::from(point) - on_plane).dot(normal) < reach_m;
        }
        if !in_space.is_near(&point, reach_m) {
            return false;
        }
        let centre = to_wall(point);
        bounds.is_near(&centre, reach_m) && wall.model.shape.is_within(centre, reach_m)
    }
}

/// Adds the wall forces to the wrenches after a step of `dt`, s, before a kick of `kick_s`, s, and
/// records their reactions on the walls: at the `meetings` that have been found in this step.
pub(crate) fn wall_wrenches(
    walls: &mut [Wall],
    contacts: &mut Contacts,
    particles: &mut Particles,
    meetings: &mut [Meetings],
    [dt, kick_s]: [f64; 2],
) {
    let meetings = &mut meetings[..chunks(walls)];
    let meet = |meetings: &mut Meetings| {
        let wall = &walls[meetings.of.0];
        let place = Place {
            wall,
            walls,
            olds: &wall.touching,
            particles,
            materials: &contacts.materials,
            least_overlap: contacts.model.least_overlap,
            dt,
        };
        place.meet(&meetings.all, &mut meetings.met);
    };
    for_each(meetings, near_walls(walls), meet);
    let force_n = |wall: &Wall, old: &WallContact| touch_force_n(wall, contacts, particles, old);
    book_patches(walls, (particles, &force_n), meetings, [dt, kick_s]);
    for wall in walls.iter_mut() {
        wall.push = WallLoad::default();
        wall.scratch.damping = WallLoad::default();
        wall.scratch.elastic_j = 0.0;
        wall.stiffness_n_m = 0.0;
        wall.touching.clear();
    }
    for some in meetings {
        for met in &some.met {
            book(&mut walls[some.of.0], met, particles);
        }
    }
}

/// Calls `work` for each chunk of `near` particles, with several threads if they are many.
fn for_each(meetings: &mut [Meetings], near: usize, work: impl Fn(&mut Meetings) + Sync + Send) {
    if near < FEW {
        meetings.iter_mut().for_each(work);
    } else {
        threads::for_each(meetings.iter_mut(), work);
    }
}

/// Divides the particles near each wall into chunks.
fn set_chunks<'a>(walls: &[Wall], meetings: &'a mut Vec<Meetings>) -> &'a mut [Meetings] {
    let mut chunks = 0;
    for (number, wall) in walls.iter().enumerate() {
        for first in (0..wall.near.len()).step_by(CHUNK) {
            if meetings.len() == chunks {
                meetings.push(Meetings::default());
            }
            meetings[chunks].of = (number, first..wall.near.len().min(first + CHUNK));
            chunks += 1;
        }
    }
    &mut meetings[..chunks]
}

/// Sets where the particles of a chunk touch a wall, or did in the previous step.
fn find_meetings(wall: &Wall, particles: &Particles, meetings: &mut Meetings) {
    let to_wall = wall.frame.all_to_wall();
    let bounds = wall.model.shape.bounds();
    let is_solid = wall.model.shape.is_finite_solid();
    let Meetings {
        of: (_, range),
        touches,
        all: found,
        ..
    } = meetings;
    let some = &wall.near[range.clone()];
    found.clear();
    let first = some.first().copied().unwrap_or(0);
    let mut first = wall.touching.partition_point(|old| old.particle < first);
    for &particle in some {
        let old = &wall.touching[first..];
        let passed = old.iter().take_while(|old| old.particle < particle);
        first += passed.count();
        let old = &wall.touching[first..];
        let own = old.iter().take_while(|old| old.particle == particle);
        let before = &old[..own.count()];
        let pose = &particles.poses[particle as usize];
        let centre = to_wall(pose.place().into());
        touches.clear();
        if bounds.is_near(&centre, pose.radius_m()) {
            wall.model.shape.touches(centre, pose.radius_m(), touches);
        }
        let first_found = found.len();
        add_meetings(
            &wall.frame,
            (particle, pose),
            touches,
            (first, before),
            found,
        );
        if is_solid
            && !touches.is_empty()
            && let Some(meeting) = found.get_mut(first_found)
        {
            meeting.is_behind = comes_out_behind(meeting, before);
        }
    }
}

fn book(wall: &mut Wall, met: &Met, particles: &mut Particles) {
    let i = met.touch.particle as usize;
    particles.wrenches[i].add(&met.forces[0], &met.torque);
    let arm = met.point - Vector3::from(wall.frame.position_m);
    let pushes = [&mut wall.push, &mut wall.scratch.damping];
    for ((push, force), moment) in pushes.into_iter().zip(met.forces).zip(met.moments) {
        let about_pivot = arm.cross(&force) + moment;
        push.add(force.into(), about_pivot.into(), force.dot(&met.belt));
    }
    wall.scratch.elastic_j += met.elastic_j;
    wall.stiffness_n_m += met.stiffness_n_m;
    wall.friction_j += met.lost_j[0];
    wall.damping_j += met.lost_j[1];
    if met.crossed {
        wall.scratch.crossed = Some(met.touch.particle);
    }
    if met.touch.history != ContactHistory::default() {
        wall.touching.push(met.touch);
    }
}

/// Adds the `touches` of a particle, given in the wall's frame, and the contacts that have ended.
fn add_meetings(
    frame: &Frame,
    (particle, pose): (u32, &Pose),
    touches: &[Touch],
    (first, before): (usize, &[WallContact]),
    found: &mut Vec<Meeting>,
) {
    let first_found = found.len();
    let numbered = |at: usize| Some((first + at) as u32);
    for touch in touches {
        let there = frame.touch_to_space(touch);
        let normal = -Vector3::from(there.normal);
        let old = remembered(before, touches, touch, &normal);
        found.push(Meeting::new(particle, there, old.and_then(numbered)));
    }
    // The losses of contacts that have ended are still to be recorded.
    for (at, old) in before.iter().enumerate() {
        let goes_on = |meeting: &Meeting| {
            let known = meeting.old.map(|known| &before[known as usize - first]);
            known.is_some_and(|known| known.feature == old.feature)
        };
        if !found[first_found..].iter().any(goes_on) {
            found.push(Meeting::ended(old, pose, (first + at) as u32));
        }
    }
}

/// Whether a particle touches a solid from the opposite side compared with the previous step: it
/// went through a solid thinner than itself.
fn comes_out_behind(meeting: &Meeting, before: &[WallContact]) -> bool {
    let normal = -Vector3::from(meeting.there.normal);
    before
        .iter()
        .any(|old| Vector3::from(old.normal).dot(&normal) < 0.0)
}

/// Number, in those before, of the contact that a touch continues: that of the same feature. When a
/// sphere slides from one flat part to the next, it is that of a feature that the sphere no longer
/// touches and whose normal was nearly the same.
fn remembered(
    before: &[WallContact],
    touches: &[Touch],
    touch: &Touch,
    normal: &Vector3<f64>,
) -> Option<usize> {
    let same = before.iter().position(|old| old.feature == touch.feature);
    same.or_else(|| {
        let left = |old: &&WallContact| touches.iter().all(|t| t.feature != old.feature);
        let alike = |old: &&WallContact| Vector3::from(old.normal).dot(normal) > SAME_WAY;
        before.iter().position(|old| left(&old) && alike(&old))
    })
}

/// Force of a wall at rest on a particle at rest at one point, from its contact history.
pub(crate) fn push_at_rest(
    wall: &Wall,
    contacts: &Contacts,
    particles: &Particles,
    old: &WallContact,
) -> WallLoad {
    let pose = &particles.poses[old.particle as usize];
    let there = Touch {
        point: pose.place().into(),
        feature: old.feature,
        normal: old.normal.map(|n| -n),
        distance_m: pose.radius_m() - old.history.overlap_m() - old.history.origin_m(),
    };
    let place = Place {
        wall,
        walls: &[],
        olds: std::slice::from_ref(old),
        particles,
        materials: &contacts.materials,
        least_overlap: contacts.model.least_overlap,
        dt: 0.0,
    };
    let mut met = Vec::new();
    place.meet(&[Meeting::new(old.particle, there, Some(0))], &mut met);
    let mut push = WallLoad::default();
    for met in met {
        let arm = met.point - Vector3::from(wall.frame.position_m);
        let about_pivot = arm.cross(&met.forces[0]) + met.moments[0];
        push.add(met.forces[0].into(), about_pivot.into(), 0.0);
    }
    push
}

/// Contact of a particle at rest with a wall at rest; `normal` from the wall to its centre, overlap
/// `overlap_m`.
pub(crate) fn wall_contact(
    particles: &Particles,
    i: usize,
    normal: &Vector3<f64>,
    overlap_m: f64,
) -> ContactKinematics {
    let foot = WallPoint {
        normal: (*normal).into(),
        normal_before: (*normal).into(),
        distance_m: particles.poses[i].radius_m() - overlap_m,
        velocity_m_s: Vec3(0.0, 0.0, 0.0),
        spin_rad_s: Vec3(0.0, 0.0, 0.0),
    };
    wall_contact_kinematics(&foot, particles.contact_sphere_at_rest(i), 0.0)
}

/// A recorded contact of a particle with a wall, both at rest.
fn recorded(particles: &Particles, touch: &WallContact) -> ContactKinematics {
    let overlap_m = touch.history.overlap_m();
    let normal = Vector3::from(touch.normal);
    let mut recorded = wall_contact(particles, touch.particle as usize, &normal, overlap_m);
    recorded.overlap_m = overlap_m;
    recorded
}

/// Part of the energy of recorded contacts of a wall that is adhesion, J: below 0.
pub(crate) fn touches_adhesion_j<'a>(
    wall: &Wall,
    contacts: &Contacts,
    particles: &Particles,
    touches: impl Iterator<Item = &'a WallContact>,
) -> f64 {
    if !wall.model.kinds.iter().any(ContactKind::attracts) {
        return 0.0;
    }
    let adhesion_j = |touch: &WallContact| {
        let kind = wall.kind(contacts.materials[touch.particle as usize]);
        kind.adhesion_j(&recorded(particles, touch))
    };
    touches.map(adhesion_j).sum()
}

/// Elastic energy of a recorded wall contact, J.
pub fn touch_energy_j(
    wall: &Wall,
    contacts: &Contacts,
    particles: &Particles,
    touch: &WallContact,
) -> f64 {
    let kind = wall.kind(contacts.materials[touch.particle as usize]);
    let history = &touch.history;
    let touch = recorded(particles, touch);
    kind.with(|number| number, StoredEnergy { touch, history })
}

/// Where a wall touches a particle in a recorded contact, m.
pub fn touch_point_m(particles: &Particles, touch: &WallContact) -> Vector3<f64> {
    let pose = &particles.poses[touch.particle as usize];
    let lever_m = pose.radius_m() - touch.history.overlap_m();
    pose.place() - lever_m * Vector3::from(touch.normal)
}

/// Force of a wall on a particle in a recorded contact, N.
pub fn touch_force_n(
    wall: &Wall,
    contacts: &Contacts,
    particles: &Particles,
    old: &WallContact,
) -> Vector3<f64> {
    let history = &old.history;
    let touch = recorded(particles, old);
    let kind = wall.kind(contacts.materials[old.particle as usize]);
    kind.with(|number| number, StoredForce { touch, history })
}

/// Makes the overlaps of some particles, ascending, with a wall the origins of their laws.
pub(crate) fn relax_touches(wall: &mut Wall, particles: &Particles, some: &[u32]) {
    let is_near = nearness(wall, 0.0);
    let mut found = Vec::new();
    let mut touches = Vec::new();
    for &particle in some {
        let pose = &particles.poses[particle as usize];
        if !is_near(pose) {
            continue;
        }
        touches.clear();
        let centre = wall.frame.to_wall(pose.place().into());
        wall.model
            .shape
            .touches(centre, pose.radius_m(), &mut touches);
        found.extend(touches.iter().map(|touch| {
            let there = wall.frame.touch_to_space(touch);
            WallContact {
                particle,
                feature: there.feature,
                normal: there.normal.map(|x| -x),
                history: ContactHistory::separated_at(pose.radius_m() - there.distance_m),
            }
        }));
    }
    drop(is_near);
    wall.touching.extend(found);
    wall.touching.sort_by_key(|touch| touch.particle);
}

/// Distance of a sphere from a wall, m; infinite if it exceeds the radius of the sphere.
pub(crate) fn gap_m(wall: &Wall, pose: &Pose) -> f64 {
    let centre = wall.frame.to_wall(pose.place().into());
    let mut touches = Vec::new();
    let reach_m = 2.0 * pose.radius_m();
    wall.model.shape.touches(centre, reach_m, &mut touches);
    let gaps = touches
        .iter()
        .map(|touch| touch.distance_m - pose.radius_m());
    gaps.fold(f64::INFINITY, f64::min)
}
