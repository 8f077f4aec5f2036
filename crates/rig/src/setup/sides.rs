//! The sides of a triaxial test.

use dem_engine::state::State;
use dem_scene::{PlaneShape, Scene, Test, Wall, WallShape};
use nalgebra::Vector3;

use super::arrangement::{GAUGE, Side, extent, middle, size};

/// The walls on the sides of a triaxial test.
pub(super) fn sides(scene: &Scene, test: &Test, state: &State, particles: &[u32]) -> Vec<Side> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let extent_m = axes.map(|axis| extent(state, particles, &axis));
    let confining = |name: &String| {
        let confinement = test.confinement.as_ref();
        confinement.is_some_and(|confinement| confinement.walls.contains(name))
    };
    let walls = scene.walls.iter().enumerate();
    let side = |(wall, (_, of)): (usize, (&String, &Wall))| match of.shape {
        WallShape::Plane(PlaneShape { normal, .. }) => Some(Side {
            wall,
            inwards: normal,
            area_m2: side_m2(&extent_m, normal),
            near: near_side(
                state,
                particles,
                [test.direction, normal].map(Vector3::from),
            ),
            gauge_m: 0.0,
        }),
        _ => None,
    };
    let walls = walls.filter(|(_, (name, _))| confining(name));
    let mut sides: Vec<Side> = walls.filter_map(side).collect();
    let places: Vec<[f64; 3]> = (sides.iter())
        .map(|side| side.inwards.map(|c| c * side.place_m(state)))
        .collect();
    for at in 0..sides.len() {
        let inwards = sides[at].inwards;
        let is_opposite = |other: &&Side| (0..3).all(|k| other.inwards[k] == -inwards[k]);
        let measured = |side: &Side| !side.near.is_empty();
        let other = sides
            .iter()
            .position(|other| is_opposite(&other) && measured(other));
        if let Some(other) = other.filter(|_| measured(&sides[at])) {
            let apart = Vector3::from(places[other]) - Vector3::from(places[at]);
            sides[at].gauge_m = apart.norm();
        }
    }
    sides
}

/// The particles of a body in its middle half along `direction` that are halfway between its middle
/// and the side from which `inwards` points.
pub(super) fn near_side(
    state: &State,
    particles: &[u32],
    [direction, inwards]: [Vector3<f64>; 2],
) -> Vec<u32> {
    let of = |axis: &Vector3<f64>| {
        let ends = extent(state, particles, axis);
        (middle(ends), size(ends))
    };
    let ((middle_m, height_m), (centre_m, width_m)) = (of(&direction), of(&inwards));
    let radii = particles
        .iter()
        .map(|&i| state.particles.poses[i as usize].radius_m());
    let largest_m = radii.fold(0.0, f64::max);
    let spot_m = (0.05 * width_m).max(2.0 * largest_m);
    let is_near = |i: &u32| {
        let place = state.particles.poses[*i as usize].place();
        let from_side_m = place.dot(&inwards) - centre_m + 0.5 * GAUGE * width_m;
        let from_middle_m = place.dot(&direction) - middle_m;
        from_side_m.abs() < spot_m && from_middle_m.abs() < 0.5 * GAUGE * height_m
    };
    particles.iter().copied().filter(is_near).collect()
}

/// Area of the box around a body, square to one of its axes, m2.
pub(crate) fn side_m2(extent_m: &[[f64; 2]; 3], normal: [f64; 3]) -> f64 {
    let sides = (0..3).filter(|k| normal[*k].abs() < 0.5);
    sides.map(|k| size(extent_m[k])).product()
}
