//! Bodies at rest fall asleep together with all bodies that they touch, and wake together when
//! something moving comes near.
//!
//! The decision depends only on positions, motions and contacts, never on what happens to be
//! listed, so that a run resumed from a checkpoint decides the same.

use nalgebra::Vector3;

use crate::stages::chunks::{chunk_of, chunks_of};
use crate::stages::clumps::motion::{place_all, synchronous};
use crate::stages::contacts::forces::contact_energy_j;
use crate::stages::ledger::totals::synchronous_motions;
use crate::stages::search::neighbours::near_pairs;
use crate::stages::stage::{Need, Stage};
use crate::stages::walls::{has_moved, nearness, push_at_rest, touch_energy_j, will_move};
use crate::state::State;
use crate::state::bridges::Bridges;
use crate::state::contacts::{ContactHistory, Contacts};
use crate::state::events::SleepEvent;
use crate::state::events::TopologyChange;
use crate::state::particles::Wrench;
use crate::state::partitions::{Idle, divide_busy};
use crate::state::sleep::mask::Asleep;
use crate::state::sleep::{ClusterSleep, FrozenContact, FrozenWallContact, Sleep};
use crate::state::walls::{Wall, WallLoad};
use dem_io::disjoint::{find, join};
use dem_io::units::significant;

/// Sleeping bodies.
pub(crate) const SLEEP: Stage = Stage {
    bytes: |state| {
        state.sleep.as_ref().map_or(0, |sleep| {
            size_of_val(&sleep.of_cluster[..])
                + size_of_val(&sleep.pairs[..])
                + size_of_val(&sleep.touches[..])
                + state.particles.asleep.len()
        })
    },
    ..Stage::new("sleep", |state, scene| {
        match (&state.model.sleep, &scene.sleep) {
            (Some(sleep), _) => Need::Needed(format!(
                "bodies slower than {} mm/s for {} ms are not stepped until something comes near",
                significant(1e3 * sleep.speed_m_s, 4),
                significant(1e3 * sleep.after_s, 4)
            )),
            (None, Some(_)) => Need::LeftOut("nothing can touch"),
            (None, None) => Need::LeftOut("not asked for"),
        }
    })
};

/// Interval between checks for slow bodies, in steps.
const EVERY: u64 = 100;

/// Puts to sleep the bodies that have been slow for long enough and touch only such bodies, between
/// a kick and the drift after it.
pub(crate) fn update_sleep(state: &mut State) -> usize {
    if let Some(sleep) = &mut state.sleep {
        let (all, left_out) = (state.particles.len() as u64, sleep.particles as u64);
        sleep.particle_steps[0] += all - left_out;
        sleep.particle_steps[1] += left_out;
    }
    if state.sleep.is_none() || !state.steps.is_multiple_of(EVERY) {
        return 0;
    }
    let speeds_m_s = speeds_m_s(state);
    let (Some(rule), Some(sleep), Some(clusters)) =
        (state.model.sleep, &mut state.sleep, &state.clusters)
    else {
        return 0;
    };
    sleep
        .of_cluster
        .resize(clusters.history.len(), ClusterSleep::AWAKE);
    let slow_for =
        |body: &ClusterSleep| !body.asleep && state.time_s - body.slow_since_s >= rule.after_s;
    for (body, speed_m_s) in sleep.of_cluster.iter_mut().zip(speeds_m_s) {
        body.slow_since_s = match speed_m_s {
            Some(speed_m_s) if speed_m_s < rule.speed_m_s => body.slow_since_s.min(state.time_s),
            _ => f64::INFINITY,
        };
    }
    let may: Vec<bool> = sleep.of_cluster.iter().map(slow_for).collect();
    let falling = at_rest_together(state, may);
    if !falling.is_empty() {
        fall_asleep(state, &falling);
    }
    1
}

/// For each cluster an upper bound of the speed of its points, m/s; none if it has ended or sleeps.
fn speeds_m_s(state: &State) -> Vec<Option<f64>> {
    let Some(clusters) = &state.clusters else {
        return Vec::new();
    };
    let mut speeds: Vec<Option<f64>> = vec![None; clusters.history.len()];
    let mut note = |id: u32, speed_m_s: f64| {
        let largest = &mut speeds[id as usize];
        *largest = Some(largest.map_or(speed_m_s, |before| before.max(speed_m_s)));
    };
    let norm = |v: [f64; 3]| Vector3::from(v).norm();
    let p = &state.particles;
    let awake = chunks_of(p.free).filter(|&chunk| !p.asleep.is_whole(chunk));
    let awake = awake.flat_map(|chunk| chunk_of(chunk, p.free));
    for i in awake.filter(|&i| !p.sleeps(i)) {
        let motion = &p.motions[i];
        let turning_m_s = norm(motion.spin_rad_s) * p.poses[i].radius_m();
        note(
            clusters.of_particle[i],
            norm(motion.velocity_m_s) + turning_m_s,
        );
    }
    for clump in state.clumps.all.iter().filter(|clump| !clump.asleep) {
        let template = state.clumps.template(clump);
        let reach_m = template.largest_reach_m();
        let turning_m_s = clump.spin_rad_s(template).norm() * reach_m;
        note(clump.cluster, norm(clump.velocity_m_s) + turning_m_s);
    }
    speeds
}

/// The candidates that can sleep, in ascending order: nothing holds, loads or moves them, and all
/// bodies that they touch, are near to or have liquid bridges to can sleep as well.
fn at_rest_together(state: &mut State, mut may: Vec<bool>) -> Vec<u32> {
    let (Some(contacts), Some(clusters)) = (&state.contacts, &state.clusters) else {
        return Vec::new();
    };
    let id = |i: u32| clusters.of_particle[i as usize];
    let held = state.supports.iter();
    let held = held.filter(|support| state.time_s < support.end_s);
    let held = held.flat_map(|support| &support.held);
    let held = held.map(|held| held.particle);
    let loaded = state.loads.iter();
    let loaded = loaded.filter(|load| state.time_s < load.end_s);
    let loaded = loaded.flat_map(|load| &load.particles).copied();
    for i in held.chain(loaded) {
        may[id(i) as usize] = false;
    }
    let moving = |wall: &&Wall| moves(wall, [state.time_s, state.time_step_s]);
    for touch in state.walls.iter().filter(moving).flat_map(|w| &w.touching) {
        may[id(touch.particle) as usize] = false;
    }
    let mut names: Vec<u32> = (0..may.len() as u32).collect();
    for (pair, history) in contacts.pairs.iter().zip(&contacts.histories) {
        if history.overlap_m() > 0.0 {
            join(&mut names, id(pair[0]), id(pair[1]));
        }
    }
    if let Some(bridges) = &state.bridges {
        for [a, b] in bridges.pairs.iter().map(|bridge| bridge.pair) {
            join(&mut names, id(a), id(b));
        }
        for bridge in &bridges.walls {
            if moving(&&state.walls[bridge.wall as usize]) {
                may[id(bridge.particle) as usize] = false;
            }
        }
    }
    leave_out_islands(&mut names, &mut may, state.sleep.as_ref());
    if !may.contains(&true) {
        return Vec::new();
    }
    // Few candidates get this far: only now are all neighbours searched for.
    place_all(&state.clumps, &mut state.particles);
    let (poses, skin_m) = (&state.particles.poses, contacts.skin_m);
    for wall in state.walls.iter().filter(moving) {
        let near = nearness(wall, skin_m);
        for (pose, &cluster) in poses.iter().zip(&clusters.of_particle) {
            if may[cluster as usize] && near(pose) {
                may[cluster as usize] = false;
            }
        }
    }
    for pair in near_pairs(poses, &clusters.of_particle, skin_m) {
        join(&mut names, id(pair[0]), id(pair[1]));
    }
    leave_out_islands(&mut names, &mut may, state.sleep.as_ref());
    let found = (0..may.len() as u32).filter(|&cluster| may[cluster as usize]);
    found.collect()
}

/// Removes every island that contains an awake cluster that may not sleep.
fn leave_out_islands(names: &mut [u32], may: &mut [bool], sleep: Option<&Sleep>) {
    let mut can = vec![true; may.len()];
    for cluster in 0..may.len() as u32 {
        let sleeps = sleep.is_some_and(|sleep| sleep.is_asleep(cluster));
        can[find(names, cluster) as usize] &= may[cluster as usize] || sleeps;
    }
    for cluster in 0..may.len() as u32 {
        may[cluster as usize] &= can[find(names, cluster) as usize];
    }
}

/// Whether a wall moves in the previous step or in the one of this length, s, that begins at this
/// time.
fn moves(wall: &Wall, [time_s, time_step_s]: [f64; 2]) -> bool {
    has_moved(wall) || will_move(wall, time_s, [time_step_s; 2])
}

/// Whether any body sleeps and a wall at rest begins to move: then no body may sleep on it.
pub(crate) fn begins_to_move(
    sleep: Option<&Sleep>,
    walls: &[Wall],
    [time_s, time_step_s]: [f64; 2],
) -> bool {
    let begins = |wall: &Wall| !has_moved(wall) && will_move(wall, time_s, [time_step_s; 2]);
    sleep.is_some_and(|sleep| sleep.bodies > 0) && walls.iter().any(begins)
}

/// Puts clusters to sleep: sets their motion to zero and records the loss.
fn fall_asleep(state: &mut State, falling: &[u32]) {
    let motions = synchronous_motions(state);
    let now = synchronous(state);
    let (Some(clusters), Some(sleep)) = (&state.clusters, &mut state.sleep) else {
        return;
    };
    let falls = |id: u32| falling.binary_search(&id).is_ok();
    let half_s = 0.5 * state.time_step_s;
    for i in (0..state.particles.len()).filter(|&i| falls(clusters.of_particle[i])) {
        let p = &mut state.particles;
        let motion = p.motions[i];
        if i < p.free {
            let own = motion.spin_rad_s.map(|w| w / motion.inverse_inertia);
            let kinetic_j = p.kinetic_j(i, &motions[i]);
            state.ledger.stop(
                [1.0 / motion.inverse_mass, kinetic_j],
                [p.poses[i].place().into(), motion.velocity_m_s, own],
            );
            if let Some(mean) = state.mean_resistance.get_mut(i) {
                *mean = Wrench::default();
            }
            let resisting = [
                &mut state.bond_resistance,
                &mut state.scratch.particle_resistance,
            ];
            for wrench in resisting.into_iter().filter_map(|list| list.get_mut(i)) {
                // The dissipation by damping in the next half step has already been recorded.
                let power_w = motion.power_w(wrench);
                state.ledger.gain(-half_s * power_w);
                *wrench = Wrench::default();
            }
        }
        p.motions[i].velocity_m_s = [0.0; 3];
        p.motions[i].spin_rad_s = [0.0; 3];
        p.wrenches[i] = Wrench::default();
    }
    for (n, now) in now.iter().enumerate() {
        if !falls(now.cluster) {
            continue;
        }
        let template = state.clumps.template(now);
        let (mass_kg, kinetic_j) = (template.mass_kg, now.kinetic_j(template));
        let clump = &mut state.clumps.all[n];
        state.ledger.stop(
            [mass_kg, kinetic_j],
            [clump.place_m, clump.velocity_m_s, clump.angular_momentum],
        );
        clump.velocity_m_s = [0.0; 3];
        clump.angular_momentum = [0.0; 3];
        clump.force_n = [0.0; 3];
        clump.torque_n_m = [0.0; 3];
    }
    for &id in falling {
        sleep.of_cluster[id as usize].asleep = true;
    }
    state.scratch.events.sleep.push(SleepEvent {
        step: state.steps,
        time_s: state.time_s,
        kind: "asleep",
        cause: "rest",
        bodies: falling.len(),
    });
    if let Some(contacts) = &mut state.contacts {
        contacts.search_all();
    }
    count_sleepers(state);
}

/// Sleeping clusters near an awake particle, by the list of pairs, or near a moving wall.
pub(crate) fn disturbed(state: &State) -> Vec<u32> {
    let (Some(contacts), Some(clusters)) = (&state.contacts, &state.clusters) else {
        return Vec::new();
    };
    let p = &state.particles;
    if p.asleep.is_empty() {
        return Vec::new();
    }
    let near_particles =
        contacts
            .pairs
            .iter()
            .filter_map(|&[a, b]| match [a, b].map(|i| p.sleeps(i as usize)) {
                [true, false] => Some(a),
                [false, true] => Some(b),
                _ => None,
            });
    let mut near: Vec<u32> = near_particles.collect();
    for (n, wall) in state.walls.iter().enumerate() {
        if moves(wall, [state.time_s, state.time_step_s]) {
            let is_near = nearness(wall, contacts.skin_m);
            let sleepers = (0..p.len()).filter(|&i| p.asleep[i] && is_near(&p.poses[i]));
            near.extend(sleepers.map(|i| i as u32));
            near.extend(asleep_at(state, n));
        }
    }
    let ids = near.iter().map(|&i| clusters.of_particle[i as usize]);
    let mut ids: Vec<u32> = ids.collect();
    ids.sort_unstable();
    ids.dedup();
    ids
}

/// Sleeping particles with a liquid bridge to the wall of this number.
fn asleep_at(state: &State, wall: usize) -> impl Iterator<Item = u32> {
    let bridges = state.bridges.iter().flat_map(|bridges| &bridges.walls);
    let of_wall = bridges.filter(move |bridge| bridge.wall as usize == wall);
    let particles = of_wall.map(|bridge| bridge.particle);
    particles.filter(|&i| state.particles.sleeps(i as usize))
}

/// Wakes clusters and all that sleep with them, through contacts and liquid bridges, directly or
/// indirectly.
pub(crate) fn wake(state: &mut State, ids: &[u32], cause: &'static str) {
    let (Some(sleep), Some(clusters)) = (&mut state.sleep, &state.clusters) else {
        return;
    };
    let mut names: Vec<u32> = (0..clusters.history.len() as u32).collect();
    let bridged = state.bridges.iter().flat_map(|bridges| &bridges.pairs);
    let bridged = bridged.map(|bridge| bridge.pair);
    for pair in sleep.pairs.iter().map(|kept| kept.pair).chain(bridged) {
        let [a, b] = pair.map(|i| clusters.of_particle[i as usize]);
        join(&mut names, a, b);
    }
    let mut wakes = vec![false; names.len()];
    for &id in ids {
        wakes[find(&mut names, id) as usize] = true;
    }
    let mut bodies = 0;
    for (id, body) in (0..).zip(&mut sleep.of_cluster) {
        if body.asleep && wakes[find(&mut names, id) as usize] {
            *body = ClusterSleep::AWAKE;
            bodies += 1;
        }
    }
    state.scratch.events.sleep.push(SleepEvent {
        step: state.steps,
        time_s: state.time_s,
        kind: "awake",
        cause,
        bodies,
    });
    let of_cluster = &sleep.of_cluster;
    let is_awake = |i: u32| !of_cluster[clusters.of_particle[i as usize] as usize].asleep;
    put_back(
        &mut sleep.pairs,
        &mut sleep.touches,
        state.contacts.as_mut(),
        &mut state.walls,
        state.bridges.as_ref(),
        is_awake,
    );
    count_sleepers(state);
}

/// Wakes the bodies that are about to be removed or replaced, with all that sleep with them.
/// Returns the frozen contacts of the others to the lists, where they are renumbered.
pub(crate) fn prepare_change(state: &mut State, changes: &TopologyChange) {
    let Some(sleep) = &state.sleep else {
        return;
    };
    let clumps = &state.clumps.all;
    let swapped = changes.to_clusters.iter().map(|&at| clumps[at].cluster);
    let stiffened = changes.to_clumps.iter().map(|(id, _)| *id);
    let gone = changes.leaving.iter().copied();
    let all = swapped.chain(stiffened).chain(gone);
    let asleep: Vec<u32> = all.filter(|&id| sleep.is_asleep(id)).collect();
    if !asleep.is_empty() {
        wake(state, &asleep, "changed");
    }
    if let Some(sleep) = &mut state.sleep {
        let contacts = state.contacts.as_mut();
        let Sleep { pairs, touches, .. } = sleep;
        let bridges = state.bridges.as_ref();
        put_back(pairs, touches, contacts, &mut state.walls, bridges, |_| {
            true
        });
    }
}

/// Returns the frozen contacts of awake particles to the lists.
fn put_back(
    pairs: &mut Vec<FrozenContact>,
    touches: &mut Vec<FrozenWallContact>,
    contacts: Option<&mut Contacts>,
    walls: &mut [Wall],
    bridges: Option<&Bridges>,
    is_awake: impl Fn(u32) -> bool,
) {
    if let Some(contacts) = contacts {
        let before = contacts.pairs.iter().zip(&contacts.histories);
        let mut all: Vec<([u32; 2], ContactHistory)> =
            before.map(|(pair, m)| (*pair, *m)).collect();
        let back = pairs.extract_if(.., |kept| is_awake(kept.pair[0]));
        all.extend(back.map(|kept| (kept.pair, kept.history)));
        all.sort_by_key(|(pair, _)| *pair);
        (contacts.pairs, contacts.histories) = all.into_iter().unzip();
    }
    for kept in touches.extract_if(.., |kept| is_awake(kept.touch.particle)) {
        walls[kept.wall].touching.push(kept.touch);
    }
    for wall in walls.iter_mut() {
        wall.touching.sort_by_key(|touch| touch.particle);
    }
    sum_pushes(touches, bridges, |i| !is_awake(i), walls);
}

/// Moves the contact histories of sleeping bodies out of the lists and keeps them.
pub(crate) fn freeze_contacts(state: &mut State) {
    let (Some(sleep), Some(contacts)) = (&mut state.sleep, &state.contacts) else {
        return;
    };
    let p = &state.particles;
    if p.asleep.is_empty() {
        return;
    }
    let known = sleep.pairs.len() + sleep.touches.len();
    for (at, (&pair, &history)) in contacts.pairs.iter().zip(&contacts.histories).enumerate() {
        let both_sleep = pair.iter().all(|&i| p.sleeps(i as usize));
        // Listed pairs that do not touch have no history.
        if both_sleep && history != ContactHistory::default() {
            let elastic_j = contact_energy_j(contacts, p, at);
            sleep.pairs.push(FrozenContact {
                pair,
                history,
                elastic_j,
            });
        }
    }
    for (n, wall) in state.walls.iter_mut().enumerate() {
        let mut touching = std::mem::take(&mut wall.touching);
        touching.retain(|touch| {
            let sleeps = p.sleeps(touch.particle as usize);
            if sleeps {
                sleep.touches.push(FrozenWallContact {
                    wall: n,
                    touch: *touch,
                    push: push_at_rest(wall, contacts, p, touch),
                    elastic_j: touch_energy_j(wall, contacts, p, touch),
                });
            }
            !sleeps
        });
        wall.touching = touching;
    }
    if sleep.pairs.len() + sleep.touches.len() > known || state.bridges.is_some() {
        sleep.pairs.sort_by_key(|kept| kept.pair);
        sleep
            .touches
            .sort_by_key(|kept| (kept.wall, kept.touch.particle));
        let sleeps = |i: u32| p.sleeps(i as usize);
        let bridges = state.bridges.as_ref();
        sum_pushes(&sleep.touches, bridges, sleeps, &mut state.walls);
    }
}

/// Forces between walls and the bodies that sleep on them.
fn sum_pushes(
    touches: &[FrozenWallContact],
    bridges: Option<&Bridges>,
    sleeps: impl Fn(u32) -> bool,
    walls: &mut [Wall],
) {
    for wall in walls.iter_mut() {
        wall.load_by_sleepers = WallLoad::default();
    }
    for FrozenWallContact { wall, push, .. } in touches {
        walls[*wall]
            .load_by_sleepers
            .add(push.force_n, push.torque_n_m, push.belt_w);
    }
    let of_walls = bridges.into_iter().flat_map(|bridges| &bridges.walls);
    for bridge in of_walls.filter(|bridge| sleeps(bridge.particle)) {
        let WallLoad {
            force_n,
            torque_n_m,
            belt_w,
        } = bridge.load;
        walls[bridge.wall as usize]
            .load_by_sleepers
            .add(force_n, torque_n_m, belt_w);
    }
}

/// Updates everything that depends on which bodies sleep: particles, clumps, the division of work,
/// and the gravity term of the ledger.
pub(crate) fn count_sleepers(state: &mut State) {
    let (Some(sleep), Some(clusters)) = (&mut state.sleep, &state.clusters) else {
        return;
    };
    state.damping_memory.clear();
    let p = &mut state.particles;
    sleep.bodies = sleep.of_cluster.iter().filter(|body| body.asleep).count();
    let asleep: Vec<bool> = match sleep.bodies {
        0 => Vec::new(),
        _ => {
            let of_particle = clusters.of_particle.iter();
            of_particle.map(|&id| sleep.is_asleep(id)).collect()
        }
    };
    p.asleep = Asleep::from(asleep);
    sleep.boxes.clear();
    sleep.particles = p.asleep.iter().filter(|asleep| **asleep).count();
    let bonds = &state.bonds;
    let rests = |at: &usize| p.sleeps(bonds.ends[*at][0] as usize) && !bonds.is_broken(*at);
    sleep.bonds = match sleep.particles {
        0 => 0,
        _ => (0..bonds.len()).filter(rests).count() as u64,
    };
    let idle = Idle {
        asleep: &p.asleep,
        part_of: &state.rigid_parts.of_particle,
    };
    state.scratch.partitions = divide_busy(bonds, p.free, state.scratch.threads, idle);
    for clump in &mut state.clumps.all {
        clump.asleep = sleep.is_asleep(clump.cluster);
    }
    let free = (0..p.free).filter(|&i| p.sleeps(i));
    let free = free.map(|i| (1.0 / p.motions[i].inverse_mass, p.poses[i].place().into()));
    let clumps = state.clumps.all.iter().filter(|clump| clump.asleep);
    let clumps = clumps.map(|clump| (state.clumps.template(clump).mass_kg, clump.place_m));
    state.ledger.set_asleep(free.chain(clumps));
}
