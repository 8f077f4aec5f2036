//! Directions in which a test moves: towards the body, or away from what holds it.

use dem_engine::state::State;
use dem_io::units::{show_length, significant};
use dem_io::{Diagnostic, Result};
use dem_scene::{PlaneShape, Scene, Test, Wall, WallShape};
use nalgebra::Vector3;

use super::arrangement::{extent, middle};
use super::walls::{middle_of, placed};

/// Largest sine of the angle between the direction of a test and the normal of a plane that moves.
const OBLIQUE: f64 = 1e-3;
/// Normal of a plane at the start. None: it is another shape.
pub(super) fn normal_of(wall: &Wall) -> Option<Vector3<f64>> {
    let WallShape::Plane(PlaneShape { point_m, normal }) = wall.shape else {
        return None;
    };
    let tip_m = [0, 1, 2].map(|k| point_m[k] + normal[k]);
    Some(placed(wall, tip_m) - placed(wall, point_m))
}

/// Refuses planes that load obliquely, walls that load by moving away from the body, and a
/// transmission bar that is not behind it.
pub(super) fn all_come_nearer(scene: &Scene, test: &Test, middle: Vector3<f64>) -> Result<()> {
    let direction = Vector3::from(test.direction);
    for name in &test.crosshead {
        let normal = scene.walls.get(name).and_then(normal_of);
        if normal.is_some_and(|normal| normal.cross(&direction).norm() > OBLIQUE) {
            return Err(Diagnostic::input(
                format!("{}: test.direction", scene.source),
                format!("the wall '{name}' is not square to the direction in which it moves"),
                "write a direction along the normal of the wall",
            ));
        }
    }
    let behind_m = |name: &String| {
        let place = middle_of(scene.walls.get(name)?)?;
        Some((place - middle).dot(&Vector3::from(test.direction)))
    };
    for name in &test.crosshead {
        if let Some(behind_m) = behind_m(name).filter(|behind_m| *behind_m >= 0.0) {
            return Err(Diagnostic::input(
                format!("{}: [test]", scene.source),
                format!(
                    "the wall '{name}' moves away from the body '{}', whose middle lies {} mm behind it",
                    test.body,
                    significant(1e3 * behind_m, 3)
                ),
                "turn direction round, or name the walls that press in moves",
            ));
        }
    }
    let Some(bars) = &test.bars else {
        return Ok(());
    };
    match behind_m(&bars.transmission) {
        Some(behind_m) if behind_m <= 0.0 => Err(Diagnostic::input(
            format!("{}: test.transmission_bar", scene.source),
            format!(
                "the wall '{}' is not behind the body '{}', but {} mm before its middle along direction",
                bars.transmission,
                test.body,
                significant(-1e3 * behind_m, 3)
            ),
            "name the wall on the far side of the body",
        )),
        _ => Ok(()),
    }
}

/// Refuses a group that is pulled towards the one that is held, or that ends in the other bar.
pub(super) fn pulls_apart(
    scene: &Scene,
    test: &Test,
    state: &State,
    halves: &[Vec<u32>; 2],
) -> Result<()> {
    let direction = Vector3::from(test.direction);
    let [pulled_m, held_m] =
        (halves.each_ref()).map(|half| middle(extent(state, half, &direction)));
    if halves[1].is_empty() || pulled_m > held_m {
        return Ok(());
    }
    let (problem, remedy) = match &test.bars {
        Some(bars) => (
            format!(
                "the incident bar pulls '{}' towards '{}', the end of the transmission bar, {} before it",
                test.crosshead.join(", "),
                bars.transmission,
                show_length(held_m - pulled_m)
            ),
            "exchange crosshead and transmission_bar, or turn direction round",
        ),
        None => (
            format!(
                "the test pulls '{}' towards what is held, {} before it",
                test.crosshead.join(", "),
                show_length(held_m - pulled_m)
            ),
            "turn direction round, or name the group at the other end as the crosshead",
        ),
    };
    let place = format!("{}: [test]", scene.source);
    Err(Diagnostic::input(place, problem, remedy))
}
