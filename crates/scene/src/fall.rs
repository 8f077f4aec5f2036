//! `drop` of `[bodies.NAME]`: a body just above a wall, with the speed of a fall.

use super::conflicts;
use super::listing::Listing;
use super::schema::{Key, Schema};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::LENGTH;

/// Where a body falls from, and onto what.
#[derive(Debug, Clone, PartialEq)]
pub struct Fall {
    /// `height`: distance, along gravity, that the first point of the body to touch the wall has
    /// fallen from rest when it does so, m; above 0.
    pub height_m: f64,
    /// `onto`: a name of `[walls]`.
    pub onto: String,
}

pub(super) static DROP: Schema = Schema {
    title: "Drop",
    doc: "A fall from rest onto a wall, from above it.",
    keys: &[
        Key::quantity(
            "height",
            &LENGTH,
            "Distance along gravity that the first point to touch the wall has fallen by then: the speed of impact is sqrt(2 g height).",
        )
        .positive()
        .required("\"1 m\""),
        Key::text("onto", "a name in [walls]", "The wall that the body falls onto: a plane, a box, a cylinder or an STL surface below it.")
            .required("\"NAME\", a name in [walls]"),
    ],
};

/// `drop` of a body; refuses one of a body that has a velocity as well.
pub(super) fn read(body: &Table<'_>) -> Result<Option<Fall>> {
    let Some(field) = body.get("drop") else {
        return Ok(None);
    };
    let table = Table::of(&field, &DROP)?;
    conflicts::BODY.refuse_key("velocity", body)?;
    Ok(Some(Fall {
        height_m: table.read("height")?,
        onto: table.need("onto")?.text()?.to_owned(),
    }))
}

pub(super) fn list(fall: &Fall, listing: &mut Listing) {
    listing.table("drop", &DROP, |listing| {
        listing.value("height", &fall.height_m);
        listing.text("onto", &fall.onto);
    });
}
