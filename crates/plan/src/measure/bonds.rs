//! Energy, failure and strain rates of the bonds of a set.

use dem_engine::state::State;
use dem_scene::{ALL, Scene};

use super::measurement::{Measurement, Settles};
use super::probe::Probe;
use super::utilisation::{DynamicUtilisation, largest_utilisation};
use super::view::View;

pub(super) const MEASUREMENTS: &[Measurement] = &[
    Measurement {
        settles: Settles::IfHeld,
        ..Measurement::new("elastic_energy", elastic_j)
    },
    Measurement {
        refusal: |measure, planned| {
            let (of, scene) = (&measure.of, planned.scene);
            let is_group = of != ALL && !scene.bodies.contains_key(of);
            (is_group && loses_bonds(scene)).then(|| {
                (
                    format!(
                        "\"{of}\" is a group, which forgets particles that leave or become rigid, and their broken bonds"
                    ),
                    "name a body in \"of\", or all",
                )
            })
        },
        ..Measurement::new("broken_bonds", broken_bonds)
    },
    Measurement {
        settles: Settles::IfHeld,
        ..Measurement::new("largest_utilisation", |probe, view| {
            largest_utilisation(view.state, &probe.members.marked(view.state))
        })
    },
    Measurement {
        missing: |probe| Some(no_intact_bond(probe)),
        ..Measurement::new("largest_strain_rate", |probe, view| {
            largest(probe, view, f64::NAN, |bond| bond.strain_rate_1_s)
        })
    },
    Measurement::new("largest_dynamic_increase_factor", |probe, view| {
        largest(probe, view, 1.0, |bond| bond.increase_factor)
    }),
    Measurement::new("largest_dynamic_utilisation", |probe, view| {
        largest(probe, view, 0.0, |bond| bond.utilisation)
    }),
    Measurement {
        missing: |probe| Some(no_intact_bond(probe)),
        ..Measurement::new("fraction_below_dynamic_utilisation", |probe, view| {
            let limit = probe.measure.limit.unwrap_or(f64::NAN);
            let [below, all] = over_intact(probe, view, [0.0, 0.0], |[below, all], bond| {
                let is_below = u8::from(bond.utilisation < limit);
                [below + f64::from(is_below), all + 1.0]
            });
            below / all
        })
    },
];

fn no_intact_bond(probe: &Probe) -> String {
    format!("\"{}\" has no intact bond", probe.measure.of)
}

/// Whether bonds of this scene are removed while it runs.
fn loses_bonds(scene: &Scene) -> bool {
    let mut rules = scene.replacement.values();
    !scene.outlets.is_empty() || rules.any(|rule| rule.restore.is_some())
}

/// Elastic energy of the bonds, J.
fn elastic_j(probe: &Probe, view: &View<'_>) -> f64 {
    if probe.members.are_all {
        return view.balance.elastic_j();
    }
    let (bonds, poses) = (&view.state.bonds, &view.state.particles.poses);
    over_bonds(probe, view.state, 0.0, |sum, at, ends_in| {
        if bonds.is_broken(at) {
            return sum;
        }
        sum + 0.5 * ends_in * bonds.forces(at, poses).energy.total()
    })
}

/// Broken bonds since the start, those of what has left included.
fn broken_bonds(probe: &Probe, view: &View<'_>) -> f64 {
    let state = view.state;
    if probe.members.name == ALL {
        return state.broken_count as f64;
    }
    let mut bodies = state.model.bodies.iter();
    let body = bodies.position(|body| body.name == probe.members.name);
    let gone = body.and_then(|body| state.population.broken_gone.get(body));
    let gone = gone.copied().unwrap_or(0) as f64;
    over_bonds(probe, state, gone, |sum, at, _| {
        sum + f64::from(u8::from(state.bonds.is_broken(at)))
    })
}

/// Folds over the bonds that have an end in the set, with the number of ends in it.
fn over_bonds<T>(probe: &Probe, state: &State, start: T, next: impl Fn(T, usize, f64) -> T) -> T {
    let is_in = probe.members.marked(state);
    let mut value = start;
    for (at, ends) in state.bonds.ends.iter().enumerate() {
        let ends_in = ends.iter().filter(|&&end| is_in[end as usize]).count();
        if ends_in > 0 {
            value = next(value, at, ends_in as f64);
        }
    }
    value
}

/// Folds over the intact bonds that have an end in the set.
fn over_intact<T>(
    probe: &Probe,
    view: &View<'_>,
    start: T,
    next: impl Fn(T, &DynamicUtilisation) -> T,
) -> T {
    let bonds = view.bonds();
    over_bonds(probe, view.state, start, |value, at, _| match &bonds[at] {
        Some(bond) => next(value, bond),
        None => value,
    })
}

/// The largest value of the intact bonds that have an end in the set, and at least `least`.
fn largest(probe: &Probe, view: &View<'_>, least: f64, of: fn(&DynamicUtilisation) -> f64) -> f64 {
    over_intact(probe, view, least, |largest, bond| largest.max(of(bond)))
}
