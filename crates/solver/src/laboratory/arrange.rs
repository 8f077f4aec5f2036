//! The loading rate of a test, and the scene with everything that follows from it.

use std::collections::BTreeMap;

use dem_io::{Body, Diagnostic, Result};
use dem_laboratory::TestType;
use dem_scene::{Factor, Hold, Scene, Support, Test, WallMotion};

use crate::check::lowest_frequency::lowest_frequency_hz;
use crate::plan::bodies::place_bodies;
use crate::state::State;
use dem_laboratory::theory::ON_PINS;

/// A scene whose test has its rate, times `faster`: walls in `moves` get a velocity, sets get a
/// moving support, the run gets its end. A scene without a test stays as it is. The velocity rises
/// uniformly during the first period of `lowest_frequency_hz`, that of the body in the test, which
/// leaves the lowest mode at rest.
///
/// # Errors
/// A support with the name of one of the test's.
pub(crate) fn arrange(scene: &Scene, lowest_frequency_hz: f64, faster: f64) -> Result<Scene> {
    let mut scene = scene.clone();
    let Some(test) = scene.test.clone() else {
        return Ok(scene);
    };
    let period_s = 1.0 / lowest_frequency_hz;
    let rate = test
        .rate_m_s
        .unwrap_or(test.stroke_m / (test.periods * period_s));
    let rate = faster * rate;
    let ramp = Factor::Ramp { until_s: period_s };
    for name in &test.crosshead {
        if let Some(wall) = scene.walls.get_mut(name) {
            wall.motion = WallMotion::Velocity {
                velocity_m_s: test.direction.map(|c| rate * c),
                spin_rad_s: [0.0; 3],
                factor: ramp.clone(),
            };
            continue;
        }
        let support = Support {
            group: name.clone(),
            holds: pulled(&test, rate),
            factor: ramp.clone(),
            end_s: None,
        };
        let key = support_of(name);
        if scene.supports.insert(key.clone(), support).is_some() {
            return Err(Diagnostic::input(
                format!("{}: [supports.{key}]", scene.source),
                format!("the test holds '{name}' by a support of this name"),
                "give it another name",
            ));
        }
    }
    // Half a period is lost while the velocity rises.
    let end_s = test.stroke_m / rate + 0.5 * period_s;
    scene.run.end_time_s = scene.run.end_time_s.min(end_s);
    if let Some(test) = &mut scene.test {
        test.rate_m_s = Some(rate);
    }
    Ok(scene)
}

/// Name of the support with which a test moves a set.
pub(crate) fn support_of(set: &str) -> String {
    format!("test-{set}")
}

/// A grip: moves along the direction of the test, which is one of the axes. Across it the body may
/// become thinner, as if the grip slid on ice: holding it across as well would make it break at the
/// grip.
fn pulled(test: &Test, rate_m_s: f64) -> [Option<Hold>; 6] {
    let mut holds = [None; 6];
    for (hold, along) in holds.iter_mut().zip(test.direction) {
        if along != 0.0 {
            *hold = Some(Hold::Velocity(rate_m_s * along));
        }
    }
    holds
}

/// Lowest frequency of the body that a scene tests, Hz: that of the free body, and for bending its
/// remaining fraction on two supports at its ends. None: the scene has no test.
///
/// # Errors
/// The body has no bonds.
pub(crate) fn lowest_in_test_hz(
    scene: &Scene,
    bodies: &BTreeMap<String, Body>,
    threads: usize,
) -> Result<Option<f64>> {
    let Some(test) = &scene.test else {
        return Ok(None);
    };
    let only = bodies.get_key_value(&test.body);
    let only = only.map(|(name, body)| (name.clone(), body.clone()));
    let (particles, bonds, _) = place_bodies(scene, only.into_iter().collect())?;
    let mut state = State::new(particles, bonds, 1.0, threads);
    let free = lowest_frequency_hz(&mut state).ok_or_else(|| {
        Diagnostic::input(
            format!("{}: [test]", scene.source),
            format!("the body '{}' has no bonds, so nothing to test", test.body),
            "make it with bonds: dem-pack --bond-range 1.1",
        )
    })?;
    Ok(Some(match test.kind {
        TestType::FourPointBending | TestType::ThreePointBending => ON_PINS * free,
        TestType::BrazilianDisc | TestType::Compression | TestType::Tension => free,
    }))
}
