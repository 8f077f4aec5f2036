//! `[clusters]`

use super::listing::one_field_a_key;
use super::schema::{Key, Schema};
use super::table::Table;
use dem_io::diagnostic::Result;

/// What holds for the spheres of one piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Clusters {
    /// `self_contact`: spheres of one piece that no bond joins can touch.
    pub self_contact: bool,
}

pub(super) static CLUSTERS: Schema = Schema {
    title: "[clusters]",
    doc: "Contacts within a piece of bonded spheres.",
    keys: &[Key::flag(
        "self_contact",
        true,
        "Spheres of one piece that no bond joins touch: cracks that close carry load, and a body that folds does not pass through itself. false: never, as in Platzer 2022.",
    )],
};

one_field_a_key! {
    Clusters {
        self_contact: "self_contact",
    }
}

pub(super) fn read(root: &Table<'_>) -> Result<Clusters> {
    fields(&root.table("clusters", &CLUSTERS)?)
}
