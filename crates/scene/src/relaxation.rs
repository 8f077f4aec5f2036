//! `[relaxation]`

use std::ops::Bound::{Excluded, Included};

use super::listing::one_field_a_key;
use super::schema::{Key, Schema};
use super::table::Table;
use dem_io::diagnostic::Result;

/// Treatment of overlaps between particles that are no longer connected (Platzer 2022, 4.3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxation {
    /// `enabled`: such an overlap becomes the origin of the pair's contact law.
    pub enabled: bool,
    /// `min_overlap`: smaller overlaps, as a fraction of the reduced radius, are not kept; in
    /// [0, 1). The contact force that such a pair then has at once adds energy, which grows with
    /// this to the power of 2.5: at 1e-3 an entire body can gain 1e-4 of its own.
    pub min_overlap: f64,
}

pub(super) static RELAXATION: Schema = Schema {
    title: "[relaxation]",
    doc: "Overlaps between particles of fragments that separate.",
    keys: &[
        Key::flag(
            "enabled",
            true,
            "Their contact law begins at this overlap, which therefore exerts no force.",
        ),
        Key::number(
            "min_overlap",
            "Smallest overlap that is relaxed, as a fraction of the effective radius; smaller ones act at once.",
        )
        .within(Included(0.0), Excluded(1.0))
        .remedy("it is a fraction of the reduced radius: 0 keeps all")
        .or(0.0),
    ],
};

one_field_a_key! {
    Relaxation {
        enabled: "enabled",
        min_overlap: "min_overlap",
    }
}

pub(super) fn read(root: &Table<'_>) -> Result<Relaxation> {
    fields(&root.table("relaxation", &RELAXATION)?)
}
