//! Runs scenes with bonded bodies. So far: reads a body and says what it holds.

pub mod check;
pub mod cli;
pub mod clock;
pub mod physics;
pub mod stages;
pub mod state;
pub mod step;
