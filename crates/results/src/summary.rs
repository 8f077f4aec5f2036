//! The summary of a run: its results, their reliability, and the time spent in each stage.

mod balance;
mod by_name;
mod contents;
mod equilibrium;
mod inputs;
mod measured;
mod named;
mod parts;
mod short;
mod sizes;
mod text;

pub use balance::{Balance, ENERGIES, Energy, EnergyKind};
pub use contents::{COARSE, Summary, Trust, Unfinished, Verdict};
pub use equilibrium::EquilibriumSummary;
pub use inputs::{InputBody, InputFile, Inputs};
pub use measured::Measured;
pub use parts::{
    AdaptiveSummary, BodyFlow, FragmentSummary, OutletSummary, PartError, PopulationSummary,
    SleepSummary, TakenIn, WallLoadSummary, WallSummary,
};
pub use sizes::{RESOLVED_DIAMETERS, SizeSummary, Sizes, Unresolved};
