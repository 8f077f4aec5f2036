//! The loading rate of a test, and the scene with everything that follows from it.

use std::collections::BTreeMap;

use dem_io::{Body, Diagnostic, Result};
use dem_laboratory::TestType;
use dem_scene::{
    Bars, Confinement, Factor, Hold, Load, NormalStress, PlaneShape, Scene, Support, Test,
    WallMotion, WallShape, Weight,
};
use nalgebra::Vector3;

use crate::setup::{extent, side_m2};
use dem_engine::check::lowest_frequency::lowest_frequency_hz;
use dem_engine::state::State;
use dem_laboratory::theory::ON_PINS;
use dem_plan::bodies::place_bodies;

/// Time that a test with bars takes, in ends of its pulse.
const AFTER_PULSE: f64 = 1.5;
/// Longest time of a drop-weight test, in times that the weight takes for the stroke at the
/// velocity of the impact.
const LONGEST_FALL: f64 = 20.0;

/// Time in which the confining pressure rises before the crosshead moves, and the normal stress
/// before the shear, over that of the stroke.
const BEFORE: f64 = 0.25;
/// Largest velocity of a wall that keeps a pressure, over that of the crosshead.
const SERVO: f64 = 10.0;

/// The body of a test as placed in the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TestedBody {
    /// Its lowest frequency in the test, Hz.
    pub lowest_frequency_hz: f64,
    /// Smallest and largest coordinate along x, y and z, m.
    pub extent_m: [[f64; 2]; 3],
}

/// A scene whose test has its rate, times `faster`: walls in `moves` get a velocity, sets get a
/// moving support, the run gets its end. A scene without a test stays as it is. The velocity rises
/// uniformly during the first period of the body in the test, which leaves the lowest mode at rest.
/// A confining pressure and a normal stress rise before that, in a quarter of the time of the
/// stroke. Refuses a support or a load with the name of one of the test's.
pub fn arrange(scene: &Scene, body: &TestedBody, faster: f64) -> Result<Scene> {
    let mut scene = scene.clone();
    let Some(test) = scene.test.clone() else {
        return Ok(scene);
    };
    if let Some(bars) = &test.bars {
        return between_bars(scene, &test, bars);
    }
    if let Some(weight) = &test.weight {
        return Ok(under_weight(scene, &test, weight));
    }
    let period_s = 1.0 / body.lowest_frequency_hz;
    let rate = test
        .rate_m_s
        .unwrap_or(test.stroke_m / (test.periods * period_s));
    let rate = faster * rate;
    let mut start_s = 0.0;
    if let Some(confinement) = &test.confinement {
        start_s = BEFORE * test.stroke_m / rate;
        confine(&mut scene, confinement, body, start_s, SERVO * rate);
    }
    if let Some(normal) = &test.normal_stress {
        start_s = BEFORE * test.stroke_m / rate;
        press(&mut scene, &test, normal, body, start_s)?;
    }
    let ramp = if start_s > 0.0 {
        Factor::Table(vec![[0.0, 0.0], [start_s, 0.0], [start_s + period_s, 1.0]])
    } else {
        Factor::Ramp { until_s: period_s }
    };
    for name in &test.crosshead {
        if let Some(wall) = scene.walls.get_mut(name) {
            wall.motion = WallMotion::Velocity {
                velocity_m_s: test.direction.map(|c| rate * c),
                spin_rad_s: [0.0; 3],
                factor: ramp.clone(),
            };
            continue;
        }
        let holds = pulled(&test, |along| Hold::Velocity(rate * along));
        grip(&mut scene, name, holds, ramp.clone())?;
    }
    // Half a period is lost while the velocity rises.
    let end_s = start_s + test.stroke_m / rate + 0.5 * period_s;
    scene.run.end_time_s = scene.run.end_time_s.min(end_s);
    if let Some(test) = &mut scene.test {
        test.rate_m_s = Some(rate);
    }
    Ok(scene)
}

/// A scene whose test has the ends of the two bars, and its end time.
fn between_bars(mut scene: Scene, test: &Test, bars: &Bars) -> Result<Scene> {
    let impedance_n_s_m = bars.impedance_n_s_m();
    let incident = [(&test.crosshead[0], bars.incident_m_s(), bars.pulse())];
    let transmitted = [(&bars.transmission, 0.0, Factor::One)];
    for (name, incident_m_s, factor) in incident.into_iter().chain(transmitted) {
        if let Some(wall) = scene.walls.get_mut(name) {
            wall.motion = WallMotion::Bar {
                direction: test.direction,
                impedance_n_s_m,
                incident_m_s,
                factor,
            };
            continue;
        }
        let holds = pulled(test, |along| Hold::Bar {
            impedance_n_s_m,
            incident_m_s: incident_m_s * along,
        });
        grip(&mut scene, name, holds, factor)?;
    }
    let end_s = AFTER_PULSE * bars.pulse_end_s();
    scene.run.end_time_s = scene.run.end_time_s.min(end_s);
    Ok(scene)
}

/// A scene whose test has its weight, and its latest end time.
fn under_weight(mut scene: Scene, test: &Test, weight: &Weight) -> Scene {
    if let Some(wall) = scene.walls.get_mut(&test.crosshead[0]) {
        wall.motion = WallMotion::Weight {
            direction: test.direction,
            mass_kg: weight.mass_kg,
            velocity_m_s: weight.velocity_m_s,
            gravity_m_s2: weight.gravity_m_s2,
        };
    }
    let end_s = LONGEST_FALL * test.stroke_m / weight.velocity_m_s;
    scene.run.end_time_s = scene.run.end_time_s.min(end_s);
    scene
}

/// The walls on the sides of a body keep a pressure, which rises until `full_s`.
fn confine(
    scene: &mut Scene,
    confinement: &Confinement,
    body: &TestedBody,
    full_s: f64,
    largest_m_s: f64,
) {
    for name in &confinement.walls {
        let Some(wall) = scene.walls.get_mut(name) else {
            continue;
        };
        if let WallShape::Plane(PlaneShape { normal, .. }) = wall.shape {
            wall.motion = WallMotion::Servo {
                force_n: confinement.pressure_pa * side_m2(&body.extent_m, normal),
                direction: normal,
                max_velocity_m_s: largest_m_s,
                factor: Factor::Ramp { until_s: full_s },
            };
        }
    }
}

/// A load presses the driven half onto the other one, and rises until `full_s`.
fn press(
    scene: &mut Scene,
    test: &Test,
    normal: &NormalStress,
    body: &TestedBody,
    full_s: f64,
) -> Result<()> {
    if normal.stress_pa == 0.0 {
        return Ok(());
    }
    let area_m2 = test
        .area_m2
        .unwrap_or_else(|| side_m2(&body.extent_m, normal.direction));
    for name in &test.crosshead {
        let share = normal.stress_pa * area_m2 / test.crosshead.len() as f64;
        let load = Load {
            group: name.clone(),
            force_n: normal.direction.map(|c| share * c),
            torque_n_m: [0.0; 3],
            factor: Factor::Ramp { until_s: full_s },
            end_s: None,
        };
        let key = support_of(name);
        if scene.loads.insert(key.clone(), load).is_some() {
            return Err(Diagnostic::input(
                format!("{}: [loads.{key}]", scene.source),
                format!("the test presses '{name}' by a load of this name"),
                "give it another name",
            ));
        }
    }
    Ok(())
}

/// Adds the support by which a test moves a group.
fn grip(scene: &mut Scene, name: &str, holds: [Option<Hold>; 6], factor: Factor) -> Result<()> {
    let support = Support {
        group: name.to_owned(),
        holds,
        factor,
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
    Ok(())
}

/// Name of the support with which a test moves a set.
pub(crate) fn support_of(set: &str) -> String {
    format!("test-{set}")
}

/// A grip: moves along the direction of the test, which is one of the axes. Across it the body may
/// become thinner, as if the grip slid on ice: holding it across as well would make it break at the
/// grip. The half of a body that is sheared does not rotate either, and stays in line.
fn pulled(test: &Test, hold_along: impl Fn(f64) -> Hold) -> [Option<Hold>; 6] {
    let mut holds = [None; 6];
    for (hold, along) in holds.iter_mut().zip(test.direction) {
        if along != 0.0 {
            *hold = Some(hold_along(along));
        }
    }
    if let Some(normal) = &test.normal_stress {
        let across = (0..3).find(|k| test.direction[*k] == 0.0 && normal.direction[*k] == 0.0);
        for hold in across.into_iter().chain(3..6) {
            holds[hold] = Some(Hold::Fixed);
        }
    }
    holds
}

/// The body that a scene tests; its lowest frequency is that of the free body, and for bending its
/// remaining fraction on two supports at its ends. None: the scene has no test. Refuses a body
/// without bonds.
pub fn tested_body(
    scene: &Scene,
    bodies: &BTreeMap<String, Body>,
    threads: usize,
) -> Result<Option<TestedBody>> {
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
    let all: Vec<u32> = (0..).take(state.particles.len()).collect();
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    Ok(Some(TestedBody {
        lowest_frequency_hz: match test.kind {
            TestType::FourPointBending | TestType::ThreePointBending => ON_PINS * free,
            _ => free,
        },
        extent_m: axes.map(|axis| extent(&state, &all, &axis)),
    }))
}
