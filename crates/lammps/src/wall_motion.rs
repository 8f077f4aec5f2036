//! Motions of walls as formulas of the time: of regions, which travel, and of surfaces, which
//! travel or turn.
//!
//! <https://docs.lammps.org/region.html>, `fix_modify move` of
//! <https://docs.lammps.org/fix_surface_global.html>

use std::f64::consts::TAU;

use dem_physics::machine::Orbit;
use dem_scene::{Factor, WallMotion};

use super::forces::{formula, rate};
use super::refusals::Refusals;
use super::words::numbers;
use dem_engine::state::walls::Wall;

/// Formulas along x, y and z.
type Formulas = [String; 3];

/// The motion of a surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum SurfaceMotion {
    /// None.
    Stands,
    /// Displacement, m, and velocity, m/s, without turning.
    Travels {
        displacement_m: Formulas,
        velocity_m_s: Formulas,
    },
    /// Arguments of `move rotate`: a point, an axis and the time of a turn.
    Turns(String),
}

/// Displacement and velocity of a wall that travels. None: it stands.
type Path = Option<[Formulas; 2]>;

/// The displacement of a region along x, y and z as formulas of the time. Some(None): it stands;
/// None: its motion is refused.
pub(super) fn moves(
    part: &str,
    motion: &WallMotion,
    refusals: &mut Refusals,
) -> Option<Option<Formulas>> {
    if motion.turns() {
        refusals.add(
            part,
            "the exported regions move, but do not turn",
            "make the wall a surface (stl), or run the scene with dem-run",
        );
        return None;
    }
    let path = path(part, motion, refusals)?;
    Some(path.map(|[displacement_m, _]| displacement_m))
}

/// The motion of a surface. None: it is refused.
pub(super) fn surface_motion(
    part: &str,
    wall: &Wall,
    refusals: &mut Refusals,
) -> Option<SurfaceMotion> {
    let motion = &wall.model.motion;
    if motion.turns() {
        let turn = steady_turn(motion, wall.frame.position_m);
        if turn.is_none() {
            refusals.add(
                part,
                "surfaces turn steadily about a point that stands, and this one does not",
                "give it an angular_velocity alone, without ramp, or run the scene with dem-run",
            );
        }
        return turn.map(SurfaceMotion::Turns);
    }
    Some(match path(part, motion, refusals)? {
        None => SurfaceMotion::Stands,
        Some([displacement_m, velocity_m_s]) => SurfaceMotion::Travels {
            displacement_m,
            velocity_m_s,
        },
    })
}

/// Point, axis and period of a wall that turns steadily about its pivot, which stands.
fn steady_turn(motion: &WallMotion, pivot_m: [f64; 3]) -> Option<String> {
    let WallMotion::Velocity {
        velocity_m_s: [0.0, 0.0, 0.0],
        spin_rad_s,
        factor: Factor::One,
    } = motion
    else {
        return None;
    };
    let rate_rad_s = spin_rad_s.iter().map(|w| w * w).sum::<f64>().sqrt();
    let axis = spin_rad_s.map(|w| w / rate_rad_s);
    Some(format!(
        "{} {} {:e}",
        numbers(&pivot_m),
        numbers(&axis),
        TAU / rate_rad_s
    ))
}

/// The path of a wall that does not turn. None: it is refused.
fn path(part: &str, motion: &WallMotion, refusals: &mut Refusals) -> Option<Path> {
    match motion {
        WallMotion::Fixed => Some(None),
        WallMotion::Velocity {
            velocity_m_s,
            factor,
            ..
        } => {
            let Some(travelled) = travelled(factor) else {
                refusals.add(
                    part,
                    "the path of a wall is a formula, and a table of velocities has no short one",
                    "give a table of displacements instead",
                );
                return None;
            };
            let factor = formula(factor);
            Some(Some([
                velocity_m_s.map(|v| format!("{v:e}*{travelled}")),
                velocity_m_s.map(|v| format!("{v:e}*{factor}")),
            ]))
        }
        WallMotion::Displacement {
            displacement_m,
            factor,
            ..
        } => {
            let (factor, rate) = (formula(factor), rate(factor));
            Some(Some([
                displacement_m.map(|d| format!("{d:e}*{factor}")),
                displacement_m.map(|d| format!("{d:e}*{rate}")),
            ]))
        }
        WallMotion::Orbit(orbit) => Some(Some(round(orbit))),
        WallMotion::Gyration(_) => None,
        WallMotion::Servo { .. } | WallMotion::Bar { .. } | WallMotion::Weight { .. } => {
            refusals.add(
                part,
                "a wall that moves with particles around it takes no force as a target",
                "give it a velocity or a displacement",
            );
            None
        }
    }
}

/// The integral of a factor over time as a formula, s. None: it has no short one.
fn travelled(factor: &Factor) -> Option<String> {
    match factor {
        Factor::One => Some("time".to_owned()),
        Factor::Ramp { until_s } => Some(format!(
            "((time<{until_s:e})*time*time/{:e}+(time>={until_s:e})*(time-{:e}))",
            2.0 * until_s,
            0.5 * until_s
        )),
        Factor::Table(_) | Factor::Oscillation { .. } => None,
    }
}

/// Displacement and velocity on an orbit.
fn round(orbit: &Orbit) -> [Formulas; 2] {
    let rate_rad_s = TAU * orbit.frequency_hz;
    // At the start, and a quarter of a turn later.
    let [from, to] = [0.0, 0.25 / orbit.frequency_hz].map(|at_s| orbit.place_m(at_s));
    let place = |k: usize| {
        format!(
            "({:e}*(cos({rate_rad_s:e}*time)-1)+({:e})*sin({rate_rad_s:e}*time))",
            from[k], to[k]
        )
    };
    let speed = |k: usize| {
        format!(
            "({:e}*cos({rate_rad_s:e}*time)-({:e})*sin({rate_rad_s:e}*time))",
            rate_rad_s * to[k],
            rate_rad_s * from[k]
        )
    };
    [[0, 1, 2].map(place), [0, 1, 2].map(speed)]
}
