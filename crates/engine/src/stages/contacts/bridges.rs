//! Liquid bridges: they form where wet ends touch, pull their ends together, and rupture.

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::stages::chunks::CHUNK;
use crate::stages::stage::{Need, Stage};
use crate::stages::walls::SAME_WAY;
use crate::stages::walls::patches::book_bridge;
use crate::state::State;
use crate::state::bridges::{BridgeScratch, Bridges, PairBridge, Stepped, WallBridge};
use crate::state::contacts::{ContactPartition, Contacts};
use crate::state::particles::{Particles, Wrench};
use crate::state::walls::{Wall, WallLoad};
use dem_physics::contact::liquid_bridge::LiquidBridge;
use dem_physics::geometry::Touch;
use dem_physics::geometry::one_surface::is_one;

/// Liquid bridges.
pub(crate) const BRIDGES: Stage = Stage {
    bytes: |state| {
        state.bridges.as_ref().map_or(0, |bridges| {
            size_of_val(&bridges.pairs[..]) + size_of_val(&bridges.walls[..])
        })
    },
    ..Stage::new("liquid bridges", |state, _| {
        Need::of(
            state.bridges.is_some(),
            || "materials are wet".to_owned(),
            "no materials are wet",
        )
    })
};

/// Forms and ruptures bridges, and adds their forces to the wrenches. Returns their number.
pub(crate) fn compute_bridges(state: &mut State) -> usize {
    let Some(mut bridges) = state.bridges.take() else {
        return 0;
    };
    let mut scratch = std::mem::take(&mut state.scratch.bridges);
    between_particles(state, &mut bridges, &mut scratch.pairs);
    at_walls(state, &mut bridges, &mut scratch);
    state.scratch.bridges = scratch;
    let count = bridges.pairs.len() + bridges.walls.len();
    state.bridges = Some(bridges);
    count
}

impl Bridges {
    /// Records the formation and the rupture of a bridge.
    fn book<B>(&mut self, stepped: &Stepped<B>, is_new: bool) {
        self.lost_j += stepped.lost_j;
        self.formed_and_ruptured[0] += u64::from(is_new);
        self.formed_and_ruptured[1] += u64::from(stepped.is_ruptured);
    }
}

fn between_particles(
    state: &mut State,
    bridges: &mut Bridges,
    stepped: &mut Vec<Stepped<PairBridge>>,
) {
    let Some(contacts) = &state.contacts else {
        return;
    };
    let (p, drift_s) = (&mut state.particles, state.previous_time_step_s);
    let new = new_pairs(contacts, &bridges.pairs);
    let known = bridges.pairs.par_iter().with_min_len(CHUNK);
    known
        .map(|bridge| step_pair(contacts, p, bridge.pair, Some(bridge.gap_m), drift_s))
        .collect_into_vec(stepped);
    stepped.extend(
        new.iter()
            .map(|&pair| step_pair(contacts, p, pair, None, drift_s)),
    );
    let known = bridges.pairs.len();
    bridges.pairs.clear();
    for (n, stepped) in stepped.iter().enumerate() {
        let [a, b] = stepped.bridge.pair.map(|end| end as usize);
        let none = Vector3::zeros();
        p.wrenches[a].add(&-stepped.force_n, &none);
        p.wrenches[b].add(&stepped.force_n, &none);
        bridges.book(stepped, n >= known);
        if !stepped.is_ruptured {
            bridges.pairs.push(stepped.bridge);
        }
    }
    bridges.pairs.sort_unstable_by_key(|bridge| bridge.pair);
}

/// Wet pairs that touch and have no bridge yet, in order.
fn new_pairs(contacts: &Contacts, known: &[PairBridge]) -> Vec<[u32; 2]> {
    let kinds = &contacts.model.kinds;
    // Whatever touches was close at the last check of all pairs.
    let of_partition = |partition: &ContactPartition| {
        let wet = kinds
            .iter()
            .zip(&partition.close)
            .filter(|(kind, _)| kind.bridge.is_some());
        let close = wet.flat_map(|(_, [_, own])| own);
        let touching = close.filter(|at| contacts.histories[**at as usize].overlap_m() > 0.0);
        let pairs = touching.map(|at| contacts.pairs[*at as usize]);
        let is_new = |pair: &[u32; 2]| {
            known
                .binary_search_by_key(pair, |known| known.pair)
                .is_err()
        };
        pairs.filter(is_new).collect::<Vec<_>>()
    };
    let partitions = contacts.scratch.partitions.par_iter();
    let mut new: Vec<[u32; 2]> = partitions.flat_map_iter(of_partition).collect();
    new.sort_unstable();
    new
}

/// The bridge of a pair after a drift, from its gap before, m (none: it is new).
fn step_pair(
    contacts: &Contacts,
    p: &Particles,
    pair: [u32; 2],
    before_m: Option<f64>,
    drift_s: f64,
) -> Stepped<PairBridge> {
    let [a, b] = pair.map(|end| end as usize);
    let unchanged = |gap_m: f64| Stepped {
        bridge: PairBridge { pair, gap_m },
        is_ruptured: false,
        force_n: Vector3::zeros(),
        lost_j: 0.0,
    };
    let gap_m = before_m.unwrap_or(0.0);
    let Some(law) = contacts.model.kinds[contacts.kind(pair)].bridge else {
        return unchanged(gap_m);
    };
    if p.sleeps(a) && p.sleeps(b) {
        return unchanged(gap_m);
    }
    let radii_m = [a, b].map(|i| p.poses[i].radius_m());
    let reach_m = radii_m[0] + radii_m[1];
    let apart = p.poses[b].place() - p.poses[a].place();
    let distance_m = apart.norm();
    let earlier_m = || {
        let [from, to] = [a, b].map(|i| Vector3::from(p.motions[i].velocity_m_s));
        (apart - (to - from) * drift_s).norm() - reach_m
    };
    let gaps_m = [before_m.unwrap_or_else(earlier_m), distance_m - reach_m];
    let is_there = gaps_m[1] <= law.rupture_m();
    let radius_m = radii_m[0] * radii_m[1] / reach_m;
    let [force_n, lost_j] = law.after_step(radius_m, gaps_m, [before_m.is_some(), is_there]);
    Stepped {
        bridge: PairBridge {
            pair,
            gap_m: gaps_m[1],
        },
        is_ruptured: !is_there,
        force_n: apart * (-force_n / distance_m),
        lost_j,
    }
}

fn at_walls(state: &mut State, bridges: &mut Bridges, scratch: &mut BridgeScratch) {
    let Some(contacts) = &state.contacts else {
        return;
    };
    let BridgeScratch {
        walls: stepped,
        touches,
        keys,
        ..
    } = scratch;
    let (all, known) = (&bridges.walls, bridges.walls.len());
    let kick_s = state.kick_s();
    stepped.clear();
    stepped.resize(known, Stepped::default());
    touches.resize_with(known.div_ceil(CHUNK), Vec::new);
    let chunks = all.par_chunks(CHUNK).zip(stepped.par_chunks_mut(CHUNK));
    chunks.zip(touches).for_each(|((own, stepped), touches)| {
        for (bridge, stepped) in own.iter().zip(stepped) {
            *stepped = followed(state, contacts, all, bridge, touches);
        }
    });
    add_new_at_walls(state, contacts, all, stepped, keys);
    bridges.walls.clear();
    for (n, stepped) in stepped.iter_mut().enumerate() {
        let bridge = &mut stepped.bridge;
        if !stepped.is_ruptured && !state.particles.sleeps(bridge.particle as usize) {
            bridge.load = load(
                &state.walls[bridge.wall as usize],
                &state.particles,
                bridge,
                stepped.force_n,
            );
            let wrench: &mut Wrench = &mut state.particles.wrenches[bridge.particle as usize];
            wrench.add(&stepped.force_n, &Vector3::zeros());
            let WallLoad {
                force_n,
                torque_n_m,
                belt_w,
            } = bridge.load;
            state.walls[bridge.wall as usize]
                .push
                .add(force_n, torque_n_m, belt_w);
        }
        bridges.book(stepped, n >= known);
        if !stepped.is_ruptured {
            let wall = &mut state.walls[stepped.bridge.wall as usize];
            book_bridge(wall, &state.particles, &stepped.bridge, kick_s);
            bridges.walls.push(stepped.bridge);
        }
    }
    bridges.walls.sort_unstable_by_key(WallBridge::key);
}

/// The load of a wall on the particle of a bridge with this force, N, which acts along the normal
/// through the centre.
fn load(
    wall: &Wall,
    particles: &Particles,
    bridge: &WallBridge,
    force_n: Vector3<f64>,
) -> WallLoad {
    let centre = particles.poses[bridge.particle as usize].place();
    let arm = centre - Vector3::from(wall.frame.position_m);
    WallLoad {
        force_n: force_n.into(),
        torque_n_m: arm.cross(&force_n).into(),
        belt_w: 0.0,
    }
}

/// A bridge at a wall after a drift: at the same feature of the wall, or at one without a bridge to
/// which the particle has moved on. `touches`: room for where the particle touches the wall.
fn followed(
    state: &State,
    contacts: &Contacts,
    all: &[WallBridge],
    bridge: &WallBridge,
    touches: &mut Vec<Touch>,
) -> Stepped<WallBridge> {
    let (wall, i) = (&state.walls[bridge.wall as usize], bridge.particle as usize);
    let law = wall.kind(contacts.materials[i]).bridge;
    let Some(law) = law.filter(|_| !state.particles.sleeps(i)) else {
        return Stepped {
            bridge: *bridge,
            is_ruptured: false,
            force_n: Vector3::zeros(),
            lost_j: 0.0,
        };
    };
    let pose = &state.particles.poses[i];
    touches.clear();
    let reach_m = pose.radius_m() + 2.0 * law.rupture_m();
    wall.model
        .shape
        .touches(wall.frame.to_wall(pose.place().into()), reach_m, touches);
    let is_taken = |feature: u32| {
        let key = WallBridge { feature, ..*bridge }.key();
        all.binary_search_by_key(&key, WallBridge::key).is_ok()
    };
    let along = |normal: &[f64; 3]| -Vector3::from(*normal).dot(&Vector3::from(bridge.normal));
    let there = touches.iter().find(|touch| touch.feature == bridge.feature);
    let there = there
        .map(|touch| wall.frame.touch_to_space(touch))
        .or_else(|| {
            let free = touches.iter().filter(|touch| !is_taken(touch.feature));
            let mut free = free.map(|touch| wall.frame.touch_to_space(touch));
            free.find(|touch| along(&touch.normal) > SAME_WAY)
        });
    let now = match there {
        Some(touch) => WallBridge {
            feature: touch.feature,
            normal: touch.normal.map(|n| -n),
            gap_m: touch.distance_m - pose.radius_m(),
            ..*bridge
        },
        None => {
            let gone_m = opening_m_s(wall, &state.particles, bridge) * state.previous_time_step_s;
            WallBridge {
                gap_m: bridge.gap_m + gone_m,
                ..*bridge
            }
        }
    };
    let is_there = there.is_some() && now.gap_m <= law.rupture_m();
    let gaps_m = [bridge.gap_m, now.gap_m];
    stepped_at_wall(&law, pose.radius_m(), now, gaps_m, [true, is_there])
}

/// Adds the bridges of wet particles that touch a wall and have none yet at the same feature; where
/// walls meet, one goes over from wall to wall. `all`: the bridges before the step, `keys`: room
/// for those of the bridges.
fn add_new_at_walls(
    state: &State,
    contacts: &Contacts,
    all: &[WallBridge],
    stepped: &mut Vec<Stepped<WallBridge>>,
    keys: &mut Vec<[u32; 3]>,
) {
    keys.clear();
    let there = stepped.iter().filter(|known| !known.is_ruptured);
    keys.extend(there.map(|known| known.bridge.key()));
    keys.sort_unstable();
    for (n, wall) in (0..).zip(&state.walls) {
        for touch in wall
            .touching
            .iter()
            .filter(|touch| touch.history.overlap_m() > 0.0)
        {
            let i = touch.particle as usize;
            let bridge = WallBridge {
                wall: n,
                particle: touch.particle,
                feature: touch.feature,
                normal: touch.normal,
                gap_m: -touch.history.overlap_m() - touch.history.origin_m(),
                load: WallLoad::default(),
            };
            let is_known = keys.binary_search(&bridge.key()).is_ok();
            let law = wall.kind(contacts.materials[i]).bridge;
            if let Some(law) = law.filter(|_| !is_known) {
                let p = &state.particles;
                if let Some(at) = moved_from(state, contacts, all, stepped, &bridge) {
                    let gaps_m = [all[at].gap_m, bridge.gap_m];
                    let radius_m = p.poses[i].radius_m();
                    stepped[at] = stepped_at_wall(&law, radius_m, bridge, gaps_m, [true; 2]);
                    continue;
                }
                let drift_s = state.previous_time_step_s;
                let before_m = bridge.gap_m - opening_m_s(wall, p, &bridge) * drift_s;
                let (radius_m, gaps_m) = (p.poses[i].radius_m(), [before_m, bridge.gap_m]);
                stepped.push(stepped_at_wall(
                    &law,
                    radius_m,
                    bridge,
                    gaps_m,
                    [false, true],
                ));
            }
        }
    }
}

/// The place in `all` of the bridge of the same particle with another wall, of the same liquid,
/// that stands for the same surface: see [`is_one`]. None: there is none.
fn moved_from(
    state: &State,
    contacts: &Contacts,
    all: &[WallBridge],
    stepped: &[Stepped<WallBridge>],
    bridge: &WallBridge,
) -> Option<usize> {
    let i = bridge.particle as usize;
    let pose = &state.particles.poses[i];
    let radius_m = pose.radius_m();
    let law = |wall: u32| {
        state.walls[wall as usize]
            .kind(contacts.materials[i])
            .bridge
    };
    let place = |bridge: &WallBridge| {
        let distance_m = radius_m + bridge.gap_m;
        let normal = -Vector3::from(bridge.normal);
        let touch = Touch {
            point: (pose.place() + distance_m * normal).into(),
            normal: normal.into(),
            distance_m,
            feature: bridge.feature,
        };
        let wall = &state.walls[bridge.wall as usize];
        wall.model.shape.place(touch, radius_m)
    };
    let others = (0..state.walls.len() as u32).filter(|wall| *wall != bridge.wall);
    let others = others.filter(|wall| law(*wall) == law(bridge.wall));
    let mut before = others.flat_map(|wall| {
        let from = all.partition_point(|one| one.key() < [wall, bridge.particle, 0]);
        let own = all[from..].iter();
        let own = own.take_while(move |one| (one.wall, one.particle) == (wall, bridge.particle));
        (from..).zip(own).map(|(at, _)| at)
    });
    before.find(|&at| {
        let old = &stepped[at];
        let is_there = !old.is_ruptured && old.bridge.wall == all[at].wall;
        let places = [place(&old.bridge), place(bridge)];
        let [nearer, farther] = match old.bridge.gap_m < bridge.gap_m {
            true => places,
            false => [places[1], places[0]],
        };
        is_there && is_one(&nearer, &farther, radius_m)
    })
}

/// Speed at which the gap between a particle and a wall opened in the drift, m/s.
fn opening_m_s(wall: &Wall, particles: &Particles, bridge: &WallBridge) -> f64 {
    let i = bridge.particle as usize;
    let normal = Vector3::from(bridge.normal);
    let centre = particles.poses[i].place();
    let foot = centre - normal * (particles.poses[i].radius_m() + bridge.gap_m);
    let arm = foot - Vector3::from(wall.frame.position_m);
    let [velocity, spin] = [wall.velocities_m_s[0], wall.spins_rad_s[0]].map(Vector3::from);
    let of_particle = Vector3::from(particles.motions[i].velocity_m_s);
    (of_particle - velocity - spin.cross(&arm)).dot(&normal)
}

fn stepped_at_wall(
    law: &LiquidBridge,
    radius_m: f64,
    bridge: WallBridge,
    gaps_m: [f64; 2],
    there: [bool; 2],
) -> Stepped<WallBridge> {
    let [force_n, lost_j] = law.after_step(radius_m, gaps_m, there);
    Stepped {
        bridge,
        is_ruptured: !there[1],
        force_n: Vector3::from(bridge.normal) * -force_n,
        lost_j,
    }
}

/// Energy of all bridges, J: see [`LiquidBridge::energy_j`].
pub(crate) fn bridges_energy_j(state: &State) -> f64 {
    bridge_energies_j(state).map(|(_, energy_j)| energy_j).sum()
}

/// The energy of each bridge, J, and its first particle.
pub(crate) fn bridge_energies_j(state: &State) -> impl Iterator<Item = (u32, f64)> {
    let known = state.bridges.as_ref().zip(state.contacts.as_ref());
    let radius_m = |i: u32| state.particles.poses[i as usize].radius_m();
    known.into_iter().flat_map(move |(bridges, contacts)| {
        let of_pairs = bridges.pairs.iter().filter_map(move |bridge| {
            let [a, b] = bridge.pair.map(radius_m);
            let law = contacts.model.kinds[contacts.kind(bridge.pair)].bridge?;
            let energy_j = law.energy_j(bridge.gap_m, a * b / (a + b));
            Some((bridge.pair[0], energy_j))
        });
        let of_walls = bridges.walls.iter().filter_map(move |bridge| {
            let material = contacts.materials[bridge.particle as usize];
            let law = state.walls[bridge.wall as usize].kind(material).bridge?;
            let energy_j = law.energy_j(bridge.gap_m, radius_m(bridge.particle));
            Some((bridge.particle, energy_j))
        });
        of_pairs.chain(of_walls)
    })
}
