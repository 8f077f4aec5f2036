//! The engine: the [`State`] of a simulation, the stages that a [`step()`] consists of, the limit
//! of its length, and equilibrium without steps.
//!
//! It reads and writes no files: `dem-plan` makes a state from a scene, and `dem-runner` steps it
//! to its end.

pub mod check;
pub mod clock;
pub mod stages;
pub mod state;
pub mod statics;
pub mod step;
pub mod threads;

pub use dem_results::Balance;
pub use stages::ledger::bookkeeping::balance;
pub use state::State;
pub use step::step;
