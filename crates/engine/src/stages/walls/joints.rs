//! Walls that meet: a sphere at their joint touches one surface, not each of them.
//!
//! Of the touches that stand for one surface the nearest is kept, with the contact history of the
//! wall from which the sphere comes.

use crate::state::meetings::{Joint, JointBuffers, Meeting, Meetings, WallTouch};
use crate::state::particles::{Particles, Pose};
use crate::state::walls::Wall;
use dem_physics::geometry::Touch;
use dem_physics::geometry::one_surface::is_one;

/// Touches whose distances differ by less than this fraction of the radius are equally near: walls
/// in one plane differ by rounding.
const AS_NEAR: f64 = 1e-6;

/// Keeps, of meetings of a particle with several walls that stand for one surface, only one.
/// `buffers`: kept for their memory.
pub(super) fn join_walls(
    walls: &[Wall],
    meetings: &mut [Meetings],
    particles: &Particles,
    buffers: &mut JointBuffers,
) {
    find_joints(walls.len(), meetings, particles, buffers);
    let JointBuffers {
        joints,
        touches,
        left,
        doubles,
        ..
    } = buffers;
    for some in joints.chunk_by(|a, b| a.particle == b.particle) {
        let pose = &particles.poses[some[0].particle as usize];
        touches.clear();
        touches.extend(some.iter().map(|joint| {
            let meeting = &meetings[joint.chunk].all[joint.at];
            let shape = &walls[joint.wall].model.shape;
            let place = shape.place(meeting.there, pose.radius_m());
            (joint.wall, place, meeting.old.is_some())
        }));
        find_doubles(touches, pose.radius_m(), left, doubles);
        for &(kept, dropped) in doubles.iter() {
            drop_double(walls, meetings, pose, [&some[kept], &some[dropped]]);
        }
    }
    for joint in joints.iter() {
        // Once a chunk is cleared, none of its numbers leads to a double.
        let all = &mut meetings[joint.chunk].all;
        if all.get(joint.at).is_some_and(|meeting| meeting.is_double) {
            all.retain(|meeting| !meeting.is_double);
        }
    }
}

/// Sets the meetings of particles that touch more than one wall, by particle, wall and place in the
/// list.
fn find_joints(
    walls: usize,
    meetings: &[Meetings],
    particles: &Particles,
    JointBuffers {
        joints, of_walls, ..
    }: &mut JointBuffers,
) {
    joints.clear();
    let first_of = |wall: usize| meetings.partition_point(|some| some.of.0 < wall);
    let touched = (0..walls)
        .map(|wall| [first_of(wall), first_of(wall + 1)])
        .filter(|[first, end]| {
            meetings[*first..*end]
                .iter()
                .any(|some| !some.all.is_empty())
        });
    of_walls.clear();
    of_walls.extend(touched);
    let count = |[first, end]: [usize; 2]| -> usize {
        meetings[first..end].iter().map(|some| some.all.len()).sum()
    };
    for (n, &one) in of_walls.iter().enumerate() {
        for &other in &of_walls[n + 1..] {
            let [few, many] = if count(one) <= count(other) {
                [one, other]
            } else {
                [other, one]
            };
            add_common(meetings, particles, [few, many], joints);
        }
    }
    joints.sort_unstable();
    joints.dedup();
}

/// Adds the meetings of particles that touch both of two walls, whose meetings stand between these
/// places. The first wall has fewer of them.
fn add_common(
    meetings: &[Meetings],
    particles: &Particles,
    [few, many]: [[usize; 2]; 2],
    joints: &mut Vec<Joint>,
) {
    let touches = |meeting: &Meeting| {
        meeting.there.distance_m < particles.poses[meeting.particle as usize].radius_m()
    };
    let mut far = many[0];
    for near in few[0]..few[1] {
        for (at, meeting) in meetings[near].all.iter().enumerate() {
            let particle = meeting.particle;
            let is_before = |some: &Meetings| some.all.last().is_none_or(|m| m.particle < particle);
            while far < many[1] && is_before(&meetings[far]) {
                far += 1;
            }
            if far == many[1] {
                return;
            }
            let others = &meetings[far].all;
            let first = others.partition_point(|other| other.particle < particle);
            let own = others[first..]
                .iter()
                .take_while(|other| other.particle == particle);
            let own = (first..).zip(own).filter(|(_, other)| touches(other));
            let before = joints.len();
            joints.extend(own.map(|(at, _)| Joint {
                particle,
                wall: meetings[far].of.0,
                chunk: far,
                at,
            }));
            if joints.len() > before && touches(meeting) {
                joints.push(Joint {
                    particle,
                    wall: meetings[near].of.0,
                    chunk: near,
                    at,
                });
            } else {
                joints.truncate(before);
            }
        }
    }
}

/// Finds which of the touches of a sphere with several walls stand for one surface: pairs of the
/// one kept and one dropped. `left`: kept for its memory.
fn find_doubles(
    touches: &[WallTouch],
    radius_m: f64,
    left: &mut Vec<usize>,
    found: &mut Vec<(usize, usize)>,
) {
    found.clear();
    left.clear();
    left.extend(0..touches.len());
    let distance_m = |at: usize| touches[at].1.touch.distance_m;
    loop {
        let nearest = left.iter().map(|at| distance_m(*at));
        let limit_m = nearest.fold(f64::INFINITY, f64::min) + AS_NEAR * radius_m;
        let as_near = left.iter().copied().filter(|at| distance_m(*at) <= limit_m);
        // A face before an edge; then the wall that the sphere touches already; then in the order
        // of the walls.
        let kept = as_near.min_by_key(|at| {
            let (wall, place, goes_on) = &touches[*at];
            (!place.is_flat, !goes_on, *wall)
        });
        let Some(kept) = kept else {
            return;
        };
        left.retain(|&at| {
            let is_double = at != kept
                && touches[at].0 != touches[kept].0
                && is_one(&touches[kept].1, &touches[at].1, radius_m);
            if is_double {
                found.push((kept, at));
            }
            at != kept && !is_double
        });
    }
}

/// Marks a meeting as the double of the one kept. Its contact goes on there; if that one has its
/// own, it ends.
fn drop_double(
    walls: &[Wall],
    meetings: &mut [Meetings],
    pose: &Pose,
    [kept, dropped]: [&Joint; 2],
) {
    let double = &mut meetings[dropped.chunk].all[dropped.at];
    let old = double.old;
    double.is_double = true;
    let Some(number) = old else {
        return;
    };
    let goes_on = &mut meetings[kept.chunk].all[kept.at];
    if goes_on.old.is_none() {
        goes_on.old = old;
        goes_on.old_wall = Some(dropped.wall as u32);
        return;
    }
    let ended = &walls[dropped.wall].touching[number as usize];
    meetings[dropped.chunk].all[dropped.at] = Meeting::ended(ended, pose, number);
}

/// Removes, of the touches of a sphere with walls, given in space, those that stand for the same
/// surface as a nearer one.
pub fn drop_doubles(walls: &[Wall], touches: &mut Vec<(usize, Touch)>, radius_m: f64) {
    if touches.len() < 2 {
        return;
    }
    let places = touches.iter().map(|(wall, touch)| {
        let shape = &walls[*wall].model.shape;
        (*wall, shape.place(*touch, radius_m), false)
    });
    let places: Vec<WallTouch> = places.collect();
    let mut dropped = Vec::new();
    find_doubles(&places, radius_m, &mut Vec::new(), &mut dropped);
    let mut at = 0..;
    touches.retain(|_| {
        let at = at.next();
        !dropped.iter().any(|(_, dropped)| Some(*dropped) == at)
    });
}
