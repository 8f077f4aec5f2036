//! `[search]`

use std::ops::Bound::{Excluded, Included};

use super::listing::one_field_a_key;
use super::schema::{Key, Schema};
use super::table::Table;
use dem_io::diagnostic::Result;

/// Neighbour search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// `skin`: distance beyond contact up to which pairs are listed, as a fraction of the largest
    /// radius; in (0, 2]. None: chosen by the program.
    pub skin: Option<f64>,
}

pub(super) static SEARCH: Schema = Schema {
    title: "[search]",
    doc: "Neighbour search.",
    keys: &[Key::number(
        "skin",
        "Verlet skin: largest gap of pairs in the neighbour list, as a fraction of the largest radius.",
    )
    .within(Excluded(0.0), Included(2.0))
    .remedy("it is a fraction of the largest radius: leave it out, and the program chooses")
    .otherwise("chosen by the program")],
};

one_field_a_key! { Search { skin: "skin" } }

pub(super) fn read(root: &Table<'_>) -> Result<Search> {
    fields(&root.table("search", &SEARCH)?)
}
