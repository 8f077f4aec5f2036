//! Forces and torques of supports.

use super::measurement::{IfZero, Measurement, Settles};
use super::probe::Probe;
use super::view::View;

pub(super) const MEASUREMENTS: &[Measurement] = &[
    reaction("reaction_x", |probe, view| reactions(probe, view, 0)),
    reaction("reaction_torque_x", |probe, view| reactions(probe, view, 3)),
];

const fn reaction(name: &'static str, read: fn(&Probe, &View<'_>) -> f64) -> Measurement {
    Measurement {
        settles: Settles::Always,
        if_zero: IfZero::Note(|measure| {
            let of = &measure.of;
            Some(format!("the supports of '{of}' carry nothing that way"))
        }),
        ..Measurement::new(name, read)
    }
}

/// Sum of a component of force, N, or, from the third on, of torque, N m.
fn reactions(probe: &Probe, view: &View<'_>, first: usize) -> f64 {
    let particles = &probe.members.particles;
    let held = view.state.supports.iter();
    held.flat_map(|support| &support.held)
        .filter(|held| particles.binary_search(&held.particle).is_ok())
        .map(|held| held.reactions[0][first + probe.measure.part])
        .sum::<f64>()
}
