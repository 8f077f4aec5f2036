//! `[relaxation]`

use std::ops::Bound::{Excluded, Included};

use super::plain_table::plain_table;
use super::table::Table;
use dem_io::diagnostic::Result;

plain_table! {
    RELAXATION = "[relaxation]";
    /// Overlaps between particles of fragments that separate.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Relaxation {
        /// Their contact law begins at this overlap, which therefore exerts no force.
        enabled: bool = flag("enabled", true);
        /// Smallest overlap that is relaxed, as a fraction of the effective radius; smaller ones
        /// act at once.
        min_overlap: f64 = number("min_overlap")
            .within(Included(0.0), Excluded(1.0))
            .remedy("it is a fraction of the reduced radius: 0 keeps all")
            .or(0.0);
    }
}

pub(super) fn read(root: &Table<'_>) -> Result<Relaxation> {
    Relaxation::read(&root.table("relaxation", &RELAXATION)?)
}
