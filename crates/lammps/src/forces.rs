//! Loads and supports as fixes.

use dem_scene::{Factor, Hold, Scene};

use super::refusals::Refusals;
use dem_plan::Plan;

/// A load on a group of particles.
#[derive(Debug, Clone)]
pub(super) struct WrittenLoad {
    /// Its name in the scene.
    pub name: String,
    /// The particles of the state.
    pub particles: Vec<u32>,
    /// Force on each as formulas, N.
    pub formulas: [String; 3],
}

/// A support of a group of particles.
#[derive(Debug, Clone)]
pub(super) struct WrittenSupport {
    /// Its name in the scene.
    pub name: String,
    /// The particles of the state.
    pub particles: Vec<u32>,
    /// Velocity with which they move without turning, m/s; None: they are fixed.
    pub velocity_m_s: Option<[f64; 3]>,
}

/// All loads and supports.
#[derive(Debug, Clone, Default)]
pub(super) struct Forces {
    pub loads: Vec<WrittenLoad>,
    pub supports: Vec<WrittenSupport>,
}

/// A factor over time as a formula of LAMMPS.
pub(super) fn formula(factor: &Factor) -> String {
    match factor {
        Factor::One => "1.0".to_owned(),
        Factor::Oscillation {
            frequency_hz,
            phase_rad,
        } => format!(
            "(sin({:e}*time+({phase_rad:e}))-({:e}))",
            std::f64::consts::TAU * frequency_hz,
            phase_rad.sin()
        ),
        Factor::Ramp { until_s } => {
            format!("((time<{until_s:e})*time/{until_s:e}+(time>={until_s:e}))")
        }
        Factor::Table(points) => {
            let mut terms = Vec::new();
            if let (Some([from_s, first]), Some([until_s, last])) = (points.first(), points.last())
            {
                terms.push(format!("(time<{from_s:e})*({first:e})"));
                for pair in points.windows(2) {
                    let [[t0, f0], [t1, f1]] = [pair[0], pair[1]];
                    terms.push(format!(
                        "(time>={t0:e})*(time<{t1:e})*(({f0:e})+({:e})*(time-({t0:e})))",
                        (f1 - f0) / (t1 - t0)
                    ));
                }
                terms.push(format!("(time>={until_s:e})*({last:e})"));
            }
            format!("({})", terms.join("+"))
        }
    }
}

/// The rate of change of a factor over time as a formula of LAMMPS, 1/s.
pub(super) fn rate(factor: &Factor) -> String {
    match factor {
        Factor::One => "0.0".to_owned(),
        Factor::Oscillation {
            frequency_hz,
            phase_rad,
        } => {
            let rate_rad_s = std::f64::consts::TAU * frequency_hz;
            format!("({rate_rad_s:e}*cos({rate_rad_s:e}*time+({phase_rad:e})))")
        }
        Factor::Ramp { until_s } => format!("((time<{until_s:e})/{until_s:e})"),
        Factor::Table(points) => {
            let slope = |pair: &[[f64; 2]]| {
                let [[t0, f0], [t1, f1]] = [pair[0], pair[1]];
                format!("(time>={t0:e})*(time<{t1:e})*({:e})", (f1 - f0) / (t1 - t0))
            };
            let slopes: Vec<String> = points.windows(2).map(slope).collect();
            match slopes.is_empty() {
                true => "0.0".to_owned(),
                false => format!("({})", slopes.join("+")),
            }
        }
    }
}

/// The loads and supports of a planned scene. Refuses torques, and supports that hold only some
/// degrees of freedom, turn, or end.
pub(super) fn forces(scene: &Scene, plan: &Plan, refusals: &mut Refusals) -> Forces {
    let mut forces = Forces::default();
    for ((name, _), load) in scene.loads.iter().zip(&plan.state.loads) {
        let part = format!("[loads.{name}]");
        if load.torque_n_m != [0.0; 3] {
            refusals.add(
                part,
                "fix addtorque turns a group as a whole, but loads no single particle with a torque",
                "replace the torque by forces",
            );
        }
        let mut factor = formula(&load.factor);
        if load.end_s.is_finite() {
            factor = format!("{factor}*(time<{:e})", load.end_s);
        }
        forces.loads.push(WrittenLoad {
            name: name.clone(),
            particles: load.particles.clone(),
            formulas: load.force_n.map(|f| format!("{f:e}*{factor}")),
        });
    }
    for ((name, _), support) in scene.supports.iter().zip(&plan.state.supports) {
        let part = format!("[supports.{name}]");
        if support.end_s.is_finite() {
            refusals.add(
                &*part,
                "a fix that holds particles is not removed within a run",
                "leave end out",
            );
        }
        let Some(held) = all_held(&support.holds, &support.factor) else {
            refusals.add(
                part,
                "fix freeze holds all six degrees of freedom, and fix move moves without turning and at one velocity",
                "use fixed = true; or velocities along x, y and z, without ramp, and fixed = [\"rx\", \"ry\", \"rz\"]",
            );
            continue;
        };
        forces.supports.push(WrittenSupport {
            name: name.clone(),
            particles: support.held.iter().map(|held| held.particle).collect(),
            velocity_m_s: held,
        });
    }
    forces
}

/// The velocity of a support that holds all degrees of freedom and does not turn: Some(None) if it
/// is fixed, None if it is another support.
fn all_held(holds: &[Option<Hold>; 6], factor: &Factor) -> Option<Option<[f64; 3]>> {
    let speed = |hold: &Option<Hold>| match hold {
        Some(Hold::Fixed) => Some(0.0),
        Some(Hold::Velocity(v)) if *factor == Factor::One => Some(*v),
        _ => None,
    };
    let mut speeds = [0.0; 6];
    for (slot, hold) in speeds.iter_mut().zip(holds) {
        *slot = speed(hold)?;
    }
    let [x, y, z, turning @ ..] = speeds;
    if turning != [0.0; 3] {
        return None;
    }
    Some(([x, y, z] != [0.0; 3]).then_some([x, y, z]))
}
