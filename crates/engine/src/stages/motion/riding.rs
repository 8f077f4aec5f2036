//! Sleeping bodies that a moving surface carries along. They keep their velocity and their contacts
//! until they could come near something that does not move with them, which is known beforehand.

use nalgebra::Vector3;

use crate::stages::chunks::chunk_of;
use crate::stages::clumps::motion::place_spheres;
use crate::stages::search::neighbours::near_pairs;
use crate::stages::walls::carrying::{carrying_velocity_m_s, is_belt, steady_velocity_m_s};
use crate::stages::walls::{nearness, plane_in_space};
use crate::state::State;
use crate::state::clumps::Clumps;
use crate::state::particles::{Particles, Pose};
use crate::state::sleep::{Rider, Sleep};
use crate::state::walls::Wall;
use dem_physics::geometry::Bounds;
use dem_physics::geometry::balls::around;

/// What could come near in this number of steps is looked at now.
const STEPS_LEFT: f64 = 2.0;
/// Boxes are larger by this part of the skin, for rounding.
const ROUNDING: f64 = 0.01;

/// The sleepers, if any of them ride.
fn with_riders(state: &State) -> Option<&Sleep> {
    let sleep = state.sleep.as_ref();
    sleep.filter(|sleep| !sleep.riders.is_empty())
}

/// The particles of a cluster.
fn members(state: &State, cluster: u32) -> &[u32] {
    let clusters = state.clusters.as_ref();
    clusters.map_or(&[], |clusters| clusters.members(cluster))
}

/// Moves riders: clumps as a whole, without their spheres. Returns their number.
pub(crate) fn drift_riders(state: &mut State) -> usize {
    let (Some(sleep), Some(clusters)) = (&state.sleep, &state.clusters) else {
        return 0;
    };
    if sleep.riders.is_empty() {
        return 0;
    }
    let dt = state.time_step_s;
    let p = &mut state.particles;
    for rider in &sleep.riders {
        let members = clusters.members(rider.cluster).iter();
        for &i in members.take_while(|i| (**i as usize) < p.free) {
            for k in 0..3 {
                p.poses[i as usize].position_m[k] += dt * rider.velocity_m_s[k];
            }
        }
    }
    for clump in state.clumps.all.iter_mut().filter(|clump| clump.rides()) {
        for k in 0..3 {
            clump.place_m[k] += dt * clump.velocity_m_s[k];
        }
    }
    for wall in state.walls.iter_mut().filter(|wall| is_belt(wall)) {
        let load = &mut wall.load_by_sleepers;
        let belt_m = Vector3::from(wall.model.surface_velocity_m_s) * dt;
        let turned = Vector3::from(load.torque_n_m) + belt_m.cross(&Vector3::from(load.force_n));
        load.torque_n_m = turned.into();
    }
    let riders = sleep.riders.len();
    let turns = |wall: &Wall| wall.spins_rad_s[1] != [0.0; 3];
    if state.walls.iter().any(turns) {
        // How fast a wall turns where particles are is found from all of them.
        for clump in state.clumps.all.iter().filter(|clump| clump.rides()) {
            place_spheres(&state.clumps, clump, &mut state.particles);
        }
    } else if !state.watches.is_empty() {
        place_touching(sleep, &state.clumps, &mut state.particles);
    }
    riders
}

/// Puts the spheres of riders in place that touch another sleeping particle.
fn place_touching(sleep: &Sleep, clumps: &Clumps, particles: &mut Particles) {
    for i in sleep.pairs.iter().flat_map(|kept| kept.pair) {
        let carrier = clumps.carrier_of(i as usize);
        let carrier = carrier.map(|at| &clumps.all[at]);
        if let Some(clump) = carrier.filter(|clump| clump.rides()) {
            let template = clumps.template(clump);
            let sphere = template.outer[(i - clump.first) as usize] as usize;
            let place = template.pose(sphere, clump).place();
            particles.poses[i as usize].put_at(place.into());
        }
    }
}

/// Uses up the distance that riders may approach what does not move steadily, in a drift in which
/// that moved by at most `moved_m`. Returns the largest speed of a rider, m/s.
pub(crate) fn use_up_approach(sleep: &mut Sleep, moved_m: f64, time_step_s: f64) -> f64 {
    sleep.left_m -= moved_m + sleep.riding_m_s * time_step_s;
    sleep.riding_m_s
}

/// Whether a rider could come near something in the next steps, or its wall ceases to move
/// steadily.
pub(crate) fn is_due(state: &State) -> bool {
    let Some(sleep) = with_riders(state) else {
        return false;
    };
    let soon_s = STEPS_LEFT * state.time_step_s;
    let approach_m_s = state.fastest_m_s + sleep.riding_m_s;
    let has_changed = |(number, wall): (u32, &Wall)| {
        let carries =
            |rider: &Rider| rider.wall == number || rider.velocity_m_s == wall.velocities_m_s[0];
        steady_velocity_m_s(wall, state.moment()).is_none() && sleep.riders.iter().any(carries)
    };
    state.time_s + soon_s > sleep.due_s
        || sleep.left_m < soon_s * approach_m_s
        || (0..).zip(&state.walls).any(has_changed)
}

/// A box around some sleeping bodies that move alike.
struct Part {
    bounds: Bounds,
    of: PartOf,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum PartOf {
    Rider(u32),
    /// The bodies at rest in a chunk of particles.
    Chunk(usize),
}

/// Sleeping bodies that have the same velocity.
struct Group {
    velocity_m_s: [f64; 3],
    bounds: Bounds,
    parts: Vec<Part>,
}

/// The groups of sleeping bodies. `chunks`: boxes around those at rest in each chunk of particles.
fn groups(state: &State, sleep: &Sleep) -> Vec<Group> {
    let at_rest = (sleep.boxes.iter().enumerate()).filter(|(_, bounds)| **bounds != Bounds::EMPTY);
    let at_rest = at_rest.map(|(chunk, bounds)| ([0.0; 3], *bounds, PartOf::Chunk(chunk)));
    let riders = sleep.riders.iter().map(|rider| {
        let bounds = bounds_of(state, rider);
        (rider.velocity_m_s, bounds, PartOf::Rider(rider.cluster))
    });
    let mut groups: Vec<Group> = Vec::new();
    for (velocity_m_s, bounds, of) in at_rest.chain(riders) {
        let known = groups
            .iter()
            .position(|group| group.velocity_m_s == velocity_m_s);
        let known = known.unwrap_or_else(|| {
            groups.push(Group {
                velocity_m_s,
                bounds: Bounds::EMPTY,
                parts: Vec::new(),
            });
            groups.len() - 1
        });
        groups[known].bounds = groups[known].bounds.with(&bounds);
        groups[known].parts.push(Part { bounds, of });
    }
    groups
}

/// The place of a body: of the clump, or of its first particle, m.
fn place_m(state: &State, cluster: u32) -> [f64; 3] {
    let Some(&first) = members(state, cluster).first() else {
        return [0.0; 3];
    };
    match state.clumps.carrier_of(first as usize) {
        Some(clump) => state.clumps.all[clump].place_m,
        None => state.particles.poses[first as usize].place().into(),
    }
}

/// The corners of the box around a body whose spheres are in place, relative to its place, m.
pub(super) fn box_around(state: &State, cluster: u32) -> [[f64; 3]; 2] {
    let members = members(state, cluster).iter();
    let balls = members.map(|&i| around(&state.particles.poses[i as usize].position_m));
    let bounds = balls.fold(Bounds::EMPTY, |all, ball| all.with(&ball));
    let bounds = bounds.moved(place_m(state, cluster).map(|x| -x));
    [bounds.low, bounds.high]
}

/// The box around a rider now, m.
fn bounds_of(state: &State, rider: &Rider) -> Bounds {
    let [low, high] = rider.corners_m;
    Bounds { low, high }.moved(place_m(state, rider.cluster))
}

/// Puts the spheres of a rider in place, if it is a clump. Returns its particles.
fn place_rider(state: &mut State, cluster: u32) -> Vec<u32> {
    let members = members(state, cluster).to_vec();
    let carrier = members
        .first()
        .and_then(|&i| state.clumps.carrier_of(i as usize));
    if let Some(carrier) = carrier {
        let clump = &state.clumps.all[carrier];
        place_spheres(&state.clumps, clump, &mut state.particles);
    }
    members
}

/// Puts the riders in place that overlap these boxes around what is awake, and lists their
/// particles that do.
pub(crate) fn list_riders_beside(state: &mut State, awake: &[Bounds]) -> Vec<u32> {
    let Some(sleep) = with_riders(state) else {
        return Vec::new();
    };
    let awake = AlongX::of(awake);
    let beside = |bounds: &Bounds| awake.near(bounds, 0.0).any(|part| part.overlaps(bounds));
    let riders = sleep
        .riders
        .iter()
        .filter(|rider| beside(&bounds_of(state, rider)));
    let riders: Vec<u32> = riders.map(|rider| rider.cluster).collect();
    let mut found = Vec::new();
    for cluster in riders {
        let members = place_rider(state, cluster);
        let ball = |i: &u32| around(&state.particles.poses[*i as usize].position_m);
        found.extend(members.into_iter().filter(|i| beside(&ball(i))));
    }
    found
}

/// Riders that come to the end of what carries them.
pub(crate) fn at_edges(state: &State) -> Vec<u32> {
    let soon_s = state.time_s + STEPS_LEFT * state.time_step_s;
    let riders = state.sleep.iter().flat_map(|sleep| &sleep.riders);
    let ending = riders.filter(|rider| soon_s > rider.until_s);
    ending.map(|rider| rider.cluster).collect()
}

/// Sleeping particles near a wall that does not move with them, and near others that sleep but move
/// otherwise.
pub(crate) fn riders_near(state: &mut State, skin_m: f64) -> Vec<u32> {
    let mut near = Vec::new();
    let Some(sleep) = with_riders(state) else {
        return near;
    };
    let margin_m = (1.0 + ROUNDING) * skin_m;
    let mut reached: Vec<(usize, u32)> = Vec::new();
    for rider in &sleep.riders {
        let bounds = bounds_of(state, rider);
        for (number, wall) in state.walls.iter().enumerate() {
            let reaches = || wall_gap_m(wall, &bounds) <= margin_m;
            if !is_with(state, number, rider) && reaches() {
                reached.push((number, rider.cluster));
            }
        }
    }
    let groups = groups(state, sleep);
    let mut meeting: Vec<PartOf> = Vec::new();
    for (n, one) in groups.iter().enumerate() {
        for other in &groups[n + 1..] {
            meeting.extend(overlapping(one, other, margin_m).iter().flatten());
        }
    }
    meeting.sort_unstable();
    meeting.dedup();
    for (number, cluster) in reached {
        let members = place_rider(state, cluster);
        let is_near = nearness(&state.walls[number], skin_m);
        let poses = &state.particles.poses;
        near.extend(members.into_iter().filter(|&i| is_near(&poses[i as usize])));
    }
    near.extend(near_each_other(state, &meeting, skin_m));
    near
}

/// Parts of two groups that are nearer than a margin, m.
fn overlapping(one: &Group, other: &Group, margin_m: f64) -> Vec<[PartOf; 2]> {
    let mut found = Vec::new();
    let reaching = other.bounds.grown(margin_m);
    for a in one
        .parts
        .iter()
        .filter(|part| part.bounds.overlaps(&reaching))
    {
        let bounds = a.bounds.grown(margin_m);
        let beside = other.parts.iter().filter(|b| b.bounds.overlaps(&bounds));
        found.extend(beside.map(|b| [a.of, b.of]));
    }
    found
}

/// Particles of these parts that are near one with another velocity.
fn near_each_other(state: &mut State, parts: &[PartOf], skin_m: f64) -> Vec<u32> {
    let mut particles = Vec::new();
    for part in parts {
        match part {
            PartOf::Rider(cluster) => particles.extend(place_rider(state, *cluster)),
            PartOf::Chunk(chunk) => {
                let some = chunk_of(*chunk, state.particles.len());
                particles.extend(some.filter(|&i| state.rests_asleep(i)).map(|i| i as u32));
            }
        }
    }
    particles.sort_unstable();
    particles.dedup();
    let (Some(sleep), Some(clusters)) = (&state.sleep, &state.clusters) else {
        return Vec::new();
    };
    let mut velocities: Vec<[f64; 3]> = Vec::new();
    let name_of = |&i: &u32| {
        let velocity = sleep.of_cluster[clusters.of_particle[i as usize] as usize].velocity_m_s;
        let known = velocities.iter().position(|known| *known == velocity);
        known.unwrap_or_else(|| {
            velocities.push(velocity);
            velocities.len() - 1
        }) as u32
    };
    let names: Vec<u32> = particles.iter().map(name_of).collect();
    let poses = particles.iter().map(|&i| state.particles.poses[i as usize]);
    let poses: Vec<Pose> = poses.collect();
    let pairs = near_pairs(&poses, &names, skin_m).into_iter().flatten();
    pairs.map(|n| particles[n as usize]).collect()
}

/// Whether a wall moves with a rider, or carries it on the face of a belt.
fn is_with(state: &State, number: usize, rider: &Rider) -> bool {
    let wall = &state.walls[number];
    let Some(velocity) = steady_velocity_m_s(wall, state.moment()) else {
        return false;
    };
    if is_belt(wall) {
        let carried = carrying_velocity_m_s(wall, velocity);
        return rider.wall as usize == number && carried == Some(rider.velocity_m_s);
    }
    velocity == rider.velocity_m_s
}

/// Distance between a box and a wall, m, at least: for other walls than planes that of its box.
fn wall_gap_m(wall: &Wall, bounds: &Bounds) -> f64 {
    match plane_in_space(wall) {
        Some([point, normal]) => {
            let corners = bounds.corners().into_iter();
            let heights = corners.map(|corner| (Vector3::from(corner) - point).dot(&normal));
            heights.fold(f64::INFINITY, f64::min)
        }
        None => wall.bounds_in_space().gap_m(bounds),
    }
}

/// Finds when riders are to be looked at again, after nothing near them was found. `awake`: boxes
/// around what is awake, larger by the skin, m.
pub(crate) fn look_ahead(state: &mut State, awake: &[Bounds], skin_m: f64) {
    let Some(sleep) = with_riders(state) else {
        return;
    };
    let awake = AlongX::of(awake);
    let (mut after_s, mut left_m) = (f64::INFINITY, f64::INFINITY);
    for rider in &sleep.riders {
        let bounds = bounds_of(state, rider);
        after_s = after_s.min(rider.until_s - state.time_s);
        for number in (0..state.walls.len()).filter(|&number| !is_with(state, number, rider)) {
            let wall = &state.walls[number];
            match steady_velocity_m_s(wall, state.moment()) {
                // It is noticed when it begins to move.
                Some([0.0, 0.0, 0.0]) => {
                    let approach = rider.velocity_m_s;
                    let meets_s = reaches_wall_s(wall, &bounds.grown(skin_m), approach);
                    after_s = after_s.min(at_least(meets_s, approach, skin_m));
                }
                _ => left_m = left_m.min(wall_gap_m(wall, &bounds).max(skin_m)),
            }
        }
        let gaps_m = awake.near(&bounds, left_m).map(|part| part.gap_m(&bounds));
        left_m = gaps_m.fold(left_m, |least_m, gap_m| least_m.min(gap_m + skin_m));
    }
    let groups = groups(state, sleep);
    for (n, one) in groups.iter().enumerate() {
        for other in &groups[n + 1..] {
            after_s = first_meeting_s(one, other, skin_m, after_s);
        }
    }
    let now_s = state.time_s;
    if let Some(sleep) = &mut state.sleep {
        (sleep.due_s, sleep.left_m) = (now_s + after_s, left_m);
    }
}

/// Boxes in the order of their lower ends along x.
struct AlongX {
    boxes: Vec<Bounds>,
    /// Length of the longest along x, m.
    longest_m: f64,
}

impl AlongX {
    fn of(boxes: &[Bounds]) -> Self {
        let mut boxes = boxes.to_vec();
        boxes.sort_unstable_by(|a, b| a.low[0].total_cmp(&b.low[0]));
        let lengths_m = boxes.iter().map(|part| part.high[0] - part.low[0]);
        let longest_m = lengths_m.fold(0.0, f64::max);
        Self { boxes, longest_m }
    }

    /// Those that may be nearer to a box than a distance, m.
    fn near(&self, bounds: &Bounds, within_m: f64) -> impl Iterator<Item = &Bounds> {
        let from_m = bounds.low[0] - within_m - self.longest_m;
        let first = self.boxes.partition_point(|part| part.low[0] < from_m);
        let to_m = bounds.high[0] + within_m;
        self.boxes[first..]
            .iter()
            .take_while(move |part| part.low[0] <= to_m)
    }
}

/// Difference of two velocities, m/s.
fn apart(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

/// Time until the skin around a box that approaches something reaches it, s. If it already does,
/// nothing in them is nearer than the skin, and the time in which they could touch.
fn at_least(meets_s: f64, approach_m_s: [f64; 3], skin_m: f64) -> f64 {
    if meets_s > 0.0 {
        return meets_s;
    }
    skin_m / Vector3::from(approach_m_s).norm()
}

/// Time until a box that approaches a wall reaches it, s.
fn reaches_wall_s(wall: &Wall, bounds: &Bounds, approach_m_s: [f64; 3]) -> f64 {
    let Some([_, normal]) = plane_in_space(wall) else {
        return bounds.meets_after_s(approach_m_s, &wall.bounds_in_space());
    };
    let sinks_m_s = -Vector3::from(approach_m_s).dot(&normal);
    let height_m = wall_gap_m(wall, bounds);
    match height_m > 0.0 {
        true if sinks_m_s > 0.0 => height_m / sinks_m_s,
        true => f64::INFINITY,
        false => 0.0,
    }
}

/// Time until the skins of parts of two groups first meet, s; `known_s` if none meet before.
fn first_meeting_s(one: &Group, other: &Group, skin_m: f64, known_s: f64) -> f64 {
    let approach = apart(one.velocity_m_s, other.velocity_m_s);
    let mut first_s = known_s;
    for a in &one.parts {
        let bounds = a.bounds.grown(skin_m);
        if bounds.meets_after_s(approach, &other.bounds) < first_s {
            for b in &other.parts {
                let meets_s = bounds.meets_after_s(approach, &b.bounds);
                first_s = first_s.min(at_least(meets_s, approach, skin_m));
            }
        }
    }
    first_s
}
