//! Damping models of bonds, one per file. See `doc/adding-a-model.md` for how to add another.

mod chen;
mod platzer;

pub use self::chen::{Chen, ChenByMode};
pub use self::platzer::Platzer;
