//! `[sleep]`

use super::field::Field;
use super::listing::one_field_a_key;
use super::schema::{Key, Schema};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{TIME, VELOCITY};

/// When bodies at rest are no longer integrated, until something comes near them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sleep {
    /// `speed`: largest speed of any point of a body that falls asleep, m/s; more than 0.
    pub speed_m_s: f64,
    /// `after`: time for which the body has been below that speed, s; more than 0.
    pub after_s: f64,
}

pub(super) static SLEEP: Schema = Schema {
    title: "[sleep]",
    doc: "Sleep of bodies at rest, which are then not stepped. Without this table no body sleeps.",
    keys: &[
        Key::quantity(
            "speed",
            &VELOCITY,
            "A body falls asleep when no point of it moves faster than this.",
        )
        .positive()
        .or(1e-3),
        Key::quantity(
            "after",
            &TIME,
            "Time for which it must have been that slow.",
        )
        .positive()
        .or(0.05),
    ],
};

one_field_a_key! {
    Sleep {
        speed_m_s: "speed",
        after_s: "after",
    }
}

pub(super) fn read(field: &Field<'_>) -> Result<Sleep> {
    fields(&Table::of(field, &SLEEP)?)
}
