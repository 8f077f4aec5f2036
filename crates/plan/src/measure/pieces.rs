//! Count and masses of fragments.

use super::measurement::Measurement;
use super::probe::Probe;
use super::view::View;

pub(super) const MEASUREMENTS: &[Measurement] = &[
    of_pieces("count", |_, view| {
        let clusters = view.state.clusters.as_ref();
        let gone = view.state.population.discharged.len();
        clusters.map_or(f64::NAN, |c| (c.living().count() + gone) as f64)
    }),
    of_pieces("mass_of_largest", |_, view| largest_kg(view)),
    of_pieces("mass_fraction_of_largest", |_, view| {
        largest_kg(view) / view.masses_kg().iter().sum::<f64>()
    }),
];

const fn of_pieces(name: &'static str, read: fn(&Probe, &View<'_>) -> f64) -> Measurement {
    Measurement {
        needs_clusters: true,
        ..Measurement::new(name, read)
    }
}

fn largest_kg(view: &View<'_>) -> f64 {
    view.masses_kg().iter().copied().fold(0.0, f64::max)
}
