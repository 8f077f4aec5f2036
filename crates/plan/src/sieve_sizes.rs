//! Bodies scaled to a sieve.

use std::collections::BTreeMap;

use dem_io::Body;
use dem_physics::shape::sieve::{Ball, smallest_opening_m};
use dem_scene::Scene;

/// Scales each body with a `sieve_size` until it just passes a square opening of this side.
pub(super) fn scale_to_sieves(scene: &Scene, read: &mut BTreeMap<String, Body>) {
    for (name, entry) in &scene.bodies {
        if let (Some(size_m), Some(body)) = (entry.sieve_size_m, read.get_mut(name)) {
            let spheres = body.positions.iter().zip(&body.radii);
            let balls: Vec<Ball> = spheres
                .map(|(place, radius)| ((*place).into(), *radius))
                .collect();
            scale(body, size_m / smallest_opening_m(&balls));
        }
    }
}

/// Scales a body about the origin of its file.
fn scale(body: &mut Body, factor: f64) {
    let places = body.positions.iter_mut().flatten();
    places.for_each(|place| *place *= factor);
    grow(body, factor);
}

/// Scales all of a body but the places of its spheres.
pub(super) fn grow(body: &mut Body, factor: f64) {
    let lengths = body.radii.iter_mut().chain(&mut body.bond_radii);
    let lengths = lengths.chain(&mut body.bond_lengths);
    let lengths = lengths.chain(&mut body.about.thinnest_part_m);
    lengths.for_each(|length| *length *= factor);
    for column in &mut body.bond_histories {
        column.grow(factor);
    }
    if let Some(volume_m3) = &mut body.about.shape_volume_m3 {
        *volume_m3 *= factor.powi(3);
    }
}

#[cfg(test)]
mod tests {
    use super::scale;
    use dem_io::Body;

    #[test]
    fn all_lengths_of_a_body_grow() {
        let mut body = Body {
            positions: vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]],
            radii: vec![1.0, 2.0],
            bonds: vec![[0, 1]],
            bond_radii: vec![0.5],
            bond_lengths: vec![3.0],
            ..Body::default()
        };
        body.about.shape_volume_m3 = Some(10.0);
        body.about.thinnest_part_m = Some(4.0);
        body.about.particles_across = Some(2.0);
        scale(&mut body, 2.0);
        assert_eq!(body.positions[1], [8.0, 10.0, 12.0]);
        assert_eq!((body.radii, body.bond_radii), (vec![2.0, 4.0], vec![1.0]));
        assert_eq!(body.bond_lengths, [6.0]);
        assert_eq!(body.about.shape_volume_m3, Some(80.0));
        assert_eq!(body.about.thinnest_part_m, Some(8.0));
        assert_eq!(body.about.particles_across, Some(2.0));
    }
}
