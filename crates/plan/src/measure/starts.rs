//! Where bodies were at the start, and how they were rotated.

use std::collections::BTreeMap;

use nalgebra::{UnitQuaternion, Vector3};

use super::members::Members;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::events::REMOVED;

/// Initial positions of bodies, by name.
pub(super) type Starts = BTreeMap<String, Start>;

/// Initial position of a body.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Start {
    /// Its particles, by their numbers in its file, m.
    places: Vec<Vector3<f64>>,
    /// Its centre, if it was a clump, m.
    centre: Option<Vector3<f64>>,
    /// Rotations of its particles, by their numbers in its file.
    pub(super) turned: Vec<UnitQuaternion<f64>>,
}

/// Positions of the bodies of a state that has not been stepped.
pub(super) fn starts(bodies: &[PlacedBody], state: &State) -> Starts {
    let place = |i: &u32| state.particles.poses[*i as usize].place();
    let turned = |i: &u32| state.particles.poses[*i as usize].rotation();
    let placed = bodies.iter().map(|body| {
        let start = Start {
            places: body.particles.iter().map(place).collect(),
            centre: None,
            turned: body.particles.iter().map(turned).collect(),
        };
        (body.name.clone(), start)
    });
    let clumps = state.clumps.all.iter().map(|clump| {
        let template = state.clumps.template(clump);
        let mut places = vec![Vector3::zeros(); template.spheres.len()];
        let mut turned = vec![UnitQuaternion::identity(); template.spheres.len()];
        for (sphere, &number) in template.file_number.iter().enumerate() {
            let pose = template.pose(sphere, clump);
            places[number as usize] = pose.place();
            turned[number as usize] = pose.rotation();
        }
        let start = Start {
            places,
            centre: Some(clump.place_m.into()),
            turned,
        };
        (template.body.clone(), start)
    });
    placed.chain(clumps).collect()
}

/// Centre of mass of the initial positions of the members, m. Members that did not exist then do
/// not count.
pub(super) fn start_centre(
    members: &Members,
    starts: &Starts,
    bodies: &[PlacedBody],
    state: &State,
) -> Vector3<f64> {
    let mut parts: Vec<(f64, Vector3<f64>)> = Vec::new();
    for body in bodies {
        let Some(start) = starts.get(&body.name) else {
            continue;
        };
        for (place, i) in start.places.iter().zip(&body.particles) {
            if *i != REMOVED && members.particles.binary_search(i).is_ok() {
                let motion = &state.particles.motions[*i as usize];
                parts.push((1.0 / motion.inverse_mass, *place));
            }
        }
    }
    for (_, template) in members.clumps(state, &state.clumps.all) {
        match starts.get(&template.body) {
            Some(Start {
                centre: Some(centre),
                places,
                ..
            }) if places.len() == template.spheres.len() => {
                parts.push((template.mass_kg, *centre));
            }
            // A fragment.
            Some(start) => {
                let spheres = template.spheres.iter().zip(template.file_number.iter());
                parts.extend(spheres.map(|(s, n)| (s.mass_kg, start.places[*n as usize])));
            }
            None => {}
        }
    }
    // In the order of the file or of the state: the same mean, except for rounding.
    mean(&parts)
}

/// The mean of vectors, each with a weight.
pub(super) fn mean(parts: &[(f64, Vector3<f64>)]) -> Vector3<f64> {
    let Some(&(_, origin)) = parts.first() else {
        return Vector3::repeat(f64::NAN);
    };
    let weight: f64 = parts.iter().map(|(weight, _)| weight).sum();
    let sum: Vector3<f64> = parts.iter().map(|(w, x)| *w * (x - origin)).sum();
    origin + sum / weight
}

/// Initial rotations of those of the members' particles that were rotated then.
pub(super) fn turned_before(
    members: &Members,
    starts: &Starts,
    bodies: &[PlacedBody],
) -> BTreeMap<u32, UnitQuaternion<f64>> {
    let known = bodies
        .iter()
        .filter_map(|body| Some((body, starts.get(&body.name)?)));
    let particles = known.flat_map(|(body, start)| body.particles.iter().zip(&start.turned));
    particles
        .filter(|(i, turned)| {
            **turned != UnitQuaternion::identity() && members.particles.binary_search(i).is_ok()
        })
        .map(|(i, turned)| (*i, *turned))
        .collect()
}
