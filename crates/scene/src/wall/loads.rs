//! `loads` of `[walls.NAME]`: what contacts do to each patch of a wall.

use crate::field::Field;
use crate::plain_table::plain_table;
use crate::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{LENGTH, WEAR_CONSTANT};

plain_table! {
    LOADS = "Wall loads";
    /// What contacts do to each patch of a wall: impulses, works and wear, in `wall_loads.csv`.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Loads {
        /// Longest edge of the patches; required with `plane`, `box` and `cylinder`. With `stl`,
        /// each triangle is a patch.
        patch_m: Option<f64> = quantity("patch", &LENGTH)
            .positive()
            .sometimes_required("\"20 mm\", the edge of the patches");
        /// Archard's wear coefficient over the hardness of the wall, K/H: volume worn off over
        /// normal force and sliding distance.
        wear_constant_1_pa: f64 = quantity("wear_constant", &WEAR_CONSTANT).not_negative().or(0.0);
    }
}

/// The loads of a wall whose shape is `shape`, a key.
pub(super) fn read(field: &Field<'_>, shape: &str) -> Result<Loads> {
    let table = Table::of(field, &LOADS)?;
    if shape != "stl" {
        table.need("patch")?;
    } else if let Some(patch) = table.get("patch") {
        let remedy = "remove it: the triangles of the file are the patches";
        return Err(patch.fault("has no effect with stl", remedy));
    }
    Loads::read(&table)
}
