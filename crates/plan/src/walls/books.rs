//! The patches on which loads of walls are booked.

use dem_io::Result;
use dem_scene::Wall as SceneWall;

use dem_engine::state::State;
use dem_physics::contact::patch_book::WallBookModel;
use dem_physics::geometry::patches::{Patches, refuse_many};
use dem_physics::geometry::{Bounds, Frame, Shape};

/// A plane is taken to be touched over at least this length, m.
const LEAST_REACH_M: f64 = 1e-3;

/// How the loads of a wall are booked, with its shape and its place at the start. None: they are
/// not.
///
/// # Errors
/// Too many patches.
pub(super) fn book_model(
    entry: &SceneWall,
    shape: &Shape,
    start: &Frame,
    state: &State,
) -> Result<Option<WallBookModel>> {
    let Some(loads) = &entry.loads else {
        return Ok(None);
    };
    let edge_m = loads.patch_m.unwrap_or(f64::INFINITY);
    if shape.plane().is_some() {
        let reach = reach_m(state).max(LEAST_REACH_M) / edge_m;
        refuse_many(edge_m, reach * reach)?;
    }
    Ok(Some(WallBookModel {
        patches: Patches::new(shape, edge_m)?,
        wear_constant_1_pa: loads.wear_constant_1_pa,
        start: *start,
    }))
}

/// Size of what a plane may be touched by, m: of all bodies and regions, as far as these are
/// finite.
fn reach_m(state: &State) -> f64 {
    let poses = state.particles.poses.iter();
    let bodies = Bounds::of(poses.map(dem_engine::state::particles::Pose::place));
    let regions = state.model.rules.regions.iter();
    let regions = regions.map(dem_physics::geometry::region::Region::bounds);
    let all = regions.fold(bodies, |all, region| match region.diagonal_m() {
        size_m if size_m.is_finite() => all.with(&region),
        _ => all,
    });
    all.longest_side_m()
}
