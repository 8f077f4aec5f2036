//! The time step: its stages, in order.

use std::sync::LazyLock;
use std::time::Instant;

use crate::stages::bonds::breakage::{
    DAMAGE, FAILURE, FRICTION, RATES, SCATTER, break_failed_bonds, count_frictional, count_rates,
    count_scattered,
};
use crate::stages::bonds::damage::press_damaged_bonds;
use crate::stages::bonds::damping::{BOND_DAMPING, compute_bond_damping};
use crate::stages::bonds::flat_joints::{FLAT_JOINTS, compute_flat_joints};
use crate::stages::bonds::forces::{BONDS, clear_wrenches, compute_bonds};
use crate::stages::bonds::incremental::{HISTORIES, compute_incremental_bonds};
use crate::stages::bonds::plasticity::{PLASTICITY, compute_plastic_bonds};
use crate::stages::bonds::structural_damping::{STRUCTURAL_DAMPING, compute_structural_damping};
use crate::stages::clumps::contact_masses::share_masses;
use crate::stages::clumps::motion::{CLUMPS, drift_clumps, gather_clumps, kick_clumps};
use crate::stages::clumps::replacement::{REPLACEMENT, SQUEEZE, count_squeezing, replace_clumps};
use crate::stages::clumps::restoring::restore_clumps;
use crate::stages::clumps::rigid_parts::{
    RIGID_PARTS, drift_rigid_parts, gather_rigid_parts, kick_rigid_parts,
};
use crate::stages::clumps::zones::{ZONES, follow_zones};
use crate::stages::clusters::pieces::{CLUSTERS, find_pieces};
use crate::stages::contacts::bridges::{BRIDGES, compute_bridges};
use crate::stages::contacts::forces::{
    CONTACTS, RELAXATION, ROLLING, compute_contacts, count_relaxing, count_rolling,
};
use crate::stages::contacts::self_contact::{SELF_CONTACT, find_self_contacts};
use crate::stages::ledger::bookkeeping::{
    CHECKS, LEDGER, advance_time, book_after_kick, book_before_kick, opened,
};
use crate::stages::motion::kick_and_drift::{
    GRAVITY, MOTION, count_falling, drift_particles, kick_particles,
};
use crate::stages::motion::loads::{LOADS, apply_loads};
use crate::stages::motion::local_damping::{PARTICLE_DAMPING, compute_particle_damping};
use crate::stages::motion::riding::drift_riders;
use crate::stages::motion::sleep::{SLEEP, update_sleep};
use crate::stages::motion::supports::{SUPPORTS, hold_supports, remember_held};
use crate::stages::population::absorbed_energy::{DAUGHTERS, take_in_energy};
use crate::stages::population::daughters::replace_by_daughters;
use crate::stages::population::flow::{FLOW, apply_inlets_and_outlets, count_bond_steps};
use crate::stages::search::lists::{SEARCH, renew_lists, use_up_skin};
use crate::stages::stage::Stage;
use crate::stages::walls::{
    WALLS, compute_wall_contacts, drift_walls, find_wall_contacts, plan_wall_motions,
};
use crate::stages::watching::{OUTPUT, watch};
use crate::state::State;
use crate::state::events::Events;
use crate::threads::share_loops;

/// A part of the step: its stage and its function, which returns the number of bonds, contacts,
/// particles or bodies that the stage has worked on.
type Part = (&'static Stage, fn(&mut State) -> usize);

/// First half of a step: the forces on the particles at their present positions, and the velocities
/// that follow from them.
const INTERACT: &[Part] = &[
    (&SELF_CONTACT, find_self_contacts),
    (&SEARCH, renew_lists),
    (&MOTION, clear_wrenches),
    (&BONDS, compute_bonds),
    (&HISTORIES, compute_incremental_bonds),
    (&PLASTICITY, compute_plastic_bonds),
    (&FLAT_JOINTS, compute_flat_joints),
    (&DAMAGE, press_damaged_bonds),
    (&WALLS, find_wall_contacts),
    (&CLUMPS, share_masses),
    (&CONTACTS, compute_contacts),
    (&RELAXATION, count_relaxing),
    (&ROLLING, count_rolling),
    (&WALLS, compute_wall_contacts),
    (&BRIDGES, compute_bridges),
    (&CLUMPS, gather_clumps),
    (&DAUGHTERS, take_in_energy),
    (&SUPPORTS, remember_held),
    (&FAILURE, break_failed_bonds),
    (&RATES, count_rates),
    (&SCATTER, count_scattered),
    (&FRICTION, count_frictional),
    (&CLUSTERS, find_pieces),
    (&LOADS, apply_loads),
    (&PARTICLE_DAMPING, compute_particle_damping),
    (&STRUCTURAL_DAMPING, compute_structural_damping),
    (&BOND_DAMPING, compute_bond_damping),
    (&RIGID_PARTS, gather_rigid_parts),
    (&LEDGER, book_before_kick),
    (&MOTION, kick_particles),
    (&GRAVITY, count_falling),
    (&CLUMPS, kick_clumps),
    (&RIGID_PARTS, kick_rigid_parts),
    (&SUPPORTS, hold_supports),
    (&WALLS, plan_wall_motions),
    (&LEDGER, book_after_kick),
    (&OUTPUT, watch),
    (&CHECKS, nothing),
];

/// Second half, with velocities half a step later: bodies are added, removed and replaced.
const EXCHANGE: &[Part] = &[
    (&LEDGER, count_bond_steps),
    (&FLOW, apply_inlets_and_outlets),
    (&DAUGHTERS, replace_by_daughters),
    (&REPLACEMENT, restore_clumps),
    (&REPLACEMENT, replace_clumps),
    (&SQUEEZE, count_squeezing),
    (&ZONES, follow_zones),
];

/// Everything moves on.
const DRIFT: &[Part] = &[
    (&SLEEP, update_sleep),
    (&SLEEP, drift_riders),
    (&MOTION, drift_particles),
    (&RIGID_PARTS, drift_rigid_parts),
    (&CLUMPS, drift_clumps),
    (&WALLS, drift_walls),
    (&SEARCH, use_up_skin),
    (&LEDGER, advance_time),
];

/// Stages that have work in few steps only: they are timed in each.
const IN_FEW_STEPS: [&Stage; 4] = [&SEARCH, &CLUSTERS, &FLOW, &REPLACEMENT];

/// A complete step. Returns what happened in it.
pub fn step(state: &mut State) -> &Events {
    interact(state);
    advance(state);
    &state.scratch.events
}

/// First half of a step. Afterwards poses are those of `time_s` and velocities those half a step
/// later: the moment at which everything can be measured.
pub fn interact(state: &mut State) {
    state.scratch.events.begin(state.steps, state.time_s);
    if !state.ledger.is_open {
        state.ledger = opened(state);
        state.open_islands();
    }
    run(INTERACT, &TABLE.interact, state);
}

/// Second half of a step. Afterwards poses and time are those at the end of the step.
pub fn advance(state: &mut State) {
    exchange(state);
    drift(state);
}

/// Adds, removes and replaces bodies, while poses are those of `time_s` and velocities those half a
/// step later.
pub fn exchange(state: &mut State) {
    run(EXCHANGE, &TABLE.exchange, state);
}

/// Moves everything on to the end of the step.
pub fn drift(state: &mut State) {
    run(DRIFT, &TABLE.drift, state);
}

/// Does the parts whose stages are not left out. `stages`: for each part the number of its stage.
fn run(parts: &[Part], stages: &[usize], state: &mut State) {
    state.scratch.clock.start(state.steps);
    share_loops(state.wanted_partitions() > 1);
    for ((_, part), &stage) in parts.iter().zip(stages) {
        if state.scratch.clock.is_left_out(stage) {
            continue;
        }
        let began = TABLE.in_few_steps[stage].then(Instant::now);
        let items = part(state);
        let clock = &mut state.scratch.clock;
        clock.did(stage, items);
        match began {
            Some(began) => clock.book_since(stage, began),
            None => clock.book(stage),
        }
    }
    share_loops(true);
}

/// Checks are listed in the table, but run between steps.
fn nothing(_: &mut State) -> usize {
    0
}

/// The stages in the order in which they first occur in the step, and for each part the number of
/// its stage.
struct Table {
    stages: Vec<&'static Stage>,
    /// For each stage whether it has work in few steps only.
    in_few_steps: Vec<bool>,
    interact: Vec<usize>,
    exchange: Vec<usize>,
    drift: Vec<usize>,
}

static TABLE: LazyLock<Table> = LazyLock::new(|| {
    let mut stages: Vec<&'static Stage> = Vec::new();
    let mut number = |(stage, _): &Part| {
        let known = stages.iter().position(|other| *other == *stage);
        known.unwrap_or_else(|| {
            stages.push(stage);
            stages.len() - 1
        })
    };
    let mut numbers = |parts: &[Part]| parts.iter().map(&mut number).collect::<Vec<usize>>();
    let [interact, exchange, drift] = [INTERACT, EXCHANGE, DRIFT].map(&mut numbers);
    Table {
        in_few_steps: (stages.iter().map(|stage| IN_FEW_STEPS.contains(stage))).collect(),
        stages,
        interact,
        exchange,
        drift,
    }
});

/// All stages, in the order of the step.
pub fn stages() -> &'static [&'static Stage] {
    &TABLE.stages
}

/// Number of a stage in [`stages`], under which the clock of a state counts its time.
pub fn number_of(stage: &Stage) -> usize {
    let number = TABLE.stages.iter().position(|other| *other == stage);
    number.unwrap_or(TABLE.stages.len())
}

/// Bytes of all arrays of a state.
pub fn all_bytes(state: &State) -> usize {
    stages().iter().map(|stage| (stage.bytes)(state)).sum()
}
