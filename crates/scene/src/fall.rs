//! `drop` of `[bodies.NAME]`: a body just above a wall, with the speed of a fall.

use super::conflicts;
use super::plain_table::plain_table;
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::LENGTH;

plain_table! {
    DROP = "Drop";
    /// A fall from rest onto a wall, from above it.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Fall {
        /// Distance along gravity that the first point to touch the wall has fallen by then: the
        /// speed of impact is sqrt(2 g height).
        height_m: f64 = quantity("height", &LENGTH).positive().required("\"1 m\"");
        /// The wall that the body falls onto: a plane, a box, a cylinder or an STL surface below
        /// it.
        onto: String = text("onto", "a name in [walls]").required("\"NAME\", a name in [walls]");
    }
}

/// `drop` of a body; refuses one of a body that has a velocity as well.
pub(super) fn read(body: &Table<'_>) -> Result<Option<Fall>> {
    let Some(field) = body.get("drop") else {
        return Ok(None);
    };
    let table = Table::of(&field, &DROP)?;
    conflicts::BODY.refuse_key("velocity", body)?;
    Fall::read(&table).map(Some)
}
