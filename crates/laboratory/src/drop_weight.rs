//! An ore from its drop-weight tests: sheets of t10 over specific energy to the law of breakage.
//!
//! Data flow: files -> [`DropWeightSheets`] -> [`FittedOre`] -> [`ore_text`], which scenes include,
//! and [`ore_page`].

mod broken_fit;
mod cells;
mod columns;
mod estimate;
mod family_fit;
mod least_squares;
mod ore;
mod ore_page;
mod ore_text;
mod read;
mod refused;
mod shares;
mod sheet;
mod size;
mod t10_fit;

pub use estimate::Estimate;
pub use family_fit::FamilyMisfit;
pub use ore::{FittedOre, SizeResidual, fit_ore};
pub use ore_page::{ore_page, ore_plots};
pub use ore_text::{ore_numbers, ore_text};
pub use read::read_sheets;
pub use sheet::{DropWeightSheets, DropWeightTest};
pub use size::{SizeGroup, size_groups};

pub use crate::units::J_KG_OF_KWH_T;
