//! Scenes from texts, their plans and a step.

use dem_engine::Balance;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{advance, interact};
use dem_io::Result;
use dem_plan::{Plan, plan};
use dem_scene::{Scene, read_bodies, scene_from_text};

/// The scene of a valid text.
pub(crate) fn scene(text: &str) -> Scene {
    scene_from_text(text, "test.toml", &[]).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// The plan of a valid scene, which may be refused.
pub(crate) fn try_planned(text: &str) -> Result<Plan> {
    let scene = scene(text);
    plan(&scene, read_bodies(&scene).unwrap(), 1, false)
}

pub(crate) fn planned(text: &str) -> Plan {
    try_planned(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// The state before the first step.
pub(crate) fn started(text: &str) -> State {
    planned(text).state
}

/// A step, and the energies in its middle.
pub(crate) fn step_and_balance(state: &mut State) -> Balance {
    interact(state);
    let balance = balance(state);
    advance(state);
    balance
}
