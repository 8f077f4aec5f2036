//! Steps by body: which bodies may take longer steps, and the work on one group of them at a time.
//!
//! Leapfrog with a step of its own for each group. The kick at a common time at which the step of a
//! body changes from h to H covers (h + H)/2, so that positions keep their second order.

mod renumbered;
mod wanted;

pub(crate) use self::renumbered::{note_wholes_of_clumps, renumber_levels};
pub(crate) use self::wanted::{any_longer, foresee_walls};

use self::wanted::{have_met, wanted_levels};
use super::stage::{NO_SAVING, Need, Stage};
use super::walls::{move_walls, plan_motions};
use super::watching::watch_within_cycle;
use crate::state::State;
use crate::state::asleep::Asleep;
use crate::state::clumps::Clump;
use crate::state::events::Break;
use crate::state::ledger::Work;
use crate::state::levels::{CYCLE, Group, Levels, MOST_GROUPS, OfWall, Share, length};
use crate::state::partitions::{Idle, Partition, STALE, divide_busy};
use crate::state::walls::WallLoad;

/// Steps by body.
pub(crate) const LEVELS: Stage = Stage {
    name: "steps by body",
    within: None,
    need: |state, scene| match (&state.levels, scene.run.steps_by_body) {
        (Some(_), _) => Need::Needed(format!("steps of up to {CYCLE} times the time step")),
        (None, true) => Need::LeftOut("no body can take twice the time step"),
        (None, false) => Need::LeftOut("not asked for"),
    },
    bytes: |state| {
        let Some(Levels { scratch, .. }) = &state.levels else {
            return 0;
        };
        let of_group = |group: &Group| {
            let listed = group.partitions.iter().flat_map(|one| &one.batches);
            group.others.len() + listed.map(|batch| 4 * batch.which.listed()).sum::<usize>()
        };
        // Body and level of each particle.
        let of_particles = 5 * state.particles.len();
        of_particles + scratch.groups.iter().map(of_group).sum::<usize>()
    },
    saving: NO_SAVING,
};

/// Interval between looks for bodies that may take longer steps, in time steps.
const LOOK_EVERY: u64 = 9 * CYCLE;
/// Number of particles and bonds of a group that justify a thread of their own.
const WORTH_A_THREAD: usize = 5000;

/// Sets the levels of the bodies at a common time, and groups the particles. Returns the number of
/// bodies whose level was looked for.
pub(crate) fn set_levels(state: &mut State) -> usize {
    let Some(levels) = &state.levels else {
        return 0;
    };
    let is_new = levels.shares.is_empty();
    let looks = is_new
        || levels.looks_next
        || !levels.fired.is_empty()
        || state.steps.is_multiple_of(LOOK_EVERY)
        || have_met(state, levels);
    let wanted = looks.then(|| wanted_levels(state, is_new));
    let Some(levels) = &mut state.levels else {
        return 0;
    };
    levels.looks_next = false;
    let changed = wanted.filter(|wanted| *wanted != levels.of_particle);
    let is_changed = changed.is_some();
    if let Some(now) = changed {
        levels.scratch.before = std::mem::replace(&mut levels.of_particle, now);
    }
    if is_new || is_changed {
        group(state);
        share_out(state);
    } else if levels.scratch.groups.is_empty() || is_stale(levels, state.broken_count) {
        group(state);
    } else if levels.scratch.is_relisted {
        list_in_groups(state);
    }
    usize::from(looks)
}

/// Whether so many of the bonds that are computed have broken that it is worth to group again.
fn is_stale(levels: &Levels, broken_count: u64) -> bool {
    let computed = levels
        .scratch
        .groups
        .iter()
        .flat_map(|group| &group.partitions);
    let computed: usize = computed.map(Partition::own_bonds).sum();
    (broken_count - levels.scratch.broken_count) * STALE >= computed.max(1) as u64
}

/// Puts the particles that make the same steps, now and just before, into groups.
fn group(state: &mut State) {
    let Some(levels) = &mut state.levels else {
        return;
    };
    let before = &levels.scratch.before;
    let both = |i: usize| {
        let now = levels.of_particle[i];
        [before.get(i).copied().unwrap_or(now), now]
    };
    let mut kinds: Vec<[u8; 2]> = (0..levels.of_particle.len()).map(both).collect();
    let all = kinds.clone();
    kinds.sort_unstable_by_key(|[before, now]| (*now, *before));
    kinds.dedup();
    let (bonds, free) = (&state.bonds, state.particles.free);
    let of_kind = |levels: [u8; 2]| {
        let others = all.iter().map(|other| *other != levels);
        let others = Asleep::from(others.collect::<Vec<bool>>());
        let idle = Idle {
            asleep: &others,
            part_of: &[],
        };
        let particles = others.iter().filter(|other| !**other).count();
        let own = bonds.ends.iter().filter(|ends| !others[ends[0] as usize]);
        let worth = 1 + (particles + own.count()) / WORTH_A_THREAD;
        let threads = state.scratch.threads.min(worth);
        Group {
            levels,
            partitions: divide_busy(bonds, free, threads, idle),
            threads,
            others,
            ..Group::default()
        }
    };
    levels.scratch.groups = kinds.into_iter().map(of_kind).collect();
    levels.scratch.broken_count = state.broken_count;
    list_in_groups(state);
}

/// Divides the contacts of each group, and lists what is near walls and what touches them.
fn list_in_groups(state: &mut State) {
    let Some(levels) = &mut state.levels else {
        return;
    };
    levels.scratch.is_relisted = false;
    let count = state.particles.len();
    for group in &mut levels.scratch.groups {
        if let Some(contacts) = &mut state.contacts {
            // The division of all contacts stays, for its memory.
            std::mem::swap(&mut contacts.scratch.partitions, &mut group.contacts);
            contacts.divide(count, group.threads);
            std::mem::swap(&mut contacts.scratch.partitions, &mut group.contacts);
            group.close_skin_left_m = 0.0;
        }
        let is_own = |i: u32| !group.others[i as usize];
        group.walls.resize_with(state.walls.len(), Default::default);
        for (wall, (near, touching)) in state.walls.iter().zip(&mut group.walls) {
            near.clear();
            near.extend(wall.near.iter().copied().filter(|&i| is_own(i)));
            let of_wall = wall.touching.iter();
            touching.clear();
            touching.extend(of_wall.filter(|touch| is_own(touch.particle)).copied());
        }
    }
}

/// Gives each group its part of the expected motion. Their sums stay what they are.
fn share_out(state: &mut State) {
    let Some(levels) = &mut state.levels else {
        return;
    };
    let (p, clumps, ledger) = (&state.particles, &state.clumps, &state.ledger);
    let share = |group: &Group| {
        let mut share = Share::default();
        for i in (0..p.free).filter(|&i| !group.others[i]) {
            let (pose, motion) = (&p.poses[i], &p.motions[i]);
            let from_m = [0, 1, 2].map(|k| pose.position_m[k] - ledger.about_m[k]);
            share.add(1.0 / motion.inverse_mass, from_m, motion.velocity_m_s);
        }
        let is_own = |clump: &&Clump| !group.others[clump.first as usize];
        for clump in clumps.all.iter().filter(is_own) {
            let from_m = [0, 1, 2].map(|k| clump.place_m[k] - ledger.about_m[k]);
            let mass_kg = clumps.template(clump).mass_kg;
            share.add(mass_kg, from_m, clump.velocity_m_s);
        }
        share
    };
    let mut shares: Vec<Share> = levels.scratch.groups.iter().map(share).collect();
    let sum = sum_of(&shares);
    if let Some(first) = shares.first_mut() {
        first.mass_kg += ledger.mass_kg - sum.mass_kg;
        for k in 0..3 {
            first.first_moment[k] += ledger.first_moment[k] - sum.first_moment[k];
            first.momentum[k] += ledger.momentum[k] - sum.momentum[k];
        }
    }
    levels.shares = shares;
}

fn sum_of(shares: &[Share]) -> Share {
    shares.iter().fold(Share::default(), |mut sum, share| {
        sum.mass_kg += share.mass_kg;
        for k in 0..3 {
            sum.first_moment[k] += share.first_moment[k];
            sum.momentum[k] += share.momentum[k];
        }
        sum
    })
}

/// Works on the groups one after the other at a common time, with the velocities before the kick.
/// Afterwards the state holds what all of them have in common: loads of walls, contacts, breaks.
pub(crate) fn in_all_groups(state: &mut State, work: impl Fn(&mut State)) {
    plan_walls(state);
    let mut broken: Vec<Break> = Vec::new();
    let mut pending = Work::default();
    let levels = state.levels.as_mut();
    let mut walls = levels.map_or(Vec::new(), |levels| {
        std::mem::take(&mut levels.scratch.walls)
    });
    walls.clear();
    walls.resize(state.walls.len(), OfWall::default());
    if let Some(levels) = &mut state.levels {
        levels.scratch.pushes.iter_mut().for_each(Vec::clear);
    }
    // What has been found since the last common time counts as well.
    let mut pressed = take_pressed(state);
    for n in 0..groups(state) {
        in_group(state, n, &work);
        add_pushes(state);
        broken.append(&mut state.scratch.events.broken);
        // What comes after this time is not to be recorded by the groups that follow.
        pending.add(&std::mem::take(&mut state.ledger.pending), 1.0);
        for (sum, wall) in walls.iter_mut().zip(&mut state.walls) {
            sum.add(wall);
        }
        pressed = pressed.or_else(|| take_pressed(state));
    }
    state.scratch.events.broken = broken;
    state.ledger.pending = pending;
    for (sum, wall) in walls.iter().zip(&mut state.walls) {
        wall.push = sum.push;
        wall.scratch.damping = sum.damping;
        wall.scratch.elastic_j = sum.elastic_j;
        wall.stiffness_n_m = sum.stiffness_n_m;
        wall.pending_j = sum.pending_j;
    }
    if let Some(levels) = &mut state.levels {
        levels.scratch.walls = walls;
    }
    if let Some(contacts) = &mut state.contacts {
        contacts.scratch.excessive_overlap = pressed;
    }
    gather(state);
}

/// Works on the groups that have come to the present time, one after the other, between two common
/// times.
pub(crate) fn in_groups_now(state: &mut State, work: impl Fn(&mut State)) {
    plan_walls(state);
    let mut pressed = take_pressed(state);
    for n in 0..groups(state) {
        let of_group = |levels: &Levels| levels.scratch.groups[n].levels[1];
        let level = state.levels.as_ref().map_or(0, of_group);
        if state.steps.is_multiple_of(1 << level) {
            in_group(state, n, &work);
            pressed = pressed.or_else(|| take_pressed(state));
        }
    }
    if let Some(contacts) = &mut state.contacts {
        contacts.scratch.excessive_overlap = pressed;
    }
}

/// Takes the loads of the walls on the group that is being stepped as those of its level.
pub(crate) fn keep_pushes(state: &mut State) {
    if let Some(levels) = &mut state.levels {
        levels.scratch.pushes[usize::from(levels.scratch.stepping)].clear();
    }
    add_pushes(state);
}

/// Adds the loads of the walls on the group that was stepped last to those of its level.
fn add_pushes(state: &mut State) {
    if let Some(levels) = &mut state.levels {
        let pushes = &mut levels.scratch.pushes[usize::from(levels.scratch.stepping)];
        pushes.resize(state.walls.len(), WallLoad::default());
        for (sum, wall) in pushes.iter_mut().zip(&state.walls) {
            sum.add(wall.push.force_n, wall.push.torque_n_m, wall.push.belt_w);
        }
    }
}

/// Records between two common times the forces and contacts that measures need: of each body those
/// of its last step.
pub(crate) fn watch_between(state: &mut State) {
    if state.watches.is_empty() || !state.scratch.events.renumberings.is_empty() {
        return;
    }
    gather(state);
    if let Some(levels) = &state.levels {
        // Of all groups: each has moved in this cycle.
        state.fastest_m_s = levels.scratch.fastest_m_s + levels.scratch.fastest_wall_m_s;
        for (n, wall) in state.walls.iter_mut().enumerate() {
            wall.push = WallLoad::default();
            for push in levels.scratch.pushes.iter().filter_map(|of| of.get(n)) {
                wall.push.add(push.force_n, push.torque_n_m, push.belt_w);
            }
        }
    }
    watch_within_cycle(state);
}

/// Determines the motion of the walls in the coming time step.
fn plan_walls(state: &mut State) {
    let steps_s = state.steps_s();
    plan_motions(&mut state.walls, state.time_s, steps_s);
}

/// The first pair with an excessive overlap; it is forgotten.
fn take_pressed(state: &mut State) -> Option<[u32; 2]> {
    let contacts = state.contacts.as_mut();
    contacts.and_then(|contacts| contacts.scratch.excessive_overlap.take())
}

/// Keeps the bonds that a group has just broken for the next common time.
pub(crate) fn keep_breaks(state: &mut State) {
    let at = (state.steps, state.time_s);
    let events = &mut state.scratch.events;
    let broken = events.broken.drain(..);
    let first = events.broken_between.len();
    events.broken_between.extend(broken.map(|one| (at, one)));
    let new = events.broken_between[first..].iter();
    state.unsearched.extend(new.map(|(_, one)| one.bond));
}

fn groups(state: &State) -> usize {
    (state.levels.as_ref()).map_or(0, |levels| levels.scratch.groups.len())
}

/// Works on a group: its arrays, its steps and its share of the ledger take the place of those of
/// the state for a while.
fn in_group(state: &mut State, n: usize, work: impl Fn(&mut State)) {
    let Some(levels) = &mut state.levels else {
        return;
    };
    let mut group = std::mem::take(&mut levels.scratch.groups[n]);
    levels.scratch.stepping = group.levels[1];
    let [before, now] = group.levels.map(length);
    swap_in(state, &mut group, n);
    state.previous_time_step_s *= before;
    state.time_step_s *= now;
    work(state);
    state.previous_time_step_s /= before;
    state.time_step_s /= now;
    swap_in(state, &mut group, n);
    if let Some(levels) = &mut state.levels {
        levels.scratch.groups[n] = group;
    }
}

/// Exchanges the arrays of a group with those of the state.
fn swap_in(state: &mut State, group: &mut Group, n: usize) {
    use std::mem::swap;
    swap(&mut state.particles.asleep, &mut group.others);
    for clump in &mut state.clumps.all {
        clump.asleep = state.particles.sleeps(clump.first as usize);
    }
    swap(&mut state.scratch.partitions, &mut group.partitions);
    if let Some(contacts) = &mut state.contacts {
        contacts.scratch.is_of_group ^= true;
        swap(&mut contacts.scratch.partitions, &mut group.contacts);
        swap(&mut contacts.scratch.close_m, &mut group.close_m);
        let left_m = &mut contacts.scratch.close_skin_left_m;
        swap(left_m, &mut group.close_skin_left_m);
        swap(&mut contacts.moved_m, &mut group.moved_m);
    }
    for (wall, (near, touching)) in state.walls.iter_mut().zip(&mut group.walls) {
        swap(&mut wall.near, near);
        swap(&mut wall.touching, touching);
    }
    if let Some(levels) = &mut state.levels {
        let (share, ledger) = (&mut levels.shares[n], &mut state.ledger);
        swap(&mut ledger.mass_kg, &mut share.mass_kg);
        swap(&mut ledger.first_moment, &mut share.first_moment);
        swap(&mut ledger.momentum, &mut share.momentum);
    }
}

/// What follows from the drift of a group that is being stepped.
pub(crate) fn note_drift(state: &mut State) {
    let step_s = state.time_step_s;
    state.ledger.drift(step_s);
    if let Some(contacts) = &mut state.contacts {
        contacts.moved_m = state.fastest_m_s * step_s;
        contacts.scratch.close_skin_left_m -= contacts.moved_m;
    }
    let moved = &state.scratch.chunks_moved_m;
    let fastest_m_s = state.fastest_m_s;
    let awake = state.particles.asleep.iter().filter(|other| !**other);
    let awake = awake.count() as u64;
    if let Some(levels) = &mut state.levels {
        levels.particle_steps[1] += awake;
        let scratch = &mut levels.scratch;
        let steps = CYCLE as f64 / length(scratch.stepping);
        scratch.fastest_m_s = scratch.fastest_m_s.max(fastest_m_s);
        scratch.chunks_moved_m.resize(moved.len(), 0.0);
        for (all_m, moved_m) in scratch.chunks_moved_m.iter_mut().zip(moved) {
            *all_m = all_m.max(steps * moved_m);
        }
        let clumps = &state.clumps.all;
        scratch.clumps_moved_m.resize(clumps.len(), 0.0);
        let all_m = scratch.clumps_moved_m.iter_mut().zip(clumps);
        for (all_m, clump) in all_m.filter(|(_, clump)| !clump.asleep) {
            *all_m += clump.moved_m;
        }
    }
}

/// Joins the groups that make the same steps from now on, after a kick in which levels changed.
pub(crate) fn join_groups(state: &mut State) {
    let Some(levels) = &mut state.levels else {
        return;
    };
    state.scratch.events.broken_between.clear();
    levels.scratch.broken = std::mem::take(&mut state.scratch.events.broken);
    levels.scratch.fastest_m_s = 0.0;
    levels.scratch.chunks_moved_m.clear();
    levels.scratch.clumps_moved_m.clear();
    levels.scratch.fastest_wall_m_s = 0.0;
    levels.scratch.walls_moved_m.clear();
    levels.particle_steps[0] += CYCLE * levels.of_particle.len() as u64;
    if std::mem::take(&mut levels.scratch.is_renumbered) {
        levels.scratch.before.clear();
        group(state);
        share_out(state);
        return;
    }
    if levels.scratch.before.is_empty() {
        return;
    }
    levels.scratch.before.clear();
    let of_groups = levels.scratch.groups.iter().zip(&levels.shares);
    let mut shares: Vec<(u8, Share)> = Vec::new();
    for (group, share) in of_groups {
        match shares.last_mut() {
            Some((level, sum)) if *level == group.levels[1] => *sum = sum_of(&[*sum, *share]),
            _ => shares.push((group.levels[1], *share)),
        }
    }
    levels.shares = shares.into_iter().map(|(_, share)| share).collect();
    group(state);
}

/// Advances the walls and the time by one time step.
pub(crate) fn tick(state: &mut State) {
    if state.contacts.is_some() {
        let fastest_m_s = move_walls(&mut state.walls, &state.particles, state.time_step_s);
        if let Some(levels) = &mut state.levels {
            let scratch = &mut levels.scratch;
            scratch.fastest_wall_m_s = scratch.fastest_wall_m_s.max(fastest_m_s);
            scratch.walls_moved_m.resize(state.walls.len(), 0.0);
            let all_m = scratch.walls_moved_m.iter_mut().zip(&state.walls);
            all_m.for_each(|(all_m, wall)| *all_m += wall.moved_m);
        }
    }
    state.time_s += state.time_step_s;
    state.previous_time_step_s = state.time_step_s;
    state.steps += 1;
}

/// Whether particles have got other numbers since the groups were made.
pub(crate) fn is_renumbered(state: &State) -> bool {
    let levels = state.levels.as_ref();
    levels.is_some_and(|levels| levels.scratch.is_renumbered)
}

/// Whether all groups are at the present time.
pub(crate) fn is_common_time(state: &State) -> bool {
    state.steps.is_multiple_of(CYCLE)
}

/// Puts together what belongs to all groups, at the end of a cycle.
pub(crate) fn end_cycle(state: &mut State) {
    gather(state);
    if let Some(levels) = &mut state.levels {
        let sum = sum_of(&levels.shares);
        (state.ledger.momentum, state.ledger.first_moment) = (sum.momentum, sum.first_moment);
        state.ledger.note_fall(state.model.gravity_m_s2);
        state.fastest_m_s = levels.scratch.fastest_m_s + levels.scratch.fastest_wall_m_s;
        state.scratch.events.broken = std::mem::take(&mut levels.scratch.broken);
        let moved_m = &mut levels.scratch.chunks_moved_m;
        std::mem::swap(&mut state.scratch.chunks_moved_m, moved_m);
        let moved_m = levels.scratch.clumps_moved_m.iter();
        for (clump, moved_m) in state.clumps.all.iter_mut().zip(moved_m) {
            clump.moved_m = *moved_m;
        }
        let moved_m = levels.scratch.walls_moved_m.iter();
        for (wall, moved_m) in state.walls.iter_mut().zip(moved_m) {
            wall.moved_m = *moved_m;
        }
    }
}

/// Puts together the contacts of all groups with walls, and the expected momentum.
fn gather(state: &mut State) {
    let Some(levels) = &state.levels else {
        return;
    };
    let groups = &levels.scratch.groups;
    for (n, wall) in state.walls.iter_mut().enumerate() {
        wall.touching.clear();
        // Each group has its contacts in the order of the particles.
        let mut from = [0; MOST_GROUPS];
        let next = |from: &[usize], group: usize| {
            let of_wall = groups[group].walls.get(n);
            of_wall.and_then(|(_, touching)| touching.get(from[group]).copied())
        };
        while let Some((group, touch)) = (0..groups.len())
            .filter_map(|group| Some((group, next(&from, group)?)))
            .min_by_key(|(_, touch)| touch.particle)
        {
            wall.touching.push(touch);
            from[group] += 1;
        }
    }
    state.ledger.momentum = sum_of(&levels.shares).momentum;
}
