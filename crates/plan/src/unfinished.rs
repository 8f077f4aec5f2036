//! Loads, supports and walls whose ramp takes longer than the run.

use dem_io::units::significant;
use dem_scene::{Factor, Hold, Scene, Support, WallMotion};

/// Part of the run by which a ramp may end late: written times are rounded.
const ROUNDING: f64 = 1e-6;

/// Loads, supports and walls that reach only a part of their value by the end of a run, a sentence
/// each.
pub(super) fn unfinished(scene: &Scene) -> Vec<String> {
    let end_s = scene.run.end_time_s;
    let mut warnings = Vec::new();
    let mut look = |what: String, of: &str, factor: &Factor, until_s: Option<f64>| {
        // What lets go before the end of the run has had its time.
        let at_s = until_s.map_or(end_s, |until_s| until_s.min(end_s));
        if let Some((reached, full_s)) = unfinished_at(factor, at_s) {
            warnings.push(format!(
                "{what} reaches {} % of its {of} by the end of the run, {} s: it needs {} s; set run.end_time later, or its ramp or table shorter",
                significant(100.0 * reached, 3),
                significant(end_s, 4),
                significant(full_s, 4),
            ));
        }
    };
    for (name, load) in &scene.loads {
        look(format!("loads.{name}"), "force", &load.factor, load.end_s);
    }
    for (name, support) in &scene.supports {
        let of = if moves(support) { "motion" } else { continue };
        look(
            format!("supports.{name}"),
            of,
            &support.factor,
            support.end_s,
        );
    }
    for (name, wall) in &scene.walls {
        let (of, factor) = match &wall.motion {
            WallMotion::Displacement { factor, .. } => ("displacement", factor),
            WallMotion::Servo { factor, .. } => ("force", factor),
            WallMotion::Velocity { factor, .. } => ("velocity", factor),
            WallMotion::Fixed
            | WallMotion::Orbit(_)
            | WallMotion::Gyration(_)
            | WallMotion::Bar { .. }
            | WallMotion::Weight { .. } => continue,
        };
        // A table of a wall is often that of a machine, which goes on after the run.
        let is_servo = matches!(wall.motion, WallMotion::Servo { .. });
        if is_servo || matches!(factor, Factor::Ramp { .. }) {
            look(format!("walls.{name}"), of, factor, None);
        }
    }
    warnings
}

fn moves(support: &Support) -> bool {
    let mut holds = support.holds.iter().flatten();
    holds.any(|hold| !matches!(hold, Hold::Fixed))
}

/// The part of its last value that a factor which only rises has at this time, s, and the time at
/// which it has all of it, s. None: it has it, or it falls again.
fn unfinished_at(factor: &Factor, at_s: f64) -> Option<(f64, f64)> {
    let is_late = |full_s: f64| full_s > (1.0 + ROUNDING) * at_s;
    match factor {
        Factor::One | Factor::Oscillation { .. } => None,
        Factor::Ramp { until_s } => is_late(*until_s).then(|| (at_s / until_s, *until_s)),
        Factor::Table(points) => {
            let rises = points.windows(2).all(|pair| pair[1][1] >= pair[0][1]);
            // Up to the first point with the last value.
            let [_, last] = *points.last()?;
            let full_s = points.iter().find(|[_, factor]| *factor == last)?[0];
            let found = rises && last > 0.0 && is_late(full_s);
            found.then(|| {
                (
                    dem_engine::state::loads::factor_at(factor, at_s) / last,
                    full_s,
                )
            })
        }
    }
}
