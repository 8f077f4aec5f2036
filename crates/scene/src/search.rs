//! `[search]`

use std::ops::Bound::{Excluded, Included};

use super::plain_table::plain_table;
use super::table::Table;
use dem_io::diagnostic::Result;

plain_table! {
    SEARCH = "[search]";
    /// Neighbour search.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Search {
        /// Verlet skin: largest gap of pairs in the neighbour list, as a fraction of the largest
        /// radius.
        skin: Option<f64> = number("skin")
            .within(Excluded(0.0), Included(2.0))
            .remedy("it is a fraction of the largest radius: leave it out, and the program chooses")
            .otherwise("chosen by the program");
    }
}

pub(super) fn read(root: &Table<'_>) -> Result<Search> {
    Search::read(&root.table("search", &SEARCH)?)
}
