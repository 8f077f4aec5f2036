//! What contacts have done to the patches of walls: table, cells for ParaView, and sums by wall.

use std::collections::BTreeMap;
use std::path::PathBuf;

use dem_io::Result;
use dem_results::folder::names;
use dem_results::summary::WallLoadSummary;
use dem_results::{WallPatch, write_wall_load_cells, write_wall_loads};

use super::last_state::LastState;
use dem_engine::state::State;
use dem_engine::state::walls::Wall;
use dem_physics::contact::patch_book::{PatchBook, WallBook, WallBookModel};
use dem_physics::geometry::patches::Patch;

/// Writes the table and the cells, if any wall has books.
pub(super) fn wall_loads(last: &LastState<'_>) -> Result<Vec<PathBuf>> {
    let walls = &last.state.walls;
    let names: Vec<String> = walls.iter().map(|wall| wall.model.name.clone()).collect();
    let booked = (0..).zip(walls).filter_map(|(number, wall)| {
        let (model, book) = books(wall)?;
        Some(patches(number, wall, model, book))
    });
    let patches: Vec<WallPatch> = booked.flatten().collect();
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
        let (model, book) = books(wall)?;
        let total = turned(model, &book.total());
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
            impulse_n_s: total.impulse_n_s,
            normal_impulse_n_s: total.normal_impulse_n_s,
            tangential_impulse_n_s: total.tangential_impulse_n_s,
            impact_j: total.impact_j,
            friction_j: total.friction_j,
            damping_j: total.damping_j,
            sliding_load_n_m: total.sliding_load_n_m,
            wear_volume_m3: total.wear_m3(model.wear_constant_1_pa),
            largest_wear_depth_m: depths_m.into_iter().fold(0.0, f64::max),
        };
        Some((wall.model.name.clone(), of_wall))
    };
    state.walls.iter().filter_map(summary).collect()
}

fn books(wall: &Wall) -> Option<(&WallBookModel, &WallBook)> {
    Some((wall.model.book.as_ref()?, wall.book.as_deref()?))
}

/// The patches of a wall of this number, where it stood at the start.
fn patches(number: u32, wall: &Wall, model: &WallBookModel, book: &WallBook) -> Vec<WallPatch> {
    let start = &model.start;
    let in_space = |(at, book): (u64, &PatchBook)| {
        let own = model.patches.patch(&wall.model.shape, at);
        WallPatch {
            wall: number,
            patch: Patch {
                centre_m: start.to_space(own.centre_m),
                normal: start.direction_to_space(own.normal),
                area_m2: own.area_m2,
                corners_m: (own.corners_m.iter())
                    .map(|corner| start.to_space(*corner))
                    .collect(),
            },
            book: turned(model, book),
            wear_m3: book.wear_m3(model.wear_constant_1_pa),
        }
    };
    book.patches().into_iter().map(in_space).collect()
}

/// A book with impulses along axes in space, as the wall stood at the start.
fn turned(model: &WallBookModel, book: &PatchBook) -> PatchBook {
    PatchBook {
        impulse_n_s: model.start.direction_to_space(book.impulse_n_s),
        ..*book
    }
}
