//! Which bodies are at rest, on the ground or on a surface that carries them along, and may fall
//! asleep.

use nalgebra::Vector3;

use super::riding::box_around;
use crate::stages::chunks::{chunk_of, chunks_of};
use crate::stages::clumps::motion::{place_all, place_awake};
use crate::stages::search::neighbours::near_pairs;
use crate::stages::walls::carrying::{
    BeltFace, carrying_velocity_m_s, is_belt, steady_velocity_m_s,
};
use crate::stages::walls::{moves, nearness};
use crate::state::State;
use crate::state::sleep::{Rider, Sleep};
use dem_io::disjoint::{find, join};

/// Interval between checks for slow bodies, in steps.
pub(super) const EVERY: u64 = 100;

/// A body that is awake.
pub(super) struct AwakeBody {
    pub(super) cluster: u32,
    /// Velocity of the surface on which it is slowest, m/s.
    pub(super) surface_m_s: [f64; 3],
    /// Upper bound of the speed of its points relative to that, m/s.
    pub(super) speed_m_s: f64,
}

/// The bodies that are awake, by the numbers of their clusters.
pub(super) fn awake_bodies(state: &State) -> Vec<AwakeBody> {
    let Some(clusters) = &state.clusters else {
        return Vec::new();
    };
    let p = &state.particles;
    let chunks = chunks_of(p.free).filter(|&chunk| !p.asleep.is_whole(chunk));
    let awake = chunks.flat_map(|chunk| chunk_of(chunk, p.free));
    let awake: Vec<usize> = awake.filter(|&i| !p.sleeps(i)).collect();
    let clumps = state.clumps.all.iter().filter(|clump| !clump.asleep);
    let mut all: Vec<u32> = awake.iter().map(|&i| clusters.of_particle[i]).collect();
    all.dedup();
    all.extend(clumps.map(|clump| clump.cluster));
    all.sort_unstable();
    all.dedup();
    let on_ground = speeds_m_s(state, &all, &awake, [0.0; 3]);
    let of_body = |(cluster, speed_m_s)| AwakeBody {
        cluster,
        surface_m_s: [0.0; 3],
        speed_m_s,
    };
    let mut bodies: Vec<AwakeBody> = all.iter().copied().zip(on_ground).map(of_body).collect();
    let mut known = vec![[0.0; 3]];
    for wall in &state.walls {
        let steady = steady_velocity_m_s(wall, state.moment());
        let carried = steady.and_then(|velocity| carrying_velocity_m_s(wall, velocity));
        let Some(surface_m_s) = carried.filter(|velocity| !known.contains(velocity)) else {
            continue;
        };
        known.push(surface_m_s);
        let speeds = speeds_m_s(state, &all, &awake, surface_m_s);
        for (body, speed_m_s) in bodies.iter_mut().zip(speeds) {
            if speed_m_s < body.speed_m_s {
                (body.surface_m_s, body.speed_m_s) = (surface_m_s, speed_m_s);
            }
        }
    }
    bodies
}

/// For each of these clusters an upper bound of the speed of its points relative to a velocity,
/// m/s. `awake`: the free particles that are awake.
fn speeds_m_s(
    state: &State,
    of_clusters: &[u32],
    awake: &[usize],
    relative_to: [f64; 3],
) -> Vec<f64> {
    let mut speeds = vec![0.0_f64; of_clusters.len()];
    let mut note = |id: u32, speed_m_s: f64| {
        if let Ok(at) = of_clusters.binary_search(&id) {
            // What is no number is not slow.
            if speed_m_s > speeds[at] || speed_m_s.is_nan() {
                speeds[at] = speed_m_s;
            }
        }
    };
    let norm = |v: [f64; 3]| Vector3::from(v).norm();
    let relative = |v: [f64; 3]| [0, 1, 2].map(|k| v[k] - relative_to[k]);
    let (p, clusters) = (&state.particles, state.clusters.as_ref());
    let of_particle = clusters.map_or(&[][..], |clusters| &clusters.of_particle);
    for &i in awake {
        let motion = &p.motions[i];
        let turning_m_s = norm(motion.spin_rad_s) * p.poses[i].radius_m();
        let speed_m_s = norm(relative(motion.velocity_m_s)) + turning_m_s;
        note(of_particle[i], speed_m_s);
    }
    for clump in state.clumps.all.iter().filter(|clump| !clump.asleep) {
        let template = state.clumps.template(clump);
        let reach_m = template.largest_reach_m();
        let turning_m_s = clump.spin_rad_s(template).norm() * reach_m;
        let speed_m_s = norm(relative(clump.velocity_m_s)) + turning_m_s;
        note(clump.cluster, speed_m_s);
    }
    speeds
}

/// The moving wall that carries a body: with its feature if the body lies on the face of a belt.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Carrier {
    wall: u32,
    feature: Option<u32>,
}

/// Bodies that may fall asleep together, while they are found.
struct Candidates {
    /// For each cluster whether it may.
    may: Vec<bool>,
    /// For each cluster the surface that it touches, and later its island.
    carriers: Vec<Option<Carrier>>,
    /// For each cluster the time at which it comes to the edge of a face, s.
    until_s: Vec<f64>,
    /// Islands of clusters: see [`join`].
    names: Vec<u32>,
}

/// The candidates that can sleep, in ascending order: nothing holds, loads or moves them, or a
/// surface carries them along, and all bodies that they touch, are near to or have liquid bridges to
/// can sleep as well. Those of them that a surface carries are riders.
pub(super) fn at_rest_together(state: &mut State, may: Vec<bool>) -> (Vec<u32>, Vec<Rider>) {
    let none = Default::default();
    let mut candidates = Candidates {
        carriers: vec![None; may.len()],
        until_s: vec![f64::INFINITY; may.len()],
        names: (0..may.len() as u32).collect(),
        may,
    };
    candidates.leave_out_bound(state);
    candidates.look_at_touches(state);
    candidates.join_bridged(state);
    candidates.leave_out_islands(state.sleep.as_ref());
    if !candidates.may.contains(&true) {
        return none;
    }
    // Few candidates get this far: only now are their spheres put in place.
    place_awake(&state.clumps, &mut state.particles);
    candidates.look_at_near_walls(state);
    if !candidates.may.contains(&true) {
        return none;
    }
    // And only now are all neighbours searched for.
    place_all(&state.clumps, &mut state.particles);
    let (Some(contacts), Some(clusters)) = (&state.contacts, &state.clusters) else {
        return none;
    };
    for pair in near_pairs(
        &state.particles.poses,
        &clusters.of_particle,
        contacts.skin_m,
    ) {
        candidates.join(
            clusters.of_particle[pair[0] as usize],
            clusters.of_particle[pair[1] as usize],
        );
    }
    candidates.leave_out_islands(state.sleep.as_ref());
    candidates.found(state)
}

impl Candidates {
    fn join(&mut self, a: u32, b: u32) {
        join(&mut self.names, a, b);
    }

    /// Those that supports hold or loads act on.
    fn leave_out_bound(&mut self, state: &State) {
        let Some(clusters) = &state.clusters else {
            return;
        };
        let held = state.supports.iter();
        let held = held.filter(|support| state.time_s < support.end_s);
        let held = held.flat_map(|support| &support.held);
        let held = held.map(|held| held.particle);
        let loaded = state.loads.iter();
        let loaded = loaded.filter(|load| state.time_s < load.end_s);
        let loaded = loaded.flat_map(|load| &load.particles).copied();
        for i in held.chain(loaded) {
            self.may[clusters.of_particle[i as usize] as usize] = false;
        }
    }

    /// Leaves out those that touch a wall which does not carry them, and joins those that touch.
    fn look_at_touches(&mut self, state: &State) {
        let (Some(contacts), Some(clusters)) = (&state.contacts, &state.clusters) else {
            return;
        };
        let id = |i: u32| clusters.of_particle[i as usize];
        for (number, wall) in (0..).zip(&state.walls) {
            let steady = steady_velocity_m_s(wall, state.moment());
            let carrying = steady.and_then(|velocity| carrying_velocity_m_s(wall, velocity));
            for touch in &wall.touching {
                let cluster = id(touch.particle) as usize;
                let velocity = velocity_of(state.sleep.as_ref(), cluster);
                let rides = velocity != [0.0; 3];
                let carrier = Carrier {
                    wall: number,
                    feature: is_belt(wall).then_some(touch.feature),
                };
                if carrying != Some(velocity) || (is_belt(wall) && !rides) {
                    self.may[cluster] = false;
                } else if rides {
                    self.put_on(cluster, carrier);
                }
            }
        }
        for (pair, history) in contacts.pairs.iter().zip(&contacts.histories) {
            if history.overlap_m() > 0.0 {
                self.join(id(pair[0]), id(pair[1]));
            }
        }
    }

    fn put_on(&mut self, cluster: usize, carrier: Carrier) {
        match common([self.carriers[cluster], Some(carrier)]) {
            Ok(common) => self.carriers[cluster] = common,
            Err(()) => self.may[cluster] = false,
        }
    }

    /// Joins bodies with liquid bridges. With one, a body sleeps only at rest.
    fn join_bridged(&mut self, state: &State) {
        let (Some(bridges), Some(clusters)) = (&state.bridges, &state.clusters) else {
            return;
        };
        let id = |i: u32| clusters.of_particle[i as usize];
        for [a, b] in bridges.pairs.iter().map(|bridge| bridge.pair) {
            self.join(id(a), id(b));
        }
        for bridge in &bridges.walls {
            if moves(&state.walls[bridge.wall as usize], state.moment()) {
                self.may[id(bridge.particle) as usize] = false;
            }
        }
        for i in bridges.particles() {
            let cluster = id(i) as usize;
            self.may[cluster] &= velocity_of(state.sleep.as_ref(), cluster) == [0.0; 3];
        }
    }

    /// Removes every island that contains an awake cluster that may not sleep, or clusters that
    /// cannot ride together.
    fn leave_out_islands(&mut self, sleep: Option<&Sleep>) {
        let count = self.may.len();
        let mut can = vec![true; count];
        let mut velocities: Vec<Option<[f64; 3]>> = vec![None; count];
        let mut carriers: Vec<Option<Carrier>> = vec![None; count];
        for cluster in 0..count {
            let island = find(&mut self.names, cluster as u32) as usize;
            let velocity = velocity_of(sleep, cluster);
            let sleeps = sleep.is_some_and(|sleep| sleep.is_asleep(cluster as u32));
            // It wakes if it is as near as that.
            let rests = sleeps && velocity == [0.0; 3];
            let same = *velocities[island].get_or_insert(velocity) == velocity;
            can[island] &= (self.may[cluster] || rests) && same;
            match common([carriers[island], self.carriers[cluster]]) {
                Ok(common) => carriers[island] = common,
                Err(()) => can[island] = false,
            }
        }
        for cluster in 0..count {
            let island = find(&mut self.names, cluster as u32) as usize;
            let rests = velocity_of(sleep, cluster) == [0.0; 3];
            self.carriers[cluster] = carriers[island];
            self.may[cluster] &= can[island] && (rests || carriers[island].is_some());
        }
    }

    /// Leaves out those near a wall that does not move as they do, and finds for how long faces of
    /// belts carry the others.
    fn look_at_near_walls(&mut self, state: &State) {
        let (Some(contacts), Some(clusters)) = (&state.contacts, &state.clusters) else {
            return;
        };
        let velocities: Vec<[f64; 3]> = (0..self.may.len())
            .map(|cluster| velocity_of(state.sleep.as_ref(), cluster))
            .collect();
        let riding = |cluster: usize| velocities[cluster] != [0.0; 3];
        let any_rides = (0..self.may.len()).any(|cluster| self.may[cluster] && riding(cluster));
        for (number, wall) in (0..).zip(&state.walls) {
            let is_moving = moves(wall, state.moment());
            if !is_moving && !any_rides {
                continue;
            }
            let near = nearness(wall, contacts.skin_m);
            let moves_with = steady_velocity_m_s(wall, state.moment()).filter(|_| !is_belt(wall));
            let mut face: Option<(u32, Option<BeltFace>)> = None;
            for (pose, &cluster) in state.particles.poses.iter().zip(&clusters.of_particle) {
                let cluster = cluster as usize;
                let is_still = moves_with == Some(velocities[cluster]);
                if !self.may[cluster] || is_still {
                    continue;
                }
                let lies_on = self.carriers[cluster].filter(|carrier| carrier.wall == number);
                let Some(feature) = lies_on.and_then(|carrier| carrier.feature) else {
                    self.may[cluster] &= !near(pose);
                    continue;
                };
                if face.as_ref().is_none_or(|(of, _)| *of != feature) {
                    face = Some((feature, BeltFace::of(wall, feature)));
                }
                let carries_s = face
                    .as_ref()
                    .and_then(|(_, face)| face.as_ref()?.carries_s(pose));
                let least_s = EVERY as f64 * state.time_step_s;
                match carries_s.filter(|carries_s| *carries_s > least_s) {
                    Some(carries_s) => {
                        let until_s = &mut self.until_s[cluster];
                        *until_s = until_s.min(state.time_s + carries_s);
                    }
                    None => self.may[cluster] = false,
                }
            }
        }
    }

    /// The clusters that may sleep, and the riders among them.
    fn found(mut self, state: &State) -> (Vec<u32>, Vec<Rider>) {
        let mut of_islands_s = vec![f64::INFINITY; self.may.len()];
        for cluster in 0..self.may.len() {
            let until_s = &mut of_islands_s[find(&mut self.names, cluster as u32) as usize];
            *until_s = until_s.min(self.until_s[cluster]);
        }
        let found = (0..self.may.len() as u32).filter(|&cluster| self.may[cluster as usize]);
        let found: Vec<u32> = found.collect();
        let mut riders = Vec::new();
        for &cluster in &found {
            let velocity_m_s = velocity_of(state.sleep.as_ref(), cluster as usize);
            let carrier = self.carriers[cluster as usize];
            if let Some(Carrier { wall, .. }) = carrier.filter(|_| velocity_m_s != [0.0; 3]) {
                riders.push(Rider {
                    cluster,
                    velocity_m_s,
                    wall,
                    until_s: of_islands_s[find(&mut self.names, cluster) as usize],
                    corners_m: box_around(state, cluster),
                });
            }
        }
        (found, riders)
    }
}

/// Velocity relative to which a cluster is slow, or with which it rides, m/s.
fn velocity_of(sleep: Option<&Sleep>, cluster: usize) -> [f64; 3] {
    let body = sleep.and_then(|sleep| sleep.of_cluster.get(cluster));
    body.map_or([0.0; 3], |body| body.velocity_m_s)
}

/// What carries two bodies that touch: several walls that move alike, or one face of a belt.
fn common([one, other]: [Option<Carrier>; 2]) -> Result<Option<Carrier>, ()> {
    match (one, other) {
        (Some(a), Some(b)) if a != b && (a.feature.is_some() || b.feature.is_some()) => Err(()),
        _ => Ok(one.or(other)),
    }
}
