//! Runs scenes with bonded bodies. So far: reads a body and says what it holds.

pub mod cli;
pub mod physics;
pub mod stages;
pub mod state;
