//! `[clusters]`

use super::listing::one_field_a_key;
use super::schema::{Key, Kind, Schema};
use super::table::Table;
use dem_io::diagnostic::Result;

/// When damaged bodies are searched for fragments (Platzer 2022, 4.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Clusters {
    /// `interval`: steps between two checks for broken bonds. At least 1.
    pub interval: u64,
    /// `min_broken_bonds`: number of bonds broken since the last search that triggers another. At
    /// least 1.
    pub min_broken_bonds: u64,
    /// `force_every`: number of intervals after the last search that triggers another in any case.
    /// 0: never.
    pub force_every: u64,
}

pub(super) static CLUSTERS: Schema = Schema {
    title: "[clusters]",
    doc: "Frequency of the search for fragments in broken bodies.",
    keys: &[
        Key::new(
            "interval",
            Kind::Whole {
                least: 1,
                most: None,
                of: "steps",
            },
            "Steps between two checks for broken bonds.",
        )
        .remedy("a usual value is 50")
        .or(50.0),
        Key::whole(
            "min_broken_bonds",
            1,
            "Number of bonds that must break before the next search.",
        )
        .remedy("1 stands for any bond")
        .or(1.0),
        Key::new(
            "force_every",
            Kind::Whole {
                least: 0,
                most: Some(u64::MAX),
                of: "intervals",
            },
            "Number of intervals after which a search is made in any case; 0: never.",
        )
        .remedy("write 0 for never")
        .otherwise("never"),
    ],
};

one_field_a_key! {
    Clusters {
        interval: "interval",
        min_broken_bonds: "min_broken_bonds",
        force_every: "force_every",
    }
}

pub(super) fn read(root: &Table<'_>) -> Result<Clusters> {
    fields(&root.table("clusters", &CLUSTERS)?)
}
