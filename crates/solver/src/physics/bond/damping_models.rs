//! Damping models of bonds, a file each. `doc/adding-a-model.md` tells how another one is added.

mod chen;
mod platzer;

pub use self::chen::{Chen, ChenByMode};
pub use self::platzer::Platzer;
