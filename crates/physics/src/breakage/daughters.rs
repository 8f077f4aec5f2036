//! The fragments of a broken particle, as spheres within it.

use nalgebra::Vector3;

use super::passing;
use dem_io::random::uniform;

/// Sizes of daughters are the smallest one times powers of the 32nd root of 2, so that many
/// particles have the same size.
const SIZES_PER_OCTAVE: f64 = 32.0;
/// Rounds of moving daughters apart. Their overlaps hardly change after that.
const ROUNDS: usize = 60;
/// Distance from the centre that is left to each daughter, over the radius of the ball.
const LEAST_ROOM: f64 = 0.03;

/// Diameters of the daughters of a particle of this size, m, the largest first: the part of its
/// mass in daughters above any size is 1 - t_n, to half of the mass of one daughter. None is
/// smaller than `smallest_m`; the rest of the mass is fines. All have the density of the particle.
pub fn diameters_m(family_exponent: f64, t10: f64, size_m: f64, smallest_m: f64) -> Vec<f64> {
    let rungs = SIZES_PER_OCTAVE * (size_m / smallest_m).log2();
    let mut rung = rungs.floor();
    let mut diameters_m = Vec::new();
    let mut mass = 0.0;
    while rung >= 0.0 {
        let diameter_m = smallest_m * (rung / SIZES_PER_OCTAVE).exp2();
        let own = (diameter_m / size_m).powi(3);
        let above = 1.0 - passing(family_exponent, size_m / diameter_m, t10);
        if mass + 0.5 * own <= above && mass + own <= 1.0 {
            diameters_m.push(diameter_m);
            mass += own;
        } else {
            rung -= 1.0;
        }
    }
    diameters_m
}

/// Centres of spheres with these radii, m, within a ball of this radius about the origin, their
/// centre of mass: moved apart from random places until they overlap little for the room there is.
/// They may reach out of the ball by a seventh of its radius. `seed` decides on the places.
pub fn arranged_m(radii_m: &[f64], ball_m: f64, seed: u64) -> Vec<Vector3<f64>> {
    let room_m = |radius_m: f64| (ball_m - radius_m).max(LEAST_ROOM * ball_m);
    let start = |(n, radius_m): (usize, &f64)| {
        let [u, v, w] = [0, 1, 2].map(|which| uniform(seed, &[n as u64, which]));
        let height = 2.0 * u - 1.0;
        let across = (1.0 - height * height).sqrt();
        let turn = std::f64::consts::TAU * v;
        room_m(*radius_m)
            * w.cbrt()
            * Vector3::new(across * turn.cos(), across * turn.sin(), height)
    };
    let mut places: Vec<Vector3<f64>> = radii_m.iter().enumerate().map(start).collect();
    for _ in 0..ROUNDS {
        move_apart(&mut places, radii_m);
        for (place, radius_m) in places.iter_mut().zip(radii_m) {
            let most_m = room_m(*radius_m);
            let far_m = place.norm();
            if far_m > most_m {
                *place *= most_m / far_m;
            }
        }
        about_centre_of_mass(&mut places, radii_m);
    }
    places
}

/// Moves each two that overlap apart by the overlap, the lighter one further.
fn move_apart(places: &mut [Vector3<f64>], radii_m: &[f64]) {
    for b in 1..places.len() {
        for a in 0..b {
            let between = places[b] - places[a];
            let far_m = between.norm();
            let overlap_m = radii_m[a] + radii_m[b] - far_m;
            if overlap_m > 0.0 && far_m > 0.0 {
                let [of_a, of_b] = [a, b].map(|n| radii_m[n].powi(3));
                let way = between * (overlap_m / (far_m * (of_a + of_b)));
                places[a] -= way * of_b;
                places[b] += way * of_a;
            }
        }
    }
}

/// Moves the centre of mass to the origin.
fn about_centre_of_mass(places: &mut [Vector3<f64>], radii_m: &[f64]) {
    let cubes = || radii_m.iter().map(|radius_m| radius_m.powi(3));
    let moments = places.iter().zip(cubes()).map(|(place, cube)| place * cube);
    let centre = moments.sum::<Vector3<f64>>() / cubes().sum::<f64>();
    places.iter_mut().for_each(|place| *place -= centre);
}

#[cfg(test)]
mod tests {
    use super::{arranged_m, diameters_m, passing};

    #[test]
    fn daughters_follow_the_family_to_half_of_one() {
        for t10 in [0.001, 0.02, 0.1, 0.3, 0.6] {
            for smallest_m in [0.5e-3, 2e-3, 6e-3, 19e-3] {
                let size_m = 20e-3;
                let diameters_m = diameters_m(0.87, t10, size_m, smallest_m);
                let own = |diameter_m: f64| (diameter_m / size_m).powi(3);
                let above = |d_m: f64| 1.0 - passing(0.87, size_m / d_m, t10);
                let mut mass = 0.0;
                for diameter_m in &diameters_m {
                    assert!(mass + 0.5 * own(*diameter_m) <= above(*diameter_m));
                    let larger_m = diameter_m * 2.0_f64.powf(1.0 / 32.0);
                    let fits = larger_m <= size_m && mass + own(larger_m) <= 1.0;
                    let is_below = mass + 0.5 * own(larger_m) <= above(larger_m) - 1e-12;
                    assert!(
                        !(fits && is_below),
                        "{t10} {smallest_m}: {larger_m} was left out"
                    );
                    mass += own(*diameter_m);
                }
                assert!(mass <= 1.0);
                // Fines are what passes the smallest size, to half of the smallest daughter.
                let fines = passing(0.87, size_m / smallest_m, t10);
                let least = diameters_m.last().copied().map_or(own(smallest_m), own);
                assert!(
                    (1.0 - mass - fines).abs() <= 0.5 * least + 1e-12,
                    "{t10} {smallest_m}"
                );
            }
        }
    }

    #[test]
    fn daughters_lie_within_the_particle_about_its_centre_and_apart() {
        for (t10, smallest_m) in [
            (0.02, 2e-3),
            (0.02, 10e-3),
            (0.05, 4e-3),
            (0.3, 2e-3),
            (0.6, 1e-3),
        ] {
            // The ball is smaller than the particle where something presses into it.
            for (seed, ball_m) in [(1, 10e-3), (2, 9.5e-3), (3, 8e-3), (4, 6e-3)] {
                let diameters_m = diameters_m(0.87, t10, 20e-3, smallest_m);
                let radii_m: Vec<f64> = diameters_m.iter().map(|d| 0.5 * d).collect();
                let places = arranged_m(&radii_m, ball_m, seed);
                let mut moment = nalgebra::Vector3::zeros();
                for (place, radius_m) in places.iter().zip(&radii_m) {
                    let out_m = place.norm() + radius_m - ball_m.max(*radius_m);
                    assert!(out_m < ball_m / 7.0, "{t10} {ball_m}: {out_m}");
                    moment += place * radius_m.powi(3);
                }
                let scale: f64 = radii_m.iter().map(|r| ball_m * r.powi(3)).sum();
                assert!(moment.norm() < 1e-12 * scale);
                for b in 1..places.len() {
                    for a in 0..b {
                        let far_m = (places[a] - places[b]).norm();
                        assert!(
                            far_m > 0.01 * radii_m[a].min(radii_m[b]),
                            "{t10} {ball_m}: {far_m}"
                        );
                    }
                }
                assert_ne!(arranged_m(&radii_m, ball_m, seed + 10), places);
            }
        }
    }
}
