//! The time step, in the order in which it happens.

use crate::clock::Stage;
use crate::stages::bonds::bond_wrenches;
use crate::stages::breakage::break_bonds;
use crate::stages::clumps;
use crate::stages::contacts::contact_wrenches;
use crate::stages::damping::damping_wrenches;
use crate::stages::incremental::{add_incremental_wrenches, advance_histories};
use crate::stages::listing::renew_lists;
use crate::stages::loads::add_loads;
use crate::stages::motion::{add_particle_damping, drift, kick};
use crate::stages::sleep;
use crate::stages::supports::{hold, remember};
use crate::stages::walls::{move_walls, plan_motions, wall_wrenches};
use crate::stages::watching::watch;
use crate::state::State;
use crate::state::particles::Wrench;
use crate::state::partitions::{Partition, divide_anew};

/// The work is divided anew when one in so many of the bonds that are computed is broken.
const STALE: u64 = 64;

/// First half of a step: what acts on the particles where they are, and how that changes their velocities.
///
/// Afterwards poses stand at `time_s` and velocities half a step later: the moment at which everything can be measured.
pub fn act(state: &mut State) {
    let before_s = state.previous_time_step_s;
    state.clock.start(state.steps);
    renew_lists(state);
    state.clock.book(Stage::Search);

    let p = &mut state.particles;
    bond_wrenches(
        &state.bonds,
        &p.poses,
        &mut state.partitions,
        &mut p.wrenches,
    );
    state.clock.book(Stage::Bonds);
    if !state.bonds.histories.is_empty() {
        if before_s > 0.0 {
            advance_histories(&mut state.bonds, p, before_s);
        }
        add_incremental_wrenches(
            &state.bonds,
            &p.poses,
            &mut state.partitions,
            &mut p.wrenches,
        );
        state.clock.book(Stage::Histories);
    }
    if let Some(contacts) = &mut state.contacts {
        if !contacts.alone {
            contact_wrenches(contacts, p, before_s);
            state.clock.book(Stage::Contacts);
        }
        wall_wrenches(&mut state.walls, contacts, p, before_s);
        state.clock.book(Stage::Walls);
        clumps::gather(&mut state.clumps, p, before_s);
        state.clock.book(Stage::Clumps);
    }

    // Before bonds break: a break gives its ends their half of the kick at once.
    remember(&mut state.supports, &p.motions);
    state.clock.book(Stage::Supports);
    state.broken.clear();
    let rates = break_bonds(
        &mut state.bonds,
        p,
        &state.partitions,
        0.5 * before_s,
        &mut state.broken,
    );
    state.clock.did(Stage::Rates, rates);
    state.broken_count += state.broken.len() as u64;
    for broken in &state.broken {
        state.broken_by_cause.count(broken.cause);
    }
    if !state.broken.is_empty() {
        leave_out_broken(state);
    }
    state.clock.book(Stage::Failure);
    find_pieces(state);
    state.clock.book(Stage::Clusters);
    let p = &mut state.particles;
    let steps_s = [before_s, state.time_step_s];
    add_loads(&state.loads, state.time_s, steps_s, &mut p.wrenches);
    state.clock.book(Stage::Loads);

    if !state.bond_resistance.is_empty() {
        damping_wrenches(
            &state.bonds,
            &p.poses,
            &p.motions,
            &mut state.partitions,
            &mut state.bond_resistance,
        );
        state.clock.book(Stage::BondDamping);
    }
    if !state.particle_resistance.is_empty() {
        state.particle_resistance.fill(Wrench::default());
        add_particle_damping(
            p,
            state.gravity_m_s2,
            state.particle_damping,
            &mut state.particle_resistance,
        );
        state.clock.did(Stage::ParticleDamping, p.free);
        state.clock.book(Stage::ParticleDamping);
    }

    let kick_s = state.kick_s();
    crate::check::ledger::before_kick(state);
    state.clock.book(Stage::EnergyLedger);
    let p = &mut state.particles;
    let resistance = [&state.bond_resistance[..], &state.particle_resistance];
    kick(p, resistance, state.gravity_m_s2, kick_s);
    state.clock.book(Stage::Motion);
    clumps::kick(&mut state.clumps, state.gravity_m_s2, kick_s);
    state.clock.book(Stage::Clumps);
    hold(
        &mut state.supports,
        p,
        &state.broken,
        state.time_s,
        [before_s, state.time_step_s],
    );
    state.clock.book(Stage::Supports);
    plan_motions(&mut state.walls, state.time_s, state.time_step_s);
    state.clock.book(Stage::Walls);
    crate::check::ledger::after_kick(state);
    count_done(state);
    state.clock.book(Stage::EnergyLedger);
    watch(state);
}

/// Second half of a step: the particles move on.
pub fn move_on(state: &mut State) {
    state.clock.start(state.steps);
    sleep::update_sleep(state);
    state.clock.book(Stage::Sleep);
    let of_clumps_m_s = clumps::drift(&mut state.clumps, &mut state.particles, state.time_step_s);
    state.clock.book(Stage::Clumps);
    state.fastest_m_s = drift(&mut state.particles, state.time_step_s).max(of_clumps_m_s);
    state.clock.book(Stage::Motion);
    if let Some(contacts) = &mut state.contacts {
        let of_walls_m_s = move_walls(&mut state.walls, &state.particles, state.time_step_s);
        state.fastest_m_s += of_walls_m_s;
        let moved_m = state.fastest_m_s * state.time_step_s;
        contacts.moved_m = moved_m;
        contacts.close_skin_left_m -= moved_m;
        contacts.skin_left_m -= moved_m;
        if contacts.skin_left_m < moved_m {
            // After one more such step, who is not listed could overlap.
            contacts.skin_left_m = -1.0;
        }
        state.clock.book(Stage::Walls);
    }
    state.ledger.drift(state.time_step_s);
    state.time_s += state.time_step_s;
    state.previous_time_step_s = state.time_step_s;
    state.steps += 1;
    state.clock.book(Stage::EnergyLedger);
}

/// Looks for the pieces of clusters in which bonds have broken, if it is time to. Particles that are no more of one cluster may touch from the next step on.
fn find_pieces(state: &mut State) {
    state.splits.clear();
    if state.clusters.is_none() {
        return;
    }
    let broken = state.broken.iter().map(|broken| broken.bond);
    state.unsearched.extend(broken);
    if !state
        .triggers
        .due(state.steps, state.unsearched.len() as u64)
    {
        return;
    }
    find_pieces_now(state);
}

/// The same, whether it is time to or not.
pub fn find_pieces_now(state: &mut State) {
    let Some(clusters) = &mut state.clusters else {
        return;
    };
    let damaged = clusters.damaged_by(&state.unsearched, &state.bonds);
    state.clock.did(Stage::Clusters, damaged.len());
    state.splits = clusters.update(state.time_s, &damaged, &state.bonds);
    state.unsearched.clear();
    if let (Some(contacts), false) = (&mut state.contacts, state.splits.is_empty()) {
        contacts.skin_left_m = -1.0;
    }
}

/// Takes down how much each stage has done in this step.
fn count_done(state: &mut State) {
    let clock = &mut state.clock;
    for partition in &state.partitions {
        let computed = partition.computed;
        clock.did(Stage::Bonds, computed.total);
        clock.did(Stage::Histories, computed.incremental);
        clock.did(Stage::Failure, computed.compared);
        if !state.bonds.strength_factors.is_empty() {
            clock.did(Stage::Scatter, computed.compared);
        }
        clock.did(Stage::BondDamping, computed.damped);
    }
    for partition in state
        .contacts
        .iter()
        .flat_map(|contacts| &contacts.partitions)
    {
        clock.did(Stage::Contacts, partition.computed);
        clock.did(Stage::Rolling, partition.rolled);
    }
    for wall in &state.walls {
        clock.did(Stage::Walls, wall.near.len());
    }
    for load in &state.loads {
        clock.did(Stage::Loads, load.particles.len());
    }
    for support in &state.supports {
        clock.did(Stage::Supports, support.held.len());
    }
    let awake = state.clumps.all.iter().filter(|clump| !clump.asleep);
    let clumps = awake.count();
    clock.did(Stage::Clumps, clumps);
    clock.did(Stage::Motion, state.particles.free);
    if state.gravity_m_s2 != [0.0; 3] {
        clock.did(Stage::Gravity, state.particles.free + clumps);
    }
}

/// Divides the work anew once enough bonds have broken since it was divided last.
fn leave_out_broken(state: &mut State) {
    let computed: usize = state.partitions.iter().map(Partition::own_bonds).sum();
    let broken = state.broken_count - state.broken_gone;
    let asleep = state.sleep.as_ref().map_or(0, |sleep| sleep.bonds);
    let whole = state.bonds.len() as u64 - broken - asleep;
    if (computed as u64 - whole) * STALE >= computed as u64 {
        divide_anew(&state.bonds, &mut state.partitions, &state.particles.asleep);
    }
}

/// A whole step.
pub fn step(state: &mut State) {
    act(state);
    move_on(state);
}
