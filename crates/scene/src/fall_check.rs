//! Refuses falls that contradict the rest of the scene.

use std::collections::BTreeMap;

use super::body::BodyEntry;
use super::fall::DROP;
use super::inlet::Inlet;
use super::run::Run;
use super::table::Table;
use super::wall::Wall;
use dem_io::diagnostic::Result;

/// A smaller cosine between a position and gravity is due to rounding.
const ROUNDING: f64 = 1e-12;

/// Refuses falls without gravity, onto an unknown wall, or of bodies that are fed;
/// and a `position` along gravity, which is that of the fall.
pub(super) fn refuse_falls(
    root: &Table<'_>,
    run: &Run,
    bodies: &BTreeMap<String, BodyEntry>,
    walls: &BTreeMap<String, Wall>,
    inlets: &BTreeMap<String, Inlet>,
) -> Result<()> {
    for (name, body) in bodies {
        let (Some(_), Some(field)) = (&body.fall, root.find(&["bodies", name, "drop"])) else {
            continue;
        };
        let onto = Table::of(&field, &DROP)?.need("onto")?;
        onto.reference(walls.keys(), "walls")?;
        let gravity = run.gravity_m_s2;
        if gravity == [0.0; 3] {
            let problem = "needs gravity, and there is none";
            return Err(field.fault(problem, "add gravity = [0, 0, -9.81] to [run]"));
        }
        if let Some((inlet, _)) = inlets.iter().find(|(_, inlet)| inlet.feeds(name)) {
            let problem = format!(
                "is of the start, but [inlets.{inlet}] feeds the body: it is not there then"
            );
            return Err(field.fault(problem, format!("remove it, or [inlets.{inlet}]")));
        }
        let along = |one: [f64; 3], other: [f64; 3]| (0..3).map(|k| one[k] * other[k]).sum::<f64>();
        let position = body.position_m;
        let sizes = along(position, position) * along(gravity, gravity);
        let is_along = along(position, gravity).abs() > ROUNDING * sizes.sqrt();
        if let (Some(field), true) = (root.find(&["bodies", name, "position"]), is_along) {
            let remedy = "leave its part along gravity at 0: it follows from the wall";
            return Err(field.fault("moves the body along gravity, and so does drop", remedy));
        }
    }
    Ok(())
}
