//! Damping models of bonds, one per file. See `doc/inside/adding-a-model.md` for how to add
//! another.

mod chen;
mod mode_ratios;
mod platzer;
mod structural;

pub use self::chen::{Chen, ChenByMode};
pub use self::mode_ratios::ModeRatios;
pub use self::platzer::Platzer;
pub use self::structural::{SMOOTHING, StructuralDamping};
