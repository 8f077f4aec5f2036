//! `[clusters]`

use super::plain_table::plain_table;
use super::table::Table;
use dem_io::diagnostic::Result;

plain_table! {
    CLUSTERS = "[clusters]";
    /// Contacts within a piece of bonded spheres.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct Clusters {
        /// Spheres of one piece that no bond joins touch: cracks that close carry load, and a body
        /// that folds does not pass through itself. false: never, as in Platzer 2022.
        self_contact: bool = flag("self_contact", true);
    }
}

pub(super) fn read(root: &Table<'_>) -> Result<Clusters> {
    Clusters::read(&root.table("clusters", &CLUSTERS)?)
}
