//! `[sleep]`

use super::field::Field;
use super::plain_table::plain_table;
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{TIME, VELOCITY};

plain_table! {
    SLEEP = "[sleep]";
    /// Sleep of bodies at rest, which are then not stepped. Without this table no body sleeps.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Sleep {
        /// A body falls asleep when no point of it moves faster than this.
        speed_m_s: f64 = quantity("speed", &VELOCITY).positive().or(1e-3);
        /// Time for which it must have been that slow.
        after_s: f64 = quantity("after", &TIME).positive().or(0.05);
    }
}

pub(super) fn read(field: &Field<'_>) -> Result<Sleep> {
    Sleep::read(&Table::of(field, &SLEEP)?)
}
