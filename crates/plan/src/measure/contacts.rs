//! Forces and contacts between objects.

use dem_engine::state::watches::Recorded;
use dem_physics::contact::patch_book::{PatchBook, WallBookModel};

use super::measurement::{IfZero, Measurement, Settles};
use super::probe::Probe;
use super::view::View;

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
    Measurement {
        settles: Settles::Never,
        if_zero: IfZero::Untouched,
        ..Measurement::new("work", work_j)
    },
    Measurement {
        settles: Settles::Never,
        if_zero: IfZero::Untouched,
        ..Measurement::new("power", |probe, view| match view.state.time_s {
            0.0 => 0.0,
            time_s => work_j(probe, view) / time_s,
        })
    },
    booked("wear_volume", |probe, view| {
        let wear =
            |(model, book): (&WallBookModel, PatchBook)| book.wear_m3(model.wear_constant_1_pa);
        books(probe, view).map_or(f64::NAN, wear)
    }),
    booked("impact_energy", |probe, view| {
        books(probe, view).map_or(f64::NAN, |(_, book)| book.impact_j)
    }),
    booked("friction_energy", |probe, view| {
        books(probe, view).map_or(f64::NAN, |(_, book)| book.friction_j)
    }),
];

/// A sum over the patches of a wall, which needs `loads`.
const fn booked(name: &'static str, read: fn(&Probe, &View<'_>) -> f64) -> Measurement {
    Measurement {
        settles: Settles::Never,
        if_zero: IfZero::Untouched,
        refusal: |measure, planned| {
            let wall = planned.scene.walls.get(&measure.of)?;
            let problem = || {
                format!(
                    "the wall \"{}\" has no loads, of which it is a sum",
                    measure.of
                )
            };
            let remedy =
                "write loads = { patch = \"20 mm\" } for the wall, loads = {} if it has stl";
            wall.loads.is_none().then(|| (problem(), remedy))
        },
        ..Measurement::new(name, read)
    }
}

/// The sums of the patches of a wall. None: they are not booked.
fn books<'a>(probe: &Probe, view: &View<'a>) -> Option<(&'a WallBookModel, PatchBook)> {
    let (model, book) = view.state.walls.get(probe.walls[0]?)?.booked()?;
    Some((model, book.total()))
}

/// Work of the wall on particles since the start, J.
fn work_j(probe: &Probe, view: &View<'_>) -> f64 {
    let wall = probe.walls[0].and_then(|wall| view.state.walls.get(wall));
    wall.map_or(f64::NAN, |wall| wall.work_j)
}

/// One that is recorded in every step, and has no value without steps.
const fn recorded(name: &'static str, recorded: Recorded, settles: Settles) -> Measurement {
    Measurement {
        recorded: Some(recorded),
        settles,
        if_zero: IfZero::Untouched,
        ..Measurement::new(name, |_, _| f64::NAN)
    }
}
