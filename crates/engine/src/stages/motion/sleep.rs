//! Bodies at rest fall asleep together with all bodies that they touch, and wake together when
//! something moving comes near.
//!
//! The decision depends only on positions, motions and contacts, never on what happens to be
//! listed, so that a run resumed from a checkpoint decides the same.

use nalgebra::Vector3;

use super::resting::{EVERY, at_rest_together, awake_bodies};
use super::riding::riders_near;
use crate::stages::clumps::motion::{place_spheres, synchronous};
use crate::stages::contacts::forces::contact_energy_j;
use crate::stages::ledger::totals::synchronous_motions_of_free;
use crate::stages::stage::{Need, Stage};
use crate::stages::walls::carrying::is_belt;
use crate::stages::walls::{
    has_moved, moves, nearness, push_at_rest, touch_energy_j, touch_point_m, will_move,
};
use crate::state::State;
use crate::state::bridges::Bridges;
use crate::state::clusters::fragments::mass_and_centre;
use crate::state::contacts::{ContactHistory, Contacts};
use crate::state::events::SleepEvent;
use crate::state::events::TopologyChange;
use crate::state::particles::Wrench;
use crate::state::sleep::mask::Asleep;
use crate::state::sleep::{ClusterSleep, FrozenContact, FrozenWallContact, Rider, Sleep};
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
                + size_of_val(&sleep.riders[..])
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
    let awake = awake_bodies(state);
    let (Some(rule), Some(sleep), Some(clusters)) =
        (state.model.sleep, &mut state.sleep, &state.clusters)
    else {
        return 0;
    };
    let all = clusters.history.len();
    sleep.of_cluster.resize(all, ClusterSleep::AWAKE);
    let mut slow: Vec<u32> = Vec::new();
    for one in awake {
        let body = &mut sleep.of_cluster[one.cluster as usize];
        let is_slow = one.speed_m_s < rule.speed_m_s;
        if !is_slow {
            body.slow_since_s = f64::INFINITY;
            continue;
        }
        if body.velocity_m_s != one.surface_m_s {
            (body.velocity_m_s, body.slow_since_s) = (one.surface_m_s, f64::INFINITY);
        }
        body.slow_since_s = body.slow_since_s.min(state.time_s);
        if state.time_s - body.slow_since_s >= rule.after_s {
            slow.push(one.cluster);
        }
    }
    if slow.is_empty() {
        return 1;
    }
    let mut may = vec![false; all];
    for cluster in slow {
        may[cluster as usize] = true;
    }
    let (falling, riders) = at_rest_together(state, may);
    if !falling.is_empty() {
        fall_asleep(state, &falling, riders);
    }
    1
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

/// Puts clusters to sleep: sets their motion to zero, or to that of the surface that carries them,
/// and records the loss. `riders`: those of them that a surface carries.
fn fall_asleep(state: &mut State, falling: &[u32], riders: Vec<Rider>) {
    stop_particles(state, falling, &riders);
    stop_clumps(state, falling, &riders);
    if let Some(sleep) = &mut state.sleep {
        for &id in falling {
            sleep.of_cluster[id as usize].asleep = true;
        }
        sleep.riders.extend(riders);
        sleep.riders.sort_by_key(|rider| rider.cluster);
    }
    state.scratch.events.sleep.push(SleepEvent {
        step: state.steps,
        time_s: state.time_s,
        kind: "asleep",
        cause: "rest",
        bodies: falling.len(),
    });
    if let Some(contacts) = &mut state.contacts {
        contacts.skin_left_m = -1.0;
    }
    count_sleepers(state);
    for wall in &mut state.walls {
        wall.ridden.pending_j = 0.5 * state.time_step_s * wall.ridden.power_w;
    }
}

/// The rider that is a cluster which falls asleep.
fn rider_of(riders: &[Rider], cluster: u32) -> Option<&Rider> {
    let at = riders.binary_search_by_key(&cluster, |rider| rider.cluster);
    at.ok().map(|at| &riders[at])
}

/// Stops particles that fall asleep.
fn stop_particles(state: &mut State, falling: &[u32], riders: &[Rider]) {
    let motions = synchronous_motions_of_free(state);
    let Some(clusters) = &state.clusters else {
        return;
    };
    let falls = |id: u32| falling.binary_search(&id).is_ok();
    let half_s = 0.5 * state.time_step_s;
    for i in (0..state.particles.len()).filter(|&i| falls(clusters.of_particle[i])) {
        let rider = rider_of(riders, clusters.of_particle[i]);
        let p = &mut state.particles;
        let motion = p.motions[i];
        if i < p.free {
            let own = motion.spin_rad_s.map(|w| w / motion.inverse_inertia);
            let (mass_kg, kinetic_j) = (1.0 / motion.inverse_mass, p.kinetic_j(i, &motions[i]));
            let place_m = p.poses[i].place().into();
            (state.ledger).stop([mass_kg, kinetic_j], [place_m, motion.velocity_m_s, own]);
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
            if let Some(rider) = rider {
                state.ledger.carry(mass_kg, place_m, rider.velocity_m_s);
                let [fx, fy, fz, _] = p.wrenches[i].force_n;
                take_back_work(&mut state.walls, rider, [fx, fy, fz], half_s);
            }
        }
        p.motions[i].velocity_m_s = rider.map_or([0.0; 3], |rider| rider.velocity_m_s);
        p.motions[i].spin_rad_s = [0.0; 3];
        p.wrenches[i] = Wrench::default();
    }
}

/// Stops clumps that fall asleep.
fn stop_clumps(state: &mut State, falling: &[u32], riders: &[Rider]) {
    let half_s = 0.5 * state.time_step_s;
    for (n, now) in synchronous(state).iter().enumerate() {
        if falling.binary_search(&now.cluster).is_err() {
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
        if let Some(rider) = rider_of(riders, clump.cluster) {
            clump.velocity_m_s = rider.velocity_m_s;
            (state.ledger).carry(mass_kg, clump.place_m, rider.velocity_m_s);
            take_back_work(&mut state.walls, rider, clump.force_n, half_s);
        }
        clump.angular_momentum = [0.0; 3];
        clump.force_n = [0.0; 3];
        clump.torque_n_m = [0.0; 3];
    }
}

/// Takes back the work on a rider in the next half step, which the wall that carries it has already
/// recorded: all forces on bodies that ride together, `force_n`, are its forces.
fn take_back_work(walls: &mut [Wall], rider: &Rider, force_n: [f64; 3], half_s: f64) {
    let power_w: f64 = (0..3).map(|k| force_n[k] * rider.velocity_m_s[k]).sum();
    walls[rider.wall as usize].pending_j -= half_s * power_w;
}

/// Sleeping clusters near a wall or sleeping bodies that do not move as they do, besides those of
/// these particles, which are near an awake one.
pub(crate) fn disturbed(state: &mut State, mut near: Vec<u32>, skin_m: f64) -> Vec<u32> {
    near.extend(riders_near(state, skin_m));
    near.extend(near_moving_walls(state));
    let Some(clusters) = &state.clusters else {
        return Vec::new();
    };
    let ids = near.iter().map(|&i| clusters.of_particle[i as usize]);
    let mut ids: Vec<u32> = ids.collect();
    ids.sort_unstable();
    ids.dedup();
    ids
}

/// Sleeping particles near a moving wall that does not carry them.
fn near_moving_walls(state: &State) -> Vec<u32> {
    let Some(contacts) = &state.contacts else {
        return Vec::new();
    };
    let p = &state.particles;
    let mut near = Vec::new();
    if p.asleep.is_empty() {
        return near;
    }
    for (n, wall) in state.walls.iter().enumerate() {
        if moves(wall, state.moment()) {
            let is_near = nearness(wall, contacts.skin_m);
            let sleepers = (0..p.len()).filter(|&i| state.rests_asleep(i) && is_near(&p.poses[i]));
            near.extend(sleepers.map(|i| i as u32));
            near.extend(asleep_at(state, n));
        }
    }
    near
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
            if let Some(contacts) = &mut state.contacts {
                let references = &mut contacts.scratch.references;
                references.due.extend(clusters.members(id));
            }
        }
    }
    for clump in state.clumps.all.iter().filter(|clump| clump.rides()) {
        if !sleep.is_asleep(clump.cluster) {
            place_spheres(&state.clumps, clump, &mut state.particles);
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
        (is_awake, state.time_s),
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
        let all = (|_| true, state.time_s);
        put_back(pairs, touches, contacts, &mut state.walls, bridges, all);
    }
}

/// Returns the frozen contacts of awake particles to the lists, at this time, s.
fn put_back(
    pairs: &mut Vec<FrozenContact>,
    touches: &mut Vec<FrozenWallContact>,
    contacts: Option<&mut Contacts>,
    walls: &mut [Wall],
    bridges: Option<&Bridges>,
    (is_awake, time_s): (impl Fn(u32) -> bool, f64),
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
    sum_pushes(touches, bridges, |i| !is_awake(i), (walls, time_s));
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
                    at_s: state.time_s,
                    foot_m: (wall.frame).to_wall(touch_point_m(p, touch).into()),
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
        let walls = (&mut state.walls[..], state.time_s);
        sum_pushes(&sleep.touches, bridges, sleeps, walls);
    }
}

/// Forces between walls and the bodies that sleep on them, at this time, s.
fn sum_pushes(
    touches: &[FrozenWallContact],
    bridges: Option<&Bridges>,
    sleeps: impl Fn(u32) -> bool,
    (walls, time_s): (&mut [Wall], f64),
) {
    for wall in walls.iter_mut() {
        wall.load_by_sleepers = WallLoad::default();
    }
    for kept in touches {
        let (wall, push) = (&mut walls[kept.wall], &kept.push);
        let mut torque_n_m = push.torque_n_m;
        if is_belt(wall) {
            // Its force has moved along the belt, whose pivot stays in place.
            let along_m = Vector3::from(wall.model.surface_velocity_m_s) * (time_s - kept.at_s);
            let more = along_m.cross(&Vector3::from(push.force_n));
            torque_n_m = (Vector3::from(torque_n_m) + more).into();
        }
        (wall.load_by_sleepers).add(push.force_n, torque_n_m, push.belt_w);
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
    for clump in &mut state.clumps.all {
        clump.asleep = sleep.is_asleep(clump.cluster);
    }
    let free = (0..p.free).filter(|&i| p.sleeps(i)).map(|i| {
        let motion = &p.motions[i];
        let moving = [p.poses[i].place().into(), motion.velocity_m_s];
        (1.0 / motion.inverse_mass, moving)
    });
    let clumps = state.clumps.all.iter().filter(|clump| clump.asleep);
    let clumps = clumps.map(|clump| {
        let moving = [clump.place_m, clump.velocity_m_s];
        (state.clumps.template(clump).mass_kg, moving)
    });
    state.ledger.set_asleep(free.chain(clumps));
    count_riders(state);
    state.divide_bonds();
}

/// Updates the riders and the power of the walls that carry them.
fn count_riders(state: &mut State) {
    let (Some(sleep), Some(clusters)) = (&mut state.sleep, &state.clusters) else {
        return;
    };
    let of_cluster = &sleep.of_cluster;
    (sleep.riders).retain(|rider| of_cluster[rider.cluster as usize].asleep);
    let speeds = sleep.riders.iter();
    let speeds = speeds.map(|rider| Vector3::from(rider.velocity_m_s).norm());
    sleep.riding_m_s = speeds.fold(0.0, f64::max);
    for wall in &mut state.walls {
        wall.ridden.power_w = 0.0;
    }
    let weight_m_s2 = -Vector3::from(state.model.gravity_m_s2);
    for rider in &sleep.riders {
        let members = clusters.members(rider.cluster);
        let carrier = (members.first()).and_then(|&i| state.clumps.carrier_of(i as usize));
        let mass_kg = match carrier {
            Some(clump) => state.clumps.template(&state.clumps.all[clump]).mass_kg,
            None => mass_and_centre(members, &state.particles).0,
        };
        let rise_m2_s3 = weight_m_s2.dot(&Vector3::from(rider.velocity_m_s));
        state.walls[rider.wall as usize].ridden.power_w += mass_kg * rise_m2_s3;
    }
}
