//! What contacts have done to the patches of walls: table, cells for ParaView, and sums by wall.

use std::collections::BTreeMap;
use std::path::PathBuf;

use dem_io::Result;
use dem_results::folder::names;
use dem_results::summary::WallLoadSummary;
use dem_results::{write_wall_load_cells, write_wall_loads};

use super::last_state::LastState;
use crate::wall_patches::{Position, turned, wall_patches};
use dem_engine::state::State;
use dem_engine::state::walls::Wall;
use dem_physics::contact::patch_book::PatchBook;

/// Writes the table and the cells, if any wall has books.
pub(super) fn wall_loads(last: &LastState<'_>) -> Result<Vec<PathBuf>> {
    let walls = &last.state.walls;
    let names: Vec<String> = walls.iter().map(|wall| wall.model.name.clone()).collect();
    let patches = wall_patches(walls, Position::Start);
    if walls.iter().all(|wall| wall.book.is_none()) {
        return Ok(Vec::new());
    }
    let table = last.folder.file(names::WALL_LOADS);
    write_wall_loads(&table, &names, &patches)?;
    let cells = last.folder.file(names::WALL_LOAD_CELLS);
    write_wall_load_cells(&cells, &names, &patches)?;
    // The cells are no text, as which the files of the last state are kept.
    Ok(vec![table])
}

/// The sums of each wall that has books, by its name.
pub(crate) fn wall_load_summary(state: &State) -> BTreeMap<String, WallLoadSummary> {
    let summary = |wall: &Wall| {
        let (model, book) = wall.booked()?;
        let total = turned(&book.total(), &model.start);
        let touched = book.patches().into_iter();
        let touched = touched.filter(|(_, book)| **book != PatchBook::default());
        let depths_m = touched.map(|(number, book)| {
            let patch = model.patches.patch(&wall.model.shape, number);
            book.wear_m3(model.wear_constant_1_pa) / patch.area_m2
        });
        let depths_m: Vec<f64> = depths_m.collect();
        let of_wall = WallLoadSummary {
            patches: book.patches().len(),
            touched: depths_m.len(),
            sums: total,
            wear_volume_m3: total.wear_m3(model.wear_constant_1_pa),
            largest_wear_depth_m: depths_m.into_iter().fold(0.0, f64::max),
        };
        Some((wall.model.name.clone(), of_wall))
    };
    state.walls.iter().filter_map(summary).collect()
}
