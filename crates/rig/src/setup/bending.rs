//! Bending tests: pins and the beam between them.

use dem_scene::{Scene, Test, Wall, WallShape};
use nalgebra::Vector3;

use super::arrangement::{Refusal, Setup, forwards, middle, size};
use super::given::{Said, compare_with_body, compare_with_pins, dimension};
use super::walls::placed;
use dem_laboratory::theory::Beam;
use dem_laboratory::{Specimen, TestType};

/// A point of the axis of a pin, m, and the unit vector along it.
pub(super) type Pin = (Vector3<f64>, Vector3<f64>);

/// The pins of a bending test that load it, and those that support it.
pub(super) fn bending_pins(
    scene: &Scene,
    test: &Test,
) -> std::result::Result<[Vec<Pin>; 2], Refusal> {
    let (loads, supports): (Vec<_>, Vec<_>) = scene
        .walls
        .iter()
        .partition(|(name, _)| test.crosshead.contains(name));
    let wanted = if test.kind == TestType::FourPointBending {
        2
    } else {
        1
    };
    if loads.len() != wanted || supports.len() != 2 {
        return Err((
            format!(
                "a {} test has {wanted} moving and 2 fixed pins, but here are {} and {}",
                test.kind.name(),
                loads.len(),
                supports.len()
            ),
            "add or remove walls, and name those that load in moves",
        ));
    }
    let pins = |walls: &[(&String, &Wall)]| -> std::result::Result<Vec<Pin>, Refusal> {
        walls.iter().map(|(name, wall)| pin(name, wall)).collect()
    };
    Ok([pins(&loads)?, pins(&supports)?])
}

/// A beam between pins.
pub(super) fn beam(
    scene: &Scene,
    test: &Test,
    extent: impl Fn(&Vector3<f64>) -> [f64; 2],
) -> std::result::Result<Setup, Refusal> {
    let [loads, supports] = bending_pins(scene, test)?;
    let direction = Vector3::from(test.direction);
    let across = loads[0].1;
    let along = across.cross(&direction);
    if along.norm() < 0.999
        || [&loads, &supports]
            .into_iter()
            .flatten()
            .any(|(_, axis)| axis.dot(&across).abs() < 0.999)
    {
        let remedy = "turn them: all have one axis, and direction is square to it";
        return Err((
            "the pins stand askew to each other or to direction".to_owned(),
            remedy,
        ));
    }
    let along = forwards(along.normalize());
    let place = |pins: &[Pin]| -> Vec<f64> {
        let mut places: Vec<f64> = pins.iter().map(|(place, _)| place.dot(&along)).collect();
        places.sort_by(f64::total_cmp);
        places
    };
    let (loaded, held) = (place(&loads), place(&supports));
    let mut said = Said::default();
    let [wide_m, high_m] = [across, direction].map(|way| size(extent(&way)));
    compare_with_pins(
        "support_span",
        test.support_span_m,
        held[1] - held[0],
        &mut said,
    );
    compare_with_body(test, "width", test.width_m, wide_m, &mut said);
    compare_with_body(test, "height", test.height_m, high_m, &mut said);
    let beam = Beam {
        span_m: test.support_span_m.unwrap_or(held[1] - held[0]),
        loading_span_m: match loaded[..] {
            [left, right] => {
                compare_with_pins("loading_span", test.loading_span_m, right - left, &mut said);
                test.loading_span_m.unwrap_or(right - left)
            }
            _ => 0.0,
        },
        width_m: dimension(test, "width", test.width_m, wide_m, &mut said),
        height_m: dimension(test, "height", test.height_m, high_m, &mut said),
    };
    let [low, high] = extent(&along);
    if !(low < held[1] && high > held[0]) || beam.span_m <= beam.loading_span_m {
        let remedy =
            "the supports are further apart than the loading pins, and the body lies on them";
        return Err((
            "the body or the loading pins are not between the supports".to_owned(),
            remedy,
        ));
    }
    let centre = middle([held[0], held[1]]) * along
        + middle(extent(&across)) * across
        + middle(extent(&direction)) * direction;
    // A crack in three-point bending starts under the pin: it may deviate by half the height.
    let crack_within_m = if loaded.len() == 2 {
        0.5 * beam.loading_span_m
    } else {
        0.5 * beam.height_m
    };
    Ok(Setup::of(
        Specimen::Beam(beam),
        test.direction,
        along.into(),
        centre.into(),
        crack_within_m,
    )
    .saying(said))
}

/// Middle of a pin and unit vector along it.
pub(super) fn pin(name: &str, wall: &Wall) -> std::result::Result<Pin, Refusal> {
    let WallShape::Cylinder(cylinder) = &wall.shape else {
        let problem = format!("the wall '{name}' is no cylinder, which pins are");
        return Err((
            problem,
            "write cylinder = { from, to, radius }, or remove the wall",
        ));
    };
    let [from, to] = [cylinder.from_m, cylinder.to_m].map(|end| placed(wall, end));
    Ok((0.5 * (from + to), (to - from).normalize()))
}
