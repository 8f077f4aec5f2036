//! The patches of walls in space, with what contacts have done to them.

use dem_engine::state::walls::Wall;
use dem_physics::contact::patch_book::PatchBook;
use dem_physics::geometry::Frame;
use dem_physics::geometry::patches::Patch;
use dem_results::WallPatch;

/// Where walls that move are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Position {
    /// Where they stood at the start.
    Start,
    /// Where they stand now.
    Now,
}

/// The patches of all walls with loads.
pub(crate) fn wall_patches(walls: &[Wall], position: Position) -> Vec<WallPatch> {
    let booked = (0..).zip(walls).filter_map(|(number, wall)| {
        let (model, book) = wall.booked()?;
        let place = match position {
            Position::Start => &model.start,
            Position::Now => &wall.frame,
        };
        let patches = book.patches().into_iter();
        Some(patches.map(move |(at, book)| WallPatch {
            wall: number,
            patch: in_space(&model.patches.patch(&wall.model.shape, at), place),
            book: turned(book, place),
            wear_m3: book.wear_m3(model.wear_constant_1_pa),
        }))
    });
    booked.flatten().collect()
}

/// A book with impulses along axes in space of a wall in this position.
pub(crate) fn turned(book: &PatchBook, place: &Frame) -> PatchBook {
    PatchBook {
        impulse_n_s: place.direction_to_space(book.impulse_n_s),
        ..*book
    }
}

/// A patch of a wall in this position.
fn in_space(own: &Patch, place: &Frame) -> Patch {
    let corners_m = own.corners_m.iter().map(|corner| place.to_space(*corner));
    Patch {
        centre_m: place.to_space(own.centre_m),
        normal: place.direction_to_space(own.normal),
        area_m2: own.area_m2,
        corners_m: corners_m.collect(),
    }
}
