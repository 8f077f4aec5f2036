//! When loads, supports and walls change.

use dem_scene::{Factor, WallMotion};

use dem_engine::state::State;

/// Time of the last change of a load, support or wall, s; infinite if a wall never stops moving.
pub(super) fn last_change_s(state: &State) -> f64 {
    let loads = state.loads.iter().map(|load| &load.factor);
    let supports = state.supports.iter().map(|support| &support.factor);
    let end = |factor: &Factor| match factor {
        Factor::One => 0.0,
        Factor::Ramp { until_s } => *until_s,
        Factor::Table(points) => points.last().map_or(0.0, |[time_s, _]| *time_s),
        Factor::Oscillation { .. } => f64::INFINITY,
    };
    let of_walls = state.walls.iter().map(|wall| match &wall.model.motion {
        WallMotion::Fixed => 0.0,
        WallMotion::Displacement { factor, .. } | WallMotion::Servo { factor, .. } => end(factor),
        WallMotion::Velocity { factor, .. } => match factor {
            Factor::Table(points) if points.last().is_some_and(|[_, f]| *f == 0.0) => end(factor),
            _ => f64::INFINITY,
        },
        WallMotion::Orbit(_)
        | WallMotion::Gyration(_)
        | WallMotion::Bar { .. }
        | WallMotion::Weight { .. } => f64::INFINITY,
    });
    let let_go = state.supports.iter().map(|support| support.end_s);
    let let_go = let_go.chain(state.loads.iter().map(|load| load.end_s));
    let let_go = let_go.filter(|end_s| end_s.is_finite());
    let ends = loads.chain(supports).map(end).chain(of_walls).chain(let_go);
    ends.fold(0.0, f64::max)
}
