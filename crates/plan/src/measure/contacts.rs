//! Forces and contacts between objects.

use dem_engine::state::watches::Recorded;

use super::measurement::{IfZero, Measurement, Settles};

pub(super) const MEASUREMENTS: &[Measurement] = &[
    recorded("force_x", Recorded::Force, Settles::Always),
    recorded("contact_force_x", Recorded::Force, Settles::Always),
    recorded("contact_overlap", Recorded::Overlap, Settles::Always),
    recorded("contact_duration", Recorded::Duration, Settles::Never),
    // Of the particles on the wall.
    Measurement {
        settles: Settles::Always,
        if_zero: IfZero::Untouched,
        ..Measurement::new("torque_x", |probe, view| {
            let wall = probe.walls[0].and_then(|wall| view.state.walls.get(wall));
            wall.map_or(f64::NAN, |w| 0.0 - w.total_load()[1][probe.measure.part])
        })
    },
];

/// One that is recorded in every step, and has no value without steps.
const fn recorded(name: &'static str, recorded: Recorded, settles: Settles) -> Measurement {
    Measurement {
        recorded: Some(recorded),
        settles,
        if_zero: IfZero::Untouched,
        ..Measurement::new(name, |_, _| f64::NAN)
    }
}
